"""Distances from lines, against shapely's."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.verification import near
from deltacam.verification.near import Lines

NANOMETRES = st.integers(-5_000_000, 5_000_000)
PLACES = st.tuples(NANOMETRES, NANOMETRES).map(lambda place: (1e-9 * place[0], 1e-9 * place[1]))
POLYLINES = st.lists(st.lists(PLACES, min_size=1, max_size=6), min_size=1, max_size=3)


def exact(lines: list[np.ndarray], points: np.ndarray, *, closed: bool) -> np.ndarray:
    whole = []
    for line in lines:
        loop = np.concatenate([line, line[:1]]) if closed else line
        whole.append(shapely.linestrings(loop) if len(loop) > 1 else shapely.points(loop[0]))
    return shapely.distance(shapely.GeometryCollection(whole), shapely.points(points))


@settings(deadline=None)
@given(lines=POLYLINES, points=st.lists(PLACES, min_size=1, max_size=30), closed=st.booleans())
def test_the_distance_is_exact_above_the_bound_and_never_crosses_it(
    lines: list[list[tuple[float, float]]], points: list[tuple[float, float]], closed: bool
) -> None:
    arrays = [np.array(line) for line in lines]
    places = np.array(points)
    bound = 1e-5
    found = Lines(arrays, closed=closed).distance(places, exact_above=bound)
    true = exact(arrays, places, closed=closed)
    assert (found >= true - 1e-12).all()
    assert found[found > bound] == pytest.approx(true[found > bound], abs=1e-12)
    assert (found[true <= bound - 1e-12] <= bound).all()


@settings(deadline=None)
@given(line=st.lists(PLACES, min_size=2, max_size=6), along=st.floats(0.0, 1.0), closed=st.booleans())
def test_a_point_on_the_line_has_no_distance(line: list[tuple[float, float]], along: float, closed: bool) -> None:
    array = np.array(line)
    point = array[0] + along * (array[1] - array[0])
    assert Lines([array], closed=closed).distance(point[np.newaxis], exact_above=0.0)[0] <= 1e-12


def test_the_samples_are_close_and_stand_for_the_whole_length() -> None:
    line = np.array([(0.0, 0.0), (0.01, 0.0), (0.01, 0.0), (0.01, 0.005)])
    lines = Lines([line], closed=True)
    assert lines.share.max() <= near.SPACING * (1 + 1e-9)
    assert lines.share.sum() == pytest.approx(0.015 + np.hypot(0.01, 0.005))


def test_an_endless_line_takes_bounded_memory(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(near, "_MOST_SAMPLES", 20_000)
    line = np.array([(-1e3, 0.0), (1e3, 0.0)] * 50)
    lines = Lines([line], closed=False)
    assert len(lines.samples) <= 20_100
    assert lines.distance(np.array([[0.3, 0.7]]), exact_above=1e-5)[0] == pytest.approx(0.7)
