"""Small repairs of closed curves, and curves that are no contours."""

import math

import numpy as np
import pytest

from deltacam.drawing.joining import tidy
from deltacam.drawing.joining.join import Joined, join
from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Curve, Outcome

MM = 1e-3


def joined(*shapes: Curve) -> Joined:
    return join(Pack.of(shapes), name=lambda i: f"LINE #{i:X}")


def polygon(*corners: tuple[float, float]) -> Curve:
    return curves.polygon(MM * np.array(corners, dtype=float))


def test_a_loop_smaller_than_a_hundredth_of_a_millimetre_is_left_out_with_a_note() -> None:
    result = joined(polygon((0, 0), (10, 0), (10, 10)), curves.circle(np.ones(2), 0.0045 * MM))
    assert [loop.members for loop in result.loops] == [(0,)]
    assert result.notes == {1: (Outcome.IGNORED, "smaller than 0.01 mm overall")}
    (finding,) = result.findings
    assert (finding.kind, finding.where) == ("tiny", "LINE #1")
    assert finding.what == "1 line is shorter than 0.01 mm: left out"
    assert len(joined(curves.circle(np.ones(2), 0.006 * MM)).loops) == 1


def test_a_lone_speck_is_left_out_with_a_note() -> None:
    speck = Curve(MM * np.array([[0.0, 0.0], [0.006, 0.0]]), np.zeros(1), closed=False)
    result = joined(speck)
    assert (result.loops, result.chains) == ([], [])
    assert result.notes[0][0] is Outcome.IGNORED


@pytest.mark.parametrize("size", [0.0003, 0.003, 0.009])
def test_a_fine_polyline_keeps_its_shape_without_a_kink(size: float) -> None:
    count = 1200
    angles = np.linspace(0.0, 2.0 * math.pi, count + 1)
    radius = size * MM * count / (2.0 * math.pi)
    points = radius * np.column_stack([np.cos(angles), np.sin(angles)])
    points[-1] = points[0]
    lines = [Curve(points[i : i + 2], np.zeros(1), closed=False) for i in range(count)]
    result = joined(*lines)
    (loop,) = result.loops
    assert len(loop.members) == count
    assert max(curves.nearest(loop.curve, point)[2] for point in points) <= 1e-6
    # As smooth as a regular polygon of so many corners, give or take the micrometre that a repair may move it.
    corners = len(loop.curve.points)
    assert np.abs(curves.corner_angles(loop.curve)).max() <= 2.5 * 2.0 * math.pi / corners
    assert [finding.what for finding in result.findings] == [
        "1200 lines are shorter than 0.01 mm: kept as part of longer lines"
    ]


def test_a_line_drawn_back_and_forth_is_found_once() -> None:
    there = [(0, 0), (5, 1), (10, 0), (14, 3)]
    line = tidy.halved(polygon(*there, (10, 0), (5, 1)))
    assert line.points.tolist() == (MM * np.array(there)).tolist()
    turned = tidy.halved(polygon((5, 1), (10, 0), (14, 3), (10, 0), (5, 1), (0, 0)))
    assert curves.length(turned) == pytest.approx(curves.length(line))


def test_wide_thin_curves_are_no_slivers() -> None:
    shapes = [
        polygon((0, 0), (100, 0), (100, 0.02), (0, 0.02)),
        polygon((0, 0), (100, 0), (100, 0.008), (0, 0.008)),
        polygon((0, 0), (10, 10), (10, 0), (0, 10)),
        polygon((0, 0), (10, 0)),
    ]
    assert tidy.slivers(Pack.of(shapes)) == [1, 3]


def test_a_scribble_without_much_area_is_no_hang() -> None:
    scribble = Curve(np.random.default_rng(3).uniform(0.0, 1.0, (4000, 2)), np.zeros(4000))
    mirrored = Curve(np.concatenate([scribble.points, scribble.points[::-1] + 1e-3]), np.zeros(8000))
    assert tidy.slivers(Pack.of([mirrored])) == []
