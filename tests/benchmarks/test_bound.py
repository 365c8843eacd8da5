"""The lower bound on the time that the planner is measured by, against closed forms and a solver of another kind."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import linprog
from scipy.sparse import coo_matrix

from benchmarks.bound import Profile, by_chord, profiles
from benchmarks.motion_optimum import Case, cases
from deltacam.geometry import curve as curves
from deltacam.model import Array
from deltacam.motion.path import Path, from_curve, straight
from deltacam.motion.route import Limits
from deltacam.robot.reader import load_robot

ROBOT = load_robot("delta-300")
Z = ROBOT.workspace.sheet_z
CAP = 23.0
FREE = replace(ROBOT, joints=replace(ROBOT.joints, max_speed=(60.0,) * 3, max_acceleration=(9000.0,) * 3))
"""The same machine with motors that never give out."""


def line(length: float) -> Path:
    return straight(np.array([-0.5 * length, 0.02]), np.array([0.5 * length, 0.02]), Z)


def circle(radius: float) -> Path:
    return from_curve(curves.circle(np.zeros(2), radius), Z)


def test_lines_take_the_closed_form_times() -> None:
    moves = [(line(0.1), Limits(10.0, CAP)), (line(0.1), Limits(0.05, CAP)), (line(0.003), Limits(0.5, CAP))]
    times = [found.time for found in profiles(moves, FREE)]
    assert times == pytest.approx(
        [2.0 * math.sqrt(0.1 / CAP), 2.0 + 0.05 / CAP, 2.0 * math.sqrt(0.003 / CAP)], rel=1e-6
    )


@pytest.mark.parametrize("radius", [0.0003, 0.02])
def test_a_circle_takes_the_closed_form_time(radius: float) -> None:
    """With x the squared speed (x' / 2)^2 + (x / r)^2 = A^2, so x = A r sin(2 s / r) on the first eighth."""
    ramp, _ = quad(lambda s: 1.0 / math.sqrt(CAP * radius * math.sin(2.0 * s / radius)), 0.0, math.pi * radius / 4.0)
    best = 2.0 * ramp + 1.5 * math.pi * radius / math.sqrt(CAP * radius)
    (found,) = profiles([(circle(radius), Limits(10.0, CAP))], FREE)
    assert best * (1.0 - 5e-5) <= found.time <= best * (1.0 + 1e-6)


def test_intervals_half_as_long_give_the_same_times() -> None:
    for case in cases(4, 1, ramps=True):
        usual, fine = (
            np.array([one.time for one in profiles(case.moves, case.robot, fineness=fineness)]) for fineness in (1, 2)
        )
        assert usual == pytest.approx(fine, rel=2e-4)


def test_slow_joints_take_as_long_as_their_turning() -> None:
    robot = replace(FREE, joints=replace(FREE.joints, max_speed=(0.05, 0.06, 0.07)))
    path = line(0.1)

    def least(distance: float) -> float:
        position, tangent, bend, _ = path.evaluate(*path.locate(np.array([distance])))
        _, dq, _ = robot.path_derivatives(position, tangent, bend)
        return float((np.abs(dq) / robot.joints.max_speed).max())

    best, _ = quad(least, 0.0, path.total, limit=200)
    (found,) = profiles([(path, Limits(10.0, CAP))], robot)
    assert best <= found.time <= best * 1.001


def test_paths_together_have_the_times_that_they_have_alone() -> None:
    moves = [(line(0.01), Limits(0.3, CAP)), (circle(0.001), Limits(0.5, CAP, 3e-6)), (line(0.03), Limits(0.1, 9.0))]
    alone = [profiles([move], ROBOT)[0].time for move in moves]
    assert [found.time for found in profiles(moves, ROBOT)] == pytest.approx(alone, rel=1e-12)


def test_the_chord_limit_is_where_the_tool_is_beside_the_path_between_ticks() -> None:
    path, chord = circle(0.02), 5e-6
    place = np.array([0.001, 0.012, 0.05])
    position, tangent, bend, _ = path.evaluate(*path.locate(place))
    _, _, ddq = ROBOT.path_derivatives(position, tangent, bend)
    speed = np.sqrt(by_chord(ROBOT, position, tangent, ddq, chord))
    sides = [path.evaluate(*path.locate(place + sign * 0.5 * speed / ROBOT.controller.rate_hz))[0] for sign in (-1, 1)]
    between = ROBOT.forward(0.5 * (ROBOT.inverse(sides[0]) + ROBOT.inverse(sides[1])))
    assert np.linalg.norm(np.cross(between - position, tangent), axis=1) == pytest.approx(chord, rel=1e-2)


def linear_program(case: Case, grid: Array) -> Array:
    """The squared speeds whose sum is largest, by HiGHS: one linear program over the whole first move of a case.

    A polygon drawn around the half circle, not inside it, stands for the cap on the tool's acceleration.
    """
    (path, limits), robot, width = case.moves[0], case.robot, np.diff(grid)
    position, tangent, bend, _ = path.evaluate(*path.locate(grid[:-1] + 0.5 * width))
    _, dq, ddq = robot.path_derivatives(position, tangent, bend)
    angle = np.arange(97) * np.pi / 96
    curvature = np.linalg.norm(bend, axis=1)[:, None]
    a = np.concatenate([dq, -dq, np.tile(np.cos(angle), (len(dq), 1))], axis=1)
    b = np.concatenate([ddq, -ddq, curvature * np.sin(angle)], axis=1)
    most = np.concatenate([np.tile(robot.joints.max_acceleration, 2), np.full(97, limits.acceleration)])
    # a (x_after - x_before) + b (x_before + x_after) width <= 2 width most
    before, after = (b * width[:, None] + sign * a for sign in (-1.0, 1.0))
    size = np.maximum(np.abs(before), np.abs(after))
    row, interval = np.arange(a.size), np.repeat(np.arange(len(a)), a.shape[1])
    values = np.concatenate([(before / size).ravel(), (after / size).ravel()])
    table = coo_matrix((values, (np.tile(row, 2), np.concatenate([interval, interval + 1]))))
    position, tangent, bend, _ = path.evaluate(*path.locate(grid))
    _, dq, ddq = robot.path_derivatives(position, tangent, bend)
    highest = np.minimum(limits.speed, (np.asarray(robot.joints.max_speed) / np.abs(dq)).min(axis=1)) ** 2
    highest = np.minimum(highest, by_chord(robot, position, tangent, ddq, min(limits.chord, 1.0)))
    highest[[0, -1]] = 0.0
    bounds = np.column_stack([np.zeros_like(highest), highest])
    most = 2.0 * width[:, None] * most / size
    found = linprog(-np.ones(len(grid)), A_ub=table.tocsr(), b_ub=most.ravel(), bounds=bounds)
    assert found.success
    return np.maximum(found.x, 0.0)


@pytest.mark.parametrize("number", [0, 1, 3, 7])
def test_one_linear_program_over_the_whole_path_takes_about_as_long_and_no_less(number: int) -> None:
    case = list(cases(8, 5, ramps=number % 2 == 0))[number]
    (found,) = profiles(case.moves[:1], case.robot, fineness=0.25)
    other = Profile(found.distance, linear_program(case, found.distance))
    assert found.time * (1.0 - 1e-4) <= other.time <= found.time * 1.0005
