"""Estimated times of rapids against planned ones, and the estimate for one against that for many."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.model import Array, Placement
from deltacam.motion.path import straight
from deltacam.motion.route import Route
from deltacam.motion.run import run
from deltacam.motion.setpoints import rapid_limits
from deltacam.robot.rapid import Rapids
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot


def robots() -> dict[str, Robot]:
    delta, irb = load_robot("delta-300"), load_robot("irb360-1600")
    slow = {"max_acceleration": (15.0,) * 3, "max_speed": (0.8,) * 3}
    return {
        "built-in": delta,
        "weak joints": replace(delta, joints=replace(delta.joints, **slow)),
        "weak joints without jerk": replace(delta, joints=replace(delta.joints, **slow, max_jerk=None)),
        "large and weak": replace(
            irb,
            joints=replace(irb.joints, max_acceleration=(10.0,) * 3, max_speed=(0.5,) * 3, max_jerk=(400.0,) * 3),
        ),
        "large": irb,
    }


def moves(robot: Robot, count: int, seed: int) -> tuple[Array, Array]:
    """Ways on the sheet, (N, 2) m, from 1 mm to all of it."""
    rng = np.random.default_rng(seed)
    grid = robot.workspace.grid(41)[:, :2]
    begin = grid[rng.integers(len(grid), size=8 * count)]
    length = np.exp(rng.uniform(np.log(1e-3), np.log(np.ptp(grid[:, 0])), (8 * count, 1)))
    turn = rng.uniform(0.0, 2.0 * np.pi, 8 * count)
    end = begin + length * np.column_stack([np.cos(turn), np.sin(turn)])
    held = np.flatnonzero(robot.workspace.excess(end) == 0.0)[:count]
    return begin[held], end[held]


@pytest.mark.parametrize("name", robots())
def test_half_of_the_estimates_are_within_two_percent_of_the_plan_and_nearly_all_within_five(name: str) -> None:
    robot = robots()[name]
    begin, end = moves(robot, 40, seed=1)
    limits, z = rapid_limits(robot), robot.workspace.sheet_z
    route = Route.of([(straight(*ends, z), limits) for ends in zip(begin, end, strict=True)])
    planned = np.array([one.duration for one in run(route, robot)])
    off = np.abs(Rapids(robot)(begin, end) / planned - 1.0)
    assert np.median(off) < 0.02
    assert np.quantile(off, 0.9) < 0.05


@pytest.mark.parametrize("name", robots())
def test_one_way_takes_as_long_alone_as_among_many(name: str) -> None:
    robot = robots()[name]
    begin, end = moves(robot, 200, seed=2)
    rapids = Rapids(robot, Placement(0.01, -0.02, 0.7, -0.65))
    alone = [rapids.one(*one, *other) for one, other in zip(begin.tolist(), end.tolist(), strict=True)]
    assert alone == pytest.approx(rapids(begin, end), rel=1e-9)


def test_a_way_takes_as_long_back_and_no_way_takes_no_time() -> None:
    rapids = Rapids(load_robot("delta-300"))
    begin, end = moves(load_robot("delta-300"), 100, seed=3)
    assert rapids(begin, end) == pytest.approx(rapids(end, begin), rel=1e-2)
    assert rapids(begin, begin).tolist() == [0.0] * 100
    assert rapids.one(0.1, 0.1, 0.1, 0.1) == 0.0


def test_a_placed_sheet_takes_as_long_as_the_same_ways_in_the_machine() -> None:
    robot = robots()["large and weak"]
    begin, end = moves(robot, 200, seed=4)
    where = Placement(0.05, -0.03, 0.7, robot.workspace.sheet_z)
    turn = np.array([[np.cos(0.7), -np.sin(0.7)], [np.sin(0.7), np.cos(0.7)]])
    back = [(places - (where.x, where.y)) @ turn for places in (begin, end)]
    near = Rapids(robot, where)(*back) / Rapids(robot)(begin, end)
    assert np.quantile(np.abs(near - 1.0), 0.9) < 0.01


def test_long_ways_in_the_middle_of_the_sheet_follow_the_closed_form() -> None:
    # Without a limit of jerk, and with joints that allow more than the tool has: v = 1 m/s, a = 23 m/s2.
    rapids = Rapids(load_robot("irb360-1600"))
    assert rapids.one(-0.2, 0.0, 0.2, 0.0) == pytest.approx(0.4 / 1.0 + 1.0 / 23.0)
    assert rapids.one(0.0, 0.0, 0.001, 0.0) == pytest.approx(2.0 * np.sqrt(0.001 / 23.0))
