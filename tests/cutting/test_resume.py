"""Going on after a stop."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.cutting.resume import resume
from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.model import Cut, Operation

CIRCLE = curves.circle(np.zeros(2), 0.01)


def cut(number: int, operation: Operation = Operation.CUT) -> Cut:
    return Cut(number, "CUT", (f"{number:X}",), CIRCLE, operation)


@given(st.lists(st.integers(1, 9), min_size=1, max_size=12), st.data())
def test_what_is_left_out_and_what_is_left_are_all_of_it_in_its_order(numbers: list[int], data: st.DataObject) -> None:
    ordered = [cut(number) for number in numbers]
    number = data.draw(st.sampled_from(numbers))
    found = resume(ordered, number)
    assert found.cuts == tuple(ordered[numbers.index(number) :])
    assert len(found.findings) == (numbers[0] != number)


def test_a_finding_names_what_is_left_out() -> None:
    ordered = [cut(7, Operation.ENGRAVE), cut(3), cut(3), cut(2), cut(1)]
    (finding,) = resume(ordered, 2).findings
    assert (
        finding.what == "the program begins with contour 2: 2 cut and 1 engraved before it are left out, contours 7, 3"
    )
    assert (finding.where, finding.kind) == ("contour 2 (layer CUT, #2)", "resumed")


def test_many_contours_are_shortened() -> None:
    (finding,) = resume([cut(number) for number in range(1, 40)], 39).findings
    assert finding.what.endswith("contours 1, 2, 3, 4, 5, 6, 7, 8, 9, 10 and 28 more")


def test_a_contour_that_is_not_cut_is_refused_with_those_that_are() -> None:
    with pytest.raises(InfeasibleError) as caught:
        resume([cut(3), cut(1)], 2)
    assert "contour 2" in caught.value.what
    assert caught.value.where == "contours in their order: 3, 1"
    assert "--from-contour" in caught.value.hint
