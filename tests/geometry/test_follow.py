"""Lines and arcs along places in order."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, Point

from deltacam.geometry.follow import MAX_BULGE, MAX_RADIUS, follow

TOLERANCE = 2e-6


def ends(places: np.ndarray) -> np.ndarray:
    return np.array([0, len(places) - 1])


def arc(radius: float, turn: float, count: int, start: float = 0.3) -> np.ndarray:
    angles = start + np.linspace(0.0, turn, count)
    return radius * np.column_stack([np.cos(angles), np.sin(angles)])


def drawn(start: np.ndarray, end: np.ndarray, bulge: float) -> LineString:
    """The piece as many short chords, built from its centre: another route than that of the fit."""
    if bulge == 0.0:
        return LineString([start, end])
    chord = end - start
    turn = 4.0 * np.arctan(bulge)
    centre = start + 0.5 * chord + 0.5 / np.tan(0.5 * turn) * np.array([-chord[1], chord[0]])
    angles = np.linspace(0.0, turn, 4001)
    x, y = start - centre
    cos, sin = np.cos(angles), np.sin(angles)
    return LineString(np.column_stack([x * cos - y * sin, x * sin + y * cos]) + centre)


def test_evenly_spaced_places_on_a_line_are_one_line() -> None:
    places = np.outer(np.linspace(0.0, 1.0, 1000), [0.3, -0.2])
    knots, bulges = follow(places, ends(places), TOLERANCE)
    assert knots.tolist() == [0, 999]
    assert bulges.tolist() == [0.0]


@pytest.mark.parametrize("turn", [2.0, -2.0, 0.4])
def test_places_on_an_arc_are_one_arc_however_they_are_spaced(turn: float) -> None:
    angles = turn * np.linspace(0.0, 1.0, 300) ** 3
    places = 0.05 * np.column_stack([np.cos(angles), np.sin(angles)])
    knots, bulges = follow(places, ends(places), 1e-9)
    assert len(knots) == 2
    assert bulges[0] == pytest.approx(np.tan(turn / 4), rel=1e-6)


def test_a_whole_circle_is_a_few_arcs_that_turn_less_than_half() -> None:
    places = arc(0.01, 2.0 * np.pi, 500)
    _, bulges = follow(places, ends(places), TOLERANCE)
    assert len(bulges) <= 4
    assert (bulges > 0.0).all()
    assert (bulges <= MAX_BULGE).all()


def test_a_line_that_runs_into_an_arc_is_cut_near_where_it_does() -> None:
    straight = np.column_stack([np.full(333, 0.02), np.linspace(-0.1, 0.0, 333)])
    places = np.concatenate([straight, arc(0.02, 1.5, 200, start=0.0)[1:]])
    knots, bulges = follow(places, ends(places), 1e-8)
    assert len(bulges) <= 12
    assert bulges[0] == 0.0
    assert abs(knots[1] - 332) <= 3
    assert np.tan(1.5 / 4) * 0.8 <= bulges.max() <= np.tan(1.5 / 4)


def test_a_piece_ends_at_every_break() -> None:
    places = np.outer(np.linspace(0.0, 1.0, 100), [1.0, 0.0])
    knots, _ = follow(places, np.array([0, 7, 8, 63, 99]), TOLERANCE)
    assert knots.tolist() == [0, 7, 8, 63, 99]


def test_there_and_back_on_one_line_are_two_pieces() -> None:
    there = np.outer(np.linspace(0.0, 0.1, 51), [1.0, 0.0])
    places = np.concatenate([there, there[-2::-1]])
    knots, _ = follow(places, ends(places), TOLERANCE)
    assert 50 in knots


def test_back_and_forth_between_the_ends_of_a_line_is_not_that_line() -> None:
    places = np.outer([0.0, 0.06, 0.03, 0.1], [1.0, 0.0])
    knots, _ = follow(places, ends(places), TOLERANCE)
    assert knots.tolist() == [0, 1, 2, 3]


@pytest.mark.parametrize("bend", [0.4, 0.5 * np.pi])
def test_a_corner_of_three_places_is_no_arc(bend: float) -> None:
    places = 0.01 * np.array([[0.0, 0.0], [1.0, 0.0], [1.0 + np.cos(bend), np.sin(bend)]])
    knots, bulges = follow(places, ends(places), TOLERANCE)
    assert (knots.tolist(), bulges.tolist()) == ([0, 1, 2], [0.0, 0.0])


@pytest.mark.parametrize(("turn", "count"), [(2.0 * np.pi, 9), (2.1, 4)])
def test_the_corners_of_a_polygon_are_on_no_arc(turn: float, count: int) -> None:
    places = arc(0.01, turn, count)
    _, bulges = follow(places, ends(places), TOLERANCE)
    assert bulges.tolist() == [0.0] * (count - 1)


def test_very_flat_arcs_become_lines() -> None:
    places = arc(5.0 * MAX_RADIUS, 0.02, 2000)
    knots, bulges = follow(places, ends(places), TOLERANCE)
    assert (bulges == 0.0).all()
    assert len(knots) < 80


def test_rest_is_part_of_a_piece() -> None:
    line = np.outer(np.linspace(0.0, 0.1, 51), [1.0, 0.0])
    places = np.concatenate([line[:20], np.repeat(line[20:21], 40, axis=0), line[21:]])
    knots, _ = follow(places, ends(places), TOLERANCE)
    assert len(knots) == 2


@given(
    st.lists(st.tuples(st.floats(-0.5, 0.5), st.floats(1e-4, 2e-3), st.integers(1, 40)), min_size=1, max_size=6),
    st.sampled_from([1e-7, 2e-6, 1e-4]),
)
def test_every_place_is_within_the_tolerance_of_its_piece_and_passed_in_order(
    parts: list[tuple[float, float, int]], tolerance: float
) -> None:
    heading = np.cumsum(np.concatenate([[0.0], *(np.full(count, bend) for bend, _, count in parts)]))
    step = np.concatenate([[0.0], *(np.full(count, size) for _, size, count in parts)])
    places = np.cumsum(step[:, None] * np.column_stack([np.cos(heading), np.sin(heading)]), axis=0)
    knots, bulges = follow(places, ends(places), tolerance)
    assert (knots[0], knots[-1]) == (0, len(places) - 1)
    assert (np.diff(knots) > 0).all()
    for first, last, bulge in zip(knots[:-1], knots[1:], bulges, strict=True):
        piece = drawn(places[first], places[last], bulge)
        points = [Point(place) for place in places[first : last + 1]]
        assert max(piece.distance(point) for point in points) <= tolerance * (1.0 + 1e-6) + 1e-10
        along = [piece.project(point) for point in points]
        assert (np.diff(along) >= -2.0 * tolerance - 1e-9).all()


def test_one_place_is_no_piece() -> None:
    knots, bulges = follow(np.zeros((1, 2)), np.array([0]), TOLERANCE)
    assert (knots.tolist(), bulges.tolist()) == ([0], [])
