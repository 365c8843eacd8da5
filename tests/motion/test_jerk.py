"""Motions within a limit of jerk, by derivatives ten times finer than the knots, by differences, and by their ends."""

import itertools
from dataclasses import replace
from functools import cache

import numpy as np
import pytest
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Corner, Curve, Cut, Placement, Process
from deltacam.motion.corners import Pace, pieces
from deltacam.motion.jerk import limited
from deltacam.motion.path import Path, straight
from deltacam.motion.route import Grid, Limits, Route
from deltacam.motion.rows import Rows
from deltacam.motion.sample import sample
from deltacam.motion.setpoints import plan_motion
from deltacam.motion.tempo import Tempo
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Interpolation, Robot
from tests.motion.shares import at_ticks, located, of_tempo
from tests.strategies import slot

DELTA = load_robot("delta-300")
Z = DELTA.workspace.sheet_z
CAP = 23.0
JERKS = {"mild": 5e4, "usual": 6388.0, "low": 1500.0, "harsh": 300.0}
"""Limits of the joints' jerk, rad/s3; the joints of delta-300 have 64 rad/s2."""


def limited_robot(jerk: float, interpolation: Interpolation = "linear") -> Robot:
    joints = replace(DELTA.joints, max_jerk=(jerk,) * 3)
    return replace(DELTA, joints=joints, controller=replace(DELTA.controller, interpolation=interpolation))


def around(curve: Curve, jerk: float, *, corner: Corner = "round", feed: float = 1.0) -> Route:
    # A joint turns by about 2.5 rad/m.
    pace = Pace(feed, CAP, jerk / 3.0, 1.0 / DELTA.controller.rate_hz)
    paths = pieces(curve, corner=corner, deviation=18e-6, ramps=True, z=Z, pace=pace)
    return Route.of([(path, Limits(feed, CAP)) for path in paths])


def rounded_rectangle(width: float, height: float, radius: float) -> Curve:
    x, y, r = 0.5 * width, 0.5 * height, radius
    corners = [(x - r, -y), (x, r - y), (x, y - r), (x - r, y), (r - x, y), (-x, y - r), (-x, r - y), (r - x, -y)]
    return curves.start_at(Curve(points=np.array(corners), bulges=np.tile([np.tan(np.pi / 8.0), 0.0], 4)), 7, x - r)


def star() -> Curve:
    angle = np.arange(10) * np.pi / 5.0
    radius = np.where(np.arange(10) % 2, 0.01, 0.03)
    return curves.polygon(radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1))


def line(*ends: float) -> Path:
    return straight(np.array(ends[:2]), np.array(ends[2:]), Z)


def rapids() -> Route:
    lines = [line(-0.14, 0.1, 0.14, -0.12), line(0.1, 0.1, -0.14, 0.13), line(0.1, 0.0, 0.101, 0.0)]
    return Route.of([(path, Limits(1.0, CAP)) for path in lines])


ROUTES = {
    "rounded rectangle": lambda jerk: around(rounded_rectangle(0.06, 0.04, 0.005), jerk),
    "star": lambda jerk: around(star(), jerk),
    "star with stops": lambda jerk: around(star(), jerk, corner="stop"),
    "slot": lambda jerk: around(slot(0.03, 0.01), jerk),
    "slow slot": lambda jerk: around(slot(0.03, 0.01), jerk, feed=0.1),
    "rapids": lambda _jerk: rapids(),
    "2 um": lambda _jerk: Route.of([(line(0.1, 0.0, 0.1 + 2e-6, 0.0), Limits(1.0, CAP))]),
}


@cache
def run(shape: str, jerk: str) -> tuple[Route, Tempo, Robot]:
    robot, route = limited_robot(JERKS[jerk]), ROUTES[shape](JERKS[jerk])
    return route, timed(route, robot), robot


def timed(route: Route, robot: Robot) -> Tempo:
    grid = Grid.over(route, robot)
    return limited(route, grid, Rows.over(route, grid, robot), robot, np.ones(len(grid.segment)))


every_motion = pytest.mark.parametrize(("shape", "jerk"), [(shape, jerk) for shape in ROUTES for jerk in JERKS])


@every_motion
def test_no_limit_is_exceeded_between_knots(shape: str, jerk: str) -> None:
    assert max(of_tempo(*run(shape, jerk), np.linspace(0.0, 1.0, 11))) <= 1.001


@every_motion
@pytest.mark.parametrize("phase", [0.0, 0.3])
def test_no_limit_is_exceeded_in_differences_with_held_ends(shape: str, jerk: str, phase: float) -> None:
    route, tempo, robot = run(shape, jerk)
    assert max(at_ticks(route, tempo, robot, phase=phase)) <= 1.001


@every_motion
def test_every_move_begins_and_ends_at_rest_without_acceleration(shape: str, jerk: str) -> None:
    route, tempo, _ = run(shape, jerk)
    begin, end = tempo.base.first[:-1], tempo.base.first[1:] - 1
    edges = np.concatenate([[0.0], np.cumsum(route.path.length)])[route.first]
    for interval, u, place in ((begin, 0.0, edges[:-1]), (end, 1.0, edges[1:])):
        motion = tempo.motion(interval, np.full(len(interval), u))
        assert motion.distance == pytest.approx(place, abs=1e-12)
        assert motion.speed == pytest.approx(0.0, abs=1e-12)
        assert motion.acceleration == pytest.approx(0.0, abs=1e-9)


@every_motion
def test_the_tool_never_goes_back(shape: str, jerk: str) -> None:
    _, tempo, _ = run(shape, jerk)
    for move, duration in enumerate(tempo.durations):
        time = np.linspace(0.0, duration, 20_000)
        assert (np.diff(tempo.at(np.full(len(time), move), time)) >= -1e-15).all()


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
@pytest.mark.parametrize("shape", ["rounded rectangle", "star", "star with stops", "rapids"])
def test_every_setpoint_lies_on_the_path(shape: str, interpolation: Interpolation) -> None:
    robot = limited_robot(JERKS["usual"], interpolation)
    route = ROUTES[shape](JERKS["usual"])
    tempo = timed(route, robot)
    for move, q in enumerate(sample(route.path, tempo, robot)):
        ends = route.first[move], route.first[move + 1]
        tool = robot.forward(q)
        assert tool[:, 2] == pytest.approx(Z, abs=1e-9)
        own = route.path.part(*ends)
        fine = np.linspace(0.0, own.total, int(own.total / 1e-6) + 2)
        points, *_ = own.evaluate(*own.locate(fine))
        off = shapely.distance(shapely.points(tool[:, :2]), shapely.LineString(points[:, :2]))
        bend = own.sharpest.max()
        assert off.max() <= 1e-9 + bend * 1e-12 / 8.0  # the sagitta of chords of a micrometre


@pytest.mark.parametrize("shape", ROUTES)
def test_a_lower_limit_of_jerk_is_not_faster(shape: str) -> None:
    route = ROUTES[shape](JERKS["harsh"])
    times = [timed(route, limited_robot(jerk)).durations for jerk in JERKS.values()]
    for faster, slower in itertools.pairwise(times):
        assert (faster <= slower * (1.0 + 1e-3)).all()


def test_moves_in_a_route_are_run_as_each_for_itself() -> None:
    route, tempo, robot = run("rapids", "usual")
    for move, duration in enumerate(tempo.durations):
        own = Route.of([(route.path.part(move, move + 1), Limits(1.0, CAP))])
        assert timed(own, robot).durations[0] == pytest.approx(duration, rel=2e-3)


def test_where_it_is_told_to_be_slower_the_speed_is_lower_and_the_acceleration_by_the_square() -> None:
    route, free, robot = run("rounded rectangle", "low")
    grid = Grid.over(route, robot)
    rows = Rows.over(route, grid, robot)
    half = limited(route, grid, rows, robot, np.full(len(grid.segment), 0.5))
    interval = np.arange(len(half.base.width))
    motion = half.motion(interval, np.full(len(interval), 0.5))
    segment, _ = located(route, half.base.move, motion.distance)
    assert (motion.speed <= 0.5 * route.speed[segment] * 1.001).all()
    assert np.abs(motion.acceleration).max() <= 0.25 * CAP * 1.001
    assert half.durations[0] > free.durations[0]


def test_a_limit_that_is_passed_between_stations_slows_a_motion_down_only_there() -> None:
    """A blob with its leads: its first motion has 13 times the jerk allowed for in one interval near a sharp corner."""
    rows = [
        (67048.609, 22009.468, 0.000000000),
        (67146.949, 22027.611, -0.414213562),
        (75560.733, 16234.872, 0.035293432),
        (76283.594, 13438.960, -0.012617347),
        (77761.606, 8685.309, 0.160913952),
        (77779.197, 8659.335, -0.004940943),
        (84196.834, 3613.676, 0.227913176),
        (84239.044, 3603.882, 0.094221628),
        (88513.772, 5452.004, 0.060551359),
        (93279.941, 7247.530, 0.131214049),
        (93298.955, 7264.967, 0.004038971),
        (96813.572, 12875.752, 0.107229494),
        (96820.601, 12895.756, -0.015943980),
        (97384.776, 16479.838, 0.093716939),
        (97384.797, 16498.418, -0.020387387),
        (96328.694, 23731.202, 0.300115276),
        (96293.757, 23773.763, -0.019152878),
        (90367.428, 25860.959, 0.005225681),
        (90366.452, 25861.334, -0.011072433),
        (86640.644, 27341.558, 0.240920054),
        (86595.223, 27338.258, 0.024334159),
        (81297.377, 23760.233, 0.091454839),
        (75251.192, 19140.290, 0.196796482),
        (75238.296, 19104.661, 0.035293432),
        (75560.733, 16234.872, 0.012817176),
        (75777.618, 15207.633, -0.414213562),
        (70423.641, 6508.063, 0.000000000),
        (70326.359, 6484.905, 0.000000000),
    ]
    columns = np.array(rows)
    curve = Curve(points=1e-6 * columns[:, :2], bulges=columns[:-1, 2], closed=False)
    robot = load_robot("delta-300")
    process = Process(name="", source="", material="", thickness=1e-3, kerf=0.0, feed=0.3, power=1.0, pierce_time=0.0)
    where = Placement(-0.048667828, -0.058088115, 0.0, robot.workspace.sheet_z)
    cut = Cut(1, "", ("2F",), curve)
    found = plan_motion([cut], robot=robot, process=process, placement=where, drawing_error=0.0, jobs=1)
    assert found.held[0].time < 0.75
