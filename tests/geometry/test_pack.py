"""Many curves in a few arrays, against one curve at a time."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Curve


@st.composite
def any_curves(draw: st.DrawFn) -> Curve:
    count = draw(st.integers(2, 6))
    numbers = st.floats(-1.0, 1.0).map(lambda value: round(value, 4))
    points = np.array(draw(st.lists(st.tuples(numbers, numbers), min_size=count, max_size=count, unique=True)))
    closed = draw(st.booleans())
    bulge = st.one_of(st.just(0.0), st.floats(-1.0, 1.0))
    many = count if closed else count - 1
    return Curve(points, np.array(draw(st.lists(bulge, min_size=many, max_size=many))), closed)


@given(st.lists(any_curves(), min_size=1, max_size=5))
def test_a_pack_agrees_with_its_curves(found: list[Curve]) -> None:
    pack = Pack.of(found)
    assert len(pack) == len(found)
    for i, curve in enumerate(found):
        assert np.array_equal(pack[i].points, curve.points)
        assert np.array_equal(pack[i].bulges, curve.bulges)
        assert pack[i].closed == curve.closed
    assert pack.lengths() == pytest.approx([curves.length(curve) for curve in found], rel=1e-12)
    assert pack.bounds() == pytest.approx(np.array([curves.bounds(curve) for curve in found]), abs=1e-9)
    ends = [(curve.points[0], curve.points[0 if curve.closed else -1]) for curve in found]
    assert np.array_equal(pack.ends(), np.array(ends))


@given(st.lists(any_curves(), min_size=1, max_size=5), st.data())
def test_curves_can_be_taken_in_any_order(found: list[Curve], data: st.DataObject) -> None:
    indices = data.draw(st.lists(st.integers(0, len(found) - 1), min_size=1, max_size=6))
    taken = Pack.of(found).take(np.array(indices))
    for k, i in enumerate(indices):
        assert np.array_equal(taken[k].points, found[i].points)
        assert np.array_equal(taken[k].bulges, found[i].bulges)
        assert taken[k].closed == found[i].closed


def test_the_bounds_of_arcs_are_exact() -> None:
    pack = Pack.of([curves.circle((3.0, 4.0), 2.0), Curve(np.array([[0.0, 0.0], [1.0, 0.0]]), np.array([1.0]), False)])
    assert pack.bounds() == pytest.approx(np.array([[1.0, 2.0, 5.0, 6.0], [0.0, -0.5, 1.0, 0.0]]), abs=1e-12)


def test_no_curves_make_an_empty_pack() -> None:
    pack = Pack.of([])
    assert (len(pack), pack.lengths().shape, pack.bounds().shape, pack.ends().shape) == (0, (0,), (0, 4), (0, 2, 2))


def test_arrays_that_do_not_go_together_are_refused() -> None:
    with pytest.raises(ValueError, match="2 points and 2 bulges of 1 curves"):
        Pack(np.zeros((2, 2)), np.zeros(2), np.array([0, 3]), np.array([False]))
