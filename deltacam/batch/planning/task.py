"""One part, planned: a task to its result. Nothing of it is raised, and nothing is read or written."""

from __future__ import annotations

from pathlib import PurePosixPath
from typing import Any, Final

from deltacam import pipeline
from deltacam.batch.parts import MORE, TOO_LITTLE, Facts, Outcome, Result, Status, Task
from deltacam.batch.results.thumbnail import Lines, thumbnail
from deltacam.drawing.reader import read_drawing
from deltacam.errors import DeltacamError
from deltacam.model import Report

_OUT_OF_MEMORY: Final = ("bad_alloc", "failed to map segment", "annot allocate memory")
"""What libraries in C++, and the loader of libraries, say."""

_SMALL: Final = (
    b"0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n0\nSECTION\n2\nENTITIES\n"
    b"0\nCIRCLE\n8\n0\n10\n0.0\n20\n0.0\n40\n2.0\n0\nENDSEC\n0\nEOF\n"
)
"""A drawing of a disc."""


def get_ready() -> None:
    """Plan a small part, so that all libraries are loaded and have the memory that they keep.

    The routines for matrices do not say that they got no memory, they try for ever: so they get theirs before there is
    a limit.
    """
    pipeline.reports_of(pipeline.plan("ready.dxf", data=_SMALL, jobs=1, what_if=False), library="")


def perform(task: Task) -> Result:
    """Plan and verify a part; whatever goes wrong is the outcome, but for an interrupt."""
    file = PurePosixPath(task.name).name
    try:
        planned = pipeline.plan(file, data=task.data, jobs=1, **task.options)
        data, page = pipeline.reports_of(planned, library=task.library)
        outcome = _outcome(planned.report, thumbnail(planned.drawing), task)
    except Exception as problem:  # noqa: BLE001 - the last resort: the other parts are planned all the same
        if _is_for_want_of_memory(problem):
            return Result(_ended(Status.MEMORY, task, TOO_LITTLE, hint=MORE))
        if isinstance(problem, DeltacamError):
            return _refused(problem, file, task)
        what = f"a fault of deltacam: {type(problem).__name__}: {problem}"
        return Result(_ended(Status.FAULT, task, what, hint="report it with the drawing"))
    files = {".report.json": data, ".report.html": page}
    return Result(outcome, {**files, ".program.csv": planned.content} if planned.report.passed else files)


def _is_for_want_of_memory(problem: BaseException | None) -> bool:
    """Whether that is what began it, whatever was made of it on the way."""
    while problem is not None:
        if isinstance(problem, MemoryError) or any(sign in str(problem) for sign in _OUT_OF_MEMORY):
            return True
        problem = problem.__cause__ or problem.__context__
    return False


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
