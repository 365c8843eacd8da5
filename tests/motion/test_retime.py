"""The fastest rate against the closed form for a line, against finer knots, and against its own limits."""

import math
from dataclasses import dataclass, replace
from typing import cast

import numpy as np
import numpy.typing as npt
import pytest
from scipy.optimize import brentq

from deltacam.model import Array
from deltacam.motion import knots, retime
from deltacam.motion.corners import pieces
from deltacam.motion.jerk import limited
from deltacam.motion.path import straight
from deltacam.motion.retime import Rows, Stations, fastest
from deltacam.motion.route import Grid, Limits, Route
from deltacam.motion.rows import Rows as GridRows
from deltacam.motion.tempo import Base, Tempo, windows
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Controller, JointLimits, Robot
from tests.strategies import slot

UP_TO = np.linspace(0.0, 1.0, retime.STATIONS)[:, None]


@dataclass(frozen=True)
class Gantry:
    """A machine whose joints are x, y and z: on a line along x the limits of a joint are those of the tool."""

    joints: JointLimits
    controller: Controller

    def inverse(self, points: npt.ArrayLike) -> Array:
        return np.asarray(points, dtype=np.float64)

    def path_derivatives(self, p: Array, dp: Array, ddp: Array) -> tuple[Array, Array, Array]:
        return p, dp, ddp

    def third_derivative(self, *derivatives: Array) -> Array:
        return derivatives[-1]


def seven_phases(length: float, speed: float, acceleration: float, jerk: float) -> float:
    """The shortest time along a line from rest to rest with zero acceleration at both ends, s.

    A change of the speed by v takes v / a + a / j, or 2 sqrt(v / j) where the largest acceleration is not reached; the
    way in that time is half of v times it.
    """

    def taken(v: float) -> float:
        return v / acceleration + acceleration / jerk if v * jerk >= acceleration**2 else 2.0 * math.sqrt(v / jerk)

    if speed * taken(speed) <= length:
        return 2.0 * taken(speed) + (length - speed * taken(speed)) / speed
    return 2.0 * taken(brentq(lambda v: v * taken(v) - length, 1e-12, speed))


def stations(base: Base, speed: float, acceleration: float, jerk: float) -> Stations:
    """The base along a line, where one joint is the place and the others stand still."""
    interval = np.arange(len(base.width))
    at = [base.at(interval, np.full(len(interval), u)) for u in UP_TO[:, 0]]
    v, a, j = (np.stack([one[order] for one in at]) for order in (1, 2, 3))
    still = np.zeros_like(v)
    limit = np.ones((3, 1, 1))
    return Stations(
        *(np.stack([one, still, still]) for one in (v, a, j)),
        v,
        a,
        still,
        highest=speed**2 / np.maximum(v**2, 1e-12),
        accelerations=acceleration * limit,
        acceleration=np.full_like(v, acceleration),
        jerks=jerk * limit,
    )


def optimised(base: Base, *limits: float) -> Tempo:
    at = stations(base, *limits)
    rows = Rows.at(base, np.broadcast_to(UP_TO, at.speed.shape), at)
    steady = at.steady().min(axis=0).min()
    start = retime.scaled(base, rows, np.full(len(base.width) + 2 * len(base.first) - 2, steady), 0.9)
    return Tempo.of(base, fastest(base, rows, start))


def smooth_base(lengths: Array, count: int) -> Base:
    """Moves of one second each on even knots, whose speed rises and falls like the square of a sine."""
    first = count * np.arange(len(lengths) + 1)
    begins = np.concatenate([[0.0], np.cumsum(lengths)[:-1]])
    width = np.full(first[-1], 1.0 / count)
    return Base.through(first, width, lambda move, at: lengths[move] * np.sin(np.pi * at) ** 2, begins, lengths)


@pytest.mark.parametrize(
    ("speed", "acceleration", "jerk"),
    [(1.0, 20.0, 2000.0), (0.1, 20.0, 2000.0), (1.0, 20.0, 300.0), (10.0, 5.0, 500.0)],
)
def test_lines_take_the_closed_form_time_of_seven_phases(speed: float, acceleration: float, jerk: float) -> None:
    lengths = np.array([0.2, 0.05, 0.01])
    found = optimised(smooth_base(lengths, 150), speed, acceleration, jerk).durations
    best = np.array([seven_phases(length, speed, acceleration, jerk) for length in lengths])
    assert (found >= best * 0.999).all()
    assert (found <= best * 1.005).all()


def test_the_rate_keeps_all_limits_at_its_stations_and_meets_one_of_them_nearly_everywhere() -> None:
    limits = (0.5, 20.0, 2000.0)
    tempo = optimised(smooth_base(np.array([0.1]), 100), *limits)
    interval = np.arange(100)
    used = []
    for u in UP_TO[:, 0]:
        motion = tempo.motion(interval, np.full(100, u))
        used.append(np.max([np.abs(one) / limit for one, limit in zip(motion[1:], limits, strict=True)], axis=0))
    assert np.max(used) <= 1.0
    assert np.mean(np.max(used, axis=0) >= 0.99) >= 0.9


def test_moves_do_not_matter_to_each_other() -> None:
    limits = (0.5, 20.0, 2000.0)
    lengths = np.array([0.1, 0.003, 0.02])
    together = optimised(smooth_base(lengths, 60), *limits).durations
    apart = [optimised(smooth_base(np.array([length]), 60), *limits).durations[0] for length in lengths]
    assert together == pytest.approx(apart, rel=1e-3)


def test_a_smaller_gap_gains_no_more_than_it_says() -> None:
    base = smooth_base(np.array([0.1, 0.01]), 60)
    at = stations(base, 0.5, 20.0, 2000.0)
    rows = Rows.at(base, np.broadcast_to(UP_TO, at.speed.shape), at)
    start = retime.scaled(base, rows, np.full(124, 1e-3), 0.9)
    times = [Tempo.of(base, fastest(base, rows, start, gap=gap)).durations for gap in (1e-2, 1e-3, 1e-6)]
    for gap, time in zip((1e-2, 1e-3), times, strict=False):
        assert (time >= times[-1]).all()
        assert (time <= times[-1] * (1.0 + 2.0 * gap)).all()


def test_scaled_weights_use_the_given_share_of_the_limits() -> None:
    limits = (0.5, 20.0, 2000.0)
    base = smooth_base(np.array([0.1, 0.01]), 60)
    at = stations(base, *limits)
    rows = Rows.at(base, np.broadcast_to(UP_TO, at.speed.shape), at)
    weights = retime.scaled(base, rows, np.exp(np.random.default_rng(1).normal(0.0, 0.1, 124)), 0.8)
    tempo, interval = Tempo.of(base, weights), np.arange(120)
    used = np.zeros(120)
    for u in UP_TO[:, 0]:
        _, v, a, j = tempo.motion(interval, np.full(120, u))
        powers = ((v / limits[0]) ** 2, np.abs(a) / limits[1], (np.abs(j) / limits[2]) ** (2.0 / 3.0))
        used = np.maximum(used, np.max(powers, axis=0))
    assert np.maximum.reduceat(used, [0, 60]) == pytest.approx([0.8, 0.8], rel=1e-9)
    assert (windows(base, weights) > 0.0).all()


def timed(route: Route, robot: Robot) -> Tempo:
    grid = Grid.over(route, robot)
    return limited(route, grid, GridRows.over(route, grid, robot), robot, np.ones(len(grid.segment)))


@pytest.mark.parametrize(
    ("length", "jerk", "most"),
    [(0.2, 2000.0, 1.005), (0.05, 20_000.0, 1.005), (0.01, 2000.0, 1.02), (1e-3, 300.0, 1.08)],
)
def test_the_whole_motion_along_a_line_takes_the_closed_form_time(length: float, jerk: float, most: float) -> None:
    wide, three = (1e3,) * 3, np.ones(3)
    joints = JointLimits((-1.0,) * 3, (1.0,) * 3, wide, tuple(20.0 * three), tuple(jerk * three))
    path = straight(np.zeros(2), np.array([length, 0.0]), -0.5)
    tempo = timed(Route.of([(path, Limits(1.0, 1e4))]), cast("Robot", Gantry(joints, Controller())))
    best = seven_phases(length, 1.0, 20.0, jerk)
    assert best * 0.9995 <= tempo.durations[0] <= best * most


@pytest.mark.parametrize("jerk", [6388.0, 1500.0])
def test_finer_knots_gain_little(jerk: float, monkeypatch: pytest.MonkeyPatch) -> None:
    robot = load_robot("delta-300")
    robot = replace(robot, joints=replace(robot.joints, max_jerk=(jerk,) * 3))
    shape = slot(0.06, 0.02)
    (path,) = pieces(shape, corner="round", deviation=18e-6, ramps=True, z=robot.workspace.sheet_z)
    route = Route.of([(path, Limits(1.0, robot.tool.max_acceleration))])
    usual = timed(route, robot).durations[0]
    for name, factor in (("_PER_RAMP", 2.0), ("_PER_CLOTHOID", 2.0), ("COARSEST", 0.5)):
        monkeypatch.setattr(knots, name, factor * getattr(knots, name))
    fine = timed(route, robot).durations[0]
    assert fine * 0.999 <= usual <= fine * 1.01
