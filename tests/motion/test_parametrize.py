"""The time law, against closed forms, a solver of another kind, and the limits themselves."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.optimize import linprog
from scipy.sparse import coo_matrix

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve
from deltacam.motion import parametrize as module
from deltacam.motion.corners import pieces
from deltacam.motion.law import TimeLaw
from deltacam.motion.parametrize import UndrivableError, parametrize
from deltacam.motion.path import Path, straight
from deltacam.motion.route import Grid, Limits, Route
from deltacam.motion.rows import Rows
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot
from tests.strategies import slot

ROBOT = load_robot("delta-300")
Z = ROBOT.workspace.sheet_z
CAP = 23.0

WEAK = replace(
    ROBOT,
    joints=replace(
        ROBOT.joints,
        max_speed=tuple(0.15 * limit for limit in ROBOT.joints.max_speed),
        max_acceleration=tuple(0.3 * limit for limit in ROBOT.joints.max_acceleration),
    ),
)
"""The same machine with motors that are the first to give out."""


def around(curve: Curve) -> Path:
    (path,) = pieces(curve, corner="round", deviation=17e-6, ramps=False, z=Z)
    return path


def timed(path: Path, robot: Robot, limits: Limits) -> TimeLaw:
    return parametrize(Route.of([(path, limits)]), robot)


def speeds(law: TimeLaw) -> Array:
    return np.sqrt(law.squared)


def random_path(seed: int) -> Path:
    """A rounded path of lines and arcs somewhere on the sheet, of 5 to 60 mm across."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 12))
    angle = 2.0 * np.pi * (np.arange(count) + rng.uniform(-0.3, 0.3, count)) / count
    radius = 10.0 ** rng.uniform(-2.6, -1.5, count)
    bulges = np.where(rng.random(count) < 0.5, 0.0, rng.uniform(-0.3, 0.5, count))
    points = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    curve = Curve(points=points + rng.uniform(-0.1, 0.1, 2), bulges=bulges)
    parts = pieces(curve, corner="round", deviation=17e-6, ramps=seed % 2 == 1, z=Z)
    return max(parts, key=lambda path: path.total)


def derivatives(path: Path, distance: Array) -> tuple[Array, Array, Array]:
    """q' and q'' and curvature just where asked, from inside a segment."""
    segment, inside = path.locate(distance)
    position, tangent, bend, _ = path.evaluate(segment, inside)
    _, dq, ddq = ROBOT.path_derivatives(position, tangent, bend)
    return dq, ddq, np.linalg.norm(bend, axis=1)


def test_a_circle_takes_the_closed_form_time() -> None:
    """Rest to rest on a circle of radius r under |a| <= A alone.

    With x the squared speed, (x' / 2)^2 + (x / r)^2 = A^2, so x = A r sin(2 s / r) until x = A r after an eighth of
    the way around, then constant, then the same backwards.
    """
    r = 0.02
    ramp, _ = quad(lambda s: 1.0 / math.sqrt(CAP * r * math.sin(2.0 * s / r)), 0.0, math.pi * r / 4.0)
    best = 2.0 * ramp + 1.5 * math.pi * r / math.sqrt(CAP * r)
    law = timed(around(curves.circle(np.zeros(2), r)), ROBOT, Limits(10.0, CAP))
    assert best * 0.99999 <= law.durations[0] <= best * 1.005


def test_a_straight_line_takes_the_closed_form_time() -> None:
    short = timed(straight(np.array([-0.05, 0.0]), np.array([0.05, 0.0]), Z), ROBOT, Limits(10.0, CAP))
    assert short.durations[0] == pytest.approx(2.0 * math.sqrt(0.1 / CAP), rel=1e-3)
    slow = timed(straight(np.array([-0.05, 0.0]), np.array([0.05, 0.0]), Z), ROBOT, Limits(0.05, CAP))
    assert slow.durations[0] == pytest.approx(0.1 / 0.05 + 0.05 / CAP, rel=1e-3)
    long = timed(straight(np.array([-0.14, 0.1]), np.array([0.14, 0.1]), Z), ROBOT, Limits(0.5, CAP))
    assert long.durations[0] == pytest.approx(0.28 / 0.5 + 0.5 / CAP, rel=1e-3)


@pytest.mark.parametrize("robot", [ROBOT, WEAK], ids=["strong joints", "weak joints"])
@pytest.mark.parametrize("seed", range(12))
def test_no_limit_is_exceeded_between_gridpoints_either(seed: int, robot: Robot) -> None:
    path, feed = random_path(seed), [0.05, 0.3, 1.0][seed % 3]
    law = timed(path, robot, Limits(feed, CAP, chord=20e-6))
    for share in (1e-6, 0.25, 0.5, 0.75, 1.0 - 1e-6):
        squared = law.squared[:-1] * (1.0 - share) + law.squared[1:] * share
        width = np.diff(law.distance)
        u = np.diff(law.squared) / (2.0 * width)
        dq, ddq, curvature = derivatives(path, law.distance[:-1] + share * width)
        assert np.sqrt(squared).max() <= feed * (1.0 + 1e-6)
        assert np.hypot(u, curvature * squared).max() <= CAP * 1.001
        speed = np.abs(dq) * np.sqrt(squared)[:, None]
        acceleration = np.abs(dq * u[:, None] + ddq * squared[:, None])
        assert (speed / robot.joints.max_speed).max() <= 1.001
        assert (acceleration / robot.joints.max_acceleration).max() <= 1.001


def shortest_time(path: Path, robot: Robot, cap: float, feed: float, spacing: float) -> float:
    """The shortest time by another route: one linear program over the whole profile of the squared speed, by HiGHS.

    The limits hold in the middle of intervals that are much shorter than ours, and a polygon drawn around the half
    circle, not inside it, stands for the cap. The profile with the largest sum is the fastest one.
    """
    count = np.maximum(8, np.ceil(path.length / spacing)).astype(int)
    width = np.repeat(path.length / count, count)
    dq, ddq, curvature = derivatives(path, np.cumsum(width) - width / 2.0)
    angle = np.arange(49) * np.pi / 48
    a = np.concatenate([dq, -dq, np.tile(np.cos(angle), (len(dq), 1))], axis=1)
    b = np.concatenate([ddq, -ddq, curvature[:, None] * np.sin(angle)], axis=1)
    most = np.concatenate([np.tile(robot.joints.max_acceleration, 2), np.full(49, cap)])
    # a (x_after - x_before) / (2 width) + b (x_before + x_after) / 2 <= most
    intervals, rows = a.shape
    row, interval = np.arange(a.size), np.repeat(np.arange(intervals), rows)
    before, after = (0.5 * b + sign * a / (2.0 * width[:, None]) for sign in (-1.0, 1.0))
    table = coo_matrix(
        (np.concatenate([before.ravel(), after.ravel()]), (np.tile(row, 2), np.concatenate([interval, interval + 1])))
    )
    ceiling = np.minimum(feed**2, np.min((np.asarray(robot.joints.max_speed) / np.abs(dq)) ** 2, axis=1))
    highest = np.minimum(np.append(ceiling, 0.0), np.insert(ceiling, 0, 0.0))
    highest[[0, -1]] = 0.0
    bounds = np.column_stack([np.zeros_like(highest), highest])
    found = linprog(-np.ones(intervals + 1), A_ub=table.tocsr(), b_ub=np.tile(most, intervals), bounds=bounds)
    assert found.success
    speed = np.sqrt(np.maximum(found.x, 0.0))
    return float(np.sum(2.0 * width / (speed[:-1] + speed[1:])))


@pytest.mark.parametrize("robot", [ROBOT, WEAK], ids=["strong joints", "weak joints"])
@pytest.mark.parametrize("seed", range(5))
def test_the_time_is_within_half_a_percent_of_one_linear_program_over_the_whole_path(seed: int, robot: Robot) -> None:
    path = random_path(100 + seed)
    law = timed(path, robot, Limits(0.6, CAP))
    best = shortest_time(path, robot, CAP, 0.6, 1e-4)
    assert 0.9995 * best <= law.durations[0] <= 1.005 * best


def test_a_joint_of_line_and_arc_is_passed_without_a_stop() -> None:
    path = around(curves.start_at(slot(0.06, 0.02), 0, 0.03))
    law = timed(path, ROBOT, Limits(10.0, CAP))
    inner = (law.distance > 0.02) & (law.distance < path.total - 0.02)
    assert speeds(law)[inner].min() > 0.9 * math.sqrt(CAP * 0.01)


def test_where_the_chord_would_leave_the_path_the_motion_is_slower() -> None:
    path = around(curves.circle(np.zeros(2), 0.02))
    free = timed(path, ROBOT, Limits(10.0, CAP))
    bound = timed(path, ROBOT, Limits(10.0, CAP, chord=5e-6))
    assert speeds(bound).max() == pytest.approx(math.sqrt(0.02 * 8 * 5e-6 / 0.0025**2), rel=0.1)
    assert bound.durations[0] > 1.5 * free.durations[0]


def test_the_law_is_exact_between_gridpoints() -> None:
    law = timed(straight(np.zeros(2), np.array([0.03, 0.0]), Z), ROBOT, Limits(10.0, CAP))
    time = np.linspace(0.0, law.durations[0] / 2.0, 50)
    assert law.at(np.zeros(50, dtype=int), time) == pytest.approx(0.5 * CAP * time**2, rel=2e-3, abs=1e-9)
    assert law.at(np.array([0]), law.durations)[0] == pytest.approx(0.03, abs=1e-12)


def two_moves() -> Route:
    there, back = np.array([0.0, 0.0]), np.array([0.05, 0.0])
    return Route.of([(straight(there, back, Z), Limits(1.0, CAP)), (straight(back, there, Z), Limits(1.0, CAP))])


@pytest.mark.parametrize("interface", ["_by_compiled_solver", "_by_public_interface"])
def test_a_route_without_a_time_law_is_an_error(interface: str, monkeypatch: pytest.MonkeyPatch) -> None:
    if interface == "_by_public_interface":
        monkeypatch.setattr(module, "_profile", module._by_public_interface)
    # Rows that no motion can meet: forwards and backwards at once.
    monkeypatch.setattr(module, "_TOOL", module._TOOL * [1.0, 1.0, -1.0])
    with pytest.raises(UndrivableError, match=r"of 50\.000 mm along this path") as caught:
        parametrize(two_moves(), ROBOT)
    assert caught.value.move == 1


@pytest.mark.parametrize("robot", [ROBOT, WEAK], ids=["strong joints", "weak joints"])
@pytest.mark.parametrize("seed", range(4))
def test_both_interfaces_of_the_solver_give_the_same_speeds(seed: int, robot: Robot) -> None:
    route = Route.of([(random_path(seed), Limits(0.3, CAP)), *[(random_path(seed + 1), Limits(1.0, CAP, 20e-6))] * 2])
    grid = Grid.over(route, robot)
    program = module._Program.of(grid, Rows.over(route, grid, robot), np.ones(len(grid.segment)))
    quick, slow = module._profile(program), module._by_public_interface(program)
    # Of the largest x. toppra gives 1e-10 of it away at every step, and more where a step has no solution at first.
    assert np.abs(quick - slow).max() <= 2e-5
    times = [TimeLaw.of(grid.distance, program.unit * x, grid.rest).durations for x in (quick, slow)]
    assert times[0] == pytest.approx(times[1], rel=1e-5)


def test_a_long_route_is_solved_in_slices_as_a_short_one_is(monkeypatch: pytest.MonkeyPatch) -> None:
    route = Route.of([(random_path(seed), Limits(0.3, CAP)) for seed in range(3)])
    whole = parametrize(route, ROBOT)
    monkeypatch.setattr(module, "_SLICE", 100)
    monkeypatch.setattr(module, "_SLICES_KEPT", 1)
    assert parametrize(route, ROBOT).squared == pytest.approx(whole.squared, abs=1e-9)


def test_moves_in_a_route_are_run_as_each_for_itself() -> None:
    paths = [random_path(seed) for seed in range(3)]
    together = parametrize(Route.of([(path, Limits(0.3, CAP)) for path in paths]), ROBOT)
    apart = [timed(path, ROBOT, Limits(0.3, CAP)).durations[0] for path in paths]
    assert together.durations == pytest.approx(apart, rel=1e-6)
    assert not together.squared[together.rest].any()
