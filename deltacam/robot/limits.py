"""The joint limits that follow from what the tool must be able to do."""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from deltacam.model import Array
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.kinematics import inverse_jacobian, joint_curvatures
from deltacam.robot.workspace import Workspace

_COVER: Final = 1e-6  # the derived limit is raised by this part, so that it covers what the search may have missed
_DIGITS: Final = 7  # of a derived limit: the same on every machine


def joint_speed_demand(geometry: DeltaGeometry, points: Array, *, speed: float) -> Array:
    """The largest joint speed while the tool moves at ``speed`` in any direction of the sheet's plane.

    qd_i = row_i . v, so the largest over all directions is |row_i,xy| |v|.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.
        speed: of the tool, m/s.

    Returns:
        (N, 3) rad/s.

    Raises:
        RobotError: a point is out of reach.
    """
    return np.asarray(np.linalg.norm(inverse_jacobian(geometry, points)[:, :, :2], axis=2)) * speed


def joint_acceleration_demand(geometry: DeltaGeometry, points: Array, *, speed: float, acceleration: float) -> Array:
    """The largest joint acceleration while the tool has any speed and acceleration up to these, in any two directions.

    qdd_i = row_i . a + v.H_i v with the symmetric `joint_curvatures` H_i. The two terms are independent, so the largest
    sum is |row_i,xy| a + max(|lambda|) v^2 over the eigenvalues of the plane part of H_i.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.
        speed: of the tool, m/s.
        acceleration: of the tool, m/s^2.

    Returns:
        (N, 3) rad/s^2.

    Raises:
        RobotError: a point is out of reach.
    """
    turning = joint_turning(geometry, points) * speed**2
    return joint_speed_demand(geometry, points, speed=acceleration) + turning


def joint_turning(geometry: DeltaGeometry, points: Array) -> Array:
    """The largest joint acceleration of a tool that moves straight on at 1 m/s, in any direction of the sheet's plane.

    Args:
        geometry: the robot.
        points: (N, 3) in the machine frame, m.

    Returns:
        (N, 3) rad/m^2, to be multiplied by the square of the tool's speed.

    Raises:
        RobotError: a point is out of reach.
    """
    H = joint_curvatures(geometry, points)
    mean = (H[:, :, 0, 0] + H[:, :, 1, 1]) / 2.0
    spread = np.hypot((H[:, :, 0, 0] - H[:, :, 1, 1]) / 2.0, H[:, :, 0, 1])
    return np.asarray(np.abs(mean) + spread)


def derive_max_speed(geometry: DeltaGeometry, workspace: Workspace, *, speed: float) -> float:
    """The smallest joint speed limit, rad/s, that lets the tool have its ``speed``, m/s, everywhere on the sheet.

    One limit for the three joints, the largest of theirs: they are the same motors, and the largest differs only where
    the sheet is not as symmetric as the arms.

    Raises:
        RobotError: a part of the sheet is out of reach.
    """
    value, _ = workspace.worst(lambda points: joint_speed_demand(geometry, points, speed=speed).max(axis=1))
    return _cover(value)


def derive_max_acceleration(
    geometry: DeltaGeometry, workspace: Workspace, *, speed: float, acceleration: float
) -> float:
    """The smallest joint acceleration limit, rad/s^2, for the tool's ``speed`` and ``acceleration`` at the same time.

    It holds everywhere on the sheet and for any two directions in its plane; m/s and m/s^2. One limit for the three
    joints, as in `derive_max_speed`.

    Raises:
        RobotError: a part of the sheet is out of reach.
    """

    def demand(points: Array) -> Array:
        needed = joint_acceleration_demand(geometry, points, speed=speed, acceleration=acceleration)
        return np.asarray(needed.max(axis=1))

    value, _ = workspace.worst(demand)
    return _cover(value)


def _cover(value: float) -> float:
    """The value raised a little, to a number of few digits."""
    scale = 10.0 ** (_DIGITS - 1 - math.floor(math.log10(value)))
    return math.ceil(value * (1.0 + _COVER) * scale) / scale
