"""Stretches of one colour cover the way and lose nothing unusual."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.report.stretches import largest, most_unusual, stretches

STEPS = st.lists(st.tuples(st.integers(0, 2), st.integers(0, 4), st.integers(0, 3)), min_size=1, max_size=60)


def way(count: int) -> np.ndarray:
    return np.column_stack([np.arange(count + 1) * 1e-3, np.zeros(count + 1)])


@given(STEPS)
def test_without_a_reach_every_step_keeps_its_band_and_colours(steps: list[tuple[int, int, int]]) -> None:
    band, one, two = np.array(steps).T
    first, colours = stretches(way(len(steps)), band, [largest(one), most_unusual(two, 1.0)], reach=0.0, most=1)
    length = np.diff([*first, len(steps)])
    for wanted, found in ((band, band[first]), (one, colours[0]), (two, colours[1])):
        assert np.repeat(found, length).tolist() == wanted.tolist()
    changes = np.any(np.diff(np.array(steps), axis=0) != 0, axis=1).sum()
    assert len(first) == 1 + changes


@given(STEPS, st.floats(1e-3, 20e-3))
def test_a_reach_joins_steps_of_a_band_and_keeps_the_largest_colour(
    steps: list[tuple[int, int, int]], reach: float
) -> None:
    band, colour, _ = np.array(steps).T
    first, (found,) = stretches(way(len(steps)), band, [largest(colour)], reach=reach, most=1000)
    ends = [*first, len(steps)]
    for start, end, shown in zip(ends, ends[1:], found, strict=False):
        assert len(set(band[start:end])) == 1
        assert shown == colour[start:end].max()


def test_the_reach_grows_until_there_are_few_enough_stretches() -> None:
    colour = np.arange(1000) % 2
    first, _ = stretches(way(1000), np.zeros(1000, dtype=np.int64), [largest(colour)], reach=1e-4, most=100)
    assert len(first) <= 100


@pytest.mark.parametrize(("usual", "shown"), [(2.0, 9), (8.0, 1)])
def test_the_colour_that_is_farthest_from_the_usual_one_is_shown(usual: float, shown: int) -> None:
    assert most_unusual(np.array([1, 5, 9]), usual)(np.array([0])).tolist() == [shown]
