"""Biarc chains against the curves that they stand for, measured with a brute-force distance to every arc."""

import math

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from deltacam.geometry import biarc
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve

TOLERANCE = 0.5e-6


def ellipse(a: float, b: float) -> biarc.Evaluate:
    def evaluate(t: Array) -> tuple[Array, Array]:
        return np.stack([a * np.cos(t), b * np.sin(t)], axis=1), np.stack([-a * np.sin(t), b * np.cos(t)], axis=1)

    return evaluate


def cubic(control: Array) -> biarc.Evaluate:
    """The Bezier curve over (4, 2) control points."""

    def evaluate(t: Array) -> tuple[Array, Array]:
        s = 1.0 - t
        weights = np.stack([s**3, 3 * s * s * t, 3 * s * t * t, t**3], axis=1)
        slopes = np.stack([-3 * s * s, 3 * s * s - 6 * s * t, 6 * s * t - 3 * t * t, 3 * t * t], axis=1)
        return weights @ control, slopes @ control

    return evaluate


def farthest(curve: Curve, points: Array) -> float:
    """The largest distance of the points from the curve, m."""
    return max(curves.nearest(curve, point)[2] for point in points)


def test_a_straight_line_becomes_one_segment() -> None:
    control = np.outer([0.0, 0.1, 0.7, 1.0], [0.3, 0.2])
    curve, error = biarc.fit(cubic(control), np.linspace(0.0, 1.0, 9), TOLERANCE)
    assert curve.points == pytest.approx(np.array([[0.0, 0.0], [0.3, 0.2]]), abs=1e-12)
    assert not curve.bulges.any()
    assert error < 1e-15


def test_a_circle_becomes_two_half_circles() -> None:
    curve, error = biarc.fit(ellipse(0.05, 0.05), np.linspace(0.0, 2.0 * math.pi, 17), TOLERANCE)
    assert len(curve.bulges) == 2
    assert curve.bulges == pytest.approx(1.0, rel=1e-13)
    assert error < 1e-15


@settings(deadline=None, max_examples=15)
@given(st.floats(1e-3, 0.5), st.floats(0.05, 0.999))
def test_an_ellipse_is_followed_within_a_micrometre_without_a_corner(a: float, ratio: float) -> None:
    evaluate = ellipse(a, a * ratio)
    curve, error = biarc.fit(evaluate, np.linspace(0.0, 2.0 * math.pi, 9), TOLERANCE)
    points, _ = evaluate(np.linspace(0.0, 2.0 * math.pi, 401))
    worst = farthest(curve, points)
    assert worst <= 1e-6
    assert worst <= 1.2 * error + 1e-9
    assert error <= 1.2 * TOLERANCE + 1e-8
    assert np.abs(curves.corner_angles(curve)).max() < 1e-4


@settings(deadline=None, max_examples=40)
@given(st.lists(st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1)), min_size=4, max_size=4, unique=True))
@example([(0.0, 2e-155), (0.0, 1e-308), (0.0625, 0.0625), (0.0, 0.0)])  # out and back on one line
def test_a_cubic_with_loops_cusps_and_inflections_is_followed_within_a_micrometre(points: list[Array]) -> None:
    evaluate = cubic(np.array(points))
    curve, _ = biarc.fit(evaluate, np.linspace(0.0, 1.0, 3), TOLERANCE)
    samples, _ = evaluate(np.linspace(0.0, 1.0, 499))
    assert farthest(curve, samples) <= 1e-6
    assert curve.points[0] == pytest.approx(samples[0], abs=1e-15)
    assert curve.points[-1] == pytest.approx(samples[-1], abs=1e-15)


def test_the_curve_of_arcs_never_strays_from_the_exact_one() -> None:
    control = np.array([[0.0, 0.0], [0.2, 0.1], [-0.1, 0.1], [0.1, 0.0]])
    curve, _ = biarc.fit(cubic(control), np.linspace(0.0, 1.0, 3), TOLERANCE)
    exact, _ = cubic(control)(np.linspace(0.0, 1.0, 500_001))
    places, _ = curves.flatten(curve, 1e-8)
    from scipy.spatial import cKDTree

    apart, _ = cKDTree(exact).query(places)
    assert apart.max() < 1e-6


def test_a_circular_stretch_within_a_curve_is_one_arc() -> None:
    straight, quarter = 0.05, 0.05 * math.pi / 2.0

    def evaluate(t: Array) -> tuple[Array, Array]:
        heading = np.clip((t - straight) / 0.05, 0.0, math.pi / 2.0)
        x = np.minimum(t, straight) + 0.05 * np.sin(heading)
        y = 0.05 * (1.0 - np.cos(heading)) + np.maximum(t - straight - quarter, 0.0)
        return np.stack([x, y], axis=1), np.stack([np.cos(heading), np.sin(heading)], axis=1)

    breaks = np.unique(np.concatenate([np.linspace(0.0, straight, 4), straight + np.linspace(0.0, quarter, 7)]))
    curve, _ = biarc.fit(evaluate, breaks, TOLERANCE)
    assert curve.bulges == pytest.approx([0.0, math.tan(math.pi / 8.0)], rel=1e-13)


def rush(turn: float, speed: float) -> biarc.Evaluate:
    """A stretch of an ellipse that is run almost at once, near parameter 0.512 of 0 to 1."""
    return lambda t: ellipse(0.02, 0.01)(0.5 * turn * (1.0 + np.tanh(speed * (t - 0.512))))


@pytest.mark.parametrize(("turn", "speed"), [(math.pi, 150.0), (2.0 * math.pi, 300.0)])
def test_a_curve_that_is_run_in_a_rush_between_two_samples_is_followed(turn: float, speed: float) -> None:
    curve, error = biarc.fit(rush(turn, speed), np.array([0.0, 1.0]), TOLERANCE)
    points, _ = ellipse(0.02, 0.01)(np.linspace(1e-4, turn - 1e-4, 101))
    assert farthest(curve, points) <= 1e-6
    assert error <= 1.02 * TOLERANCE


def test_a_curve_that_is_not_followed_in_time_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(biarc, "_CHECKS", 1)
    with pytest.raises(ValueError, match="too fast"):
        biarc.fit(rush(2.0 * math.pi, 300.0), np.array([0.0, 1.0]), TOLERANCE)


def test_a_line_that_turns_back_beyond_its_start_is_not_cut_short() -> None:
    def evaluate(t: Array) -> tuple[Array, Array]:
        return np.stack([t * t - 0.02 * t, 0.0 * t], axis=1), np.stack([2.0 * t - 0.02, 0.0 * t], axis=1)

    curve, _ = biarc.fit(evaluate, np.array([0.0, 1.0]), TOLERANCE)
    assert curve.points[:, 0].min() == pytest.approx(-1e-4, abs=1e-6)


def test_a_curve_that_never_becomes_smooth_is_refused() -> None:
    def evaluate(t: Array) -> tuple[Array, Array]:
        wiggle = np.stack([t, np.sin(1e7 * t)], axis=1)
        return wiggle, np.stack([np.ones_like(t), 1e7 * np.cos(1e7 * t)], axis=1)

    with pytest.raises(ValueError, match="more than"):
        biarc.fit(evaluate, np.array([0.0, 1.0]), TOLERANCE)


def test_a_curve_that_runs_to_infinity_is_refused() -> None:
    def evaluate(t: Array) -> tuple[Array, Array]:
        return np.stack([t, np.full_like(t, np.nan)], axis=1), np.stack([np.ones_like(t), t], axis=1)

    with pytest.raises(ValueError, match="infinity"):
        biarc.fit(evaluate, np.array([0.0, 1.0]), TOLERANCE)
