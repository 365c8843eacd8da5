"""A mark is free from a zoom on exactly where its box touches no other at any larger zoom."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from deltacam.report.crowd import NEVER, Crowd

PLACES = st.tuples(st.integers(-40, 40), st.integers(-40, 40))
ZOOMS = 2.0 ** np.arange(0.0, 12.0, 0.01)


def overlap(zoom: float, one: np.ndarray, other: np.ndarray, shift: np.ndarray, room: np.ndarray) -> bool:
    return bool((np.abs((one - other) * zoom + shift) < room).all())


@given(st.lists(PLACES, min_size=2, max_size=12), st.integers(0, 3))
def test_two_marks_that_are_both_shown_never_overlap(places: list[tuple[int, int]], corner: int) -> None:
    crowd, unit, half = Crowd(1e-3), 1e-3, np.array([7.3, 6.1])
    offsets = np.roll(np.array([[9.0, 8.0], [9.0, -8.0], [-9.0, 8.0], [-9.0, -8.0]]), corner, axis=0)
    shown: list[tuple[np.ndarray, np.ndarray, float]] = []
    for place in places:
        point = np.array(place) * unit
        side, zoom = crowd.free(point, offsets, half)
        if zoom < NEVER:
            crowd.add(point, offsets[side], half, zoom)
            shown.append((point / unit, offsets[side], zoom))
    assert shown[0][2] == 1.0
    for at, (one, side, zoom) in enumerate(shown):
        for other, beside, before in shown[:at]:
            both = ZOOMS[max(zoom, before) <= ZOOMS]
            assert not any(overlap(z, one, other, side - beside, 2 * half - 1e-9) for z in both)


def test_a_mark_is_shown_as_soon_as_it_is_free_and_never_on_the_same_point() -> None:
    crowd, half = Crowd(1e-3), np.array([5.0, 5.0])
    crowd.add(np.zeros(2), np.zeros(2), half)
    _, zoom = crowd.free(np.array([2e-3, 0.0]), np.zeros((1, 2)), half)
    assert zoom == 5.0  # 2 pixels apart, 10 are needed
    assert crowd.free(np.array([2e-3, 0.0]), np.array([[0.0, 0.0], [20.0, 0.0]]), half) == (1, 1.0)
    assert crowd.free(np.zeros(2), np.zeros((1, 2)), half)[1] == NEVER
    assert crowd.free(np.array([0.5, 0.0]), np.zeros((1, 2)), half, least=3.0) == (0, 3.0)


def test_a_mark_gives_no_way_to_one_that_is_shown_only_where_they_are_apart() -> None:
    crowd, half = Crowd(1e-3), np.array([5.0, 5.0])
    crowd.add(np.zeros(2), np.zeros(2), half, zoom=8.0)
    assert crowd.free(np.array([2e-3, 0.0]), np.zeros((1, 2)), half) == (0, 1.0)
    assert crowd.free(np.array([1e-3, 0.0]), np.zeros((1, 2)), half) == (0, 10.0)
