"""Corners, against distances measured by shapely."""

import itertools
import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.model import Curve
from deltacam.motion.corners import pieces
from tests.strategies import rectangle, slot, star_curves

DEVIATION = 17e-6


def flat(curve: Curve) -> np.ndarray:
    points, _ = curves.flatten(curve, 1e-8)
    return np.concatenate([points, points[:1]]) if curve.closed else points


def worst_kink(curve: Curve) -> float:
    return float(np.abs(curves.corner_angles(curve)).max(initial=0.0))


@settings(max_examples=150)
@given(star_curves(low=1e-3, high=40e-3), st.floats(1e-6, 1e-4))
def test_rounded_corners_leave_a_tangent_path_within_the_deviation(curve: Curve, deviation: float) -> None:
    assume(curves.lengths(curve).min() > 1e-5)
    parts = pieces(curve, corner="round", deviation=deviation)
    drawn = shapely.LineString(flat(curve))
    driven = np.concatenate([flat(part) for part in parts])
    assert shapely.distance(shapely.points(driven), drawn).max() <= deviation + 2e-8
    assert shapely.distance(shapely.points(flat(curve)), shapely.LineString(driven)).max() <= deviation + 2e-8
    assert max(worst_kink(part) for part in parts) < 1e-5
    assert driven[0] == pytest.approx(curve.points[0])
    assert driven[-1] == pytest.approx(curve.points[0])


@pytest.mark.parametrize("seed", range(40))
def test_polygons_of_every_angle_and_size_become_drivable(seed: int) -> None:
    rng = np.random.default_rng(seed)
    turns = np.radians(rng.uniform(1.0, 179.0, 25)) * rng.choice([-1.0, 1.0], 25)
    edges = 10.0 ** rng.uniform(np.log10(5e-5), -1.0, 25)
    heading = np.cumsum(turns)
    points = np.cumsum(edges[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=1), axis=0)
    parts = pieces(curves.polygon(points), corner="round", deviation=DEVIATION)
    assert sum(curves.length(part) for part in parts) <= edges.sum() + float(np.hypot(*(points[-1] - points[0])))
    assert all(worst_kink(part) < 1e-5 and curves.lengths(part).min() > 0.0 for part in parts)
    for before, after in itertools.pairwise(parts):
        assert before.points[-1] == pytest.approx(after.points[0], abs=1e-12)


def test_a_right_angle_gets_the_largest_arc_that_the_deviation_allows() -> None:
    square = curves.start_at(rectangle(0.06, 0.04), 0, 0.03)
    (part,) = pieces(square, corner="round", deviation=DEVIATION)
    radius = 1.0 / np.abs(curves.curvatures(part)).max()
    assert radius == pytest.approx(DEVIATION / (math.sqrt(2.0) - 1.0), rel=1e-6)
    assert np.count_nonzero(part.bulges) == 4


def test_stopping_keeps_the_corner_and_ends_a_piece_there() -> None:
    square = curves.start_at(rectangle(0.06, 0.04), 0, 0.03)
    parts = pieces(square, corner="stop", deviation=DEVIATION)
    assert [part.points.tolist() for part in parts][1:4] == [
        [[0.06, 0.0], [0.06, 0.04]],
        [[0.06, 0.04], [0.0, 0.04]],
        [[0.0, 0.04], [0.0, 0.0]],
    ]


def test_stopping_passes_what_is_no_corner() -> None:
    polygon = curves.polygon(np.array([[np.cos(a), np.sin(a)] for a in np.radians(np.arange(360))]) * 0.03)
    assert len(pieces(polygon, corner="stop", deviation=DEVIATION)) == 1
    assert len(pieces(slot(0.04, 0.01), corner="stop", deviation=DEVIATION)) == 1


def test_a_path_that_turns_back_on_itself_stops_there() -> None:
    spike = curves.polygon(np.array([[0.0, 0.0], [0.02, 0.0], [0.0, 1e-9], [-0.01, 0.01]]))
    assert len(pieces(spike, corner="round", deviation=DEVIATION)) == 3  # it turns back at two corners


def test_no_deviation_means_a_stop_at_every_corner() -> None:
    assert len(pieces(rectangle(0.06, 0.04), corner="round", deviation=0.0)) == 4


def test_slivers_are_left_out() -> None:
    points = np.array([[0.0, 0.0], [0.03, 0.0], [0.03, 2e-7], [0.03, 0.03], [0.0, 0.03], [-3e-7, 1e-7]])
    (part,) = pieces(curves.polygon(points), corner="round", deviation=DEVIATION)
    assert curves.lengths(part).min() > 1e-5
    assert len(part.points) == 8


@pytest.mark.parametrize("kink", [1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1.74e-3, 1e-2])
@pytest.mark.parametrize("radius", [0.075e-3, 0.0088, 0.2])
@pytest.mark.parametrize("turn", [-1.5, 1.5])
def test_a_line_that_almost_touches_an_arc_is_no_stop(kink: float, radius: float, turn: float) -> None:
    bend = curves.advance(np.zeros((1, 2)), np.zeros(1), np.array([np.sign(turn) / radius]), np.array([1.5 * radius]))
    for side in (-1.0, 1.0):
        heading = float(bend[1][0]) + side * kink
        end = bend[0][0] + 0.13 * np.array([np.cos(heading), np.sin(heading)])
        points = np.array([[-0.1, 0.0], [0.0, 0.0], bend[0][0], end])
        curve = Curve(points=points, bulges=np.array([0.0, np.tan(turn / 4.0), 0.0, 0.0]))
        parts = pieces(curve, corner="stop", deviation=DEVIATION)
        assert parts[0].points[-1] == pytest.approx(end)  # the first stop is the sharp corner after the second line
        assert worst_kink(parts[0]) < 1e-5
        assert np.abs(curves.curvatures(parts[0])).max() < 1.3 / radius


@settings(max_examples=100)
@given(star_curves(low=1e-3, high=40e-3), st.floats(1e-6, 1e-4))
def test_an_open_line_is_driven_from_end_to_end(closed: Curve, deviation: float) -> None:
    curve = Curve(points=closed.points, bulges=closed.bulges[:-1], closed=False)
    assume(curves.lengths(curve).min() > 1e-5)
    parts = pieces(curve, corner="round", deviation=deviation)
    driven = np.concatenate([flat(part) for part in parts])
    assert shapely.distance(shapely.points(driven), shapely.LineString(flat(curve))).max() <= deviation + 2e-8
    assert shapely.distance(shapely.points(flat(curve)), shapely.LineString(driven)).max() <= deviation + 2e-8
    assert max(worst_kink(part) for part in parts) < 1e-5
    assert driven[[0, -1]] == pytest.approx(curve.points[[0, -1]])
    stopped = pieces(curve, corner="stop", deviation=deviation)
    assert len(stopped) <= len(curve.points) - 1
    assert sum(curves.length(part) for part in stopped) == pytest.approx(curves.length(curve), rel=1e-3)


@pytest.mark.parametrize("sliver", [0, 1, 2])
def test_slivers_of_an_open_line_are_left_out_but_not_its_ends(sliver: int) -> None:
    x = np.insert([0.0, 0.01, 0.02], sliver + 1, [0.0, 0.01, 0.02][sliver] + 2e-7)
    curve = Curve(points=np.column_stack([np.sort(x), np.zeros(4)]), bulges=np.zeros(3), closed=False)
    (part,) = pieces(curve, corner="stop", deviation=DEVIATION)
    assert part.points[[0, -1], 0] == pytest.approx(curve.points[[0, -1], 0], abs=1e-12)
    assert curves.lengths(part).min() > 1e-3


def test_a_line_of_one_segment_stays_as_it_is() -> None:
    curve = Curve(points=np.array([[0.0, 0.0], [0.01, 0.0]]), bulges=np.array([0.4]), closed=False)
    (part,) = pieces(curve, corner="round", deviation=DEVIATION)
    assert part.points == pytest.approx(curve.points)
    assert part.bulges == pytest.approx(curve.bulges)
