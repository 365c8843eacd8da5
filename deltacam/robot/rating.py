"""What the tool's rating needs of the joints over the sheet, and what the joints allow the tool."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from deltacam.model import Array
from deltacam.robot.limits import joint_acceleration_demand, joint_speed_demand, joint_turning
from deltacam.robot.robot import Robot

PerJoint = Callable[[Array], Array]
"""Takes points (N, 3) m, gives a value for each joint, (N, 3)."""


@dataclass(frozen=True, slots=True, eq=False)
class Extreme:
    """The largest or smallest value over the sheet.

    Attributes:
        value: in SI.
        point: where, (3,) m.
        joint: of which joint, from 0.
    """

    value: float
    point: Array
    joint: int


@dataclass(frozen=True, slots=True, eq=False)
class Rating:
    """What a robot can do over its whole sheet, in any direction of the sheet's plane.

    Attributes:
        speed_needed: the largest joint speed at the tool's rated speed, rad/s.
        acceleration_needed: the largest joint acceleration at the rated acceleration and speed at once, rad/s^2.
        speed_allowed: the smallest tool speed that the joints' speed limits allow, m/s.
        acceleration_from_rest: the smallest tool acceleration that the joints' limits allow a tool at rest, m/s^2.
        acceleration_at_speed: the same for a tool at its rated speed, m/s^2; negative where it cannot even go on
            straight.
        angles: the smallest and the largest angle of every joint, (2, 3) rad.
        pressure_angles: the largest mu1 and mu2, rad, and where, (3,) m each.
        inverse_condition: the smallest, and where.
    """

    speed_needed: Extreme
    acceleration_needed: Extreme
    speed_allowed: Extreme
    acceleration_from_rest: Extreme
    acceleration_at_speed: Extreme
    angles: Array
    pressure_angles: tuple[tuple[float, Array], tuple[float, Array]]
    inverse_condition: tuple[float, Array]


def rate(robot: Robot) -> Rating:
    """Search the sheet, its edge included, for what is needed most and allowed least.

    Raises:
        RobotError: a part of the sheet is out of reach.
    """
    sheet = robot.workspace
    mu1 = sheet.worst(lambda points: robot.pressure_angles(points)[0].max(axis=1))
    mu2 = sheet.worst(lambda points: robot.pressure_angles(points)[1].max(axis=1))
    condition, where = sheet.worst(lambda points: -robot.inverse_condition(points))
    return Rating(
        speed_needed=_most(robot, lambda points: speed_needed(robot, points)),
        acceleration_needed=_most(robot, lambda points: acceleration_needed(robot, points)),
        speed_allowed=_least(robot, lambda points: speed_allowed(robot, points)),
        acceleration_from_rest=_least(robot, lambda points: acceleration_allowed(robot, points, speed=0.0)),
        acceleration_at_speed=_least(
            robot, lambda points: acceleration_allowed(robot, points, speed=robot.tool.max_speed)
        ),
        angles=_angles(robot),
        pressure_angles=(mu1, mu2),
        inverse_condition=(-condition, where),
    )


def speed_needed(robot: Robot, points: Array) -> Array:
    """The joint speeds at the tool's rated speed in the direction that needs most, (N, 3) rad/s."""
    return joint_speed_demand(robot.geometry, points, speed=robot.tool.max_speed)


def acceleration_needed(robot: Robot, points: Array) -> Array:
    """The joint accelerations at the tool's rated acceleration and speed, in the directions that need most, rad/s^2."""
    tool = robot.tool
    return joint_acceleration_demand(robot.geometry, points, speed=tool.max_speed, acceleration=tool.max_acceleration)


def speed_allowed(robot: Robot, points: Array) -> Array:
    """The tool speed that every joint's limit of speed allows in any direction of the sheet's plane, (N, 3) m/s."""
    return np.asarray(robot.joints.max_speed / joint_speed_demand(robot.geometry, points, speed=1.0))


def acceleration_allowed(robot: Robot, points: Array, *, speed: float) -> Array:
    """The tool acceleration that every joint's limit allows at that tool speed, m/s, in any two directions.

    From qdd_i = row_i . a + v.H_i v (see `limits.joint_acceleration_demand`): what is left of the limit after the
    joint's turning at v, over |row_i,xy|.

    Returns:
        (N, 3) m/s^2; negative where the turning alone needs more than the limit.
    """
    left = robot.joints.max_acceleration - joint_turning(robot.geometry, points) * speed**2
    return np.asarray(left / joint_speed_demand(robot.geometry, points, speed=1.0))


def _most(robot: Robot, values: PerJoint) -> Extreme:
    value, point = robot.workspace.worst(lambda points: values(points).max(axis=1))
    return Extreme(value, point, int(values(point[np.newaxis]).argmax()))


def _least(robot: Robot, values: PerJoint) -> Extreme:
    found = _most(robot, lambda points: -values(points))
    return Extreme(-found.value, found.point, found.joint)


def _angles(robot: Robot) -> Array:
    def extreme(joint: int, sign: float) -> float:
        return sign * robot.workspace.worst(lambda points: sign * robot.inverse(points)[:, joint])[0]

    return np.array([[extreme(joint, sign) for joint in range(3)] for sign in (-1.0, 1.0)])
