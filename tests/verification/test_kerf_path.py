"""The reference kerf path, against the distance from the exact contour."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from shapely import Polygon

from deltacam.geometry import curve as curves
from deltacam.model import Contour, Curve, Operation
from deltacam.verification.kerf_path import ACCURACY, rings, sharp_corners


def contour(curve: Curve, depth: int) -> Contour:
    return Contour(1, curve, "CUT", ("1A",), depth, None)


@st.composite
def gears(draw: st.DrawFn) -> Curve:
    """Closed counter-clockwise contours of lines and arcs about the origin that do not cross themselves."""
    corners = draw(st.integers(5, 12))
    radii = draw(st.lists(st.floats(8e-3, 14e-3), min_size=corners, max_size=corners))
    bulges = draw(st.lists(st.floats(-0.15, 0.3), min_size=corners, max_size=corners))
    angles = np.arange(corners) * 2 * np.pi / corners
    points = np.array(radii)[:, np.newaxis] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return Curve(points=points, bulges=np.array(bulges))


@settings(deadline=None)
@given(curve=gears(), depth=st.integers(0, 3), kerf=st.floats(1e-5, 2e-3))
def test_every_point_of_the_path_is_half_a_kerf_from_the_contour_on_the_right_side(
    curve: Curve, depth: int, kerf: float
) -> None:
    fine, _ = curves.flatten(curve, 1e-8)
    inside = Polygon(fine)
    if not inside.is_valid:
        return
    found = rings(contour(curve, depth), kerf)
    assert found
    for ring in found:
        middles = (ring + np.roll(ring, -1, axis=0)) / 2
        points = np.concatenate([ring, middles])[:: max(1, len(ring) // 25)]
        for point in points:
            _, _, distance = curves.nearest(curve, point)
            assert distance == pytest.approx(kerf / 2, abs=ACCURACY)
        polygon = Polygon(ring)
        assert (polygon.area > inside.area) == (depth % 2 == 0)


@pytest.mark.parametrize("radius", [0.3e-3, 5e-3, 0.2])
@pytest.mark.parametrize("depth", [0, 1])
def test_a_circle_becomes_a_circle(radius: float, depth: int) -> None:
    (ring,) = rings(contour(curves.circle(np.array([0.05, -0.02]), radius), depth), 0.2e-3)
    expected = radius + (0.1e-3 if depth == 0 else -0.1e-3)
    off = np.hypot(*(ring - (0.05, -0.02)).T) - expected
    assert np.abs(off).max() <= ACCURACY


def test_without_a_kerf_the_path_is_the_contour() -> None:
    (ring,) = rings(contour(curves.polygon(np.array([(0, 0), (1, 0), (1, 1)]) * 1e-2), 0), 0.0)
    assert ring.tolist() == [[0.0, 0.0], [0.01, 0.0], [0.01, 0.01]]


def test_a_swallowed_hole_has_no_path() -> None:
    assert rings(contour(curves.circle(np.zeros(2), 1e-3), 1), 2.1e-3) == ()


def test_a_contour_that_crosses_itself_has_no_path_that_could_be_trusted() -> None:
    bow_tie = curves.polygon(np.array([(0, 0), (1, 1), (1, 0), (0, 1)]) * 1e-2)
    assert rings(contour(bow_tie, 0), 0.2e-3) == ()


def test_a_bay_that_the_kerf_closes_leaves_two_rings() -> None:
    chamber = [(5.05, 10), (5.05, 9), (7, 9), (7, 2), (3, 2), (3, 9), (4.95, 9), (4.95, 10)]
    points = np.array([(0, 0), (10, 0), (10, 10), *chamber, (0, 10)]) * 1e-3
    assert len(rings(contour(curves.polygon(points), 0), 0.2e-3)) == 2


def test_sharp_corners_are_those_of_the_polygon() -> None:
    line = np.array([(0.0, 0.0), (1.0, 0.0), (2.0, 0.1), (2.0, 1.0), (0.0, 1.0)])
    corners, turns = sharp_corners(line, closed=True)
    assert corners.tolist() == [[0.0, 0.0], [2.0, 0.1], [2.0, 1.0], [0.0, 1.0]]
    assert turns == pytest.approx([np.pi / 2, np.pi / 2 - np.arctan(0.1), np.pi / 2, np.pi / 2])
    corners, turns = sharp_corners(line, closed=False)
    assert corners.tolist() == [[2.0, 0.1], [2.0, 1.0]]
    assert turns == pytest.approx([np.pi / 2 - np.arctan(0.1), np.pi / 2])


@pytest.mark.parametrize(("closed", "operation"), [(True, "engrave"), (False, "engrave"), (False, "cut")])
def test_what_is_engraved_or_open_is_followed_on_the_line_itself(closed: bool, operation: str) -> None:
    corners = np.array([(0.0, 0.0), (1.0, 0.0), (1.0, 1.0)]) * 1e-2
    line = Curve(points=corners, bulges=np.zeros(3 if closed else 2), closed=closed)
    drawn = replace(contour(line, 0), operation=Operation(operation))
    assert [ring.tolist() for ring in rings(drawn, 0.2e-3)] == [corners.tolist()]
