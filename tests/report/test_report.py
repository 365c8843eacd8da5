"""The report as JSON and as text."""

import json
import re
from dataclasses import fields, replace

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.model import Check, Finding, LedgerEntry, Outcome, Report
from deltacam.plain import plain
from deltacam.program.program import Program
from deltacam.report.listing import to_json
from deltacam.report.text import to_text
from deltacam.verification.verify import verify
from tests.bench import Bench

HOSTILE = 'CUT\x1b[2J\x1b]0;title\x07\r\n\u2028\u202e\u200b\x9b1m<script>"\ud800'


@pytest.fixture
def bad(bench: Bench, program: Program) -> Report:
    """A report of a program whose names are hostile and whose last contour is not cut."""
    blocks = tuple(replace(block, layer=HOSTILE, handles=(HOSTILE,)) for block in program.blocks)
    contours = tuple(replace(c, layer=HOSTILE, handles=(HOSTILE,)) for c in bench.drawing.contours)
    entry = LedgerEntry("2F", "TEXT", HOSTILE, "", Outcome.IGNORED, HOSTILE)
    finding = Finding(HOSTILE, where=HOSTILE, hint=HOSTILE)
    drawing = replace(bench.drawing, file=HOSTILE, contours=contours, ledger=(entry,), findings=(finding,))
    program = bench.but(order=(4, 3, 1)).program()
    moved = replace(program, drawing=replace(program.drawing, file=HOSTILE), blocks=blocks[: len(program.blocks)])
    return verify(bench.shifted(moved, 700, 1e-3), drawing=drawing)


def test_the_json_has_the_documented_keys_in_order(bench: Bench, program: Program) -> None:
    report = verify(program, drawing=bench.drawing)
    found = json.loads(to_json(report), parse_constant=pytest.fail)
    assert list(found) == [*("passed", "warnings", "checks", "summary", "ledger", "findings", "sizes", "held", "kerf")]
    assert found["passed"] is True
    keys = ["name", "passed", "worst", "limit", "unit", "tick", "where"]
    assert list(found["checks"][0]) == [*keys, "time", "place", "contour", "layer", "handle", "warns"]
    assert list(found["checks"][0]) == [field.name for field in fields(Check)]
    assert to_json(report) == to_json(verify(program, drawing=bench.drawing))


def test_nothing_hostile_reaches_a_terminal(bad: Report) -> None:
    assert not bad.passed
    for text in (to_text(bad), to_json(bad)):
        lines = text.split("\n")
        assert all(line.isprintable() for line in lines)
        assert text.encode("utf-8")
    assert json.loads(to_json(bad))["ledger"][0]["layer"] == HOSTILE


def test_the_text_says_the_verdict_first_and_fits_a_screen(bench: Bench, program: Program, bad: Report) -> None:
    good = to_text(verify(program, drawing=bench.drawing)).splitlines()
    assert good[0].startswith("PASSED  plate.dxf (cut): all ")
    assert len(good) <= 24
    assert max(map(len, good)) <= 120
    lines = to_text(bad).splitlines()
    assert lines[0].startswith("FAILED  ")
    assert len([line for line in lines if line.startswith("  FAIL  ")]) == len(bench.failed(bad))
    assert not [line for line in lines if line.startswith("  ok  ")]
    assert any("tick 7" in line and "(1.7" in line and "s) x " in line for line in lines)


def test_every_check_is_listed_where_that_is_asked_for(bench: Bench, program: Program, bad: Report) -> None:
    for report in (bad, verify(program, drawing=bench.drawing)):
        listed = re.findall(r"  (?:ok|FAIL)  (\S.*?)(?:  |$)", to_text(report, every_check=True), flags=re.MULTILINE)
        assert sorted(listed) == sorted(check.name for check in report.checks)


def test_a_warning_is_no_failure_and_is_said_in_the_first_line(bench: Bench, program: Program) -> None:
    check = Check("rough edge", False, 2.0, 1.0, "um", warns=True)
    good = verify(program, drawing=bench.drawing)
    report = replace(good, checks=(*good.checks, check))
    assert report.passed
    assert report.warnings == ("rough edge",)
    lines = to_text(report).splitlines()
    assert lines[0].endswith(f"{len(good.checks)} of {len(report.checks)} checks; warning: rough edge")
    assert "  WARN  rough edge  2 / 1 um" in lines
    without = verify(program, drawing=None)
    assert without.passed
    assert [what.partition(":")[0] for what in without.warnings] == ["not checked without the drawing"]


def test_the_text_of_a_program_without_cuts_or_positions_is_whole(bench: Bench, program: Program) -> None:
    q = program.q.copy()
    q[700] = -3.0
    text = to_text(verify(replace(program, q=q), drawing=bench.drawing))
    assert "FAIL  possible poses" in text
    assert "tick 700" in text
    assert "note: the arms cannot close" in text


@pytest.mark.parametrize(
    ("value", "shown"),
    [(1_600_400.4, "1600400"), (99_999.96, "100000"), (14.0, "14"), (0.0, "0"), (1.4e-7, "1.4e-07"), (1e12, "1.0e+12")],
)
def test_a_number_has_an_exponent_only_where_people_would_write_one(program: Program, value: float, shown: str) -> None:
    report = replace(verify(program, drawing=None), checks=(Check("some", True, value, value, "um"),))
    text = to_text(report, every_check=True)
    assert f"  ok  some  {shown} / {shown} um\n" in text


def test_many_findings_do_not_fill_the_screen(program: Program) -> None:
    report = replace(verify(program, drawing=None), findings=tuple(Finding(f"thing {n}") for n in range(100)))
    text = to_text(report)
    assert "note: thing 0\n" in text
    assert "and 92 more" in text


@settings(deadline=None)
@given(st.text(alphabet=st.characters(codec=None, categories=None)))
def test_plain_text_is_printable_and_short(text: str) -> None:
    shown = plain(text)
    assert shown.isprintable()
    assert len(shown) <= 60 * len("\\U0010ffff")
    assert "\x1b" not in shown


@pytest.mark.parametrize("text", ["CUT", "Ebene 1 (außen)", "図面", "a<b>&\"c'"])
def test_plain_text_leaves_ordinary_names_alone(text: str) -> None:
    assert plain(text) == text
