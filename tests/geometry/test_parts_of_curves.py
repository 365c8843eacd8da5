"""Parts of open curves, and open curves put together."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.model import Curve
from tests.strategies import star_curves


@given(star_curves(), st.floats(0.0, 1.0), st.floats(0.0, 1.0))
def test_a_part_begins_and_ends_where_it_is_said_to(curve: Curve, one: float, other: float) -> None:
    whole = curves.opened(curve)
    first, last = sorted([one * curves.length(whole), other * curves.length(whole)])
    if last - first < 1e-6:
        return
    part = curves.part(whole, first, last)
    assert curves.length(part) == pytest.approx(last - first, abs=5e-9)
    ends = np.cumsum(curves.lengths(whole))
    for place, at in ((part.points[0], first), (part.points[-1], last)):
        segment = min(int(np.searchsorted(ends, at)), len(ends) - 1)
        expected, _ = curves.evaluate(
            whole, np.array([segment]), np.array([at - ends[segment]]) + curves.lengths(whole)[segment]
        )
        assert place == pytest.approx(expected[0], abs=5e-9)


@given(star_curves(), st.floats(0.1, 0.9))
def test_two_parts_chained_are_the_whole(curve: Curve, share: float) -> None:
    whole = curves.opened(curve)
    length = curves.length(whole)
    both = curves.chain([curves.part(whole, 0.0, share * length), curves.part(whole, share * length, length)])
    assert not both.closed
    assert curves.length(both) == pytest.approx(length, abs=5e-9)
    points, _ = curves.flatten(both, 1e-6)
    gaps = [curves.nearest(whole, point)[2] for point in points[:: max(1, len(points) // 20)]]
    assert max(gaps) < 5e-9


def test_the_whole_part_of_a_curve_is_that_curve() -> None:
    whole = curves.opened(curves.circle(np.zeros(2), 5e-3))
    part = curves.part(whole, 0.0, curves.length(whole))
    assert part.points == pytest.approx(whole.points, abs=1e-12)
    assert part.bulges == pytest.approx(whole.bulges)


@given(star_curves())
def test_an_opened_curve_ends_where_it_begins(curve: Curve) -> None:
    opened = curves.opened(curve)
    assert opened.points[0].tolist() == opened.points[-1].tolist() == curve.points[0].tolist()
    assert curves.length(opened) == pytest.approx(curves.length(curve))


def test_a_single_curve_in_a_chain_is_left_as_it_is() -> None:
    ring = curves.circle(np.zeros(2), 5e-3)
    assert curves.chain([ring]) is ring
