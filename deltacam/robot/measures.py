"""How well a pose passes on force, motion and error: pressure angles, swing, condition number, error at the tool."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from deltacam.model import Array, BoolArray
from deltacam.robot.arms import SINGULAR, forearm_vectors, solve
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.kinematics import forearm_directions, inverse_jacobian


def pressure_angles(geometry: DeltaGeometry, points: npt.ArrayLike) -> tuple[Array, Array]:
    """The angles between the forces in the forearms and the motions that they cause; 90 degrees is a singularity.

    mu1 is the angle between forearm i and the motion of its elbow: towards 90 degrees the joint no longer moves the
    tool. mu2 is the angle between forearm i and the normal of the plane of the other two, along which the tool moves
    when only joint i turns: towards 90 degrees the tool gains a freedom that no joint holds.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.

    Returns:
        mu1 (N, 3) and mu2 (N, 3), rad, in 0 to pi/2.

    Raises:
        RobotError: a point is not finite or out of reach.
        ValueError: the shape is not (N, 3).
    """
    forearms, along = forearm_directions(geometry, points)
    normals = np.cross(forearms[:, [1, 2, 0]], forearms[:, [2, 0, 1]])
    lengths = np.linalg.norm(normals, axis=2)
    volume = np.abs(np.einsum("nij,nij->ni", forearms, normals))
    across = np.divide(volume, lengths, out=np.zeros_like(volume), where=lengths > 0.0)
    return np.arccos(np.minimum(along, 1.0)), np.arccos(np.minimum(across, 1.0))


def forearm_swing(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """How far every forearm leans out of the plane of its arm, which is what its ball joints must allow.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.

    Returns:
        (N, 3) rad, in 0 to pi/2.

    Raises:
        RobotError: a point is not finite or out of reach.
        ValueError: the shape is not (N, 3).
    """
    forearms, _ = forearm_directions(geometry, points)
    w = geometry.sideways
    aside = np.abs(forearms[:, :, 0] * w[:, 0] + forearms[:, :, 1] * w[:, 1])
    return np.arcsin(np.minimum(aside, 1.0))


def inverse_condition(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """The smallest over the largest singular value of the Jacobian: 1 is isotropic, 0 is singular.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.

    Returns:
        (N,), in 0 to 1.

    Raises:
        RobotError: a point is not finite, out of reach, or at the edge of an arm's reach.
        ValueError: the shape is not (N, 3).
    """
    values = np.linalg.svd(inverse_jacobian(geometry, points), compute_uv=False)
    return np.asarray(values[:, -1] / values[:, 0])


def tool_error_per_joint_error(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """How far the tool moves, at most, where the three joints turn by small angles whose squares add up to one.

    It is the largest singular value of the Jacobian dP/dq (Merlet 2006, "Parallel robots", on accuracy).

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.

    Returns:
        (N,) m/rad; inf where the forearms do not hold the effector.

    Raises:
        RobotError: a point is not finite or out of reach.
        ValueError: the shape is not (N, 3).
    """
    return _largest_gain(_jacobian(geometry, points))


def tool_error_per_joint_error_in_plane(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """As `tool_error_per_joint_error`, of x and y of the tool alone: what changes the size of a part.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.

    Returns:
        (N,) m/rad; inf where the forearms do not hold the effector.

    Raises:
        RobotError: a point is not finite or out of reach.
        ValueError: the shape is not (N, 3).
    """
    return _largest_gain(_jacobian(geometry, points)[:, :2])


def _jacobian(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """dP/dq from S_i.dP = (S_i.b_i) dq_i: (N, 3, 3) m/rad, one column per joint; nan where the S_i lie in a plane."""
    arms = solve(geometry, points)
    forearms = forearm_vectors(geometry, arms)
    lengths = np.linalg.norm(forearms, axis=2)
    volume = np.linalg.det(forearms / lengths[:, :, np.newaxis])
    held = (np.abs(volume) > SINGULAR).reshape(-1, 1, 1)
    drive = geometry.upper_arms * arms.t
    return np.where(held, np.linalg.inv(np.where(held, forearms, np.eye(3))) * drive[:, np.newaxis], np.nan)


def _largest_gain(matrices: Array) -> Array:
    """The largest singular values of ``matrices`` (N, M, 3): (N,), inf for those that hold nan."""
    known: BoolArray = np.asarray(np.isfinite(matrices).all(axis=(1, 2)))
    values = np.linalg.svd(np.where(known.reshape(-1, 1, 1), matrices, 0.0), compute_uv=False)
    return np.where(known, values[:, 0], np.inf)
