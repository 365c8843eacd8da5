"""The summary of a batch for programs: JSON and CSV; the same bytes for the same results."""

from __future__ import annotations

import csv
import io
import json
from dataclasses import asdict
from typing import Any

from deltacam.batch.parts import Batch, Row


def to_json(batch: Batch) -> str:
    """The batch as one JSON object, indented, ASCII, with a line feed at its end."""
    return json.dumps(to_dict(batch), indent=2, allow_nan=False) + "\n"


def to_dict(batch: Batch) -> dict[str, Any]:
    """The batch as dicts, lists, texts, numbers, booleans and None."""
    return {"passed": batch.passed, "notes": list(batch.notes), "parts": [_part(row) for row in batch.rows]}


def to_csv(batch: Batch) -> str:
    """A line for every part."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(("part", "status", "reason"))
    writer.writerows((row.part, row.outcome.status.value, row.outcome.reason) for row in batch.rows)
    return stream.getvalue()


def _part(row: Row) -> dict[str, Any]:
    return {"part": row.part, "status": row.outcome.status.value, "files": [asdict(file) for file in row.files]}
