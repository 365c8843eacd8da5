"""The summary for programs: complete, as the schema and the page of the documentation say, whatever names are."""

import csv
import io
import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from jsonschema import Draft202012Validator

from deltacam.batch.parts import Batch, Outcome, Row, Status
from deltacam.batch.results.listing import columns, to_csv, to_dict, to_json
from deltacam.batch.results.totals import totals
from tests.batch.rows import HOSTILE, facts, failed, passed, without

DOCS = Path(__file__).parents[2] / "docs" / "reference"
SCHEMA = json.loads((DOCS / "batch.schema.json").read_text())

BATCH = Batch(
    (
        passed("a.dxf", quantity=3, facts=facts(time=0.1, cut_length=0.0123456789), warnings=("first", "second")),
        failed("b/a.dxf", "part size", "joint range"),
        passed("c.dxf", facts=facts(time=0.2, size=None)),
        without("d.dxf", Status.REFUSED, "not flat", where="layer 0, LINE #1", hint="project it", quantity=5),
        without("e.dxf", Status.LEFT, "the batch was stopped before"),
        Row("f.dxf", 1, Outcome(Status.UNWRITTEN, "the disk is full", facts=facts())),
    ),
    ("a note",),
)


def problems(found: Any) -> list[str]:
    return [f"{one.json_path}: {one.message}" for one in Draft202012Validator(SCHEMA).iter_errors(found)]


def table(batch: Batch) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(to_csv(batch)), strict=True))


def test_the_totals_count_the_parts_that_passed_as_often_as_they_are_wanted() -> None:
    assert to_dict(BATCH)["totals"] == {
        **{status.value: 0 for status in Status},
        "parts": 6,
        "passed": 2,
        "failed": 1,
        "refused": 1,
        "left": 1,
        "unwritten": 1,
        "pieces": 4,
        "time_s": 0.5,
        "cut_length_mm": pytest.approx(3 * 12.3456789 + 120.0, abs=1e-6),
    }
    assert to_dict(BATCH)["passed"] is False
    assert to_dict(Batch(BATCH.rows[:1]))["passed"] is True


def test_the_totals_do_not_depend_on_the_order() -> None:
    rows = tuple(passed(f"{time}.dxf", facts=facts(time=time)) for time in (1e16, 1.0, 1.0))
    assert totals(Batch(rows)) == totals(Batch(rows[::-1]))


def test_every_part_is_there_with_all_that_is_known() -> None:
    first, second, third, fourth, *_ = to_dict(BATCH)["parts"]
    assert first == {
        "part": "a.dxf",
        "status": "passed",
        "reason": None,
        "warnings": ["first", "second"],
        "quantity": 3,
        "robot": "delta-300",
        "process": "steel",
        "time_s": 0.1,
        "cut_length_mm": 12.345679,
        "size_mm": [40.0, 30.0],
        "contours": 2,
        "checks": {"made": 46, "failed": []},
        "files": [
            {"name": f"a{ending}", "sha256": str(number) * 64, "bytes": 1000 + number}
            for number, ending in enumerate((".report.json", ".report.html", ".program.csv"))
        ],
        "drawing_sha256": "d" * 64,
        "key": "e" * 64,
    }
    assert second["checks"] == {"made": 46, "failed": ["part size", "joint range"]}
    assert third["size_mm"] is None
    assert fourth["reason"] == {"what": "not flat", "where": "layer 0, LINE #1", "hint": "project it"}
    assert [fourth[key] for key in ("time_s", "size_mm", "checks", "drawing_sha256", "key")] == [None] * 5


def test_the_json_is_as_the_schema_says_and_the_schema_knows_every_key() -> None:
    Draft202012Validator.check_schema(SCHEMA)
    found = json.loads(to_json(BATCH))
    assert problems(found) == problems(json.loads(to_json(Batch(())))) == []
    assert problems({**found, "another": 1})
    assert problems({**found, "parts": [{**found["parts"][0], "status": "good"}]})
    for key in found["parts"][0]:
        assert problems({**found, "parts": [{name: of for name, of in found["parts"][0].items() if name != key}]}), key


def test_what_no_earlier_run_decides_is_not_in_the_files() -> None:
    again = Batch(tuple(replace(row, again=True) for row in BATCH.rows), BATCH.notes)
    assert to_json(again) == to_json(BATCH)
    assert to_csv(again) == to_csv(BATCH)


def test_names_that_are_not_utf8_and_hostile_ones_come_back_as_they_were() -> None:
    row = replace(failed(HOSTILE, HOSTILE), outcome=Outcome(Status.FAILED, HOSTILE, HOSTILE, HOSTILE, (HOSTILE,)))
    content = to_json(Batch((row,), (HOSTILE,)))
    assert content.encode() == content.encode("ascii")
    (part,) = json.loads(content)["parts"]
    assert part["part"] == part["warnings"][0] == part["reason"]["what"] == HOSTILE


def test_the_csv_has_a_line_for_every_part() -> None:
    rows = table(BATCH)
    assert [row["part"] for row in rows] == ["a.dxf", "b/a.dxf", "c.dxf", "d.dxf", "e.dxf", "f.dxf"]
    assert rows[0] == {
        "part": "a.dxf",
        "status": "passed",
        "quantity": "3",
        "time_s": "0.1",
        "total_time_s": "0.3",
        "cut_length_mm": "12.345679",
        "width_mm": "40.0",
        "height_mm": "30.0",
        "contours": "2",
        "robot": "delta-300",
        "process": "steel",
        "checks": "46",
        "failed_checks": "",
        "warnings": "first; second",
        "reason": "",
        "hint": "",
        "program": "a.program.csv",
        "report": "a.report.html",
    }
    assert (rows[1]["failed_checks"], rows[1]["program"]) == ("part size, joint range", "")
    assert (rows[3]["reason"], rows[3]["hint"], rows[3]["time_s"]) == ("layer 0, LINE #1: not flat", "project it", "")
    content = to_csv(BATCH)
    assert content.count("\n") == 7
    assert "\r" not in content
    assert not content.startswith("\ufeff")
    assert to_csv(Batch(())) == ",".join(columns()) + "\n"


def test_a_spreadsheet_takes_numbers_as_numbers_and_computes_no_text() -> None:
    names = ["=1+1.dxf", "+1.dxf", "-1.dxf", "@SUM(A1).dxf", "\uff1d1.dxf", "\t=1.dxf", "\r=1.dxf", "a;=1.dxf"]
    rows = [passed(name, robot=name, process=name, warnings=(name,)) for name in names]
    rows += [without(name, Status.REFUSED, name, hint=name) for name in names]
    content = to_csv(Batch(tuple(rows)))
    for line in content.splitlines()[1:]:
        cells = re.findall(r'"(?:[^"]|"")*"|[^,]+|(?<=,)(?=,)', line)
        assert ",".join(cells) == line
        for cell in filter(None, cells):
            assert re.fullmatch(r'\d+(\.\d+)?|"([^=+@\t\r\uff1d-].*)?"', cell), cell
    assert [row["part"] for row in table(Batch(tuple(rows)))][:3] == ["'=1+1.dxf", "'+1.dxf", "'-1.dxf"]


def test_every_part_is_one_line_of_utf8_whatever_it_is_called() -> None:
    content = to_csv(Batch((passed(HOSTILE), without(HOSTILE, Status.FAULT, HOSTILE, hint=HOSTILE))))
    assert len(content.encode().splitlines()) == 3
    assert [row["part"] for row in csv.DictReader(io.StringIO(content), strict=True)] == [
        HOSTILE.replace("\u202e", "\\u202e").replace("\x00", "\\x00").replace("\x1b", "\\x1b")
        .replace("\udce9", "\\udce9").replace("\n", "\\n")
    ] * 2  # fmt: skip


def documented(heading: str) -> list[str]:
    """The names in the first column of the tables below a heading of the page."""
    page = (DOCS / "batch-results.md").read_text()
    section = re.search(rf"^## {heading}\n(.*?)(?=^## |\Z)", page, flags=re.DOTALL | re.MULTILINE)
    assert section, heading
    return [name for row in re.findall(r"^\| (`[^|]+) \|", section[1], flags=re.MULTILINE) for name in names(row)]


def names(cell: str) -> list[str]:
    return re.findall(r"`([^`]+)`", cell)


def test_every_key_column_and_status_has_its_row_in_the_documentation() -> None:
    found = to_dict(BATCH)
    keys = [*found, *(f"totals.{key}" for key in found["totals"] if key not in list(Status)), *found["parts"][0]]
    keys += [f"reason.{key}" for key in found["parts"][3]["reason"]]
    keys += [f"checks.{key}" for key in found["parts"][0]["checks"]]
    keys += [f"files.{key}" for key in found["parts"][0]["files"][0]]
    assert sorted(documented("batch.json")) == sorted([*keys, "totals.passed"])
    assert documented("batch.csv") == columns()
    assert documented("Statuses") == [status.value for status in Status]


def test_the_documentation_says_which_statuses_are_planned_again() -> None:
    page = (DOCS / "batch-results.md").read_text()
    rows = re.findall(r"^\| `(\w+)` \| [^|]+ \| (yes|no)\b[^|]* \|$", page, flags=re.MULTILINE)
    assert {Status(status): again == "no" for status, again in rows} == {status: status.lasts for status in Status}
