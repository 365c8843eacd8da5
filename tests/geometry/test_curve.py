"""Curves of lines and arcs, against closed forms and against shapely's polygons."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, Point, Polygon

from deltacam.geometry import curve as curves
from deltacam.model import Curve

BULGES = st.one_of(st.just(0.0), st.floats(1e-7, 3.0), st.floats(-3.0, -1e-7))
POINTS = st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3))


@st.composite
def closed_curves(draw: st.DrawFn) -> Curve:
    points = draw(st.lists(POINTS, min_size=2, max_size=8, unique_by=lambda p: (round(p[0], 4), round(p[1], 4))))
    bulges = draw(st.lists(BULGES, min_size=len(points), max_size=len(points)))
    return Curve(points=np.array(points), bulges=np.array(bulges))


def slot() -> Curve:
    """A slot 40 mm long between centres, 10 mm wide, about the origin."""
    points = np.array([[-0.02, -0.005], [0.02, -0.005], [0.02, 0.005], [-0.02, 0.005]])
    return Curve(points=points, bulges=np.array([0.0, 1.0, 0.0, 1.0]))


def test_a_circle_has_its_length_area_bounds_and_curvature() -> None:
    ring = curves.circle(np.array([0.1, -0.2]), 0.03)
    assert curves.length(ring) == pytest.approx(2 * math.pi * 0.03, rel=1e-14)
    assert curves.signed_area(ring) == pytest.approx(math.pi * 0.03**2, rel=1e-12)
    assert curves.bounds(ring) == pytest.approx((0.07, -0.23, 0.13, -0.17), abs=1e-15)
    assert curves.curvatures(ring) == pytest.approx(1 / 0.03)


def test_a_slot_has_its_length_area_and_bounds() -> None:
    assert curves.length(slot()) == pytest.approx(0.08 + math.pi * 0.01, rel=1e-14)
    assert curves.signed_area(slot()) == pytest.approx(0.04 * 0.01 + math.pi * 0.005**2, rel=1e-13)
    assert curves.bounds(slot()) == pytest.approx((-0.025, -0.005, 0.025, 0.005), abs=1e-15)
    assert curves.corner_angles(slot()) == pytest.approx(0.0, abs=1e-12)


@given(closed_curves())
def test_area_and_length_agree_with_the_flattened_polygon(curve: Curve) -> None:
    points, _ = curves.flatten(curve, 1e-7)
    if len(points) >= 3:
        signed = Polygon(points).exterior
        x, y = np.asarray(signed.coords).T
        shoelace = 0.5 * np.sum(x[:-1] * y[1:] - x[1:] * y[:-1])
        assert curves.signed_area(curve) == pytest.approx(shoelace, abs=1e-7 * curves.length(curve) * 1.01)
        assert signed.length == pytest.approx(curves.length(curve), rel=1e-4, abs=1e-9)


@given(closed_curves())
def test_bounds_agree_with_the_flattened_points(curve: Curve) -> None:
    points, _ = curves.flatten(curve, 1e-8)
    flat = (*points.min(axis=0), *points.max(axis=0))
    assert curves.bounds(curve) == pytest.approx(flat, abs=2e-8)


@given(closed_curves())
def test_flattened_points_lie_on_the_curve_and_chords_stay_near(curve: Curve) -> None:
    coarse, segment = curves.flatten(curve, 1e-4)
    fine, _ = curves.flatten(curve, 1e-9) if curves.length(curve) < 0.2 else curves.flatten(curve, 1e-8)
    assert np.all(np.diff(segment) >= 0)
    line = LineString(np.concatenate([coarse, coarse[:1]]))
    assert max(line.distance(Point(p)) for p in fine[:: max(1, len(fine) // 50)]) <= 1e-4 * 1.001


@given(closed_curves())
def test_reversing_changes_only_the_sign(curve: Curve) -> None:
    back = curves.reverse(curve)
    assert curves.signed_area(back) == pytest.approx(-curves.signed_area(curve), rel=1e-9, abs=1e-15)
    assert curves.length(back) == pytest.approx(curves.length(curve))
    assert back.points[0] == pytest.approx(curve.points[0])


@given(closed_curves(), POINTS)
def test_nearest_is_the_distance_that_shapely_measures(curve: Curve, point: tuple[float, float]) -> None:
    points, _ = curves.flatten(curve, 1e-7)
    segment, distance, gap = curves.nearest(curve, np.array(point))
    place, _ = curves.evaluate(curve, np.array([segment]), np.array([distance]))
    assert np.hypot(*(place[0] - point)) == pytest.approx(gap, abs=1e-12)
    flat = LineString(np.concatenate([points, points[:1]])).distance(Point(point))
    assert gap == pytest.approx(flat, abs=1.1e-7)


@given(closed_curves(), st.floats(0.0, 1.0), st.integers(0, 7))
def test_a_new_start_leaves_the_line_as_it_was(curve: Curve, share: float, index: int) -> None:
    segment = index % len(curve.points)
    distance = share * float(curves.lengths(curve)[segment])
    moved = curves.start_at(curve, segment, distance)
    place, _ = curves.evaluate(curve, np.array([segment]), np.array([distance]))
    assert moved.points[0] == pytest.approx(place[0], abs=1e-8)
    assert curves.length(moved) == pytest.approx(curves.length(curve), rel=1e-9)
    assert curves.signed_area(moved) == pytest.approx(curves.signed_area(curve), rel=1e-9, abs=1e-13)


def test_transform_scales_turns_and_shifts() -> None:
    moved = curves.transform(slot(), scale=2.0, rotation=math.pi / 2, shift=(1.0, 0.0))
    assert curves.bounds(moved) == pytest.approx((0.99, -0.05, 1.01, 0.05), abs=1e-12)
    assert curves.signed_area(moved) == pytest.approx(4 * curves.signed_area(slot()))


def test_an_arc_of_no_length_is_one_point() -> None:
    curve = Curve(points=np.array([[0.0, 0.0], [0.0, 0.0], [0.01, 0.0], [0.0, 0.01]]), bulges=np.array([0.5, 0, 0, 0]))
    points, segment = curves.flatten(curve, 1e-6)
    assert points == pytest.approx(curve.points)
    assert segment.tolist() == [0, 1, 2, 3]
