"""What the kerf leaves, in the table, in the line for a terminal and in the JSON."""

import json
from dataclasses import replace

import pytest

from deltacam.model import KerfEffect
from deltacam.program.program import Program
from deltacam.report.html import to_html
from deltacam.report.kerf import HEADS, in_words, rows
from deltacam.report.listing import to_json
from deltacam.report.text import to_text
from deltacam.verification.verify import verify
from tests.bench import Bench
from tests.report.parsed import Page

PLAIN = KerfEffect(1, 1, (), 0, 0.0, None)
CORNERS = KerfEffect(2, 1, (), 4, 41.42e-6, (0.01, 0.02))
SPLIT = KerfEffect(3, 2, (4,), 1, 10e-6, (0.03, 0.0))
SWALLOWED = KerfEffect(4, 0, (3,), 0, 0.0, None)


def test_contours_that_are_cut_as_drawn_have_no_row() -> None:
    assert rows([PLAIN], []) == []
    found = rows([PLAIN, CORNERS, SPLIT, SWALLOWED], [])
    assert [row[0] for row in found] == ["2", "3", "4"]
    assert {len(row) for row in found} == {len(HEADS)}
    assert [row[1] for row in found] == ["1", "split into 2", "swallowed"]
    assert found[0][3:6] == ["4", "41.4", "10.000, 20.000"]
    assert [row[2] for row in found] == ["", "4", "3"]


def test_the_line_has_the_worst_of_it() -> None:
    assert in_words([PLAIN]) == ""
    assert in_words([CORNERS]) == "leaves up to 41.4 um in 4 inner corners, most in contour 2 at (10.000, 20.000)"
    assert in_words([PLAIN, CORNERS, SPLIT, SWALLOWED]) == (
        "swallows contours 4, splits contours 3, leaves up to 41.4 um in 5 inner corners, most in contour 2 "
        "at (10.000, 20.000)"
    )
    many = in_words([replace(SWALLOWED, contour=number) for number in range(1, 40)])
    assert many == "swallows contours 1, 2, 3, 4, 5, 6 and 33 more"


def test_a_program_that_is_compared_says_what_the_kerf_leaves(bench: Bench, program: Program) -> None:
    report = verify(program, drawing=bench.drawing)
    assert [one.contour for one in report.kerf] == [one.contour for one in report.sizes]
    found = json.loads(to_json(report))
    assert [one["paths"] for one in found["kerf"]] == [1, 1, 1, 1]
    for size in found["sizes"]:
        assert size["left_box_mm"] == pytest.approx(size["drawn_box_mm"], abs=0.01)
        assert size["exact_mm2"] == pytest.approx(size["drawn_mm2"], rel=2e-3)
    assert "  kerf     " not in to_text(report)
    worse = replace(report, kerf=(*report.kerf, CORNERS))
    assert f"\n  kerf     {in_words([CORNERS])}\n" in to_text(worse)
    (row,) = Page(to_html(worse, program, drawing=bench.drawing, title="plate")).rows("What the kerf leaves")
    assert row["inner corners"] == "4"
    assert verify(program, drawing=None).kerf == ()
