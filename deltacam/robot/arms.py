"""Poses of the robot seen from its arms: what every kinematic quantity is made of.

Arm i stands at azimuth phi_i in the vertical plane of u_i = (cos phi_i, sin phi_i, 0), whose normal is
w_i = (-sin phi_i, cos phi_i, 0). Joint angle 0 is the upper arm horizontal and outwards, positive is down. Seen from
the joint, the effector's joint is at x = P.u_i - (R - r), y = P.w_i, z = P.z < 0. C_i is the elbow, S_i = P - C_i the
forearm, and b_i = dC_i/dq_i. With

    k = (x^2 + y^2 + z^2 + La^2 - Lb^2) / (2 La),  D = x^2 + z^2,  t = sqrt(D - k^2)

the loop closure |S_i| = Lb reads x cos q - z sin q = k, and S_i.b_i = La t, S_i.db_i/dq_i = La (La - k). The elbow
points outwards where t > 0; t = 0 is the edge of reach (Clavel 1991; Williams 2015, "The delta parallel robot").
R, r, La and Lb may differ from arm to arm: they are arrays (3,), and every formula holds for each arm by itself.

Points and vectors come in the machine frame. The base may stand turned, moved or upside down in it
(`dimensions.Mount`); u_i, w_i and z are then its directions there, and this module is where they are taken.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
import numpy.typing as npt

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot.dimensions import DeltaGeometry

ROUNDING: Final = 1e-12  # of a squared length: below it a negative number under a root is rounding, not geometry
SINGULAR: Final = 1e-6  # of the forearm: below it t is taken as zero
_LARGEST: Final = 1e12  # of any coordinate, angle or derivative, in SI: its fourth power is still finite
_LOWEST_BASE: Final = -1e-6  # m; the tool is below it, in the base's own frame


class Arms(NamedTuple):
    """Poses seen from the arms; every array is (N, 3), one column per arm, but z, which is (N, 1)."""

    x: Array
    y: Array
    z: Array
    k: Array
    t: Array
    cos: Array
    sin: Array


def solve(geometry: DeltaGeometry, points: npt.ArrayLike) -> Arms:
    """The inverse kinematics without the arc tangent: cosine and sine of every joint angle, and what they come from.

    Raises:
        RobotError: a point is not finite, on the wrong side of the base, or out of reach; says which, which arm, and by
            how much.
        ValueError: the shape is not (N, 3).
    """
    array = rows(points, "points")
    x, y, z = seen_from_arms(geometry, array)
    k = loop_constant(geometry, x, y, z)
    D = x**2 + z**2
    square = D - k**2
    if (square < -ROUNDING * D).any() or (z > _LOWEST_BASE).any():
        raise _out_of_reach(geometry, array)
    t = np.sqrt(np.maximum(square, 0.0))
    return Arms(x, y, z, k, t, (x * k - z * t) / D, -(z * k + x * t) / D)


def solve_drivable(geometry: DeltaGeometry, points: npt.ArrayLike) -> Arms:
    """As `solve`, for poses in which every joint moves the tool.

    Raises:
        RobotError: as `solve`, and where an arm is at the edge of its reach.
        ValueError: the shape is not (N, 3).
    """
    arms = solve(geometry, points)
    stretched = arms.t <= SINGULAR * geometry.forearms
    if stretched.any():
        worst, arm = divmod(int(np.argmin(arms.t)), 3)
        count = stretched.any(axis=1).sum()
        what = f"arm {arm + 1} is at the edge of its reach at {_millimetres(np.asarray(points)[worst])}"
        raise RobotError(f"{what}, where its joint speed has no bound; {count} such points", where=f"point {worst}")
    return arms


def forearm_vectors(geometry: DeltaGeometry, arms: Arms) -> Array:
    """S_i in the machine frame: (N, 3, 3), ``[n, i]`` is the vector from elbow i to the effector."""
    along, down = arms.x - geometry.upper_arms * arms.cos, arms.z + geometry.upper_arms * arms.sin
    return machine_vectors(geometry, along, arms.y, down)


def machine_vectors(geometry: DeltaGeometry, along: Array, across: Array | float, upwards: Array) -> Array:
    """Vectors in the machine frame: (N, 3, 3), ``[n, i]`` has the components of arm i.

    Args:
        geometry: the robot.
        along: u_i, (N, 3).
        across: w_i, (N, 3).
        upwards: the base's z, (N, 3).
    """
    u, w = geometry.outwards, geometry.sideways
    x, y = along * u[:, 0] + across * w[:, 0], along * u[:, 1] + across * w[:, 1]
    return np.stack((x, y, geometry.up * upwards), axis=-1)


def rows(values: npt.ArrayLike, name: str) -> Array:
    """The values as an array of N rows of three numbers.

    Raises:
        RobotError: a value is nan, infinite, or beyond anything that a robot has.
        ValueError: the shape is not (N, 3).
    """
    array = np.asarray(values, dtype=np.float64)
    if array.ndim != 2 or array.shape[1] != 3:
        raise ValueError(f"{name}: expected shape (N, 3), got {array.shape}")
    usable = np.abs(array) <= _LARGEST  # false for nan
    if not usable.all():
        bad = ~usable.all(axis=1)
        raise RobotError(f"{bad.sum()} of {len(array)} {name} are not finite", where=f"row {int(np.argmax(bad))}")
    return array


def components(geometry: DeltaGeometry, vectors: Array) -> tuple[Array, Array, Array]:
    """Vectors (N, 3) of the machine along u_i, w_i and the base's z: (N, 3), (N, 3), (N, 1)."""
    u, w = geometry.outwards, geometry.sideways
    vx, vy = vectors[:, :1], vectors[:, 1:2]
    # Term by term: a product of matrices may round otherwise for another number of rows, and a program must not.
    return vx * u[:, 0] + vy * u[:, 1], vx * w[:, 0] + vy * w[:, 1], geometry.up * vectors[:, 2:]


def seen_from_arms(geometry: DeltaGeometry, points: Array) -> tuple[Array, Array, Array]:
    """Where the effector's joints are, from the base joints of the arms: x, y, z of the module's notation."""
    x, y, z = components(geometry, points - geometry.centre)
    return x - geometry.offsets, y, z


def loop_constant(geometry: DeltaGeometry, x: Array, y: Array, z: Array) -> Array:
    """The constant k of the loop closure, (N, 3) m."""
    La, Lb = geometry.upper_arms, geometry.forearms
    k: Array = (x**2 + y**2 + z**2 + (La**2 - Lb**2)) / (2.0 * La)
    return k


def _out_of_reach(geometry: DeltaGeometry, points: Array) -> RobotError:
    """The error that names the worst point, its arm, and the distance that is missing."""
    x, y, z = seen_from_arms(geometry, points)
    above = z[:, 0] > _LOWEST_BASE
    if above.any():
        worst = int(np.argmax(z))
        side, most = ("above", "lowest") if geometry.mount.upside_down else ("below", "highest")
        what = f"{above.sum()} of {len(points)} points are not {side} the base; the {most} is"
        return RobotError(f"{what} {_millimetres(points[worst])}", where=f"point {worst}")
    bar = np.sqrt(np.maximum(geometry.forearms**2 - y**2, 0.0))  # the forearm seen in the plane of the arm
    distance = np.hypot(x, z)
    too_far = np.maximum(distance - (geometry.upper_arms + bar), np.abs(y) - geometry.forearms)
    too_near = np.abs(geometry.upper_arms - bar) - distance
    missing = np.maximum(too_far, too_near)
    worst, arm = divmod(int(np.argmax(missing)), 3)
    far = "too far" if too_far[worst, arm] >= too_near[worst, arm] else "too near"
    return RobotError(
        f"{(missing > 0.0).any(axis=1).sum()} of {len(points)} points are out of reach; the worst is "
        f"{_millimetres(points[worst])}, {missing[worst, arm] * 1e3:.3f} mm {far} for arm {arm + 1}",
        where=f"point {worst}",
    )


def _millimetres(point: Array) -> str:
    return "({:.3f}, {:.3f}, {:.3f}) mm".format(*(1e3 * point))
