"""The motion as LinuxCNC's halstreamer takes it: a line per tick, three joint angles in degrees and a bit.

The format is docs/reference/formats/halstreamer.md. It has no place for anything else.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import BinaryIO, Final

import numpy as np
import numpy.typing as npt

from deltacam.errors import ProgramError
from deltacam.model import Array, BoolArray, readonly
from deltacam.program import contents
from deltacam.program.lines import parse_lines, whole_lines
from deltacam.program.program import MAX_ANGLE, Program
from deltacam.program.rows import exact_angles, whole_angles

CONFIG: Final = "fffb"
"""What the components streamer and sampler are told about the columns."""
COLUMNS: Final = ("q1_deg", "q2_deg", "q3_deg", "laser")
DECIMALS: Final = 10
"""Of a joint angle in degrees."""

_ROWS_PER_CHUNK: Final = 10_000


@dataclass(frozen=True, slots=True, eq=False)
class Samples:
    """What is played, one sample per period of the thread.

    Attributes:
        angles: of the joints, (N, 3) rad; read-only.
        laser: whether it is on, (N,); read-only.
    """

    angles: Array
    laser: BoolArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "angles", readonly(self.angles, columns=3))
        object.__setattr__(self, "laser", _bits(self.laser))


def write(program: Program, stream: BinaryIO) -> None:
    """Write the motion of ``program`` to ``stream``; the same program gives the same bytes.

    Raises:
        ProgramError: the program was read from a damaged file, it needs more than a bit for the laser, or it ends with
            the laser on, which would stay on.
    """
    contents.refuse_damaged(program)
    levels = np.unique(program.power[program.power != 0.0])
    if len(levels) > 1:
        shown = ", ".join(f"{level:g}" for level in levels[:4].tolist())
        hint = "make one program per power, with plan --layer and --ignore-layer; a power law cannot be played here"
        raise ProgramError(f"the laser can only be on or off here, and the program has powers of {shown}", hint=hint)
    if program.power[-1] != 0.0:
        raise ProgramError("the laser is on in the last row, and would stay on", hint="plan the drawing again")
    for chunk in _format_rows(program):
        stream.write(chunk)


def read(stream: BinaryIO, *, name: str) -> Samples:
    """Read samples as strictly as halstreamer does, which skips lines that it does not understand.

    Args:
        stream: binary, at its start.
        name: of the file, for messages.

    Raises:
        ProgramError: a line is not three numbers and a bit with single spaces between them; says which.
    """
    parts, line, size = [], 1, 0
    for chunk in whole_lines(stream, name):
        table = parse_lines(chunk, name, line, COLUMNS, whole=("laser",), delimiter=" ")
        _check_chunk(chunk, table, name, line)
        parts.append(table)
        line += len(table)
        size += len(chunk)
        if size > contents.MAX_BYTES or line > contents.MAX_ROWS:
            raise contents.too_large(name)
    if not parts:
        raise ProgramError("there is no sample", where=f"{name}, line 1")
    table = np.concatenate(parts)
    return Samples(angles=np.radians(table[:, :3]), laser=table[:, 3] == 1.0)


def _format_rows(program: Program) -> Iterator[bytes]:
    degrees = np.degrees(exact_angles(whole_angles(program.q)))  # as from the file, so that both give the same bytes
    table = np.column_stack([degrees, program.power != 0.0])
    line = f"%.{DECIMALS}f %.{DECIMALS}f %.{DECIMALS}f %d\n"
    for first in range(0, len(table), _ROWS_PER_CHUNK):
        rows = table[first : first + _ROWS_PER_CHUNK]
        yield (line * len(rows) % tuple(rows.ravel().tolist())).encode("ascii")


def _check_chunk(chunk: bytes, table: Array, name: str, first_line: int) -> None:
    """Refuses what is a number, but not what halstreamer takes for a bit, or not an angle."""
    if chunk.count(b" 0\n") + chunk.count(b" 1\n") != len(table):
        good = [row.endswith((b" 0", b" 1")) for row in chunk.split(b"\n")[: len(table)]]
        line = first_line + (good.index(False) if False in good else len(table) - 1)
        raise ProgramError("the line does not end with 0 or 1 and a line feed", where=f"{name}, line {line}")
    large = np.flatnonzero(np.abs(table[:, :3]).max(axis=1) > math.degrees(MAX_ANGLE))
    if len(large):
        what = f"an angle is larger than {math.degrees(MAX_ANGLE):.6g} degrees"
        raise ProgramError(what, where=f"{name}, line {first_line + large[0]}")


def _bits(values: npt.ArrayLike) -> BoolArray:
    array = np.array(values, dtype=np.bool_)
    array.flags.writeable = False
    return array
