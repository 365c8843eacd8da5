"""What flows through a batch: parts become tasks, tasks become results, and results become rows."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from pathlib import Path, PurePosixPath
from typing import Any, Final


class Status(StrEnum):
    """How a part ended."""

    PASSED = "passed"
    """Planned, every check passed, all files are there."""
    FAILED = "failed"
    """Planned, but a check failed: the reports are there, and no program."""
    REFUSED = "refused"
    """The drawing, the robot or the process must be changed."""
    FAULT = "fault"
    """A fault of deltacam."""
    CRASHED = "crashed"
    """The process that planned it ended."""
    TIMEOUT = "timeout"
    """It took longer than a part may."""
    MEMORY = "memory"
    """It needed more memory than a part may."""
    UNWRITTEN = "unwritten"
    """Planned, but its files could not be written."""
    LEFT = "left"
    """The batch was stopped before."""

    @property
    def lasts(self) -> bool:
        """Whether the same input always ends like this, so that it is not planned again."""
        return self in (Status.PASSED, Status.FAILED, Status.REFUSED)


@dataclass(frozen=True, slots=True)
class Part:
    """A drawing of the batch.

    Attributes:
        name: its place in the folder, with ``/``: ``brackets/left.dxf``. No two parts have one name.
        path: where its file is.
        options: of `pipeline.plan`, with the robot and the process loaded.
        quantity: how many are wanted, >= 1; for the totals only.
    """

    name: str
    path: Path
    options: Mapping[str, Any]
    quantity: int = 1

    @property
    def stem(self) -> str:
        """The place of its files in the folder of results, without an ending: ``brackets/left``."""
        return str(PurePosixPath(self.name).with_suffix(""))


@dataclass(frozen=True, slots=True)
class Limits:
    """What planning one part may take.

    Attributes:
        time: s; None for any.
        memory: of the process that plans, bytes; None for any.
    """

    time: float | None = None
    memory: int | None = None


TOO_LITTLE: Final = "the memory that a part may take is not enough"
MORE: Final = "let it take more with --memory, or plan fewer parts at a time with --jobs"
"""What is said of a part that needs more memory than it may take, and what to do."""


@dataclass(frozen=True, slots=True)
class Task:
    """All that planning a part needs, in bytes: whoever plans it needs no file.

    Attributes:
        name: of the part.
        data: the bytes of the drawing.
        options: of `pipeline.plan`.
        key: names the part's content, the options and the version of deltacam, as `key.key_of` makes it.
        library: where plotly.js lies, relative to the page of the part.
    """

    name: str
    data: bytes
    options: Mapping[str, Any]
    key: str
    library: str


@dataclass(frozen=True, slots=True)
class Facts:
    """What is known of a program that was planned.

    Attributes:
        time: of the program, s.
        cut_length: m, with the engraved length.
        size: width and height of the part, m; None where nothing is cut.
        contours: how many are cut or engraved.
        checks: how many were made.
        failed: the names of those that failed.
    """

    time: float
    cut_length: float
    size: tuple[float, float] | None
    contours: int
    checks: int
    failed: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True)
class Outcome:
    """What became of a part; the same for the same input.

    Attributes:
        status: how it ended.
        what: went wrong, in one line; empty where nothing did.
        where: the place of it, if any.
        hint: what to do about it, if anything.
        warnings: of the report.
        robot: the robot's name.
        process: the process's name.
        facts: None where no program was planned.
        thumbnail: lines through whole numbers x, y, x, y, ... from 0 to `thumbnail.SPAN`, y up; empty where nothing
            could be read.
    """

    status: Status
    what: str = ""
    where: str = ""
    hint: str = ""
    warnings: tuple[str, ...] = ()
    robot: str = ""
    process: str = ""
    facts: Facts | None = None
    thumbnail: tuple[tuple[int, ...], ...] = ()

    @property
    def reason(self) -> str:
        """What went wrong, and where."""
        return f"{self.where}: {self.what}" if self.where else self.what


@dataclass(frozen=True, slots=True, eq=False)
class Result:
    """What planning a part gave.

    Attributes:
        outcome: of it.
        files: the bytes by the ending of the name: ``.report.json``, ``.report.html``, and ``.program.csv`` only where
            every check passed.
    """

    outcome: Outcome
    files: Mapping[str, bytes] = field(default_factory=dict)


@dataclass(frozen=True, slots=True)
class Stored:
    """A file of a part in the folder of results.

    Attributes:
        name: relative to the folder, with ``/``.
        sha256: hexadecimal.
        size: bytes.
    """

    name: str
    sha256: str
    size: int


@dataclass(frozen=True, slots=True)
class Row:
    """A part and what became of it.

    Attributes:
        part: its name.
        quantity: how many are wanted.
        outcome: of it.
        files: what is in the folder of results, the program last.
        drawing_sha256: of the drawing; empty where it could not be read.
        key: as in `Task`; empty likewise.
        again: whether nothing was planned, because an earlier run had.
    """

    part: str
    quantity: int
    outcome: Outcome
    files: tuple[Stored, ...] = ()
    drawing_sha256: str = ""
    key: str = ""
    again: bool = False

    def file(self, ending: str) -> str:
        """The name of the file with that ending; empty where there is none."""
        return next((file.name for file in self.files if file.name.endswith(ending)), "")


@dataclass(frozen=True, slots=True)
class Batch:
    """What became of all parts.

    Attributes:
        rows: in the order of the names.
        notes: sentences that a person should know: what was left out, and what is left over.
    """

    rows: tuple[Row, ...]
    notes: tuple[str, ...] = ()

    def count(self, *statuses: Status) -> int:
        """How many parts ended in one of these ways."""
        return sum(row.outcome.status in statuses for row in self.rows)

    @property
    def passed(self) -> bool:
        """Whether every part passed."""
        return self.count(Status.PASSED) == len(self.rows)
