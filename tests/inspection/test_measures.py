import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.inspection.measures import kind, kind_in_words, layers, measure, totals
from deltacam.model import Contour, Curve, Drawing
from tests.strategies import contour, star_curves


@given(st.lists(star_curves(), min_size=1, max_size=5))
def test_measures_of_all_contours_are_those_of_each(drawn: list[Curve]) -> None:
    contours = tuple(contour(curve, number=i + 1) for i, curve in enumerate(drawn))
    measured = measure(Drawing("a.dxf", "", 1.0, "m", "header", contours[::-1], ()))
    assert [one.number for one in measured.contours] == list(range(1, len(drawn) + 1))
    for i, one in enumerate(measured.contours):
        np.testing.assert_allclose(measured.bounds[i], curves.bounds(one.curve), atol=1e-12)
        assert measured.lengths[i] == pytest.approx(curves.length(one.curve))
        assert measured.segments[i] == len(one.curve.bulges)
        assert measured.arcs[i] == np.count_nonzero(one.curve.bulges)


def test_machined_and_ignored_contours_are_listed_by_number(drawing: Drawing) -> None:
    measured = measure(drawing)
    assert [one.number for one in measured.contours] == list(range(1, 10))
    assert measured.segments.tolist() == [4, 2, 2, 4, 4, 4, 2, 2, 3]
    assert measured.arcs.tolist() == [0, 2, 2, 2, 0, 0, 0, 2, 0]


def test_a_drawing_without_contours_has_no_measures(empty: Drawing) -> None:
    assert measure(empty).bounds.shape == (0, 4)


def test_kinds_are_named_for_programs_and_people(drawing: Drawing) -> None:
    by_number: dict[int, Contour] = {one.number: one for one in measure(drawing).contours}
    assert [kind(by_number[n]) for n in (1, 2, 3, 9)] == ["outer", "inner", "outer", "open"]
    assert [kind_in_words(by_number[n]) for n in (1, 2, 3, 9)] == ["outer", "hole in 1", "outer in 2", "open"]


def test_every_layer_says_what_becomes_of_its_contours(drawing: Drawing) -> None:
    found = {used.layer.name: (used.operations, used.closed, used.open) for used in layers(drawing, measure(drawing))}
    assert found == {
        "CUT": (("cut", "ignore"), 4, 2),
        "MARK": (("engrave",), 1, 1),
        "FRAME": (("ignore",), 1, 0),
        "TXT": ((), 0, 0),
    }


def test_the_totals_count_every_entity_once(drawing: Drawing) -> None:
    counts = totals(drawing.ledger)
    assert counts == {"entities": 13, "cut": 5, "engraved": 2, "merged": 1, "ignored": 4, "lost": 1}
