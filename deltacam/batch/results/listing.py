"""The summary of a batch for programs and spreadsheets: JSON and CSV; the same bytes for the same results."""

from __future__ import annotations

import json
from collections.abc import Mapping
from importlib.metadata import version
from typing import Any, Final

from deltacam.batch.parts import Batch, Facts, Outcome, Row, Status
from deltacam.batch.results.totals import totals
from deltacam.plain import plain
from deltacam.units import to_mm

_LONGEST: Final = 32_767
"""Characters of a cell; a spreadsheet takes no more."""

_FORMULA: Final = tuple("=+-@\uff1d\uff0b\uff0d\uff20")
"""What a spreadsheet computes begins with one of these; the last four are their wide forms."""

Cell = str | int | float | None


def to_json(batch: Batch) -> str:
    """The batch as one JSON object, indented, ASCII, with a line feed at its end."""
    return json.dumps(to_dict(batch), indent=2, allow_nan=False) + "\n"


def to_dict(batch: Batch) -> dict[str, Any]:
    """The batch as dicts, lists, texts, finite numbers, booleans and None, which stands for what is not known."""
    sums = totals(batch)
    return {
        "deltacam": version("deltacam"),
        "passed": batch.passed,
        "totals": {
            "parts": len(batch.rows),
            **{status.value: batch.count(status) for status in Status},
            "pieces": sums.pieces,
            "time_s": _rounded(sums.time),
            "cut_length_mm": _rounded(to_mm(sums.cut_length)),
        },
        "notes": list(batch.notes),
        "parts": [_part(row) for row in batch.rows],
    }


def to_csv(batch: Batch) -> str:
    """A line for every part, the names of the columns first; texts are quoted, numbers are not.

    A text is on one line, and a spreadsheet that opens the file computes nothing.
    """
    lines = [list(map(_number_or_text, row.values())) for row in map(_cells, batch.rows)]
    return "".join(",".join(line) + "\n" for line in [columns(), *lines])


def columns() -> list[str]:
    """The names of the columns of the CSV."""
    return list(_cells(Row("", 1, Outcome(Status.LEFT))))


def _part(row: Row) -> dict[str, Any]:
    outcome = row.outcome
    reason = {"what": outcome.what, "where": outcome.where, "hint": outcome.hint}
    return {
        "part": row.part,
        "status": outcome.status.value,
        "reason": reason if any(reason.values()) else None,
        "warnings": list(outcome.warnings),
        "quantity": row.quantity,
        "robot": outcome.robot or None,
        "process": outcome.process or None,
        **_facts(outcome.facts),
        "files": [{"name": file.name, "sha256": file.sha256, "bytes": file.size} for file in row.files],
        "drawing_sha256": row.drawing_sha256 or None,
        "key": row.key or None,
    }


def _facts(facts: Facts | None) -> dict[str, Any]:
    """What is known of the program, in the units of the summaries."""
    if facts is None:
        return dict.fromkeys(("time_s", "cut_length_mm", "size_mm", "contours", "checks"))
    return {
        "time_s": _rounded(facts.time),
        "cut_length_mm": _rounded(to_mm(facts.cut_length)),
        "size_mm": facts.size and [_rounded(to_mm(side)) for side in facts.size],
        "contours": facts.contours,
        "checks": {"made": facts.checks, "failed": list(facts.failed)},
    }


def _cells(row: Row) -> Mapping[str, Cell]:
    """The cells of a part, by the names of their columns."""
    outcome, facts = row.outcome, _facts(row.outcome.facts)
    width, height = facts["size_mm"] or (None, None)
    checks = facts["checks"] or {"made": None, "failed": ()}
    return {
        "part": row.part,
        "status": outcome.status.value,
        "quantity": row.quantity,
        "time_s": facts["time_s"],
        "total_time_s": None if facts["time_s"] is None else _rounded(row.quantity * facts["time_s"]),
        "cut_length_mm": facts["cut_length_mm"],
        "width_mm": width,
        "height_mm": height,
        "contours": facts["contours"],
        "robot": outcome.robot,
        "process": outcome.process,
        "checks": checks["made"],
        "failed_checks": ", ".join(checks["failed"]),
        "warnings": "; ".join(outcome.warnings),
        "reason": outcome.reason,
        "hint": outcome.hint,
        "program": row.file(".program.csv"),
        "report": row.file(".report.html"),
    }


def _number_or_text(cell: Cell) -> str:
    if isinstance(cell, str):
        text = plain(cell, longest=_LONGEST).replace('"', '""')
        guard = "'" if text.startswith(_FORMULA) else ""
        return f'"{guard}{text}"'
    return "" if cell is None else repr(cell)


def _rounded(value: float) -> float:
    """To a millionth: what follows is noise of the conversion."""
    return round(value, 6)
