"""Where lines and circles meet, against substitution into their equations."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.geometry.element import Element, meeting_point, shifted, turn_between

PLACE = st.tuples(st.floats(-0.1, 0.1), st.floats(-0.1, 0.1)).map(np.array)
LINES = st.builds(Element, anchor=PLACE, heading=st.floats(-3.2, 3.2))
CIRCLES = st.builds(Element, anchor=PLACE, radius=st.floats(1e-4, 0.3) | st.floats(-0.3, -1e-4))


def miss(element: Element, point: np.ndarray) -> float:
    if element.radius == 0.0:
        return abs(float(np.cross(np.append(element.direction, 0), np.append(point - element.anchor, 0))[2]))
    return abs(float(np.hypot(*(point - element.anchor))) - abs(element.radius))


@given(LINES | CIRCLES, LINES | CIRCLES, PLACE)
def test_a_meeting_point_lies_on_both(first: Element, second: Element, about: np.ndarray) -> None:
    point = meeting_point(first, second, about)
    if point is not None:
        assert max(miss(first, point), miss(second, point)) < 1e-7


@given(CIRCLES, PLACE, st.floats(-3.2, 3.2))
def test_a_line_through_the_inside_of_a_circle_meets_it_on_both_sides(
    circle: Element, offset: np.ndarray, heading: float
) -> None:
    inside = circle.anchor + offset / 0.15 * abs(circle.radius)
    line = Element(inside, heading=heading)
    for side in (-1.0, 1.0):
        point = meeting_point(line, circle, inside + side * 2.0 * abs(circle.radius) * line.direction)
        assert point is not None
        assert side * float((point - inside) @ line.direction) > 0.0


@pytest.mark.parametrize("curvature", [1.5e-2, -1.5e-5, 3e-6, 1e-12])
def test_an_arc_that_is_almost_a_line_meets_where_the_line_would(curvature: float) -> None:
    start = np.array([-0.0156, 0.0])
    almost, line = shifted(start, 0.3, curvature, -2.4e-4), shifted(start, 0.3, 0.0, -2.4e-4)
    crossing = Element(np.array([0.0, 0.01]), radius=0.012)
    for about in (np.array([-0.01, 0.0]), np.array([0.01, 0.01])):
        there, found = meeting_point(line, crossing, about), meeting_point(almost, crossing, about)
        assert there is not None
        assert found == pytest.approx(there, abs=2e-3 * abs(curvature) + 1e-9)
        assert miss(crossing, found) < 1e-12


def test_parallel_lines_and_concentric_circles_never_meet() -> None:
    origin = np.zeros(2)
    assert meeting_point(Element(origin, heading=0.5), Element(origin + 1.0, heading=0.5), origin) is None
    assert meeting_point(Element(origin, radius=1.0), Element(origin, radius=2.0), origin) is None
    assert meeting_point(Element(origin, heading=0.0), Element(np.array([0.0, 2.0]), radius=1.0), origin) is None


@pytest.mark.parametrize(
    ("curvature", "shift", "radius"), [(50.0, 1e-3, 0.021), (-50.0, 1e-3, -0.019), (50.0, -0.03, -0.01)]
)
def test_shifting_to_the_right_grows_a_left_turn(curvature: float, shift: float, radius: float) -> None:
    circle = shifted(np.array([0.02, 0.0]), np.pi / 2.0, curvature, shift)
    assert circle.radius == pytest.approx(radius)
    assert circle.anchor == pytest.approx([0.02 - 1.0 / curvature, 0.0])


@given(st.floats(-6.0, 6.0), st.floats(-3.0, 3.0))
def test_the_turn_is_the_one_nearest_to_the_estimate(turn: float, first: float) -> None:
    circle = Element(np.array([0.3, 0.1]), radius=0.02)
    start, end = (circle.anchor + 0.02 * np.array([np.cos(a), np.sin(a)]) for a in (first, first + turn))
    assert turn_between(circle, start, end, turn + 0.5) == pytest.approx(turn, abs=1e-9)
