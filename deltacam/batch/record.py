"""What an earlier run left in a folder of results: a line of JSON for every part, appended as soon as it is known.

A line that a kill cut off counts as not written; so does one that does not look as it should.
"""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, Final, NamedTuple

from deltacam.batch.folder import ResultFolder
from deltacam.batch.parts import Facts, Outcome, Status, Stored
from deltacam.errors import ProgramError
from deltacam.program.atomic import write_whole

NAME: Final = "record.jsonl"


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
            raise ProgramError(f"the record cannot be written: {reason}", where=str(self._path)) from problem
        self.parts[name] = found

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
        raise ProgramError(f"the record cannot be read: {reason}", where=str(path)) from problem
    found: dict[str, Recorded] = {}
    for line in lines:
        with suppress(ValueError, TypeError, KeyError, RecursionError):  # not a line of ours, or not all of it
            values = json.loads(line)
            found[_text(values["part"])] = _recorded(values)
    return found


def _recorded(values: Mapping[str, Any]) -> Recorded:
    """Raises ValueError, TypeError or KeyError where the values are not as we write them."""
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
        time=float(values["time"]),
        cut_length=float(values["cut_length"]),
        size=None if size is None else (float(size[0]), float(size[1])),
        contours=_whole(values["contours"]),
        checks=_whole(values["checks"]),
        failed=tuple(map(_text, values["failed"])),
    )


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise TypeError
    return value


def _whole(value: object) -> int:
    if not isinstance(value, int) or isinstance(value, bool):
        raise TypeError
    return value
