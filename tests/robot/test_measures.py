"""Pressure angles, forearm swing and condition number, each by another route."""

import numpy as np
import pytest

from deltacam.model import Array
from deltacam.robot import measures
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.robot import Robot

ROBOTS = [load_robot(name) for name in profile_names()]


def forearms(robot: Robot, q: Array, points: Array) -> Array:
    """From the elbows to the effector's joints, from the drawing of the robot and not from its formulas."""
    geometry, rows = robot.geometry, []
    for arm, azimuth in enumerate(geometry.azimuths):
        outwards = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
        elbow = (geometry.base_radius + geometry.upper_arm * np.cos(q[:, arm, np.newaxis])) * outwards
        elbow[:, 2] -= geometry.upper_arm * np.sin(q[:, arm])
        rows.append(points + geometry.effector_radius * outwards - elbow)
    return np.stack(rows, axis=1)


def angle(a: Array, b: Array) -> Array:
    cos = (a * b).sum(axis=-1) / np.linalg.norm(a, axis=-1) / np.linalg.norm(b, axis=-1)
    return np.arccos(np.clip(np.abs(cos), 0.0, 1.0))


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_mu1_is_the_angle_between_the_forearm_and_the_motion_of_its_elbow(robot: Robot) -> None:
    points = robot.workspace.grid(9)
    q, step = robot.inverse(points), 1e-6
    motion = forearms(robot, q - step, points) - forearms(robot, q + step, points)
    assert robot.pressure_angles(points)[0] == pytest.approx(angle(forearms(robot, q, points), motion), abs=1e-7)


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_mu2_is_the_angle_between_the_forearm_and_the_motion_of_the_tool_when_its_joint_turns(robot: Robot) -> None:
    points = robot.workspace.grid(9)
    q, step = robot.inverse(points), 1e-6
    mu2 = robot.pressure_angles(points)[1]
    for arm in range(3):
        turn = step * np.eye(3)[arm]
        motion = robot.forward(q + turn) - robot.forward(q - turn)
        assert mu2[:, arm] == pytest.approx(angle(forearms(robot, q, points)[:, arm], motion), abs=1e-7)


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_the_swing_is_the_angle_between_the_forearm_and_the_plane_of_its_arm(robot: Robot) -> None:
    points = robot.workspace.grid(9)
    azimuths = np.array(robot.geometry.azimuths)
    normals = np.stack((-np.sin(azimuths), np.cos(azimuths), np.zeros(3)), axis=-1)
    expected = np.pi / 2 - angle(forearms(robot, robot.inverse(points), points), normals)
    assert robot.forearm_swing(points) == pytest.approx(expected, abs=1e-12)


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_the_inverse_condition_is_the_least_over_the_most_that_the_joints_turn_for_a_step(robot: Robot) -> None:
    points = robot.workspace.grid(5)
    rng = np.random.default_rng(0)
    steps = rng.normal(size=(20_000, 3))
    steps /= np.linalg.norm(steps, axis=1)[:, np.newaxis]
    turns = np.linalg.norm(robot.inverse_jacobian(points) @ steps.T, axis=1)
    assert robot.inverse_condition(points) == pytest.approx(turns.min(axis=1) / turns.max(axis=1), rel=2e-3)


def test_the_condition_number_of_the_built_in_robots_is_as_published_in_their_files() -> None:
    worst = {robot.name: 1.0 / robot.inverse_condition(robot.workspace.grid()).min() for robot in ROBOTS}
    assert worst["delta-300"] == pytest.approx(2.37, abs=0.01)
    assert worst["irb360-1600"] == pytest.approx(2.81, abs=0.01)
    assert worst["irb360-1130"] == pytest.approx(2.79, abs=0.01)
    assert worst["delta-x-s-d600"] == pytest.approx(2.79, abs=0.01)
    assert worst["dr3ib-8l"] == pytest.approx(2.78, abs=0.01)
    assert worst["rl5-1450"] == pytest.approx(2.74, abs=0.01)
    assert worst["tutorial-112"] == pytest.approx(1.40, abs=0.01)
    assert len(worst) == 7


def test_pressure_angles_are_90_degrees_at_the_singularities() -> None:
    stretched = DeltaGeometry(0.1, 0.1, 0.3, 0.7)
    mu1, mu2 = measures.pressure_angles(stretched, [[0.0, 0.0, -1.0]])
    assert np.degrees(mu1) == pytest.approx(np.full((1, 3), 90.0), abs=1e-4)
    assert np.degrees(mu2) == pytest.approx(np.full((1, 3), 90.0))  # the forearms are parallel as well


@pytest.mark.parametrize("robot", ROBOTS, ids=lambda robot: robot.name)
def test_the_tool_error_is_the_farthest_that_the_tool_moves_for_joint_errors_of_norm_one(robot: Robot) -> None:
    points, rng, size = robot.workspace.grid(5), np.random.default_rng(1), 1e-6
    errors = rng.normal(size=(3000, 3))
    errors *= size / np.linalg.norm(errors, axis=1)[:, np.newaxis]
    q = robot.inverse(points)
    moved = np.stack([robot.forward(q + error) - points for error in errors]) / size
    in_space, in_plane = np.linalg.norm(moved, axis=2).max(axis=0), np.linalg.norm(moved[:, :, :2], axis=2).max(axis=0)
    found = measures.tool_error_per_joint_error(robot.geometry, points)
    found_in_plane = measures.tool_error_per_joint_error_in_plane(robot.geometry, points)
    assert in_space == pytest.approx(found, rel=2e-3)
    assert in_plane == pytest.approx(found_in_plane, rel=2e-3)
    assert (found_in_plane <= found * (1 + 1e-12)).all()


def test_the_tool_error_is_infinite_where_the_forearms_are_parallel_and_zero_where_the_arms_are_stretched() -> None:
    parallel = DeltaGeometry(0.1, 0.1, 0.3, 0.7)
    assert measures.tool_error_per_joint_error(parallel, [[0.0, 0.0, -1.0]]) == pytest.approx([np.inf])
    assert measures.tool_error_per_joint_error_in_plane(parallel, [[0.0, 0.0, -1.0]]) == pytest.approx([np.inf])
    stretched = DeltaGeometry(0.13, 0.035, 0.3, 0.7)
    lowest = [[0.0, 0.0, -np.sqrt(1.0 - 0.095**2)]]
    assert measures.tool_error_per_joint_error(stretched, lowest) == pytest.approx([0.0], abs=1e-6)
