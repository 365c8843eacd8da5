"""The folder of results: held by one batch at a time, with whole files only, and a record of what made them."""

from __future__ import annotations

import errno
import hashlib
import os
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Final

from filelock import FileLock, Timeout

from deltacam.batch.parts import Part, Status, Stored
from deltacam.errors import ProgramError
from deltacam.program.atomic import write_whole
from deltacam.program.outputs import Outputs
from deltacam.report.page import plotly_js

PRIVATE: Final = ".deltacam-batch"
"""The folder, in that of the results, of the record, the lock and files that are not whole yet."""

PLOTLY: Final = "plotly.min.js"
"""The copy of plotly.js that all pages share."""

ENDINGS: Final = (".report.json", ".report.html", ".program.csv")
"""Of the files of a part, in the order in which they are written: a program never lies there without its reports."""

_ENDINGS_OF: Final = {Status.PASSED: ENDINGS, Status.FAILED: ENDINGS[:-1]}
"""Of the files of a part that ended like this; else there are none."""


class ResultFolder:
    """The folder; made by `hold`.

    Args:
        path: of it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.private = path / PRIVATE

    def write(self, name: str, content: bytes) -> Stored:
        """Write a file of that name, relative to the folder, whole or not at all.

        Raises:
            ProgramError: the operating system refuses.
        """
        path = self.path / name
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
        except OSError as problem:
            raise _refused(problem, "the folder cannot be made", path.parent) from problem
        write_whole(path, content, by_way_of=self.private)
        return Stored(name, hashlib.sha256(content).hexdigest(), len(content))

    def store(self, part: Part, files: Mapping[str, bytes]) -> tuple[Stored, ...]:
        """Write the files of a part, the program last; where that fails, none of them is left.

        Raises:
            ProgramError: the operating system refuses.
        """
        try:
            return tuple(self.write(part.stem + ending, files[ending]) for ending in ENDINGS if ending in files)
        except BaseException:
            with suppress(ProgramError):
                self.clear(part)
            raise

    def clear(self, part: Part) -> None:
        """Remove what an earlier run left of a part, so that no program is used by mistake.

        Raises:
            ProgramError: the operating system refuses.
        """
        at = self.path / part.name
        Outputs.of(at, at.parent).clear()

    def remove(self, name: str) -> None:
        """Remove a file of that name, relative to the folder, where there is one.

        Raises:
            ProgramError: the operating system refuses.
        """
        path = self.path / name
        try:
            path.unlink(missing_ok=True)
        except OSError as problem:
            raise _refused(problem, "the file of an earlier run cannot be removed", path) from problem

    def has_any(self, files: Sequence[Stored]) -> bool:
        """Whether at least one file of these names is there."""
        return any(os.path.lexists(self.path / file.name) for file in files)

    def holds(self, part: Part, status: Status, files: Sequence[Stored]) -> bool:
        """Whether these are all files of a part that ended like this, and are there with the content that they had."""
        expected = [part.stem + ending for ending in _ENDINGS_OF.get(status, ())]
        there = (_sha256(self.path / file.name) == file.sha256 for file in files)
        return [file.name for file in files] == expected and all(there)


@contextmanager
def hold(path: Path) -> Iterator[ResultFolder]:
    """The folder of results, made where it is missing, for this batch alone.

    Files that a batch which was killed did not finish are removed.

    Raises:
        ProgramError: another batch writes to it, or it cannot be written to.
    """
    folder = ResultFolder(path)
    try:
        if path.exists() and not path.is_dir():
            raise ProgramError("this is a file, not a folder", where=str(path), hint="name a folder with -o")
        folder.private.mkdir(parents=True, exist_ok=True)
    except OSError as problem:
        raise _refused(problem, "the folder cannot be written to", path) from problem
    try:
        lock = FileLock(folder.private / "lock", timeout=0)
        lock.acquire()
    except Timeout:
        hint = "wait until it has ended, or choose another folder with -o"
        raise ProgramError("another batch is writing to this folder", where=str(path), hint=hint) from None
    except (OSError, NotImplementedError) as problem:
        raise _refused(problem, "the folder cannot be locked", path) from problem
    try:
        for left in folder.private.glob("*.tmp"):
            with suppress(OSError):
                left.unlink()
        yield folder
    finally:
        lock.release()


def share_plotly(folder: ResultFolder) -> None:
    """See that the folder holds the copy of plotly.js that the pages use.

    Raises:
        ProgramError: the operating system refuses.
    """
    content = plotly_js().encode()
    if _sha256(folder.path / PLOTLY) != hashlib.sha256(content).hexdigest():
        folder.write(PLOTLY, content)


def is_full(problem: ProgramError) -> bool:
    """Whether nothing else can be written either."""
    cause = problem.__cause__
    return isinstance(cause, OSError) and cause.errno in (errno.ENOSPC, errno.EDQUOT, errno.EROFS)


def library_of(part: str) -> str:
    """Where `PLOTLY` lies, relative to the page of a part of that name."""
    return "../" * part.count("/") + PLOTLY


def _sha256(path: Path) -> str:
    """Of the content; empty where it cannot be read."""
    try:
        with path.open("rb") as stream:
            return hashlib.file_digest(stream, "sha256").hexdigest()
    except OSError:
        return ""


def _refused(problem: Exception, what: str, path: Path) -> ProgramError:
    reason = ((problem.strerror if isinstance(problem, OSError) else "") or str(problem)).lower()
    hint = "choose another folder with -o, or make room and permission there"
    return ProgramError(f"{what}: {reason}", where=os.fspath(path), hint=hint)
