"""Curves that draw the same line."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.drawing.joining import duplicates
from deltacam.errors import DrawingError
from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Curve

MM = 1e-3


def segment(start: tuple[float, float], end: tuple[float, float], bulge: float = 0.0) -> Curve:
    return Curve(MM * np.array([start, end], dtype=float), np.array([bulge]), closed=False)


def find(*shapes: Curve) -> dict[int, int]:
    return duplicates.find(Pack.of(shapes))


def test_lines_and_arcs_are_found_in_either_direction_and_within_a_hundredth_of_a_millimetre() -> None:
    line, arc = segment((0, 0), (10, 3)), segment((0, 0), (10, 3), 0.4)
    near = segment((0.004, 0), (10, 3.005))
    far = segment((0.011, 0), (10, 3))
    assert find(line, arc, curves.reverse(line), near, far, curves.reverse(arc)) == {2: 0, 3: 0, 5: 1}


def test_the_two_halves_of_a_circle_and_the_diagonals_of_a_box_are_no_copies() -> None:
    assert find(segment((0, 0), (10, 0), 1.0), segment((0, 0), (10, 0), -1.0)) == {}
    assert find(segment((0, 0), (10, 10)), segment((10, 0), (0, 10))) == {}


def test_an_arc_and_its_mirror_image_between_the_same_ends_are_no_copies() -> None:
    # Both fill the same box; only their middles differ.
    lens = segment((0, 0), (10, 10), 0.2), segment((0, 0), (10, 10), -0.2)
    assert find(*lens) == {}


def test_copies_of_copies_name_the_first() -> None:
    line = segment((0, 0), (10, 0))
    assert find(*[line] * 5) == {1: 0, 2: 0, 3: 0, 4: 0}
    row = [segment((0, 0.004 * i), (10, 0.004 * i)) for i in range(4)]
    assert find(row[0], row[1], row[1], row[2], row[2]) == {1: 0, 2: 0, 3: 0, 4: 0}


def test_a_line_and_a_polyline_over_it_are_copies_and_an_open_one_is_none_of_a_closed_one() -> None:
    split = Curve(MM * np.array([[0.0, 0.0], [4.0, 0.0], [10.0, 0.0]]), np.zeros(2), closed=False)
    assert find(segment((10, 0), (0, 0)), split) == {1: 0}
    square = MM * np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    assert find(curves.polygon(square), Curve(square, np.zeros(3), closed=False)) == {}


@settings(deadline=None, max_examples=30)
@given(st.lists(st.tuples(st.integers(0, 4), st.integers(0, 4), st.integers(1, 3)), min_size=2, max_size=30))
def test_circles_are_copies_where_centre_and_radius_agree(circles: list[tuple[int, int, int]]) -> None:
    shapes = [
        curves.transform(curves.circle(np.zeros(2), r * MM), rotation=0.3 * i, shift=(x * MM, y * MM))
        for i, (x, y, r) in enumerate(circles)
    ]
    expected = {i: circles.index(circle) for i, circle in enumerate(circles) if circles.index(circle) < i}
    assert find(*shapes) == expected


def test_fifty_thousand_copies_of_a_line_are_no_hang() -> None:
    ends = np.tile([[0.0, 0.0], [1.0, 2.0]], (50_000, 1))
    pack = Pack(ends, np.zeros(100_000), 2 * np.arange(50_001), np.zeros(50_000, dtype=np.bool_))
    assert set(duplicates.find(pack).values()) == {0}


def test_thousands_of_lines_on_about_the_same_spot_are_refused_at_once() -> None:
    shift = 1e-9 * np.arange(8000)
    ends = np.zeros((8000, 2, 2))
    ends[:, 1, 0], ends[:, :, 1] = 1.0, shift[:, None]
    pack = Pack(ends.reshape(-1, 2), np.zeros(16_000), 2 * np.arange(8001), np.zeros(8000, dtype=np.bool_))
    with pytest.raises(DrawingError, match="crowd in one place"):
        duplicates.find(pack)
