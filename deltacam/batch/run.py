"""A batch: every part planned and verified, nothing twice, nothing lost."""

from __future__ import annotations

import threading
from collections.abc import Callable, Generator, Iterator, Sequence
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path
from typing import Protocol

from deltacam.batch.parts import Batch, Outcome, Part, Result, Row, Status, Stored, Task
from deltacam.batch.planning.key import key_of, sha256
from deltacam.batch.results.folder import ResultFolder, hold, is_full, library_of, share_plotly
from deltacam.batch.results.index import to_html
from deltacam.batch.results.listing import to_csv, to_json
from deltacam.batch.results.record import Record, Recorded
from deltacam.drawing.dxf.document import read_bytes
from deltacam.errors import DeltacamError, ProgramError

SUMMARIES = {"batch.json": to_json, "batch.csv": to_csv, "index.html": to_html}
"""The files that say what became of all parts, and how each is made."""


class Planner(Protocol):
    """What plans: processes of this machine, or of a cluster."""

    def __call__(self, tasks: Iterator[Task], *, stop: threading.Event) -> Generator[tuple[Task, Result]]:
        """What becomes of every task, in any order, until ``stop`` is set; what plans ends when this is closed."""


def run(
    parts: Sequence[Part],
    output: Path,
    *,
    planner: Planner,
    force: bool = False,
    notes: Sequence[str] = (),
    stop: threading.Event | None = None,
    tell: Callable[[Row], None] = lambda _row: None,
) -> Batch:
    """Plan and verify every part, and write what comes of it into a folder, with a summary.

    A part whose files are there, made from the same drawing, robot, process and other options by the same version, is
    not planned again.

    Args:
        parts: of different names, also without their endings.
        output: the folder of results; made where it is missing.
        planner: plans.
        force: plan also what is there.
        notes: for the summary.
        stop: once it is set, what is not begun is left for another run; a full disk sets it too.
        tell: is told of every part as soon as it is known.

    Returns:
        a row for every part.

    Raises:
        DeltacamError: two parts would have the same files, the folder cannot be used, or nothing can be planned at
            all; what was done by then is there, and the next run does the rest.
    """
    stop = stop or threading.Event()
    by_name = _by_name(parts)
    with hold(output) as folder:
        record = Record(folder)
        state = _Run(folder, record, by_name, stop, tell)
        for name in SUMMARIES:
            folder.remove(name)
        share_plotly(folder)
        state.begin(force=force)
        with closing(planner(state.tasks(), stop=stop)) as results:
            for task, result in results:
                state.store(task, result)
        batch = state.end(notes)
        _summarize(folder, batch)
        with suppress(ProgramError):  # the lines that were appended say the same
            record.compact()
        return batch


def _by_name(parts: Sequence[Part]) -> dict[str, Part]:
    """Raises DeltacamError where the files of one part would take the place of those of another."""
    owners: dict[str, str] = {}
    for part in parts:
        if part.stem in owners:
            what = f"{owners[part.stem]!r} and {part.name!r} would have the same files"
            raise DeltacamError(what, hint="rename one of them")
        owners[part.stem] = part.name
    return {part.name: part for part in parts}


def _summarize(folder: ResultFolder, batch: Batch) -> None:
    """Write what became of all parts, or nothing.

    Raises:
        ProgramError: the operating system refuses.
    """
    try:
        for name, write in SUMMARIES.items():
            folder.write(name, write(batch).encode())
    except ProgramError:
        for name in SUMMARIES:
            folder.remove(name)
        raise


class _Run:
    """What is known of every part so far.

    Args:
        folder: held.
        record: of it.
        parts: by their names.
        stop: is set where the disk is full.
        tell: is told of every row.
    """

    def __init__(
        self,
        folder: ResultFolder,
        record: Record,
        parts: dict[str, Part],
        stop: threading.Event,
        tell: Callable[[Row], None],
    ) -> None:
        self._folder, self._record, self._parts, self._stop, self._tell = folder, record, parts, stop, tell
        self._rows: dict[str, Row] = {}
        self._todo: list[tuple[int, str]] = []
        self._why_left = "the batch was stopped before"

    def begin(self, *, force: bool) -> None:
        """Find out what is there already, and remove what was made from something else."""
        for name, part in sorted(self._parts.items()):
            if self._stop.is_set():
                return
            data = self._read(part)
            if data is None:
                continue
            found = self._record.parts.get(name)
            if found and not force and self._is_there(part, found, key_of(part, data)):
                self._keep(part, found, data)
            elif self._clear(part):
                self._todo.append((len(data), name))

    def tasks(self) -> Iterator[Task]:
        """What is to be planned, large drawings first, so that no long one is left for the end."""
        for _, name in sorted(self._todo, key=lambda one: (-one[0], one[1])):
            part = self._parts[name]
            data = self._read(part)  # again, so that memory holds few at a time
            if data is not None:
                yield Task(name, data, part.options, key_of(part, data), library_of(name))

    def store(self, task: Task, result: Result) -> None:
        """Write the files of a part, and that it is done."""
        part, outcome = self._parts[task.name], result.outcome
        files: tuple[Stored, ...] = ()
        try:
            files = self._folder.store(part, result.files)
            if outcome.status.lasts:
                self._record.add(task.name, Recorded(task.key, outcome, files))
        except ProgramError as problem:
            with suppress(ProgramError):
                self._folder.clear(part)
            files, outcome = (), _unwritten(outcome, problem)
            if is_full(problem):
                self._why_left = "the batch was stopped because the disk is full"
                self._stop.set()
        self._put(Row(part.name, part.quantity, outcome, files, sha256(task.data), task.key))

    def end(self, notes: Sequence[str]) -> Batch:
        """The rows of all parts."""
        for name, part in self._parts.items():
            if name not in self._rows:
                self._put(Row(name, part.quantity, Outcome(Status.LEFT, self._why_left, hint="run it again")))
        for name in [name for name in self._record.parts if name not in self._parts]:
            if not self._folder.has_any(self._record.parts[name].files):
                self._record.forget(name)
        others = sorted(self._record.parts.keys() - self._parts.keys())
        left_over = [f"not of this batch, but of an earlier one: {', '.join(others)}"] if others else []
        return Batch(tuple(self._rows[name] for name in sorted(self._rows)), (*notes, *left_over))

    def _read(self, part: Part) -> bytes | None:
        """The bytes of the drawing; where they cannot be read, that is what became of it."""
        try:
            return read_bytes(part.path)
        except DeltacamError as problem:
            if self._clear(part):
                self._put(Row(part.name, part.quantity, Outcome(Status.REFUSED, problem.what, hint=problem.hint)))
            return None

    def _is_there(self, part: Part, found: Recorded, key: str) -> bool:
        status = found.outcome.status
        return found.key == key and status.lasts and self._folder.holds(part, status, found.files)

    def _clear(self, part: Part) -> bool:
        """Whether nothing of a part is left; where something is, that is what became of it."""
        self._record.forget(part.name)
        try:
            self._folder.clear(part)
        except ProgramError as problem:
            self._put(Row(part.name, part.quantity, _unwritten(Outcome(Status.UNWRITTEN), problem)))
            return False
        return True

    def _keep(self, part: Part, found: Recorded, data: bytes) -> None:
        row = Row(part.name, part.quantity, found.outcome, found.files, sha256(data), found.key, again=True)
        self._put(row)

    def _put(self, row: Row) -> None:
        self._rows[row.part] = row
        self._tell(row)


def _unwritten(outcome: Outcome, problem: ProgramError) -> Outcome:
    """Without the path, so that it is the same wherever the folder lies."""
    return replace(outcome, status=Status.UNWRITTEN, what=problem.what, where="", hint=problem.hint)
