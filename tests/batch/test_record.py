"""What is remembered of a folder of results: all of it, or nothing of a line."""

from __future__ import annotations

import json
import string
from collections.abc import Iterator
from pathlib import Path
from typing import Any, Final

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from deltacam.batch.parts import Facts, Outcome, Status, Stored
from deltacam.batch.results.folder import ResultFolder, hold
from deltacam.batch.results.record import NAME, Record, Recorded
from deltacam.errors import ProgramError

TEXT: Final = st.text(max_size=8) | st.sampled_from(["\udcff", "\u2028", "</script>", '"\\\n'])
NUMBER: Final = st.floats(0.0, 1e6) | st.integers(0, 9)
FACTS: Final = st.builds(
    Facts, NUMBER, NUMBER, st.none() | st.tuples(NUMBER, NUMBER), st.integers(0, 9), st.integers(0, 9), st.tuples(TEXT)
)
OUTCOME: Final = st.builds(
    Outcome,
    *(st.sampled_from(Status), TEXT, TEXT, TEXT, st.tuples(TEXT, TEXT), TEXT, TEXT, st.none() | FACTS),
    st.lists(st.lists(st.integers(0, 160), max_size=6).map(tuple), max_size=3).map(tuple),
)
FILES: Final = st.lists(st.builds(Stored, TEXT, st.text(string.hexdigits), st.integers(0, 9)), max_size=3).map(tuple)
RECORDED: Final = st.dictionaries(TEXT, st.builds(Recorded, TEXT, OUTCOME, FILES), max_size=3)

FOUND: Final = Recorded(
    "key",
    Outcome(Status.PASSED, facts=Facts(2.5, 0.1, (0.04, 0.03), 1, 46), thumbnail=((0, 0, 160, 90),)),
    (Stored("a.program.csv", "0" * 64, 12),),
)


@pytest.fixture
def folder(tmp_path: Path) -> Iterator[ResultFolder]:
    with hold(tmp_path) as held:
        yield held


@settings(suppress_health_check=[HealthCheck.function_scoped_fixture], max_examples=60)
@given(parts=RECORDED)
def test_what_was_written_is_read_as_it_was_and_compact_as_well(
    folder: ResultFolder, parts: dict[str, Recorded]
) -> None:
    (folder.private / NAME).unlink(missing_ok=True)
    record = Record(folder)
    for name, found in parts.items():
        record.add(name, found)
    assert _exactly(Record(folder).parts) == _exactly(parts)
    record.compact()
    assert _exactly(Record(folder).parts) == _exactly(parts)


def _exactly(parts: dict[str, Recorded]) -> list[str]:
    """With the kind of every number: 3 is written otherwise than 3.0."""
    return sorted(map(repr, parts.items()))


def test_the_order_in_which_parts_were_done_leaves_no_trace(folder: ResultFolder) -> None:
    written = set()
    for names in (["b", "a", "c"], ["c", "b", "a", "b"]):
        (folder.private / NAME).unlink(missing_ok=True)
        record = Record(folder)
        for name in names:
            record.add(name, FOUND)
        record.compact()
        written.add((folder.private / NAME).read_bytes())
    assert len(written) == 1


def test_a_line_that_was_cut_off_anywhere_counts_as_not_written_and_harms_no_other(folder: ResultFolder) -> None:
    path = folder.private / NAME
    Record(folder).add("a", FOUND)
    before = path.read_bytes()
    Record(folder).add("b", FOUND)
    whole = path.read_bytes()
    for size in range(len(before), len(whole)):
        path.write_bytes(whole[:size])
        record = Record(folder)
        assert record.parts.keys() - {"b"} == {"a"}
        if size < len(whole.rstrip()):
            assert "b" not in record.parts
        record.add("c", FOUND)
        assert Record(folder).parts.keys() - {"b"} == {"a", "c"}


def test_what_is_forgotten_is_not_in_the_next_record(folder: ResultFolder) -> None:
    record = Record(folder)
    record.add("a", FOUND)
    record.add("b", FOUND)
    record.forget("a")
    record.forget("a")
    record.compact()
    assert Record(folder).parts == {"b": FOUND}


def changed(**changes: Any) -> dict[str, Any]:
    """A line of ours with other values; a path such as ``outcome.facts.time`` leads to each."""
    line: dict[str, Any] = {
        "part": "x",
        "key": "key",
        "files": [{"name": "x.program.csv", "sha256": "0", "size": 1}],
        "outcome": {
            **dict.fromkeys(("what", "where", "hint", "robot", "process"), ""),
            "status": "passed",
            "warnings": [],
            "thumbnail": [[0, 0, 1, 1]],
            "facts": {"time": 1.0, "cut_length": 1.0, "size": [1.0, 1.0], "contours": 1, "checks": 1, "failed": []},
        },
    }
    for path, value in changes.items():
        *way, last = path.split("__")
        inner = line
        for step in way:
            inner = inner[step]
        inner[last] = value
    return line


@pytest.mark.parametrize(
    "line",
    [
        b"\xff\xfe\x00",
        b"[" * 100_000,
        b"9" * 5000,
        b"null",
        b'"part"',
        b"[]",
        b"{}",
        b'{"part": 1}',
        *(
            json.dumps(changed(**change)).encode()
            for change in (
                {"part": None},
                {"key": 1},
                {"files": None},
                {"files": [{}]},
                {"files": [{"name": "x", "sha256": "0", "size": "1"}]},
                {"outcome": []},
                {"outcome": "status"},
                {"outcome__status": "done"},
                {"outcome__status": []},
                {"outcome__what": 1},
                {"outcome__warnings": None},
                {"outcome__more": 1},
                {"outcome__thumbnail": [[0.5]]},
                {"outcome__thumbnail": "ab"},
                {"outcome__facts": []},
                {"outcome__facts__time": float("nan")},
                {"outcome__facts__time": float("inf")},
                {"outcome__facts__time": "1"},
                {"outcome__facts__time": True},
                {"outcome__facts__time": 10**400},
                {"outcome__facts__size": []},
                {"outcome__facts__size": [1.0]},
                {"outcome__facts__size": 1},
                {"outcome__facts__contours": 1.5},
                {"outcome__facts__failed": [1]},
            )
        ),
    ],
    ids=lambda line: line[:20],
)
def test_a_line_that_is_none_of_ours_is_passed_over(folder: ResultFolder, line: bytes) -> None:
    record = Record(folder)
    record.add("a", FOUND)
    with (folder.private / NAME).open("ab") as stream:
        stream.write(line + b"\n")
    record.add("b", FOUND)
    assert Record(folder).parts == {"a": FOUND, "b": FOUND}


def test_the_lines_of_the_test_before_differ_from_one_of_ours_in_nothing_else(folder: ResultFolder) -> None:
    (folder.private / NAME).write_bytes(json.dumps(changed()).encode())
    assert list(Record(folder).parts) == ["x"]


def test_a_record_that_cannot_be_read_or_written_says_so(folder: ResultFolder) -> None:
    record = Record(folder)
    (folder.private / NAME).mkdir()
    for action in (lambda: Record(folder), lambda: record.add("a", FOUND), record.compact):
        with pytest.raises(ProgramError, match="is a directory") as caught:
            action()
        assert NAME in caught.value.where
        assert caught.value.hint
    assert record.parts == {}
