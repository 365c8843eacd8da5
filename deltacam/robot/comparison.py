"""Robots side by side: the figures of each, and what one made of a drawing."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from deltacam.robot.measures import tool_error_per_joint_error
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.robot import Robot

ARCMIN: Final = math.radians(1.0 / 60.0)


@dataclass(frozen=True, slots=True)
class Profile:
    """A robot without a drawing.

    Attributes:
        name: of the robot.
        robot: as it was read.
        reach: diameter of the largest circle about the base's axis that lies on its sheet, m.
        condition: largest condition number of the Jacobian on the sheet.
        error: largest tool error on the sheet for a joint-error vector of norm 1 arcmin, m.
        pressure: largest pressure angle on the sheet, rad.
    """

    name: str
    robot: Robot
    reach: float
    condition: float
    error: float
    pressure: float


@dataclass(frozen=True, slots=True)
class Outcome:
    """What one robot makes of the drawing.

    Attributes:
        name: of the robot.
        fits: whether the whole drawing lies on the sheet, moved or turned where it must be.
        passed: whether a program was planned and every check of it passed.
        reason: why not; empty where it passed.
        at: where the centre of the drawing lies, m; None where no program was planned, as all that follows.
        rotation: of the drawing about it, rad.
        duration: of the program, s.
        laser: time with the laser on, s.
        binds: the limits that hold the contours back, with their share of the time along them, the largest first.
        error: largest tool error over the cut for a joint-error vector of norm 1 arcmin, m.
    """

    name: str
    fits: bool
    passed: bool
    reason: str = ""
    at: tuple[float, float] | None = None
    rotation: float | None = None
    duration: float | None = None
    laser: float | None = None
    binds: tuple[tuple[str, float], ...] = ()
    error: float | None = None


def profiles(robots: Sequence[str | Path] = ()) -> tuple[Profile, ...]:
    """The figures of robots, all built-in ones where none is named.

    Raises:
        RobotError: a robot cannot be read.
    """
    return tuple(_profile(load_robot(name)) for name in robots or profile_names())


def _profile(robot: Robot) -> Profile:
    sheet, points = robot.workspace, robot.workspace.grid()
    half = sheet.radius if sheet.radius is not None else min(sheet.width or 0.0, sheet.depth or 0.0) / 2.0
    return Profile(
        name=robot.name,
        robot=robot,
        reach=2.0 * half,
        condition=float(1.0 / robot.inverse_condition(points).min()),
        error=float(tool_error_per_joint_error(robot.geometry, points).max()) * ARCMIN,
        pressure=float(max(mu.max() for mu in robot.pressure_angles(points))),
    )
