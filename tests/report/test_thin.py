"""Thinned polylines, against distances by shapely."""

import itertools

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from shapely import LineString, Point

from deltacam.report import thin as module
from deltacam.report.thin import thin


@given(
    arrays(np.int64, st.tuples(st.integers(2, 60), st.just(2)), elements=st.integers(-1000, 1000)),
    st.lists(st.integers(0, 59), max_size=5),
    st.floats(1e-6, 1.0),
)
def test_thinning_keeps_fixed_points_and_drops_none_that_is_far_from_the_line(
    grains: np.ndarray, stay: list[int], tolerance: float
) -> None:
    way = 1e-3 * grains
    fixed = np.zeros(len(way), dtype=bool)
    fixed[[0, -1, *(index for index in stay if index < len(way))]] = True
    kept = thin(way, fixed, tolerance)
    assert kept[fixed].all()
    index = np.flatnonzero(kept)
    for first, last in itertools.pairwise(index):
        line = LineString(way[[first, last]])
        assert all(line.distance(Point(point)) <= tolerance * (1.0 + 1e-9) for point in way[first:last])


def test_thinning_leaves_only_the_ends_of_a_straight_line() -> None:
    way = np.column_stack((np.linspace(0.0, 1.0, 1000), np.linspace(0.0, 2.0, 1000)))
    fixed = np.zeros(1000, dtype=bool)
    fixed[[0, -1]] = True
    assert np.flatnonzero(thin(way, fixed, 1e-9)).tolist() == [0, 999]


@pytest.mark.parametrize("batch", [1, 50, 10_000])
def test_lines_are_thinned_as_if_each_were_alone(batch: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "_BATCH", batch)
    rng = np.random.default_rng(1)
    lines = [rng.uniform(size=(count, 2)) for count in (2, 30, 2, 100, 7, 60, 2)]
    found = module.thin_lines(lines, 0.3)
    for line, thinned in zip(lines, found, strict=True):
        fixed = np.zeros(len(line), dtype=bool)
        fixed[[0, -1]] = True
        assert thinned.tolist() == line[thin(line, fixed, 0.3)].tolist()
    assert module.thin_lines([], 0.3) == []
