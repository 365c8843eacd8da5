"""The text for a terminal."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.inspection.text import to_text
from deltacam.model import Contour, Drawing, Finding, Layer, LedgerEntry, Outcome

SHOWN = """\
part.dxf
  unit     mm (header)
  size     145.00 x 90.00 mm; lower left corner at (-5.00, -5.00) mm
  error    0.13 um at most between these contours and the file

  layer  colour  line type   state   entities  operation    closed  open
  CUT         7  CONTINUOUS  on             7  cut, ignore       4     2
  MARK        1  DASHED      on             2  engrave           1     1
  FRAME       8  CONTINUOUS  off            1  ignore            1     0
  TXT         2  CONTINUOUS  frozen         2  -                 0     0

  contours: 3 outer, 3 inner, 3 open
  number  like it  kind        layer         size mm  length mm  segments    operation
       1           outer       CUT    120.00 x 80.00     400.00  4           cut
       2           hole in 1   CUT     20.00 x 20.00      62.83  2 (2 arcs)  cut
       3           outer in 2  CUT       8.00 x 8.00      25.13  2 (2 arcs)  cut
       4           hole in 1   CUT     40.00 x 10.00      91.42  4 (2 arcs)  cut
       5           hole in 1   MARK    20.00 x 10.00      60.00  4           engrave
       6           outer       FRAME  130.00 x 90.00     440.00  4           ignore
       7           open        MARK    25.00 x 15.00      40.00  2           engrave
       8           open        CUT     20.00 x 20.71      47.93  2 (2 arcs)  cut
       9           open        CUT     15.00 x 30.00      59.00  3           ignore

  entities: 13: 5 cut, 2 engraved, 1 merged, 4 ignored, 1 lost
    1  lost     its knots are no numbers
    2  ignored  text is never cut
    1  ignored  its layer is left out
    1  ignored  an open line
    1  merged   duplicate of #4

  plan will refuse: contour 3 (layer CUT, #3) at (20.000, 30.000) mm: it crosses contour 2; separate the outlines
  warning: layer TXT: 2 TEXT are not cut: text is never cut
  warning: layer CUT at (140.000, 10.000) mm: the ends are 0.02 mm apart; raise --join
  warning: (60.000, 0.000) mm: more than two lines meet
  warning: (120.000, 80.000) mm: a closed line encloses nothing

next: change the drawing as said above, then deltacam plan part.dxf
"""


def test_all_that_matters_is_on_one_screen(drawing: Drawing) -> None:
    assert to_text(drawing, again="deltacam plan part.dxf") == SHOWN


def test_without_a_unit_the_size_is_given_in_several(drawing: Drawing) -> None:
    nobody = replace(drawing, unit="", unit_source="missing", findings=())
    text = to_text(nobody, again="deltacam plan part.dxf")
    assert "unit     not stated: everything below is as if it were mm\n" in text
    assert "145.00 x 90.00 mm if mm, 3683.00 x 2286.00 mm if in, 51.15 x 31.75 mm if pt; lower" in text
    assert text.endswith("\nnext: deltacam plan part.dxf --units mm\n")
    units = Finding("no unit", hint="state the unit: --units in", kind="units", blocks=True)
    assert to_text(replace(nobody, findings=(units,)), again="deltacam plan part.dxf").endswith("part.dxf --units in\n")


@pytest.mark.parametrize(
    ("kinds", "proposed"),
    [
        ((), "next: plan"),
        (("lost",), "next: plan --accept-loss"),
        (("crossing", "lost"), "next: change the drawing as said above, then plan --accept-loss"),
    ],
)
def test_the_next_command_fits_what_blocks(drawing: Drawing, kinds: tuple[str, ...], proposed: str) -> None:
    findings = tuple(Finding("it is so", kind=kind, blocks=True) for kind in kinds)
    assert to_text(replace(drawing, findings=findings), again="plan").splitlines()[-1] == proposed


def test_a_drawing_of_nothing_has_a_text(empty: Drawing) -> None:
    text = to_text(empty)
    assert "nothing is drawn" in text
    assert "0 outer, 0 inner, 0 open" in text
    assert "entities: 0" in text


def big(count: int) -> Drawing:
    """A sheet of circles of many sizes, on many layers, with many warnings and reasons."""
    contours = tuple(
        Contour(i + 1, curves.circle(np.array([0.1 * i, 0.0]), 0.001 + 1e-4 * (i % 60)), f"L{i % 40}", (f"{i:X}",))
        for i in range(count)
    )
    ledger = tuple(
        LedgerEntry(f"{i:X}", "TEXT", "0", "", Outcome.IGNORED, f"reason {'x' * (i % 50)}") for i in range(count)
    )
    return Drawing(
        file="big.dxf",
        sha256="",
        metres_per_unit=1e-3,
        unit="mm",
        unit_source="header",
        contours=contours,
        ledger=ledger,
        findings=tuple(Finding(f"thing {'x' * (i % 60)}", kind=f"k{i % 60}") for i in range(count)),
        layers=tuple(Layer(f"L{i}", "on", 7, "CONTINUOUS", 1, 1) for i in range(40)),
        extents=(0.0, 0.0, 0.1 * count, 0.01),
    )


def test_a_large_drawing_fits_a_screen_too_and_counts_what_it_leaves_out() -> None:
    text = to_text(big(600), again="deltacam plan big.dxf")
    assert len(text.splitlines()) < 60
    assert "and 32 more layers" in text
    assert "more contours, all of them with --json" in text
    assert "more reasons" in text
    rows = [line.split() for line in text.partition("operation\n")[2].partition("entities:")[0].splitlines()]
    alike = [1 + int(row[1]) for row in rows if len(row) > 6 and row[2] == "outer"]
    left_out = int(text.partition(" more contours")[0].rsplit("and ", 1)[1])
    assert sum(alike) + left_out == 600


def test_inserted_blocks_are_one_reason(drawing: Drawing) -> None:
    inserts = tuple(
        LedgerEntry(f"{n}", "INSERT", "0", "", Outcome.MERGED, f"its block {name} is listed entity by entity")
        for n, name in enumerate(("WASHER", "HOOK", "PLATE"))
    )
    assert "3  merged  inserted blocks" in to_text(replace(drawing, ledger=inserts))


@given(st.text(min_size=1), st.text(), st.text())
def test_nothing_in_a_name_reaches_the_terminal(name: str, reason: str, what: str) -> None:
    hostile = Drawing(
        file=name,
        sha256="",
        metres_per_unit=1.0,
        unit="m",
        unit_source="header",
        contours=(Contour(1, curves.circle(np.zeros(2), 1.0), name, ("1",)),),
        ledger=(LedgerEntry("1", "CIRCLE", name, name, Outcome.IGNORED, reason, 1),),
        findings=(Finding(what, where=name, hint=reason, place=(0.0, 0.0)),),
        layers=(Layer(name, "on", 7, name, 1, 1),),
        extents=(-1.0, -1.0, 1.0, 1.0),
    )
    text = to_text(hostile, again="plan")
    assert all(letter.isprintable() or letter == "\n" for letter in text)
    assert max(map(len, text.splitlines())) < 4000
