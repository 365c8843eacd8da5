"""What a robot can do over its sheet, against all directions tried and against the other way round."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.robot.rating import acceleration_allowed, acceleration_needed, rate, speed_allowed, speed_needed
from deltacam.robot.reader import load_robot

ROBOT = load_robot("delta-300")
WEAK = replace(
    ROBOT, joints=replace(ROBOT.joints, max_speed=(2.0, 2.5, 3.0), max_acceleration=(50.0, 60.0, 45.0), derived=())
)


def test_a_tool_at_the_allowed_speed_brings_a_joint_to_its_limit_and_none_beyond() -> None:
    points = WEAK.workspace.grid(7)
    speed = speed_allowed(WEAK, points).min(axis=1)
    turn = np.linspace(0.0, np.pi, 721)
    velocity = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)])
    used = np.abs(WEAK.inverse_jacobian(points) @ velocity * speed[:, np.newaxis, np.newaxis])
    used = (used / np.array(WEAK.joints.max_speed)[:, np.newaxis]).max(axis=(1, 2))
    assert (used <= 1.0 + 1e-12).all()
    assert used == pytest.approx(1.0, abs=2e-5)  # the directions are half a degree apart


def test_a_tool_at_the_allowed_acceleration_brings_a_joint_to_its_limit_and_none_beyond() -> None:
    points, speed = WEAK.workspace.grid(3), 0.7
    allowed = acceleration_allowed(WEAK, points, speed=speed).min(axis=1)
    turn = np.linspace(0.0, 2.0 * np.pi, 361)
    way = np.stack([np.cos(turn), np.sin(turn), np.zeros_like(turn)], axis=1)
    for point, acceleration in zip(points, allowed, strict=True):
        one, other = (index.ravel() for index in np.indices((361, 361)))
        found = WEAK.path_derivatives(np.tile(point, (one.size, 1)), speed * way[one], acceleration * way[other])[2]
        used = (np.abs(found) / WEAK.joints.max_acceleration).max()
        assert used <= 1.0 + 1e-12
        assert used == pytest.approx(1.0, abs=2e-4)


def test_with_derived_limits_the_joints_allow_just_the_rating() -> None:
    found = rate(ROBOT)
    assert found.speed_needed.value == pytest.approx(ROBOT.joints.max_speed[0], rel=2e-6)
    assert found.acceleration_needed.value == pytest.approx(ROBOT.joints.max_acceleration[0], rel=2e-6)
    assert found.speed_allowed.value == pytest.approx(ROBOT.tool.max_speed, rel=2e-6)
    assert found.acceleration_at_speed.value == pytest.approx(ROBOT.tool.max_acceleration, rel=2e-6)
    assert found.acceleration_from_rest.value > found.acceleration_at_speed.value


def test_an_extreme_is_that_of_its_joint_at_its_place() -> None:
    found = rate(WEAK)
    speed, acceleration = found.speed_needed, found.acceleration_needed
    assert speed_needed(WEAK, speed.point[np.newaxis])[0, speed.joint] == speed.value
    assert acceleration_needed(WEAK, acceleration.point[np.newaxis])[0, acceleration.joint] == acceleration.value
    allowed = speed_allowed(WEAK, WEAK.workspace.grid())
    assert found.speed_allowed.value <= allowed.min()
    assert found.speed_allowed.joint == 0  # the slowest of the three


def test_the_angles_are_those_of_a_dense_grid() -> None:
    q = ROBOT.inverse(ROBOT.workspace.grid(201))
    found = rate(ROBOT).angles
    assert found[0] == pytest.approx(q.min(axis=0), abs=1e-5)
    assert found[1] == pytest.approx(q.max(axis=0), abs=1e-5)
    assert (found[0] <= q.min(axis=0)).all()
    assert (found[1] >= q.max(axis=0)).all()
