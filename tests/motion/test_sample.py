"""How far the controller leaves the path between ticks, against distances that are looked for everywhere."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline
from scipy.spatial import cKDTree

from deltacam.geometry import curve as curves
from deltacam.model import Array, Corner, Curve
from deltacam.motion.corners import pieces
from deltacam.motion.law import Law
from deltacam.motion.parametrize import parametrize
from deltacam.motion.path import Path, straight
from deltacam.motion.route import Limits, Route
from deltacam.motion.run import run
from deltacam.motion.sample import chord_deviation, halfway, sample, tick_counts
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Interpolation, Robot
from tests.strategies import slot

DELTA = load_robot("delta-300")
Z = DELTA.workspace.sheet_z
CAP = DELTA.tool.max_acceleration
TIGHT = 3e-6
kinds = pytest.mark.parametrize("interpolation", ["linear", "cubic"])
shapes = pytest.mark.parametrize("shape", ["slot", "circle", "zigzag"])
jerks = pytest.mark.parametrize("jerk", [None, 6388.0], ids=["without jerk", "with jerk"])


def robot_with(interpolation: Interpolation, jerk: float | None = None) -> Robot:
    joints = replace(DELTA.joints, max_jerk=jerk and (jerk,) * 3)
    return replace(DELTA, joints=joints, controller=replace(DELTA.controller, interpolation=interpolation))


ZIGZAG = Curve(np.array([[0.0, 0.0], [0.01, 0.002], [0.012, 0.01], [0.02, 0.0]]), np.array([0, 0.4, 0]), closed=False)
SHAPES = {"slot": slot(0.03, 0.004), "circle": curves.circle(np.array([0.03, -0.1]), 0.01), "zigzag": ZIGZAG}


def route_of(curve: Curve, robot: Robot, chord: float, corner: Corner = "round") -> Route:
    ramps = robot.joints.max_jerk is not None
    parts = pieces(curve, corner=corner, deviation=18e-6, ramps=ramps, z=Z)
    return Route.of([(part, Limits(1.0, CAP, chord)) for part in parts])


def moved(q: Array, end: Array, interpolation: Interpolation, share: float) -> Array:
    """The joints at a share of every tick, of a move that begins and ends at rest, by scipy."""
    whole = np.vstack([q, end])
    tick = np.arange(len(whole), dtype=np.float64)
    at = tick[:-1] + share
    if interpolation == "linear":
        return np.stack([np.interp(at, tick, joint) for joint in whole.T], axis=1)
    held = np.vstack([whole[:1], whole, whole[-1:]])
    return np.asarray(CubicHermiteSpline(tick, whole, 0.5 * (held[2:] - held[:-2]))(at))


def off_path(path: Path, robot: Robot, joints: Array) -> Array:
    """The distance of the tool from the path, (N,) m: from the tangent at the nearest of points every 2 um."""
    place = np.linspace(0.0, path.total, int(path.total / 2e-6) + 2)
    points, *_ = path.evaluate(*path.locate(place))
    tool = robot.forward(joints)
    place = place[cKDTree(points).query(tool)[1]]
    for _ in range(3):
        points, tangents, *_ = path.evaluate(*path.locate(place))
        place = np.clip(place + np.sum((tool - points) * tangents, axis=1), 0.0, path.total)
    points, *_ = path.evaluate(*path.locate(place))
    return np.asarray(np.linalg.norm(tool - points, axis=1))


def end_of(route: Route, robot: Robot) -> Array:
    path = route.path
    end, *_ = path.evaluate(np.array([len(path.length) - 1]), path.length[-1:])
    return np.asarray(robot.inverse(end)[0])


@kinds
@shapes
def test_the_chord_deviation_is_the_distance_from_the_path_half_way_between_ticks(
    shape: str, interpolation: Interpolation
) -> None:
    robot = robot_with(interpolation)
    route = route_of(SHAPES[shape], robot, np.inf)
    law = parametrize(route, robot)
    (q,), end = sample(route.path, law, robot), end_of(route, robot)
    off, place = chord_deviation(route.path, law, robot, (q,), end[None])
    assert off == pytest.approx(off_path(route.path, robot, moved(q, end, interpolation, 0.5)), abs=2e-9)
    assert off.max() > (1e-5 if interpolation == "linear" else 1e-7)
    assert (np.diff(place) > 0.0).all()


@kinds
def test_half_way_is_where_scipy_has_it(interpolation: Interpolation) -> None:
    q = np.random.default_rng(3).normal(0.0, 0.1, (20, 3))
    found = halfway(q, robot_with(interpolation))
    assert found == pytest.approx(moved(q[:-1], q[-1], interpolation, 0.5), abs=1e-15)


@jerks
@kinds
@shapes
@pytest.mark.parametrize("corner", ["round", "stop"])
def test_a_tight_chord_tolerance_is_held_all_along_every_tick(
    shape: str, interpolation: Interpolation, jerk: float | None, corner: Corner
) -> None:
    robot = robot_with(interpolation, jerk)
    route = route_of(SHAPES[shape], robot, TIGHT, corner)
    # The moves follow each other without a pause, as at corners that are stopped at.
    q, end = np.concatenate([one.q for one in run(route, robot)]), end_of(route, robot)
    for share in (0.25, 0.5, 0.75):
        assert off_path(route.path, robot, moved(q, end, interpolation, share)).max() <= TIGHT * 1.001


@pytest.mark.parametrize(("interpolation", "tolerance"), [("linear", TIGHT), ("cubic", 0.2e-6)])
def test_a_chord_tolerance_is_held_where_it_binds_and_is_made_use_of(
    interpolation: Interpolation, tolerance: float
) -> None:
    robot = robot_with(interpolation)
    free, bound = (run(route_of(SHAPES["slot"], robot, chord), robot)[0] for chord in (np.inf, tolerance))
    path = route_of(SHAPES["slot"], robot, tolerance).path
    end = end_of(route_of(SHAPES["slot"], robot, tolerance), robot)
    off = [off_path(path, robot, moved(one.q, end, interpolation, 0.5)).max() for one in (free, bound)]
    assert off[0] > 1.5 * tolerance
    assert 0.7 * tolerance < off[1] <= tolerance * 1.0001
    assert bound.duration > free.duration


class Even:
    """A motion of constant speed along two moves that do not begin at ticks."""

    def __init__(self, lengths: Array, durations: Array) -> None:
        self.lengths, self.durations = lengths, durations
        self.starts = np.cumsum(lengths) - lengths

    def at(self, move: Array, since: Array) -> Array:
        share = since / self.durations[move]
        return np.asarray(self.starts[move] + self.lengths[move] * share)


def test_setpoints_are_the_places_of_the_law_at_ticks_of_a_time_stretched_to_the_next_tick() -> None:
    lines = [straight(np.zeros(2), np.array([0.01, 0.0]), Z), straight(np.zeros(2), np.array([0.0, 0.03]), Z)]
    route = Route.of([(line, Limits(1.0, CAP)) for line in lines])
    law: Law = Even(np.array([0.01, 0.03]), np.array([0.0101, 0.025]))
    assert tick_counts(law, 400.0).tolist() == [5, 10]
    first, second = (DELTA.forward(q) for q in sample(route.path, law, DELTA))
    assert first[:, 0] == pytest.approx(0.01 * np.arange(5) / 5.0, abs=1e-12)
    assert second[:, 1] == pytest.approx(0.03 * np.arange(10) / 10.0, abs=1e-12)


def test_a_duration_that_is_a_whole_number_of_ticks_but_for_rounding_is_not_stretched() -> None:
    law: Law = Even(np.ones(3), np.array([4e-4, 0.0025 * (1.0 + 1e-14), 0.0025 * 1.001]))
    assert tick_counts(law, 400.0).tolist() == [1, 1, 2]
