"""The kinematics of a rotary delta robot: position, velocity and acceleration, both ways, on arrays of poses.

The notation is that of `deltacam.robot.arms`.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from deltacam.errors import RobotError
from deltacam.model import Array, BoolArray
from deltacam.robot.arms import (
    ROUNDING,
    SINGULAR,
    components,
    forearm_vectors,
    loop_constant,
    machine_vectors,
    rows,
    seen_from_arms,
    solve,
    solve_drivable,
)
from deltacam.robot.dimensions import DeltaGeometry


def inverse(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """The joint angles that bring the tool to ``points``, elbows outwards.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m, on the tool's side of the base.

    Returns:
        (N, 3) rad, in -pi to pi.

    Raises:
        RobotError: a point is not finite, on the wrong side of the base, or out of reach; says which, which arm, and by
            how much.
        ValueError: the shape is not (N, 3).
    """
    arms = solve(geometry, points)
    return np.arctan2(arms.sin, arms.cos)


def forward(geometry: DeltaGeometry, angles: npt.ArrayLike) -> Array:
    """The tool points at which joint ``angles`` hold the effector, the lower of the two solutions.

    The tool is where three spheres of the forearm's length about the elbows meet: the centre of the circle through the
    elbows, and from there down along the normal of their plane. It undoes `inverse` and nothing else: angles at which
    an elbow would fold inwards are refused, because `inverse` never gives them.

    Args:
        geometry: the robot.
        angles: (N, 3) rad.

    Returns:
        (N, 3) in the machine frame, m, on the tool's side of the base.

    Raises:
        RobotError: an angle is not finite, or the forearms do not meet below the base with the elbows outwards.
        ValueError: the shape is not (N, 3).
    """
    q = rows(angles, "joint angles")
    cos, sin = np.cos(q), np.sin(q)
    La, still = geometry.upper_arms, geometry.offsets
    elbows = geometry.centre + machine_vectors(geometry, still + La * cos, 0.0, -La * sin)
    points, meets = meeting_point(elbows, geometry.forearms, down=-geometry.up)
    x, _, z = seen_from_arms(geometry, points)
    t = -(x * sin + z * cos)
    _refuse_angles(meets, q, "the forearms do not meet in one point")
    _refuse_angles(z[:, 0] < 0.0, q, f"the forearms meet {'below' if geometry.mount.upside_down else 'above'} the base")
    _refuse_angles((t / geometry.forearms).min(axis=1) >= -SINGULAR, q, "an elbow is folded inwards")
    return points


def inverse_jacobian(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """The matrices that turn a tool velocity into joint speeds: row i is S_i / (S_i.b_i).

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.

    Returns:
        (N, 3, 3) rad/m; ``[n, i]`` is the row of joint i.

    Raises:
        RobotError: as `inverse`, and where an arm is at the edge of its reach.
        ValueError: the shape is not (N, 3).
    """
    arms = solve_drivable(geometry, points)
    return forearm_vectors(geometry, arms) / (geometry.upper_arms * arms.t)[:, :, np.newaxis]


def joint_curvatures(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """The second derivatives of the joint angles by the tool's position: qdd_i = row_i . a + v.H_i v.

    H_i = ((1 - b g^T)^T (1 - b g^T) - (S.db/dq) g g^T) / (S.b) with g the row of `inverse_jacobian`.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.

    Returns:
        (N, 3, 3, 3) rad/m^2; ``[n, i]`` is the symmetric matrix of joint i.

    Raises:
        RobotError: as `inverse_jacobian`.
        ValueError: the shape is not (N, 3).
    """
    arms = solve_drivable(geometry, points)
    La, drive = geometry.upper_arms, geometry.upper_arms * arms.t
    g = forearm_vectors(geometry, arms) / drive[:, :, np.newaxis]
    b = machine_vectors(geometry, -La * arms.sin, 0.0, -La * arms.cos)
    moved = np.eye(3) - b[..., :, np.newaxis] * g[..., np.newaxis, :]
    turned = (La * (La - arms.k))[..., np.newaxis, np.newaxis] * (g[..., :, np.newaxis] * g[..., np.newaxis, :])
    return np.asarray((np.swapaxes(moved, -1, -2) @ moved - turned) / drive[..., np.newaxis, np.newaxis])


def path_derivatives(
    geometry: DeltaGeometry, p: npt.ArrayLike, dp: npt.ArrayLike, ddp: npt.ArrayLike
) -> tuple[Array, Array, Array]:
    """Joint angles along a path and their first two derivatives by the path's parameter, in closed form.

    From |S_i|^2 = Lb^2 differentiated twice: S.b q' = S.p' and
    S.b q'' = |p' - b q'|^2 + S.p'' - (S.db/dq) q'^2.

    Args:
        geometry: the robot.
        p: points of the path, (N, 3) m.
        dp: dp/ds, (N, 3).
        ddp: d2p/ds2, (N, 3).

    Returns:
        q (N, 3) rad, dq/ds (N, 3), d2q/ds2 (N, 3). With time as the parameter: speed and acceleration.

    Raises:
        RobotError: as `inverse_jacobian`, or a derivative is not finite.
        ValueError: a shape is not (N, 3), or the shapes differ.
    """
    arms = solve_drivable(geometry, p)
    first, second = rows(dp, "first derivatives"), rows(ddp, "second derivatives")
    if not len(first) == len(second) == len(arms.t):
        raise ValueError(f"{len(arms.t)} points, {len(first)} first and {len(second)} second derivatives")
    La = geometry.upper_arms
    drive = La * arms.t
    sx, sz = arms.x - La * arms.cos, arms.z + La * arms.sin
    dx, dy, dz = components(geometry, first)
    ddx, ddy, ddz = components(geometry, second)
    dq = (sx * dx + arms.y * dy + sz * dz) / drive
    swing = (dx + La * arms.sin * dq) ** 2 + dy**2 + (dz + La * arms.cos * dq) ** 2
    ddq = (swing + sx * ddx + arms.y * ddy + sz * ddz - La * (La - arms.k) * dq**2) / drive
    return np.arctan2(arms.sin, arms.cos), dq, ddq


def third_derivative(
    geometry: DeltaGeometry, p: npt.ArrayLike, dp: npt.ArrayLike, ddp: npt.ArrayLike, dddp: npt.ArrayLike
) -> Array:
    """The third derivative of the joint angles by the parameter of a path, in closed form.

    From |S_i|^2 = Lb^2 differentiated three times, with S' and S'' the derivatives of the forearm:
    S.b q''' = 3 S'.S'' + S.p''' - 3 (S.db/dq) q' q'' + S.b q'^3.

    Args:
        geometry: the robot.
        p: points of the path, (N, 3) m.
        dp: dp/ds, (N, 3).
        ddp: d2p/ds2, (N, 3).
        dddp: d3p/ds3, (N, 3).

    Returns:
        d3q/ds3 (N, 3). With time as the parameter: jerk.

    Raises:
        RobotError: as `path_derivatives`.
        ValueError: a shape is not (N, 3), or the shapes differ.
    """
    _, dq, ddq = path_derivatives(geometry, p, dp, ddp)
    arms, third = solve_drivable(geometry, p), rows(dddp, "third derivatives")
    if len(third) != len(dq):
        raise ValueError(f"{len(dq)} points, {len(third)} third derivatives")
    La = geometry.upper_arms
    drive = La * arms.t
    bx, bz, cx, cz = -La * arms.sin, -La * arms.cos, -La * arms.cos, La * arms.sin  # b and db/dq along u and z
    sx, sz = arms.x + cx, arms.z + cz
    dx, dy, dz = components(geometry, rows(dp, "first derivatives"))
    ddx, ddy, ddz = components(geometry, rows(ddp, "second derivatives"))
    dddx, dddy, dddz = components(geometry, third)
    swing = (dx - bx * dq) * (ddx - bx * ddq - cx * dq**2) + dy * ddy + (dz - bz * dq) * (ddz - bz * ddq - cz * dq**2)
    pull = sx * dddx + arms.y * dddy + sz * dddz
    return np.asarray((3.0 * swing + pull - 3.0 * La * (La - arms.k) * dq * ddq) / drive + dq**3)


def reach_margin(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """How far every arm is from the edge of its reach: (sqrt(D) - |k|) / La, smooth, negative out of reach.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m; they may be out of reach.

    Returns:
        (N, 3), no unit; a small margin is close to the distance from the edge as a part of the upper arm.

    Raises:
        RobotError: a point is not finite.
        ValueError: the shape is not (N, 3).
    """
    x, y, z = seen_from_arms(geometry, rows(points, "points"))
    return (np.hypot(x, z) - np.abs(loop_constant(geometry, x, y, z))) / geometry.upper_arms


def forearm_directions(geometry: DeltaGeometry, points: npt.ArrayLike) -> tuple[Array, Array]:
    """The unit vectors of the forearms, elbow to effector, and t / Lb, which is cos(S_i, b_i).

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.

    Returns:
        (N, 3, 3), ``[n, i]`` is the direction of forearm i; (N, 3).

    Raises:
        RobotError: as `inverse`.
        ValueError: the shape is not (N, 3).
    """
    arms = solve(geometry, points)
    return forearm_vectors(geometry, arms) / geometry.forearms[:, np.newaxis], arms.t / geometry.forearms


def meeting_point(centres: Array, radii: Array, *, down: float) -> tuple[Array, BoolArray]:
    """The point at ``radii``, (3,) or (N, 3), from three ``centres`` (N, 3, 3), and whether it exists: (N, 3), (N,).

    Of the two, the one on the side of z that ``down``, 1 or -1, points to. With the first centre as origin, the point p
    has 2 a.p = |a|^2 + r1^2 - r2^2 and 2 b.p = |b|^2 + r1^2 - r3^2, and the rest of it is along the normal a x b.
    """
    a, b = centres[:, 1] - centres[:, 0], centres[:, 2] - centres[:, 0]
    normal = np.cross(a, b)
    area = np.einsum("ij,ij->i", normal, normal)
    largest = radii.max()
    plane = (area > (ROUNDING * largest**2) ** 2) & (normal[:, 2] ** 2 > ROUNDING * area)
    area = np.where(plane, area, 1.0)
    to_a = np.einsum("ij,ij->i", a, a) + (radii[..., 0] ** 2 - radii[..., 1] ** 2)
    to_b = np.einsum("ij,ij->i", b, b) + (radii[..., 0] ** 2 - radii[..., 2] ** 2)
    in_plane = np.cross(to_a[:, np.newaxis] * b - to_b[:, np.newaxis] * a, normal) / (2.0 * area)[:, np.newaxis]
    square = radii[..., 0] ** 2 - np.einsum("ij,ij->i", in_plane, in_plane)
    along = down * np.sign(normal[:, 2]) * np.sqrt(np.maximum(square, 0.0) / area)
    return centres[:, 0] + in_plane + along[:, np.newaxis] * normal, plane & (square >= -ROUNDING * largest**2)


def _refuse_angles(good: BoolArray, angles: Array, why: str) -> None:
    if not good.all():
        first = int(np.argmin(good))
        degrees = ", ".join(f"{angle:.4f}" for angle in np.degrees(angles[first]))
        what = f"{len(good) - good.sum()} of {len(good)} poses are impossible: {why}"
        raise RobotError(f"{what} at ({degrees}) degrees", where=f"pose {first}")
