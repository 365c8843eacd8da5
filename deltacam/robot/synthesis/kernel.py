"""The measures of many candidate designs at many poses at once: the inner loop of the synthesis.

A candidate is a row (R - r, La, Lb, z): three dimensions of a robot with the standard azimuths, and the height of the
middle of its workspace. The notation, and every formula, is that of `deltacam.robot.arms`, `deltacam.robot.measures`
and `deltacam.robot.limits`; here they do not refuse a pose out of reach but continue it, so that a search can see how
far away it is: the elbow stays where it is on the edge of reach, and the distance is in ``reach``.

Everything follows from S_i and t_i. The rows of the inverse Jacobian are S_i / (La t_i), so the squares of its
singular values are the eigenvalues of the Gram matrix S_i.S_j / (La^2 t_i t_j); they are taken from its characteristic
polynomial in closed form (Smith 1961), which is exact to rounding where the matrix is far from singular.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from deltacam.model import Array
from deltacam.robot.dimensions import STANDARD_AZIMUTHS

_COS: Final = np.cos(STANDARD_AZIMUTHS)[:, np.newaxis, np.newaxis]
_SIN: Final = np.sin(STANDARD_AZIMUTHS)[:, np.newaxis, np.newaxis]
_SMALLEST: Final = 1e-9  # of the forearm: t is not smaller, so that nothing divides by zero


class Poses(NamedTuple):
    """Candidates at poses seen from their arms; (3, C, N), one slab per arm, but the lengths, which are (C, 1)."""

    La: Array
    Lb: Array
    reach: Array
    sx: Array
    y: Array
    sz: Array
    k: Array
    t: Array
    cos: Array
    sin: Array


def poses(candidates: Array, points: Array) -> Poses:
    """The candidates (C, 4) m at points (N, 3) m about the middle of the workspace."""
    offset, La, Lb, middle = (column[:, np.newaxis] for column in candidates.T)
    x = points[:, 0] * _COS + points[:, 1] * _SIN - offset
    y = np.broadcast_to(points[:, 1] * _COS - points[:, 0] * _SIN, x.shape)
    z = points[:, 2] + middle
    D = x**2 + z**2
    root = np.sqrt(D)
    k = (D + y**2 + (La**2 - Lb**2)) / (2.0 * La)
    reach = (root - np.abs(k)) / La
    k = np.clip(k, -root, root)
    t = np.sqrt(np.maximum(D - k**2, (_SMALLEST * Lb) ** 2))
    cos, sin = (x * k - z * t) / D, -(z * k + x * t) / D
    return Poses(La, Lb, reach, x - La * cos, y, z + La * sin, k, t, cos, sin)


def joint_angles(at: Poses) -> Array:
    """The joint angles, (3, C, N) rad."""
    return np.arctan2(at.sin, at.cos)


def forearm_cosines(at: Poses) -> Array:
    """The cosines between forearms 2 and 3, 3 and 1, 1 and 2: (3, C, N)."""
    sx, sy = at.sx * _COS - at.y * _SIN, at.sx * _SIN + at.y * _COS
    turn, on = [1, 2, 0], [2, 0, 1]
    return np.asarray((sx[turn] * sx[on] + sy[turn] * sy[on] + at.sz[turn] * at.sz[on]) / at.Lb**2)


def transmission(cosines: Array) -> Array:
    """cos(mu2) of every arm, (3, C, N): the volume of the forearms over the area of the other two."""
    a, b, c = cosines
    volume = np.maximum(1.0 + 2.0 * a * b * c - (a**2 + b**2 + c**2), 0.0)
    return np.asarray(np.sqrt(np.minimum(volume / np.maximum(1.0 - cosines**2, 1e-15), 1.0)))


def singular_values(at: Poses, cosines: Array) -> tuple[Array, Array]:
    """The smallest and the largest singular value of the inverse Jacobian, each (C, N) rad/m."""
    scale = at.Lb / (at.La * at.t)
    d0, d1, d2 = scale**2
    turn, on = [1, 2, 0], [2, 0, 1]
    o12, o20, o01 = cosines * scale[turn] * scale[on]
    mean = (d0 + d1 + d2) / 3.0
    e0, e1, e2 = d0 - mean, d1 - mean, d2 - mean
    spread = np.sqrt((e0**2 + e1**2 + e2**2 + 2.0 * (o12**2 + o20**2 + o01**2)) / 6.0)
    spread = np.maximum(spread, 1e-14 * mean)
    determinant = e0 * (e1 * e2 - o12**2) - o01 * (o01 * e2 - o12 * o20) + o20 * (o01 * o12 - e1 * o20)
    turned = np.arccos(np.clip(determinant / (2.0 * spread**3), -1.0, 1.0)) / 3.0
    largest = mean + 2.0 * spread * np.cos(turned)
    smallest = mean + 2.0 * spread * np.cos(turned + 2.0 * np.pi / 3.0)
    return np.sqrt(np.maximum(smallest, 0.0)), np.sqrt(largest)


def joint_speeds(at: Poses, speed: float) -> Array:
    """The largest joint speeds for a tool ``speed``, m/s, in any direction of the plane: (3, C, N) rad/s."""
    return np.asarray(np.hypot(at.sx, at.y) / (at.La * at.t) * speed)


def joint_accelerations(at: Poses, speed: float, acceleration: float) -> Array:
    """The largest joint accelerations for a tool speed and acceleration, as `limits.joint_acceleration_demand`.

    The curvature I - g b^T - b g^T + La k g g^T over S.b, with g a row of the inverse Jacobian, in the plane of u, w.
    """
    drive = at.La * at.t
    gx, gy, bx = at.sx / drive, at.y / drive, -at.La * at.sin
    bend = at.La * at.k
    uu, ww = 1.0 - 2.0 * gx * bx + bend * gx**2, 1.0 + bend * gy**2
    uw = gy * (bend * gx - bx)
    turning = (np.abs(uu + ww) / 2.0 + np.hypot((uu - ww) / 2.0, uw)) / drive
    return np.asarray(np.hypot(gx, gy) * acceleration + turning * speed**2)
