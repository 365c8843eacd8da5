"""What an earlier run left in a folder of results: a line of JSON for every part, appended as soon as it is known.

A line that a kill cut off counts as not written; so does one that does not look as it should.
"""

from __future__ import annotations

import json
import math
import os
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final, NamedTuple

from deltacam.batch.parts import Facts, Outcome, Status, Stored
from deltacam.batch.results.folder import ResultFolder
from deltacam.errors import ProgramError
from deltacam.program.atomic import write_whole

NAME: Final = "record.jsonl"

_ROOM: Final = "choose another folder with -o, or make room and permission there"


_NOT_OURS: Final = (ValueError, TypeError, LookupError, ArithmeticError, RecursionError)
"""What comes of reading a line that is not one of ours, or not all of it."""


class Recorded(NamedTuple):
    """How a part ended once.

    Attributes:
        key: what it was made from.
        outcome: of it.
        files: that were written.
    """

    key: str
    outcome: Outcome
    files: tuple[Stored, ...]


class Record:
    """The record of a folder.

    Args:
        folder: held by this batch.
    """

    def __init__(self, folder: ResultFolder) -> None:
        self._path = folder.private / NAME
        self.parts: dict[str, Recorded] = _read(self._path)

    def add(self, name: str, found: Recorded) -> None:
        """Append a part; it is on the disk when this returns.

        Raises:
            ProgramError: the operating system refuses.
        """
        try:
            with self._path.open("ab") as stream:
                stream.write(b"\n" + _line(name, found))  # first ends what a kill may have cut off
                stream.flush()
                os.fsync(stream.fileno())
        except OSError as problem:
            reason = (problem.strerror or str(problem)).lower()
            what = f"the record cannot be written: {reason}"
            raise ProgramError(what, where=str(self._path), hint=_ROOM) from problem
        self.parts[name] = found

    def forget(self, name: str) -> None:
        """Know nothing of a part any more, because its files are not what they were; nothing is written."""
        self.parts.pop(name, None)

    def compact(self) -> None:
        """Write one line for every part, in the order of the names: the same for the same parts.

        Raises:
            ProgramError: the operating system refuses.
        """
        write_whole(self._path, b"".join(_line(name, self.parts[name]) for name in sorted(self.parts)))


def _line(name: str, found: Recorded) -> bytes:
    values = {"part": name, "key": found.key, "outcome": asdict(found.outcome), "files": list(map(asdict, found.files))}
    return json.dumps(values, separators=(",", ":"), allow_nan=False).encode() + b"\n"


def _read(path: Path) -> dict[str, Recorded]:
    try:
        lines = path.read_bytes().splitlines()
    except FileNotFoundError:
        return {}
    except OSError as problem:
        reason = (problem.strerror or str(problem)).lower()
        hint = "remove it, and every part is planned again"
        raise ProgramError(f"the record cannot be read: {reason}", where=str(path), hint=hint) from problem
    found: dict[str, Recorded] = {}
    for line in lines:
        with suppress(*_NOT_OURS):
            values = json.loads(line, parse_constant=_refuse)
            found[_text(values["part"])] = _recorded(values)
    return found


def _recorded(values: Mapping[str, Any]) -> Recorded:
    """Raises one of `_NOT_OURS` where the values are not as we write them."""
    given, facts = dict(values["outcome"]), values["outcome"]["facts"]
    given["status"] = Status(given["status"])
    given["warnings"] = tuple(map(_text, given["warnings"]))
    given["thumbnail"] = tuple(tuple(map(_whole, line)) for line in given["thumbnail"])
    given["facts"] = None if facts is None else _facts(facts)
    for key in ("what", "where", "hint", "robot", "process"):
        _text(given[key])
    files = tuple(Stored(_text(f["name"]), _text(f["sha256"]), _whole(f["size"])) for f in values["files"])
    return Recorded(_text(values["key"]), Outcome(**given), files)


def _facts(values: Mapping[str, Any]) -> Facts:
    size = values["size"]
    return Facts(
        time=_number(values["time"]),
        cut_length=_number(values["cut_length"]),
        size=None if size is None else (_number(size[0]), _number(size[1])),
        contours=_whole(values["contours"]),
        checks=_whole(values["checks"]),
        failed=tuple(map(_text, values["failed"])),
    )


def _refuse(constant: str) -> float:
    """No figure of ours is NaN or infinite."""
    raise ValueError(constant)


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError
    return value


def _number(value: object) -> float:
    """As it is, so that it is written as before: 3 does not become 3.0."""
    if not isinstance(value, (int, float)) or isinstance(value, bool) or not math.isfinite(value):
        raise TypeError
    return value


def _whole(value: object) -> int:
    if not isinstance(value, int) or isinstance(value, bool):
        raise TypeError
    return value
