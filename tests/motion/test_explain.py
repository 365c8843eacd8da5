"""What holds a motion back, where it is known beforehand."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.geometry import curve as curves
from deltacam.motion import explain
from deltacam.motion.corners import pieces
from deltacam.motion.path import Path, straight
from deltacam.motion.route import Limits, Route
from deltacam.motion.run import Run, run
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot
from tests.strategies import rectangle

PROFILE = load_robot("delta-300")
ROBOT = replace(PROFILE, joints=replace(PROFILE.joints, max_jerk=None))
Z = ROBOT.workspace.sheet_z


def only(path: Path, limits: Limits, robot: Robot = ROBOT) -> Run:
    (found,) = run(Route.of([(path, limits)]), robot, what_if=True)
    return found


def held(found: Run, name: str) -> float:
    return float(found.held[explain.NAMES.index(name)])


def without(found: Run, kind: str) -> float:
    return float(found.without[explain.KINDS.index(kind)])


def circle(radius: float) -> Path:
    (path,) = pieces(curves.circle(np.zeros(2), radius), corner="round", deviation=1e-5, ramps=False, z=Z)
    return path


def line(length: float) -> Path:
    return straight(np.array([-length / 2.0, 0.0]), np.array([length / 2.0, 0.0]), Z)


def test_all_time_is_accounted_for() -> None:
    for robot in (ROBOT, PROFILE):
        (path, *_) = pieces(
            curves.start_at(rectangle(0.06, 0.04), 0, 0.03), corner="round", deviation=1e-5, ramps=True, z=Z
        )
        found = only(path, Limits(0.15, 23.0), robot)
        assert found.held.sum() == pytest.approx(found.duration)


def test_a_slow_line_is_held_back_by_the_feed_and_would_take_no_time_without() -> None:
    found = only(line(0.1), Limits(0.05, 23.0))
    assert held(found, "feed") > 0.99 * found.duration
    assert without(found, "feed") == pytest.approx(0.1 / 1.0 + 1.0 / 23.0, rel=0.01)  # at 1 m/s the tool itself ends
    assert without(found, "joint acceleration") == pytest.approx(found.duration)


def test_a_short_fast_line_is_held_back_by_the_acceleration_of_the_tool() -> None:
    found = only(line(0.02), Limits(1.0, 23.0))
    assert held(found, "tool acceleration") > 0.99 * found.duration
    assert without(found, "tool acceleration") < 0.8 * found.duration  # the joints' come next


def test_a_small_fast_circle_is_held_back_by_the_acceleration_of_the_tool() -> None:
    assert held(found := only(circle(0.005), Limits(1.0, 23.0)), "tool acceleration") > 0.95 * found.duration


def test_slow_joints_are_named() -> None:
    slow = replace(ROBOT, joints=replace(ROBOT.joints, max_speed=(9.0, 0.1, 9.0)))
    found = only(line(0.1), Limits(1.0, 23.0), slow)
    assert held(found, "joint 2 speed") > 0.8 * found.duration
    assert without(found, "joint speed") < 0.5 * found.duration


def test_a_tight_chord_tolerance_is_named() -> None:
    found = only(circle(0.02), Limits(1.0, 23.0, chord=2e-6))
    assert held(found, "chord tolerance") > 0.9 * found.duration
    assert without(found, "chord tolerance") < 0.5 * found.duration


def test_corners_and_jerk_are_named() -> None:
    (path,) = pieces(curves.start_at(rectangle(0.03, 0.02), 0, 0.01), corner="round", deviation=1e-5, ramps=True, z=Z)
    found = only(path, Limits(1.0, 23.0), PROFILE)
    assert held(found, "corners") > 0.01 * found.duration
    assert without(found, "corners") < 0.9 * found.duration
    assert without(found, "joint jerk") == pytest.approx(only(path, Limits(1.0, 23.0)).duration)
    assert sum(held(found, f"joint {joint} jerk") for joint in (1, 2, 3)) > 0.0


def test_nobody_asking_means_no_answer() -> None:
    (found,) = run(Route.of([(line(0.02), Limits(1.0, 23.0))]), ROBOT)
    assert not len(found.without)
