"""The time law, against closed forms, a solver of another kind, and the limits themselves."""

import math

import numpy as np
import pytest
from scipy.integrate import quad

from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve
from deltacam.motion import parametrize as module
from deltacam.motion.corners import pieces
from deltacam.motion.parametrize import Limits, parametrize
from deltacam.motion.path import Path, from_curve, straight
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot
from tests.strategies import slot

ROBOT = load_robot("delta-300")
Z = ROBOT.workspace.sheet_z
CAP = 23.0


def around(curve: Curve) -> Path:
    (part,) = pieces(curve, corner="round", deviation=17e-6)
    return from_curve(part, Z)


def random_path(seed: int) -> Path:
    """A rounded path of lines and arcs somewhere on the sheet, of 5 to 60 mm across."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(3, 12))
    angle = 2.0 * np.pi * (np.arange(count) + rng.uniform(-0.3, 0.3, count)) / count
    radius = 10.0 ** rng.uniform(-2.6, -1.5, count)
    bulges = np.where(rng.random(count) < 0.5, 0.0, rng.uniform(-0.3, 0.5, count))
    points = radius[:, None] * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    parts = pieces(Curve(points=points + rng.uniform(-0.1, 0.1, 2), bulges=bulges), corner="round", deviation=17e-6)
    return from_curve(max(parts, key=curves.length), Z)


def derivatives(path: Path, distance: Array) -> tuple[Array, Array, Array]:
    """q' and q'' and curvature just where asked, from inside a segment."""
    segment, inside = path.locate(distance)
    _, dq, ddq = ROBOT.path_derivatives(*path.evaluate(segment, inside))
    return dq, ddq, np.abs(path.curvature[segment])


def test_a_circle_takes_the_closed_form_time() -> None:
    """Rest to rest on a circle of radius r under |a| <= A alone.

    With x the squared speed, (x' / 2)^2 + (x / r)^2 = A^2, so x = A r sin(2 s / r) until x = A r after an eighth of
    the way around, then constant, then the same backwards.
    """
    r = 0.02
    ramp, _ = quad(lambda s: 1.0 / math.sqrt(CAP * r * math.sin(2.0 * s / r)), 0.0, math.pi * r / 4.0)
    best = 2.0 * ramp + 1.5 * math.pi * r / math.sqrt(CAP * r)
    law = parametrize(around(curves.circle(np.zeros(2), r)), ROBOT, Limits(10.0, CAP), where="circle")
    assert best * 0.99999 <= law.duration <= best * 1.005


def test_a_straight_line_takes_the_closed_form_time() -> None:
    short = parametrize(straight(np.array([-0.05, 0.0]), np.array([0.05, 0.0]), Z), ROBOT, Limits(10.0, CAP), where="")
    assert short.duration == pytest.approx(2.0 * math.sqrt(0.1 / CAP), rel=1e-3)
    long = parametrize(straight(np.array([-0.14, 0.1]), np.array([0.14, 0.1]), Z), ROBOT, Limits(0.5, CAP), where="")
    assert long.duration == pytest.approx(0.28 / 0.5 + 0.5 / CAP, rel=1e-3)


@pytest.mark.parametrize("seed", range(12))
def test_no_limit_is_exceeded_between_gridpoints_either(seed: int) -> None:
    path, feed = random_path(seed), [0.05, 0.3, 1.0][seed % 3]
    law = parametrize(path, ROBOT, Limits(feed, CAP, chord=20e-6), where="random")
    for share in (1e-6, 0.25, 0.5, 0.75, 1.0 - 1e-6):
        squared = law.speed[:-1] ** 2 * (1.0 - share) + law.speed[1:] ** 2 * share
        width = np.diff(law.distance)
        u = np.diff(law.speed**2) / (2.0 * width)
        dq, ddq, curvature = derivatives(path, law.distance[:-1] + share * width)
        assert np.sqrt(squared).max() <= feed * (1.0 + 1e-6)
        assert np.hypot(u, curvature * squared).max() <= CAP * 1.001
        speed = np.abs(dq) * np.sqrt(squared)[:, None]
        acceleration = np.abs(dq * u[:, None] + ddq * squared[:, None])
        assert (speed / ROBOT.joints.max_speed).max() <= 1.001
        assert (acceleration / ROBOT.joints.max_acceleration).max() <= 1.001


def reachability(path: Path, robot: Robot, cap: float, feed: float, spacing: float) -> float:
    """The shortest time by another route: the largest speed profile under the exact, round cap, on a dense grid.

    A forward and a backward pass of the squared speed, each step by bisection on what the next point allows, with the
    derivatives in the middle of each interval. No polygon, no linear program.
    """
    count = np.maximum(8, np.ceil(path.length / spacing)).astype(int)
    width = np.repeat(path.length / count, count)
    middle = np.cumsum(width) - width / 2.0
    segment, inside = path.locate(middle)
    _, dq, ddq = robot.path_derivatives(*path.evaluate(segment, inside))
    curvature = np.abs(path.curvature[segment])
    most = np.asarray(robot.joints.max_acceleration)
    ceiling = np.minimum(feed**2, np.min((np.asarray(robot.joints.max_speed) / np.abs(dq)) ** 2, axis=1))
    ceiling = np.minimum(ceiling, np.where(curvature > 0.0, cap / np.maximum(curvature, 1e-12), np.inf))
    top = np.minimum(np.append(ceiling, 0.0), np.insert(ceiling, 0, 0.0))

    def allowed(i: int, low: float, high: float, sign: float) -> bool:
        u, x = sign * (high - low) / (2.0 * width[i]), 0.5 * (low + high)
        return bool(u**2 + (curvature[i] * x) ** 2 <= cap**2 and (np.abs(dq[i] * u + ddq[i] * x) <= most).all())

    def sweep(start: int, step: int, sign: float, limit: Array) -> Array:
        x = limit.copy()
        for i in range(start, start + step * len(width), step):
            here, there = (i, i + 1) if step > 0 else (i + 1, i)
            low, high = 0.0, float(limit[there])
            if allowed(i, x[here], high, sign):
                x[there] = high
                continue
            for _ in range(45):
                trial = 0.5 * (low + high)
                low, high = (trial, high) if allowed(i, x[here], trial, sign) or trial < x[here] else (low, trial)
            x[there] = low
        return x

    backward = sweep(len(width) - 1, -1, -1.0, top)
    forward = sweep(0, 1, 1.0, backward)
    speed = np.sqrt(forward)
    return float(np.sum(2.0 * width / (speed[:-1] + speed[1:])))


@pytest.mark.parametrize("seed", range(4))
def test_the_time_is_within_three_quarters_of_a_percent_of_a_dense_reachability_pass(seed: int) -> None:
    path = random_path(100 + seed)
    law = parametrize(path, ROBOT, Limits(0.6, CAP), where="random")
    assert law.duration <= 1.0075 * reachability(path, ROBOT, CAP, 0.6, 1e-4)


def test_a_joint_of_line_and_arc_is_passed_without_a_stop() -> None:
    path = around(curves.start_at(slot(0.06, 0.02), 0, 0.03))
    law = parametrize(path, ROBOT, Limits(10.0, CAP), where="slot")
    inner = (law.distance > 0.02) & (law.distance < path.total - 0.02)
    assert law.speed[inner].min() > 0.9 * math.sqrt(CAP * 0.01)


def test_where_the_chord_would_leave_the_path_the_motion_is_slower() -> None:
    path = around(curves.circle(np.zeros(2), 0.02))
    free = parametrize(path, ROBOT, Limits(10.0, CAP), where="circle")
    bound = parametrize(path, ROBOT, Limits(10.0, CAP, chord=5e-6), where="circle")
    assert bound.speed.max() == pytest.approx(math.sqrt(0.02 * 8 * 5e-6 / 0.0025**2), rel=0.1)
    assert bound.duration > 1.5 * free.duration


def test_the_law_is_exact_between_gridpoints() -> None:
    law = parametrize(straight(np.zeros(2), np.array([0.03, 0.0]), Z), ROBOT, Limits(10.0, CAP), where="line")
    time = np.linspace(0.0, law.duration / 2.0, 50)
    assert law.at(time) == pytest.approx(0.5 * CAP * time**2, rel=2e-3, abs=1e-9)
    assert law.at(np.array([law.duration]))[0] == pytest.approx(0.03, abs=1e-12)


def test_a_path_without_a_time_law_is_an_error_that_names_it(monkeypatch: pytest.MonkeyPatch) -> None:
    # A row that no motion can meet: 0 u + 0 x <= -1.
    monkeypatch.setattr(module, "_right_hand_side", lambda *_: np.full(6 + module.SIDES, -1.0))
    with pytest.raises(InfeasibleError) as caught:
        parametrize(straight(np.zeros(2), np.array([0.1, 0.0]), Z), ROBOT, Limits(1.0, CAP), where="contour 5")
    assert caught.value.where == "contour 5"
