"""The odd ways in which files write single entities, against closed forms."""

import math
from typing import Any

import ezdxf
import numpy as np
import pytest
from ezdxf.math import Vec3

from deltacam.drawing.entities import kinds, walk
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve


def only(document: Any) -> Curve:
    (curve,) = walk.read(document, 1.0).curves
    return curve


def farthest(curve: Curve, points: Array) -> float:
    """The largest distance of the points (N, 2) from the curve, m."""
    return max(curves.nearest(curve, point)[2] for point in points)


def around(t: Array) -> Array:
    return np.stack([np.cos(t), np.sin(t)], axis=1)


@pytest.mark.parametrize(("start", "end", "span"), [(350, 20, 30), (-10, 20, 30), (20, 350, 330), (710, 740, 30)])
def test_an_arc_runs_counter_clockwise_across_zero(start: float, end: float, span: float) -> None:
    document = ezdxf.new()
    document.modelspace().add_arc((1, 2), 0.5, start, end)
    curve = only(document)
    exact = [1, 2] + 0.5 * around(np.radians(start + np.linspace(0, span, 50)))
    assert farthest(curve, exact) < 1e-12
    assert curves.length(curve) == pytest.approx(0.5 * math.radians(span), rel=1e-12)
    assert curve.points[[0, -1]] == pytest.approx(exact[[0, -1]], abs=1e-12)


@pytest.mark.parametrize(("start", "end"), [(0, 360), (90, 450), (12.5, 372.5)])
def test_an_arc_of_a_whole_turn_is_a_circle(start: float, end: float) -> None:
    document = ezdxf.new()
    document.modelspace().add_arc((0, 0), 0.5, 0, 1).dxf.__dict__.update(start_angle=start, end_angle=end)
    curve = only(document)
    assert curve.closed
    assert curves.signed_area(curve) == pytest.approx(math.pi / 4, rel=1e-12)


@pytest.mark.parametrize("ratio", [1e-10, 1e-3, 0.5, 1.0, 3.0, -0.5, -1.0])
@pytest.mark.parametrize(("start", "end", "span"), [(0.0, 2 * math.pi, 2 * math.pi), (5.0, 1.0, 2 * math.pi - 4.0)])
def test_an_ellipse_of_any_ratio_runs_from_its_first_to_its_last_parameter(
    ratio: float, start: float, end: float, span: float
) -> None:
    document = ezdxf.new()
    raw = document.modelspace().add_ellipse((0.1, 0.2), (0.03, 0.01), 0.5)
    raw.dxf.__dict__.update(ratio=ratio, start_param=start, end_param=end)
    curve = only(document)
    t = start + np.linspace(0, span, 300)
    exact = [0.1, 0.2] + around(t) @ np.array([(0.03, 0.01), (-0.01 * ratio, 0.03 * ratio)])
    assert farthest(curve, exact) < 1e-6
    assert curve.points[0] == pytest.approx(exact[0], abs=1e-12)
    if abs(ratio) == 1.0:  # a circle
        assert len(curve.bulges) <= 2


def test_an_ellipse_without_parameters_is_whole() -> None:
    document = ezdxf.new()
    raw = document.modelspace().add_ellipse((0, 0), (0.03, 0), 1.0, 1, 2)
    raw.dxf.discard("start_param")
    raw.dxf.discard("end_param")
    assert only(document).closed


def test_the_minor_axis_is_upright_on_the_major_one_also_where_the_normal_is_not() -> None:
    document = ezdxf.new()
    raw = document.modelspace().add_ellipse((0, 0), (0.03, 0), 1.0)
    raw.dxf.__dict__["extrusion"] = Vec3(0.6, 0, 0.8)
    assert curves.signed_area(only(document)) == pytest.approx(math.pi * 0.03**2, rel=1e-12)


def test_a_circle_that_is_turned_and_then_squeezed_is_an_ellipse() -> None:
    document = ezdxf.new()
    document.blocks.new("A").add_circle((0, 0), 0.02)
    document.blocks.new("B").add_blockref("A", (0, 0), {"rotation": 45})
    document.modelspace().add_blockref("B", (0, 0), {"xscale": 2})
    exact = around(np.linspace(0, 2 * math.pi, 200)) * [0.04, 0.02]
    assert farthest(only(document), exact) < 1e-6


def test_a_circle_that_is_squeezed_and_stretched_again_is_exact() -> None:
    document = ezdxf.new()
    document.blocks.new("A").add_circle((1, 1), 0.02)
    document.blocks.new("B").add_blockref("A", (0, 0), {"xscale": 2})
    document.modelspace().add_blockref("B", (0, 0), {"yscale": -2})
    curve = only(document)
    assert curves.bounds(curve) == pytest.approx((1.96, -2.04, 2.04, -1.96), abs=1e-12)
    assert len(curve.bulges) == 2


@pytest.mark.parametrize("light", [True, False])
def test_repeated_vertices_are_one_and_the_closing_segment_keeps_its_bulge(light: bool) -> None:
    document = ezdxf.new()
    msp = document.modelspace()
    vertices = [(0, 0, 0.3), (0, 0, 0), (4, 0, 0), (4, 0, 0.0), (4, 3, 1), (0, 0, 0)]
    draw = msp.add_lwpolyline if light else msp.add_polyline2d
    draw(vertices, format="xyb", close=True)
    curve = only(document)
    assert curve.closed
    assert curve.points.tolist() == [[0, 0], [4, 0], [4, 3]]
    assert curve.bulges.tolist() == [0, 0, 1]


@pytest.mark.parametrize("bulge", [1.5, -4.0])
def test_an_arc_of_more_than_half_a_turn_is_two_of_less(bulge: float) -> None:
    document = ezdxf.new()
    document.modelspace().add_lwpolyline([(0, 0, bulge), (1, 0, 0), (3, 3, 0)], format="xyb")
    curve = only(document)
    assert np.abs(curve.bulges).max() < 1.0
    radius = (1 + bulge**2) / (4 * abs(bulge))
    assert np.abs(curves.curvatures(curve)[:2]) == pytest.approx(1 / radius, rel=1e-12)
    assert curves.turns(curve)[:2].sum() == pytest.approx(4 * math.atan(bulge), rel=1e-12)


@pytest.mark.parametrize("closed", [True, False])
def test_a_polyline_in_space_has_no_arcs(closed: bool) -> None:
    document = ezdxf.new()
    raw = document.modelspace().add_polyline3d([(0, 0, 1), (1, 0, 1), (1, 1, 1)], close=closed)
    raw.vertices[0].dxf.bulge = 1
    curve = only(document)
    assert curve.closed == closed
    assert not curve.bulges.any()


def test_what_is_not_a_line_says_why() -> None:
    document = ezdxf.new()
    msp = document.modelspace()
    msp.add_text("a")
    msp.add_point((0, 0))
    msp.add_polymesh((2, 2))
    msp.add_lwpolyline([(1, 1), (1, 1)])
    msp.add_circle((0, 0), 1, dxfattribs={"invisible": 1})
    reasons = [entity.reason for entity in walk.read(document, 1.0).entities]
    assert reasons == [
        "text is never cut",
        "a point is not a line",
        "a mesh in space",
        "a LWPOLYLINE of length zero",
        "marked as invisible",
    ]
    assert kinds.why_not("AEC_WALL") == "an object that only the program that made it can draw"
