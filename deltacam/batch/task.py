"""One part, planned: a task to its result. Nothing of it is raised, and nothing is read or written."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import asdict, is_dataclass
from enum import Enum
from importlib.metadata import version
from pathlib import PurePosixPath
from typing import Any, Final

from deltacam import pipeline
from deltacam.batch.parts import Facts, Outcome, Part, Result, Status, Task
from deltacam.batch.thumbnail import Lines, thumbnail
from deltacam.batch.worker import TOO_LITTLE
from deltacam.drawing.reader import read_drawing
from deltacam.errors import DeltacamError
from deltacam.model import Report

LAYOUT: Final = 1
"""Counts up when a batch writes other files for the same program, so that parts are planned again."""


def sha256(data: bytes) -> str:
    """The SHA-256 of the bytes, hexadecimal."""
    return hashlib.sha256(data).hexdigest()


def key_of(part: Part, data: bytes) -> str:
    """Names all that the files of a part follow from: a SHA-256, hexadecimal.

    Args:
        part: its name is in the program, and the depth of its folder in the page.
        data: the bytes of the drawing.
    """
    content = {
        "deltacam": version("deltacam"),
        "layout": LAYOUT,
        "name": part.name,
        "drawing": sha256(data),
        "options": _plain(part.options),
    }
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), allow_nan=False)
    return sha256(text.encode())


def perform(task: Task) -> Result:
    """Plan and verify a part; whatever goes wrong is the outcome, but for an interrupt."""
    file = PurePosixPath(task.name).name
    try:
        planned = pipeline.plan(file, data=task.data, jobs=1, **task.options)
        data, page = pipeline.reports_of(planned, library=task.library)
        outcome = _outcome(planned.report, thumbnail(planned.drawing), task)
    except DeltacamError as problem:
        return _refused(problem, file, task)
    except MemoryError:
        return Result(_ended(Status.MEMORY, task, TOO_LITTLE))
    except Exception as problem:  # noqa: BLE001 - the last resort: the other parts are planned all the same
        what = f"a fault of deltacam: {type(problem).__name__}: {problem}"
        return Result(_ended(Status.FAULT, task, what, hint="report it with the drawing"))
    files = {".report.json": data, ".report.html": page}
    return Result(outcome, {**files, ".program.csv": planned.content} if planned.report.passed else files)


def _outcome(report: Report, picture: Lines, task: Task) -> Outcome:
    summary = report.summary
    failed = tuple(check.name for check in report.checks if not (check.passed or check.warns))
    size = summary.get("part_size_mm")
    facts = Facts(
        time=summary["program"]["duration_s"],
        cut_length=(summary["cut_length_mm"] + summary["engraved_length_mm"]) / 1e3,
        size=(size[0] / 1e3, size[1] / 1e3) if size else None,
        contours=summary["contours_cut"] + summary["contours_engraved"],
        checks=len(report.checks),
        failed=failed,
    )
    return _ended(
        Status.PASSED if report.passed else Status.FAILED,
        task,
        f"failed: {', '.join(failed)}" if failed else "",
        warnings=tuple(report.warnings),
        facts=facts,
        thumbnail=picture,
    )


def _refused(problem: DeltacamError, file: str, task: Task) -> Result:
    """What must be changed, with a picture of the drawing where that can be read all the same."""
    given = {key: task.options[key] for key in ("unit", "selection") if key in task.options}
    default_unit = task.options.get("default_unit") or "mm"  # the size of the picture does not count
    try:
        drawing = read_drawing(file, data=task.data, default_unit=default_unit, strict=False, **given)
        picture = thumbnail(drawing)
    except Exception:  # noqa: BLE001 - the reason is said already
        picture = ()
    where = problem.where.removeprefix(file).removeprefix(": ").removeprefix(", ").strip()
    outcome = _ended(Status.REFUSED, task, problem.what, where=where, hint=problem.hint, thumbnail=picture)
    return Result(outcome)


def _ended(status: Status, task: Task, what: str, **others: Any) -> Outcome:
    robot, process = (getattr(task.options.get(key), "name", "") for key in ("robot", "process"))
    return Outcome(status=status, what=what, robot=robot, process=process, **others)


def _plain(value: Any) -> Any:
    """The value as JSON has it."""
    if is_dataclass(value) and not isinstance(value, type):
        return {"": type(value).__name__, **{key: _plain(each) for key, each in asdict(value).items()}}
    if isinstance(value, Enum):
        return value.value
    if isinstance(value, Mapping):
        return {str(key): _plain(each) for key, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(each) for each in value]
    return value
