"""Derived joint limits: they cover every motion of the rated tool, and hardly more."""

import numpy as np
import pytest

from deltacam.model import Array
from deltacam.robot import kinematics
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.limits import derive_max_acceleration, derive_max_speed, joint_acceleration_demand
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.robot import Robot

ROBOTS = [load_robot(name) for name in profile_names()]
RNG = np.random.default_rng(20)


def random_places(robot: Robot, count: int) -> Array:
    """Places of the sheet, many of them on its edge and corners."""
    xy = RNG.uniform(-1.2, 1.2, (count, 2))
    if robot.workspace.radius is None:
        xy = np.clip(xy, -1.0, 1.0) * [robot.workspace.width / 2, robot.workspace.depth / 2]
    else:
        xy *= robot.workspace.radius / np.maximum(1.0, np.linalg.norm(xy, axis=1))[:, np.newaxis]
    return np.column_stack((xy, np.full(count, robot.workspace.sheet_z)))


def directions(angles: Array, length: float) -> Array:
    return length * np.stack((np.cos(angles), np.sin(angles), np.zeros_like(angles)), axis=-1)


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_no_motion_of_the_rated_tool_exceeds_the_derived_limits(robot: Robot) -> None:
    count = 300_000
    v = directions(RNG.uniform(0, 2 * np.pi, count), robot.tool.max_speed) * RNG.choice([1.0, 0.5, 0.0], (count, 1))
    a = directions(RNG.uniform(0, 2 * np.pi, count), robot.tool.max_acceleration)
    _, speed, acceleration = robot.path_derivatives(random_places(robot, count), v, a)
    assert np.abs(speed).max() <= robot.joints.max_speed[0]
    assert np.abs(acceleration).max() <= robot.joints.max_acceleration[0]


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_some_motion_of_the_rated_tool_needs_the_derived_limits(robot: Robot) -> None:
    """Speed and acceleration add up, and a direction may be turned around: the worst of each may be found alone."""
    places, angles = random_places(robot, 4000), np.linspace(0, np.pi, 90)
    p = np.repeat(places, len(angles), axis=0)
    v = np.tile(directions(angles, robot.tool.max_speed), (len(places), 1))
    a = np.tile(directions(angles, robot.tool.max_acceleration), (len(places), 1))
    _, speed, turning = robot.path_derivatives(p, v, np.zeros_like(v))
    _, _, pushing = robot.path_derivatives(p, np.zeros_like(a), a)
    worst = [np.abs(x).reshape(len(places), -1, 3).max(axis=1) for x in (speed, turning, pushing)]
    assert 0.995 * robot.joints.max_speed[0] <= worst[0].max() <= robot.joints.max_speed[0]
    needed = (worst[1] + worst[2]).max()
    assert 0.995 * robot.joints.max_acceleration[0] <= needed <= robot.joints.max_acceleration[0]


def test_the_acceleration_demand_is_the_largest_over_all_directions_in_every_pose() -> None:
    """With short forearms and raised arms too, where motion at speed turns a joint the other way."""
    geometry = DeltaGeometry(0.10, 0.06, 0.10, 0.14)
    p = kinematics.forward(geometry, np.radians(RNG.uniform(10, 40, (200, 3))))
    demand = joint_acceleration_demand(geometry, p, speed=2.0, acceleration=3.0)
    angles = np.linspace(0, np.pi, 181)
    v, a = directions(angles, 2.0), directions(angles, 3.0)
    zero = np.zeros((len(p), 3))
    turning = np.stack([kinematics.path_derivatives(geometry, p, zero + row, zero)[2] for row in v])
    pushing = np.stack([kinematics.path_derivatives(geometry, p, zero, zero + row)[2] for row in a])
    assert (-turning.min(axis=0) > turning.max(axis=0)).any()
    found = np.abs(turning).max(axis=0) + np.abs(pushing).max(axis=0)
    assert (found <= demand * (1 + 1e-12)).all()
    assert found == pytest.approx(demand, rel=1e-3)


def test_the_limits_of_delta_300_are_the_reference_numbers() -> None:
    robot = ROBOTS[0]
    assert robot.name == "delta-300"
    assert robot.joints.derived == ("max_speed", "max_acceleration")
    assert robot.joints.max_speed == pytest.approx((2.57,) * 3, abs=0.005)
    assert robot.joints.max_acceleration == pytest.approx((63.9,) * 3, abs=0.05)
    at_rest = derive_max_acceleration(robot.geometry, robot.workspace, speed=0.0, acceleration=23.0)
    assert at_rest == pytest.approx(59.1, abs=0.05)


def test_the_joint_speed_is_proportional_to_the_tool_speed() -> None:
    geometry, sheet = ROBOTS[0].geometry, ROBOTS[0].workspace
    one, ten = (derive_max_speed(geometry, sheet, speed=speed) for speed in (1.0, 10.0))
    assert ten == pytest.approx(10 * one, rel=1e-6)
