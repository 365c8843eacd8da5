"""What a person reads at the end of a batch: the verdict, the totals, and why parts did not pass."""

import re

import pytest

from deltacam.batch.parts import Batch, Status
from deltacam.batch.results.reasons import reasons
from deltacam.batch.results.text import to_text
from deltacam.batch.results.totals import clock
from tests.batch.rows import HOSTILE, facts, failed, passed, without


def test_a_batch_that_passed_takes_two_lines() -> None:
    rows = (passed("a.dxf", quantity=3, facts=facts(time=2000.0, cut_length=1.5)), passed("b.dxf"))
    assert to_text(Batch(rows)) == "PASSED  2 of 2 parts passed\n  to cut  4 pieces in 1:40:02 h, 4.62 m cut"
    assert to_text(Batch(rows[1:])) == "PASSED  1 of 1 part passed\n  to cut  1 piece in 0:00:02 h, 0.12 m cut"


def test_what_was_there_already_is_said() -> None:
    rows = (passed("a.dxf", again=True), passed("b.dxf", again=True), passed("c.dxf"))
    assert "\n  before  2 parts were there already" in to_text(Batch(rows))
    assert "\n  before  1 part was there already" in to_text(Batch(rows[1:]))
    assert "before" not in to_text(Batch(rows[2:]))


def test_every_part_that_did_not_pass_is_named_with_its_reason_and_its_hint() -> None:
    rows = (
        passed("a.dxf"),
        failed("b.dxf", "part size"),
        without("c.dxf", Status.REFUSED, "it is not flat", where="layer 0, LINE #1", hint="project it"),
        without("d.dxf", Status.LEFT, "the batch was stopped before", hint="run it again"),
    )
    assert to_text(Batch(rows, ("old.dxf is of an earlier batch",))).splitlines()[2:] == [
        "",
        "  FAILED     b.dxf",
        "             failed: part size",
        "  REFUSED    c.dxf",
        "             layer 0, LINE #1: it is not flat",
        "             hint: project it",
        "  LEFT       d.dxf",
        "             the batch was stopped before",
        "             hint: run it again",
        "",
        "note: old.dxf is of an earlier batch",
    ]
    heading = to_text(Batch(rows)).splitlines()[0]
    assert heading == "FAILED  1 of 4 parts passed: 1 failed, 1 refused, 1 left"


def test_nothing_is_to_be_cut_where_nothing_passed() -> None:
    shown = to_text(Batch((without("a.dxf", Status.CRASHED, "the process ended"),)))
    assert shown.splitlines()[:2] == ["FAILED  0 of 1 part passed: 1 crashed", ""]


def test_parts_that_fail_for_one_reason_are_together_and_those_of_most_parts_come_first() -> None:
    rows = [failed("a.dxf", "part size")]
    rows += [
        without(f"{n}.dxf", Status.REFUSED, f"a gap of {n} mm at ({n}, 0) mm", where=f"layer {n}, #{n}", hint="join it")
        for n in range(1, 6)
    ]
    first, second = reasons(Batch(tuple(rows)))
    assert first.parts == ("1.dxf", "2.dxf", "3.dxf", "4.dxf", "5.dxf")
    assert first.sentence == "layer 1, #1 ...: a gap of 1 to 5 mm at (1, 0) ... mm"
    assert first.named == "1.dxf, 2.dxf, 3.dxf and 2 more"
    assert second.parts == ("a.dxf",)
    assert "  REFUSED    5 parts: 1.dxf, 2.dxf, 3.dxf and 2 more\n" in to_text(Batch(tuple(rows)))


@pytest.mark.parametrize("other", [Status.TIMEOUT, "it does not fit", "use another one"])
def test_parts_that_differ_in_status_reason_or_hint_are_apart(other: str) -> None:
    given = {"status": Status.REFUSED, "what": "it fits", "hint": "use it"}
    key = {Status.TIMEOUT: "status", "it does not fit": "what", "use another one": "hint"}[other]
    rows = (without("a.dxf", **given), without("b.dxf", **{**given, key: other}))
    assert len(reasons(Batch(rows))) == 2


def test_every_part_that_did_not_pass_has_one_reason() -> None:
    whats = ("layer 5", "layer #A", "layer (1, 2)", "layer \x00", "", HOSTILE, "layer 7e999")
    rows = [without(f"{status}{number}.dxf", status, what) for number, what in enumerate(whats) for status in Status]
    found = [part for reason in reasons(Batch(tuple(rows))) for part in reason.parts]
    assert sorted(found) == sorted(row.part for row in rows if row.outcome.status is not Status.PASSED)


def test_the_text_of_a_thousand_parts_fits_a_few_screens() -> None:
    letters = "ABCDEFGHIJKLMNOP"
    rows = [
        without(f"{n}.dxf", Status.REFUSED, f"layer {letters[n % 16]} is wrong " * 40, hint="change " * 99)
        for n in range(1000)
    ]
    notes = tuple(f"note {n}" for n in range(1000))
    lines = to_text(Batch(tuple(rows), notes)).splitlines()
    assert len(lines) < 60
    assert max(map(len, lines)) < 450
    assert "  and 248 more for other reasons, in batch.json" in lines
    assert lines[-1] == "note: and 992 more, in batch.json"


def test_no_name_commands_the_terminal() -> None:
    rows = (
        without(HOSTILE, Status.REFUSED, HOSTILE, where=HOSTILE, hint=HOSTILE),
        passed(HOSTILE),
        failed(HOSTILE, HOSTILE),
    )
    shown = to_text(Batch(rows, (HOSTILE,)))
    assert shown.replace("\n", "").isprintable()
    assert shown.encode()
    assert re.search(r"^note: </script><script>", shown, flags=re.MULTILINE)


@pytest.mark.parametrize(
    ("time", "shown"), [(0.0, "0:00:00"), (59.5, "0:01:00"), (3599.6, "1:00:00"), (360_061.2, "100:01:01")]
)
def test_long_times_are_hours_minutes_and_seconds(time: float, shown: str) -> None:
    assert clock(time) == shown
