"""Where cuts begin: where a person says so, or by rule."""

import numpy as np
import pytest

from deltacam.cutting import kerf
from deltacam.cutting.leads.starts import given_starts
from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.model import Contour, Cut
from tests.strategies import contour, rectangle

KERF = 0.2e-3


def plate() -> list[Contour]:
    """A plate of 40 x 30 mm with a round hole of 10 mm in its middle."""
    hole = curves.circle(np.array([20e-3, 15e-3]), 5e-3)
    return [contour(rectangle(40e-3, 30e-3)), contour(hole, number=2, depth=1, parent=1)]


def cuts_of(contours: list[Contour]) -> tuple[Cut, ...]:
    return kerf.offset(contours, kerf=KERF).cuts


@pytest.mark.parametrize(
    ("given", "expected"),
    [
        ((10e-3, 0.0), (10e-3, -0.1e-3)),  # on an edge
        ((10e-3, 0.3e-3), (10e-3, -0.1e-3)),  # beside it
        ((25e-3, 15e-3), (24.9e-3, 15e-3)),  # on the hole
    ],
)
def test_a_cut_begins_at_the_place_that_is_given(given: tuple[float, float], expected: tuple[float, float]) -> None:
    cuts = cuts_of(plate())
    ((index, start),) = given_starts([given], cuts, plate()).items()
    ring = curves.start_at(cuts[index].curve, start.segment, start.distance)
    assert ring.points[0] == pytest.approx(np.array(expected), abs=2e-6)


def test_at_a_corner_a_cut_begins_on_the_round_about_it() -> None:
    cuts = cuts_of(plate())
    ((index, start),) = given_starts([(40e-3, 30e-3)], cuts, plate()).items()
    ring = curves.start_at(cuts[index].curve, start.segment, start.distance)
    assert np.hypot(*(ring.points[0] - (40e-3, 30e-3))) == pytest.approx(KERF / 2.0, abs=1e-9)


def test_every_contour_has_its_own_start() -> None:
    cuts = cuts_of(plate())
    found = given_starts([(25e-3, 15e-3), (0.0, 15e-3)], cuts, plate())
    assert [cuts[index].contour for index in found] == [2, 1]


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ([(20e-3, 5e-3)], "contour 1 is nearest, 5.000 mm away"),
        ([(10e-3, 0.0), (0.0, 10e-3)], "contour 1 already begins elsewhere"),
    ],
)
def test_a_place_that_means_no_contour_is_refused(given: list[tuple[float, float]], said: str) -> None:
    with pytest.raises(InfeasibleError, match=said) as refused:
        given_starts(given, cuts_of(plate()), plate())
    assert "the start at (" in str(refused.value)


def test_a_contour_that_no_cut_goes_around_cannot_begin_anywhere() -> None:
    with pytest.raises(InfeasibleError, match="contour 1 has no cut that goes around"):
        given_starts([(10e-3, 0.0)], cuts_of(plate())[1:], plate())


def test_a_drawing_without_closed_contours_has_no_starts() -> None:
    with pytest.raises(InfeasibleError, match="no closed contour is cut"):
        given_starts([(0.0, 0.0)], (), [])
