"""Splines of every kind against ezdxf's evaluation."""

from collections.abc import Iterable
from typing import Any

import ezdxf
import numpy as np
import pytest
from ezdxf.math import BSpline, Vec3, rational_bspline_from_arc
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.drawing import entities
from deltacam.geometry import curve as curves
from deltacam.model import Curve


def read(document: Any) -> entities.Drawn:
    return entities.read(document, 1e-3)


def only(document: Any) -> Curve:
    (drawn,) = read(document).curves
    return drawn


def farthest(curve: Curve, points: Iterable[Any]) -> float:
    """The largest distance of the points, mm, from the curve, m."""
    return max(curves.nearest(curve, 1e-3 * np.array(Vec3(point).vec2))[2] for point in points)


@settings(deadline=None, max_examples=30)
@given(
    st.integers(2, 5),
    st.lists(st.tuples(st.floats(-50, 50), st.floats(-50, 50)), min_size=6, max_size=9, unique=True),
    st.lists(st.floats(0.2, 5.0), min_size=9, max_size=9),
    st.sampled_from(["clamped", "unclamped", "corner", "rational"]),
)
def test_a_spline_is_followed_within_a_micrometre(degree: int, points: list[Any], weights: Any, kind: str) -> None:
    count = len(points)
    inner = np.arange(1.0, count - degree)
    knots = np.concatenate([np.zeros(degree + 1), inner, np.full(degree + 1, count - degree)])
    if kind == "unclamped":
        knots = np.arange(count + degree + 1.0)
    if kind == "corner" and len(inner) >= degree:
        knots[degree + 1 : degree + 1 + degree] = knots[degree + 1]
        knots = np.maximum.accumulate(knots)
    tool = BSpline(points, degree + 1, knots, weights[:count] if kind == "rational" else None)
    document = ezdxf.new()
    document.modelspace().add_spline().apply_construction_tool(tool)
    t = np.linspace(knots[degree], knots[count], 211)
    found = read(document)
    (entity,), (curve,) = found.entities, found.curves
    assert farthest(curve, tool.points(t)) < 1e-6
    assert entity.error < 1e-6


def test_a_spline_of_straight_edges_keeps_its_corners_exactly() -> None:
    document = ezdxf.new()
    corners = [(0, 0), (10, 0), (10, 7), (3, 9)]
    tool = BSpline(corners, 2, [0, 0, 1, 2, 3, 3])
    document.modelspace().add_spline().apply_construction_tool(tool)
    assert only(document).points == pytest.approx(1e-3 * np.array(corners), abs=1e-15)
    cubic = [(0, 0), (3, 0), (7, 0), (10, 0), (10, 2), (10, 5), (10, 7)]
    tool = BSpline(cubic, 4, [0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2])
    document = ezdxf.new()
    document.modelspace().add_spline().apply_construction_tool(tool)
    assert only(document).points == pytest.approx(1e-3 * np.array([(0, 0), (10, 0), (10, 7)]), abs=1e-12)


def test_a_rational_spline_that_is_a_circle_becomes_arcs_of_its_radius() -> None:
    document = ezdxf.new()
    tool = rational_bspline_from_arc((3, 4), 20, 10, 300)
    document.modelspace().add_spline().apply_construction_tool(tool)
    curve = only(document)
    assert len(curve.bulges) == 2
    assert curves.curvatures(curve) == pytest.approx(50.0, rel=1e-6)


def test_a_spline_of_fit_points_runs_through_them() -> None:
    document = ezdxf.new()
    places = [(0, 0, 0), (10, 5, 0), (20, -5, 0), (30, 0, 0)]
    document.modelspace().add_spline(places)
    assert farthest(only(document), places) < 1e-6
