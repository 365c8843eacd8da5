"""Splines of every kind against ezdxf's evaluation."""

from collections.abc import Iterable
from typing import Any

import ezdxf
import numpy as np
import pytest
from ezdxf.math import BSpline, Vec3, fit_points_to_cad_cv, rational_bspline_from_arc
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.drawing.entities import walk
from deltacam.geometry import curve as curves
from deltacam.model import Curve


def read(document: Any) -> walk.Drawn:
    return walk.read(document, 1e-3)


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


@pytest.mark.parametrize("degree", [2, 3])
@pytest.mark.parametrize("centre", [(3, 4), (900, -400)])
def test_a_rational_spline_that_is_a_circle_becomes_arcs_of_its_radius(degree: int, centre: Any) -> None:
    document = ezdxf.new()
    tool = rational_bspline_from_arc(centre, 20, 10, 300)
    document.modelspace().add_spline().apply_construction_tool(elevated(tool) if degree == 3 else tool)
    found = read(document)
    (curve,) = found.curves
    assert len(curve.bulges) == 2
    assert curves.curvatures(curve) == pytest.approx(50.0, rel=1e-12)
    assert curve.points[-1] == pytest.approx(1e-3 * np.array(tool.point(tool.max_t).vec2), abs=1e-15)
    assert found.entities[0].error < 1e-13


def elevated(tool: BSpline) -> BSpline:
    """The same quadratic curve, of which every knot is double, as a cubic one."""
    weights = np.array(tool.weights())
    points = np.column_stack([np.array([point.xyz for point in tool.control_points]) * weights[:, None], weights])
    raised = [points[0]]
    for start, middle, end in zip(points[:-2:2], points[1::2], points[2::2], strict=True):
        raised += [(start + 2 * middle) / 3, (2 * middle + end) / 3, end]
    knots = np.unique(tool.knots())
    found = np.array(raised)
    return BSpline(
        found[:, :3] / found[:, 3:], 4, [knots[0], *np.repeat(knots, 3), knots[-1]], weights=found[:, 3].tolist()
    )


POINTS = [(0.0, 0.0), (4.0, 9.0), (9.0, -3.0), (14.0, 4.0), (15.0, 5.0), (20.0, 3.0)]
KNOTS = [0.0, 0, 0, 0, 1, 2, 3, 3, 3, 3]


def written(points: Any, knots: Any, weights: Any = (), flags: int = 0, degree: int = 3) -> Any:
    """A document with one spline as a file may write it."""
    document = ezdxf.new()
    spline = document.modelspace().add_spline(degree=degree)
    spline.control_points, spline.knots, spline.weights = points, knots, weights
    spline.dxf.flags = flags
    return document


SAME = {
    "marked as closed": {"flags": 11},
    "other range": {"knots": [100 + 7 * knot for knot in KNOTS]},
    "without the outer knots": {"knots": KNOTS[1:-1]},
    "outer knots anywhere": {"knots": [-5.0, *KNOTS[1:-1], 99.0]},
    "knots rounded": {"knots": [0, 0, 1e-10, 0, 1.0, 2.0, 3, 3 - 1e-10, 3, 3]},
    "equal weights": {"weights": [2.5] * 6},
}


@pytest.mark.parametrize("changes", SAME.values(), ids=SAME)
def test_ways_of_writing_the_same_spline_give_the_same_curve(changes: Any) -> None:
    curve = only(written(**{"points": POINTS, "knots": KNOTS, **changes}))
    tool = BSpline(POINTS, 4, KNOTS)
    assert farthest(curve, tool.points(np.linspace(0, 3, 200))) < 1e-6
    assert len(curve.bulges) == len(only(written(POINTS, KNOTS)).bulges)


@pytest.mark.parametrize("wrapped", [True, False])
def test_a_periodic_spline_is_closed_with_its_first_points_repeated_or_not(wrapped: bool) -> None:
    knots = [0.0, 1, 3, 4, 5, 6, 8, 9, 11, 12, 13, 14, 16]  # the steps repeat after six
    around = [*POINTS, *POINTS[:3]]
    curve = only(written(around if wrapped else POINTS, knots, flags=11))
    assert farthest(curve, BSpline(around, 4, knots).points(np.linspace(4, 12, 200))) < 1e-6
    assert curve.points[0] == pytest.approx(curve.points[-1], abs=1e-12)


LOST = {
    "a knot too many": {"knots": [0, 0, 0, 0, 1, 1.5, 2, 3, 3, 3, 3]},
    "a knot too few": {"knots": [0, 0, 0, 0, 1, 3, 3, 3, 3]},
    "two knots too few": {"knots": [0, 0, 0, 1, 2, 3, 3, 4]},
    "not marked as periodic": {"knots": list(range(13))},
    "steps that do not repeat": {"knots": [0.0, 1, 3, 4, 5, 6, 8, 9, 11, 12, 13, 15, 16], "flags": 11},
    "falling": {"knots": [0, 0, 0, 0, 2, 1, 3, 3, 3, 3]},
    "all knots equal": {"knots": [1] * 10},
    "a weight missing": {"weights": [1.0] * 5},
    "a weight below zero": {"weights": [1, 1, -1, 1, 1, 1]},
    "nan": {"points": [*POINTS[:5], (np.nan, 1.0)]},
    "infinite knot": {"knots": [0, 0, 0, 0, 1, 2, np.inf, np.inf, np.inf, np.inf]},
    "too few points": {"points": POINTS[:3], "knots": [0, 0, 0, 1, 1, 1, 1]},
    "torn apart": {"points": POINTS[:5] + POINTS[:3], "knots": [0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2]},
    "degree": {"degree": 40},
}


@pytest.mark.parametrize("changes", LOST.values(), ids=LOST)
def test_a_spline_that_could_mean_another_curve_is_lost(changes: Any) -> None:
    spline: dict[str, Any] = {"points": POINTS, "knots": KNOTS, **changes}
    spline["points"] = [(*point[:2], 0.0) for point in spline["points"]]
    found = read(written(**spline))
    assert found.entities[0].lost
    assert not len(found.curves)
    assert [finding.kind for finding in found.findings] == ["lost"]


FIT = [(0, 0, 0), (10, 5, 0), (20, -5, 0), (30, 0, 0), (31, 8, 0)]


@pytest.mark.parametrize("tangents", [None, [(1, 1, 0), (0, -1, 0)]])
@pytest.mark.parametrize("count", [3, 5])
def test_a_spline_of_fit_points_is_what_cad_programs_draw_and_says_so(tangents: Any, count: int) -> None:
    document = ezdxf.new()
    spline = document.modelspace().add_spline([FIT[0], *FIT[:count]])
    if tangents:
        spline.dxf.start_tangent, spline.dxf.end_tangent = tangents
    found = read(document)
    tool = fit_points_to_cad_cv(FIT[:count], tangents)
    assert farthest(found.curves[0], tool.approximate(200)) < 1e-6
    assert [(finding.kind, finding.blocks) for finding in found.findings] == [("fit_points", False)]


@pytest.mark.parametrize("repeated", [True, False])
def test_a_closed_spline_of_fit_points_is_smooth_all_around(repeated: bool) -> None:
    document = ezdxf.new()
    document.modelspace().add_spline([*FIT, FIT[0]] if repeated else FIT).closed = True
    curve = only(document)
    assert farthest(curve, FIT) < 1e-9
    start, end = curves.headings(curve)
    assert curve.points[0] == pytest.approx(curve.points[-1], abs=1e-12)
    assert np.cos(start[0] - end[-1]) == pytest.approx(1.0, abs=1e-6)


def test_a_spline_of_one_place_has_length_zero() -> None:
    document = written([(1, 2, 0)] * 4, [0, 0, 0, 0, 1, 1, 1, 1])
    document.modelspace().add_spline([(5, 5), (5, 5)])
    document.modelspace().add_spline()
    reasons = [entity.reason for entity in read(document).entities]
    assert reasons == ["a SPLINE of length zero", "a SPLINE of length zero", "a spline without points"]
