"""Whether a robot can do over its whole sheet what its file says."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot import kinematics
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.robot import Robot
from deltacam.robot.workspace import Workspace

_ROUNDING: Final = 1e-12  # rad
_HINT: Final = "make the sheet smaller, or move it up or down (sheet_z_mm)"


def check_reach(geometry: DeltaGeometry, workspace: Workspace) -> None:
    """Refuse a sheet of which a part is out of reach, or at the very edge of it.

    Raises:
        RobotError: the sheet is on the wrong side of the base; or the worst point, which arm, and by how much.
    """
    _refuse_wrong_side(geometry, workspace)
    _, nearest = workspace.worst(lambda points: -kinematics.reach_margin(geometry, points).min(axis=1))
    for points in (nearest[np.newaxis], workspace.grid()):
        try:
            kinematics.inverse_jacobian(geometry, points)
        except RobotError as problem:
            what = f"the robot does not reach its whole sheet: {problem.what}"
            raise RobotError(what, where="workspace", hint=_HINT) from problem


def _refuse_wrong_side(geometry: DeltaGeometry, workspace: Workspace) -> None:
    mount = geometry.mount
    if geometry.up * (workspace.sheet_z - mount.z) >= 0.0:
        side = "above" if mount.upside_down else "below"
        hint = "the base hangs above the sheet, or stands below it with upside_down = true in [mount]"
        what = f"sheet_z_mm = {1e3 * workspace.sheet_z:g} is not {side} the base, which is at {1e3 * mount.z:g} mm"
        raise RobotError(what, where="workspace", hint=hint)


def check_workspace(robot: Robot) -> None:
    """Refuse a robot that leaves its joint range, or passes on force badly, somewhere on its sheet.

    The worst of reach, joint range, pressure angles and forearm swing is searched for over the sheet, edge included.

    Raises:
        RobotError: what is exceeded, where on the sheet, by how much, and the limit.
    """
    check_reach(robot.geometry, robot.workspace)
    worst, point = robot.workspace.worst(lambda points: _excesses(robot, points).max(axis=(1, 2)))
    if worst > _ROUNDING:
        kind, arm = divmod(int(_excesses(robot, point[np.newaxis]).argmax()), 3)
        what, limit = _what(robot, kind, arm)
        place = "({:.1f}, {:.1f}, {:.1f}) mm".format(*(1e3 * point))
        raise RobotError(
            f"{what} {np.degrees(limit):g} deg is exceeded by {np.degrees(worst):.3f} deg with the tool at {place}",
            where="workspace",
            hint=f"{_HINT}; or change the limit if the machine allows it",
        )


def _excesses(robot: Robot, points: Array) -> Array:
    """By how much every limit is exceeded, negative within it: (N, 5, 3) rad, in the order of `_what`."""
    angles = robot.inverse(points)
    mu1, mu2 = robot.pressure_angles(points)
    pressure, swing = robot.workspace.max_pressure_angle, robot.workspace.max_forearm_swing
    leaning = robot.forearm_swing(points) - (np.pi if swing is None else swing)
    return np.stack(
        (angles - robot.joints.max, robot.joints.min - angles, mu1 - pressure, mu2 - pressure, leaning), axis=1
    )


def _what(robot: Robot, kind: int, arm: int) -> tuple[str, float]:
    """The name of a limit as the robot file has it, and its value, rad."""
    pressure, swing = robot.workspace.max_pressure_angle, robot.workspace.max_forearm_swing
    return (
        (f"joint {arm + 1}: max_deg", robot.joints.max[arm]),
        (f"joint {arm + 1}: min_deg", robot.joints.min[arm]),
        (f"arm {arm + 1}: max_pressure_angle_deg (mu1)", pressure),
        (f"arm {arm + 1}: max_pressure_angle_deg (mu2)", pressure),
        (f"arm {arm + 1}: max_forearm_swing_deg", np.pi if swing is None else swing),
    )[kind]
