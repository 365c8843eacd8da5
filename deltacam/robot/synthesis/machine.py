"""A design as a robot that programs can be planned for."""

from __future__ import annotations

import math
from typing import Final

from deltacam.errors import RobotError
from deltacam.robot.checks import check_workspace
from deltacam.robot.limits import derive_max_acceleration, derive_max_speed
from deltacam.robot.measures import pressure_angles
from deltacam.robot.robot import JointLimits, Robot, ToolRating
from deltacam.robot.synthesis.shape import BoxShape
from deltacam.robot.synthesis.synthesis import Design
from deltacam.robot.workspace import Workspace

SPEED: Final = 1.0
"""Rating of the tool where the wish names none, m/s."""

ACCELERATION: Final = 23.0
"""Likewise, m/s^2."""

_LARGEST_ANGLE_DEG: Final = 89.0  # that a robot file takes for a pressure angle


def machine(design: Design, *, name: str, sheet_z: float | None = None) -> Robot:
    """The robot of a design, with the sheet in the middle of its workspace or at another height of it.

    The joint limits are those of the wish, or derived from the tool's rating over the sheet.

    Args:
        design: from the synthesis.
        name: of the robot.
        sheet_z: height of the sheet, m.

    Raises:
        RobotError: the sheet is not in the workspace, or the robot cannot do over it what its file says.
    """
    wish, half = design.wish, design.wish.shape.height / 2.0
    height = design.middle if sheet_z is None else sheet_z
    if abs(height - design.middle) > half + 1e-9:
        low, high = (1e3 * (design.middle + side) for side in (-half, half))
        what = f"sheet_z = {height * 1e3:.3f} mm is not within the workspace, {low:.3f} to {high:.3f} mm"
        raise RobotError(what, where="--sheet-z", hint=f"leave it out for the middle, {design.middle * 1e3:.3f} mm")
    sheet = _sheet(design, height)
    tool = ToolRating(wish.speed or SPEED, wish.acceleration or ACCELERATION)
    speed, acceleration = wish.max_joint_speed, wish.max_joint_acceleration
    derived = tuple(key for key, value in (("max_speed", speed), ("max_acceleration", acceleration)) if value is None)
    if speed is None:
        speed = derive_max_speed(design.geometry, sheet, speed=tool.max_speed)
    if acceleration is None:
        acceleration = derive_max_acceleration(
            design.geometry, sheet, speed=tool.max_speed, acceleration=tool.max_acceleration
        )
    robot = Robot(
        name=name,
        geometry=design.geometry,
        joints=JointLimits(
            min=(wish.joint_min,) * 3,
            max=(wish.joint_max,) * 3,
            max_speed=(speed,) * 3,
            max_acceleration=(acceleration,) * 3,
            derived=derived,
        ),
        tool=tool,
        workspace=sheet,
        description=f"a design of size {design.size * 1e3:.1f} mm for a prescribed workspace",
        source=f"deltacam robot design, seed {design.seed}",
    )
    check_workspace(robot)
    return robot


def _sheet(design: Design, height: float) -> Workspace:
    """The sheet, with a bound on the pressure angles that the design keeps there: mu1 has none in most wishes."""
    shape, swing = design.wish.shape, design.wish.max_forearm_swing
    if isinstance(shape, BoxShape):
        sheet = Workspace(sheet_z=height, width=shape.width, depth=shape.depth)
    else:
        sheet = Workspace(sheet_z=height, radius=shape.diameter / 2.0)
    worst, _ = sheet.worst(lambda points: pressure_angles(design.geometry, points)[0].max(axis=1))
    asked = max(design.wish.max_transmission_angle, design.wish.max_drive_angle or 0.0)
    angle = min(max(math.degrees(asked), math.ceil(math.degrees(worst) + 0.01)), _LARGEST_ANGLE_DEG)
    return Workspace(
        sheet_z=sheet.sheet_z,
        width=sheet.width,
        depth=sheet.depth,
        radius=sheet.radius,
        max_pressure_angle=math.radians(angle),
        max_forearm_swing=swing,
    )
