"""What of interest to a batch is in a folder, and what of it a list names."""

from __future__ import annotations

import os
import shlex
import stat
from collections.abc import Iterator, Sequence
from enum import Enum
from pathlib import Path
from typing import Final

from deltacam.batch.choosing.rules import FILE
from deltacam.batch.results.folder import PRIVATE
from deltacam.errors import DeltacamError

ENDING: Final = ".dxf"
"""Of drawings, in any case."""

OTHERS: Final = (".dwg", ".dxb", ".svg", ".step", ".stp", ".ai", ".cdr", ".pdf")
"""Endings of files that may be meant to be drawings."""


class Kind(Enum):
    """What a name stands for, and what is said of it where it is left out."""

    DRAWING = ""
    HIDDEN = "hidden, and so left out"
    HIDDEN_FOLDER = "hidden, and so not looked into"
    LINKED_FOLDER = "links to folders, and so not looked into"
    NO_FILE = "neither files nor folders, and so left out"
    OTHER = "not DXF, and so left out"
    RULES = f"not read, because {FILE} counts in the folder of the batch only"


def search(folder: Path) -> Iterator[tuple[str, Kind]]:
    """What of interest is in the folder and below it.

    Yields:
        name, relative to the folder and with ``/``, and what it stands for; that of a folder ends with ``/``.

    Raises:
        DeltacamError: there is no such folder, or it or one below it cannot be read.
    """
    _check(folder)
    waiting = [""]
    while waiting:
        inside = waiting.pop()
        try:
            with os.scandir(folder / inside) as entries:
                there = [(one.name, one.is_dir(follow_symlinks=False), one.is_symlink()) for one in entries]
        except OSError as problem:
            raise _unreadable(problem, folder / inside) from problem
        for last, is_folder, is_link in there:
            name = inside + last
            if is_folder and not last.startswith("."):
                waiting.append(f"{name}/")
            elif is_folder:
                if last != PRIVATE:  # of a batch that wrote its results here: not a word in the second run only
                    yield f"{name}/", Kind.HIDDEN_FOLDER
            elif is_link and stat.S_ISDIR(_mode(folder / name)):
                yield f"{name}/", Kind.LINKED_FOLDER
            elif kind := _kind_of_file(folder, name):
                yield name, kind


def look_up(folder: Path, names: Sequence[str]) -> Iterator[tuple[str, Kind]]:
    """What a list names.

    Args:
        folder: in which all of it must be.
        names: paths as seen from the current folder; empty ones are passed over.

    Yields:
        as `search`; one name may come twice.

    Raises:
        DeltacamError: there is no such folder, or something is not there, not in the folder, or not a drawing.
    """
    _check(folder)
    root = Path(os.path.realpath(folder))
    for given in names:
        if given.strip():
            name = _inside(root, folder, given)
            kind = _kind_of_file(folder, name)
            if kind is None or kind in (Kind.OTHER, Kind.RULES):
                hint = f"list files that end in {ENDING}: find FOLDER -iname '*{ENDING}'"
                raise DeltacamError(f"{given!r} is not a drawing ({ENDING})", where="--list", hint=hint)
            yield name, kind


def _kind_of_file(folder: Path, name: str) -> Kind | None:
    """None for what has nothing to do with drawings."""
    lower = name.lower()
    is_hidden = any(part.startswith(".") for part in name.split("/"))
    if lower.endswith(ENDING):
        mode = _mode(folder / name)  # what cannot be looked at is a drawing: planning it says what is wrong with it
        is_file = mode == 0 or stat.S_ISREG(mode)
        return Kind.HIDDEN if is_hidden else Kind.DRAWING if is_file else Kind.NO_FILE
    if is_hidden:
        return None
    return Kind.RULES if name.endswith(f"/{FILE}") else Kind.OTHER if lower.endswith(OTHERS) else None


def _inside(root: Path, folder: Path, given: str) -> str:
    """The name, relative to the folder, of a file as seen from the current folder; ``root`` is where that really is."""
    path = Path(given)
    try:
        path.lstat()
    except (FileNotFoundError, NotADirectoryError):
        hint = "names are as seen from the folder that you are in, one a line"
        if _mode(folder / given):
            hint += f": {str(folder / given)!r}"
        raise DeltacamError(f"there is no file {given!r}", where="--list", hint=hint) from None
    except (OSError, ValueError) as problem:  # ValueError: a null character in the name
        raise DeltacamError(f"{given!r} cannot be found: {_reason(problem)}", where="--list") from problem
    if stat.S_ISDIR(_mode(path)):
        hint = f"list files: find FOLDER -type f -iname '*{ENDING}'"
        raise DeltacamError(f"{given!r} is a folder, not a drawing", where="--list", hint=hint)
    real = Path(os.path.realpath(path.parent)) / path.name  # of its folder only: links to files are files here
    if not real.is_relative_to(root):
        hint = "name files in that folder, or a folder that all of them are in"
        raise DeltacamError(f"{given!r} is not in the folder {str(folder)!r}", where="--list", hint=hint)
    return real.relative_to(root).as_posix()


def _mode(path: Path) -> int:
    """What a path, or what it links to, is; 0 where that cannot be found out."""
    try:
        return path.stat().st_mode
    except (OSError, ValueError):
        return 0


def _check(folder: Path) -> None:
    """Refuse a folder that is none."""
    try:
        mode = folder.stat().st_mode
    except (FileNotFoundError, NotADirectoryError):
        hint = "check the name, and the folder that you are in"
        raise DeltacamError("there is no such folder", where=str(folder), hint=hint) from None
    except (OSError, ValueError) as problem:
        raise _unreadable(problem, folder) from problem
    if stat.S_ISDIR(mode):
        return
    if folder.name.lower().endswith(ENDING):
        hint = f"deltacam plan {shlex.quote(str(folder))}"
        raise DeltacamError("this is a drawing, not a folder", where=str(folder), hint=hint)
    hint = "name the folder that holds the drawings"
    raise DeltacamError("this is a file, not a folder", where=str(folder), hint=hint)


def _unreadable(problem: Exception, folder: Path) -> DeltacamError:
    hint = "get permission to read it, or name the drawings to plan in a list: --list FILE"
    return DeltacamError(f"the folder cannot be read: {_reason(problem)}", where=str(folder), hint=hint)


def _reason(problem: Exception) -> str:
    return ((problem.strerror if isinstance(problem, OSError) else "") or str(problem)).lower()
