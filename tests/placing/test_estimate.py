"""The estimate of the time of a program, against closed forms."""

import math
from dataclasses import replace

import numpy as np
import pytest

from deltacam.motion.path import straight
from deltacam.motion.route import Limits
from deltacam.motion.schedule import Move
from deltacam.placing.estimate import estimate
from deltacam.placing.sampled import Sampled
from deltacam.robot.measures import tool_error_per_joint_error_in_plane
from deltacam.robot.reader import load_robot

ROBOT = load_robot("delta-300")
Z = ROBOT.workspace.sheet_z
SPEED, ACCELERATION = 0.4, 10.0
STRONG = replace(ROBOT, joints=replace(ROBOT.joints, max_acceleration=(1e4,) * 3, max_speed=(50.0,) * 3, max_jerk=None))


def line(length: float) -> Sampled:
    """One straight cut from the place of the part along x, with limits of the tool alone."""
    path = straight(np.zeros(2), np.array([length, 0.0]), Z)
    move = Move(path, Limits(SPEED, ACCELERATION), "a line")
    return Sampled.of([(move, True)], at=(0.0, 0.0), rotation=0.0, park=np.zeros(2), resting=0.25)


def alone(length: float) -> float:
    """The time of a straight move from rest to rest, s."""
    if length < SPEED**2 / ACCELERATION:
        return 2.0 * math.sqrt(length / ACCELERATION)
    return length / SPEED + SPEED / ACCELERATION


@pytest.mark.parametrize("length", [0.004, 0.03, 0.1])
@pytest.mark.parametrize("turn", [0.0, 0.7, 3.0])
def test_a_straight_cut_and_the_ways_about_it_take_the_time_of_a_trapezoid(length: float, turn: float) -> None:
    at = np.array([[0.02, -0.05]])
    end = at[0] + length * np.array([np.cos(turn), np.sin(turn)])
    ways = alone(float(np.hypot(*at[0]))) + alone(float(np.hypot(*end)))
    found = estimate(line(length), STRONG, at, np.array([turn]))
    assert found.time == pytest.approx([0.25 + alone(length) + ways], rel=6e-3)


def test_a_limit_of_jerk_costs_the_time_in_which_the_acceleration_is_built_up_and_down() -> None:
    at, turn = np.zeros((1, 2)), np.zeros(1)
    joints = replace(STRONG.joints, max_jerk=(5e3,) * 3)
    free, held = (estimate(line(0.1), robot, at, turn).time[0] for robot in (STRONG, replace(STRONG, joints=joints)))
    points = np.column_stack([np.linspace(0.0, 0.1, 50), np.zeros(50), np.full(50, Z)])
    along = 5e3 / np.abs(ROBOT.inverse_jacobian(points)[:, :, 0]).max(axis=1)
    # Two moves of 0.1 m, each with one rise at either end: a / j in all, j between its least and its largest value.
    assert 2.0 * ACCELERATION / along.max() * 0.95 <= held - free <= 2.0 * ACCELERATION / along.min() * 1.05


def test_weaker_joints_take_longer_in_proportion_to_the_root_of_their_acceleration() -> None:
    at, turn = np.array([[0.05, 0.05]]), np.zeros(1)
    path = straight(np.zeros(2), np.array([0.004, 0.0]), Z)
    sampled = Sampled.of(
        [(Move(path, Limits(100.0, 1e6), "a line"), True)], at=(0.0, 0.0), rotation=0.0, park=at[0], resting=0.0
    )
    times = [
        estimate(sampled, replace(STRONG, joints=replace(STRONG.joints, max_acceleration=(a,) * 3)), at, turn).time[0]
        for a in (5.0, 20.0)
    ]
    assert times[0] / times[1] == pytest.approx(2.0, rel=1e-3)


def test_the_errors_are_those_along_the_cut_wherever_it_lies() -> None:
    at, turn = np.array([[0.0, 0.0], [0.1, -0.1]]), np.array([0.0, 2.0])
    found = estimate(line(0.03), STRONG, at, turn)
    for k in range(2):
        share = np.linspace(0.0, 0.03, 400)[:, None]
        xy = at[k] + share * [np.cos(turn[k]), np.sin(turn[k])]
        truth = tool_error_per_joint_error_in_plane(ROBOT.geometry, np.column_stack([xy, np.full(400, Z)]))
        assert found.worst[k] == pytest.approx(truth.max(), rel=1e-3)
        assert found.rms[k] == pytest.approx(np.sqrt(np.mean(truth**2)), rel=1e-3)
