"""G-code as deltacam writes it: what its lines mean, and reading them strictly.

The format is docs/reference/formats/gcode.md; `deltacam.program.gcode_writer` writes it.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO, Final, NamedTuple

import numpy as np

from deltacam.errors import ProgramError
from deltacam.model import Array, IntArray, readonly
from deltacam.program import contents
from deltacam.program.contents import DAMAGED

FULL_POWER: Final = 1000.0
"""The S word of the laser's rated power."""
LINE_UNIT: Final = 1e-3
"""Metres per unit of the coordinates."""
DECIMALS: Final = 6
"""Of a coordinate: a nanometre."""
HEAD: Final = ("G21", "G90", "G17", "G91.1", "G94", "M5")
"""Millimetres, absolute, the plane of x and y, centres relative to the start, feed per minute, laser off."""
WAIT: Final = 4
"""The motion of a wait, as in G4."""

_START: Final = "G0 XY"
_MOTIONS: Final = {"G0 XYF": 0, "G1 XYF": 1, "G2 XYIJF": 2, "G3 XYIJF": 3, "G4 P": WAIT}
_KNOWN: Final = {*HEAD, _START, *_MOTIONS, "M3 S", "M2"}
_LONGEST_LINE: Final = 250
_COMMENT: Final = re.compile(rb"\([ -'*-~]*\)\n")
_COMMAND: Final = re.compile(rb"([GM]\d{1,2}(?:\.\d)?)((?: [A-Z]-?\d{1,9}(?:\.\d{1,9})?)*)\n")
_ROUND: Final = 1e-7  # m; what the radii at both ends of an arc may differ by


@dataclass(frozen=True, slots=True, eq=False)
class Moves:
    """What a file holds, in order; all arrays are read-only.

    Attributes:
        start: where the first move begins, (2,) m in the drawing's coordinates.
        motion: what each is, (M,): 0 a rapid, 1 a line, 2 an arc clockwise, 3 one counter-clockwise, 4 a wait.
        ends: where each ends, (M, 2) m.
        centres: from the start of each arc to its centre, (M, 2) m; zero for the others.
        feed: (M,) m/s; zero for waits.
        power: of the laser's rated power, 0 = off, (M,).
        dwell: how long each wait is, (M,) s; zero for the others.
    """

    start: Array
    motion: IntArray
    ends: Array
    centres: Array
    feed: Array
    power: Array
    dwell: Array

    def __post_init__(self) -> None:
        for name, columns in (("start", None), ("ends", 2), ("centres", 2)):
            object.__setattr__(self, name, readonly(getattr(self, name), columns=columns))
        for name in ("feed", "power", "dwell"):
            object.__setattr__(self, name, readonly(getattr(self, name)))
        motion = np.array(self.motion, dtype=np.int64)
        motion.flags.writeable = False
        object.__setattr__(self, "motion", motion)


class _Line(NamedTuple):
    """A line that is no comment: its number, its command with the letters of its words, and their values."""

    number: int
    code: str
    values: list[float]


def read(stream: BinaryIO, *, name: str) -> Moves:
    """Read the moves of a file that deltacam wrote; other G-code is refused.

    Args:
        stream: binary, at its start.
        name: of the file, for messages.

    Raises:
        ProgramError: a line that is not such a file's, with its number, or a file that was cut off.
    """
    lines = _lines(stream, name)
    for wanted in (*HEAD, _START):
        line = next(lines)
        if line.code != wanted:
            raise _refusal(f"expected {wanted}, found {line.code}", name, line.number)
    found, numbers = [_Move(WAIT, *line.values)], [line.number]
    power = 0.0
    for line in lines:
        if line.code in _MOTIONS:
            found.append(_move(line, found[-1], power))
            numbers.append(line.number)
        elif line.code in ("M5", "M3 S"):
            power = line.values[0] / FULL_POWER if line.values else 0.0
        elif line.code == "M2":
            break
        else:
            raise _refusal(f"{line.code} has no place here", name, line.number)
    if power:
        raise _refusal("the laser is on at the end", name, line.number)
    if stream.read(1):
        raise _refusal("there is something after M2", name, line.number + 1)
    table = np.array(found)
    _check(table, numbers, name)
    return Moves(
        start=LINE_UNIT * table[0, 1:3],
        motion=table[1:, 0],
        ends=LINE_UNIT * table[1:, 1:3],
        centres=LINE_UNIT * table[1:, 3:5],
        feed=LINE_UNIT / 60.0 * table[1:, 5],
        power=table[1:, 6],
        dwell=table[1:, 7],
    )


class _Move(NamedTuple):
    """A move in the units of the file."""

    motion: int
    x: float
    y: float
    i: float = 0.0
    j: float = 0.0
    feed: float = 0.0
    power: float = 0.0
    dwell: float = 0.0


def _move(line: _Line, before: _Move, power: float) -> _Move:
    motion, values = _MOTIONS[line.code], line.values
    if motion == WAIT:
        return _Move(motion, before.x, before.y, power=power, dwell=values[0])
    i, j = values[2:4] if motion > 1 else (0.0, 0.0)
    return _Move(motion, values[0], values[1], i, j, feed=values[-1], power=power)


def _check(table: Array, numbers: list[int], name: str) -> None:
    """Refuses moves that no machine makes: no feed, too much power, a centre that is not the centre of its arc."""
    motion, places, centres, feed, power = table[:, 0], table[:, 1:3], table[:, 3:5], table[:, 5], table[:, 6]
    arc = (motion == 2) | (motion == 3)
    before = np.concatenate([places[:1], places[:-1]])
    radius, other = np.hypot(*centres.T), np.hypot(*(before + centres - places).T)
    wrong = {
        "the feed is not above 0": (motion != WAIT) & (feed <= 0.0),
        f"the power is not from 0 to {FULL_POWER:g}": (power < 0.0) | (power > 1.0),
        "the wait is not above 0": (motion == WAIT) & (table[:, 7] <= 0.0),
        "the arc has not one radius": arc & ((np.abs(radius - other) > _ROUND / LINE_UNIT) | (radius <= 0.0)),
        "a rapid has the laser on": (motion == 0) & (power > 0.0),
    }
    for what, where in wrong.items():
        if where[1:].any():
            raise _refusal(what, name, numbers[int(np.argmax(where[1:])) + 1])


def _lines(stream: BinaryIO, name: str) -> Iterator[_Line]:
    """The lines that are no comments; the last one is M2."""
    size, number = 0, 0
    while text := stream.readline(_LONGEST_LINE + 1):
        number += 1
        size += len(text)
        if size > contents.MAX_BYTES or number > contents.MAX_ROWS:
            raise contents.too_large(name)
        if _COMMENT.fullmatch(text):
            continue
        found = _COMMAND.fullmatch(text)
        words = found[2].decode().split() if found else []
        code = " ".join(filter(None, [found[1].decode() if found else "", "".join(word[0] for word in words)]))
        if code not in _KNOWN:
            shown = text[:60].removesuffix(b"\n").decode("ascii", "backslashreplace")
            raise _refusal(f"{shown!r} is not a line that deltacam writes", name, number)
        yield _Line(number, code, [float(word[1:]) for word in words])
        if code == "M2":
            return
    raise _refusal("there is no M2: the file was cut off", name, number + 1)


def _refusal(what: str, name: str, number: int) -> ProgramError:
    return ProgramError(what, where=f"{name}, line {number}", hint=DAMAGED)
