"""What every format that holds a whole program shares: its limits, the meta object as text, and the check of the rows.

A reader gives the meta object and the rows as it found them. What contradicts itself goes to `Program.integrity`.
"""

from __future__ import annotations

import json
from collections.abc import Iterable
from typing import Final, NamedTuple

import numpy as np

from deltacam.errors import ProgramError
from deltacam.model import Array, IntArray
from deltacam.program import meta as metas
from deltacam.program.program import TICK_COLUMN, Program

VERSION: Final = "1"
"""Of the meta object and the columns; a file of another version is refused."""
MAX_BYTES: Final = 2_000_000_000
"""Largest file that is read."""
MAX_ROWS: Final = 50_000_000
"""Most rows that are read."""
MAX_META: Final = 64 * 2**20
"""Largest meta object that is read, bytes."""
DAMAGED: Final = "the file was damaged or edited; plan the drawing again"


class Rows(NamedTuple):
    """The rows as a file has them.

    Attributes:
        ticks: (N,).
        q: joint angles, (N, 3) rad.
        power: of the laser's rated power, (N,).
        block: index into the blocks, (N,).
        intact: whether their hash is the one that the file states.
    """

    ticks: IntArray
    q: Array
    power: Array
    block: IntArray
    intact: bool


def dump_meta(program: Program, sha256: str) -> str:
    """The meta object on one line: ASCII only, so that no name of a layer can end the line or hide in it.

    Raises:
        ProgramError: the program was read from a damaged file, whose hash must not be repaired; or a value is not
            finite.
    """
    refuse_damaged(program)
    meta = metas.to_meta(program, sha256=sha256)
    try:
        return json.dumps(meta, sort_keys=True, separators=(",", ":"), allow_nan=False)
    except ValueError as problem:
        raise ProgramError("a value of the program is not finite", hint="check the process and placement") from problem


def refuse_damaged(program: Program) -> None:
    """Refuses what no format takes.

    Raises:
        ProgramError: the program was read from a damaged file.
    """
    if program.integrity:
        hint = "plan the drawing again"
        raise ProgramError(f"a damaged program is not written: {program.integrity[0]}", hint=hint)


def refuse_version(version: bytes, where: str) -> None:
    """Refuses what this deltacam may misunderstand.

    Raises:
        ProgramError: another version than `VERSION`.
    """
    if version != VERSION.encode():
        shown = version[:20].decode("ascii", "backslashreplace")
        hint = "read it with the version of deltacam that wrote it"
        raise ProgramError(f"format version {shown!r} is not {VERSION}", where=where, hint=hint)


def too_large(name: str) -> ProgramError:
    """The error for a file beyond the limits."""
    return ProgramError(f"the program is larger than {MAX_BYTES:,} bytes or {MAX_ROWS:,} rows", where=name)


def to_program(meta: metas.Meta, rows: Rows, problems: Iterable[str], *, name: str, place: str, first: int) -> Program:
    """The program that the rows say.

    Args:
        meta: what the file states.
        rows: what the file holds.
        problems: what is wrong with the file besides, one message each.
        name: of the file, for messages.
        place: what a row is called in messages: line, row.
        first: the number of the first one.

    Raises:
        ProgramError: the rows make no program.
    """
    found = [*problems, *_contradictions(meta, rows), *_tick_problems(rows.ticks, place, first)]
    try:
        return Program(
            robot=meta.robot,
            placement=meta.placement,
            process=meta.process,
            drawing=meta.drawing,
            mode=meta.mode,
            blocks=meta.blocks,
            q=rows.q,
            power=rows.power,
            block=rows.block,
            from_contour=meta.from_contour,
            integrity=tuple(found),
        )
    except ValueError as problem:
        raise ProgramError(str(problem), where=name, hint=DAMAGED) from problem


def _contradictions(meta: metas.Meta, rows: Rows) -> list[str]:
    problems = []
    if not rows.intact:
        problems.append("the rows are not those that were written: their SHA-256 is not the one that the file states")
    if meta.rows != len(rows.ticks):
        problems.append(f"the meta object states {meta.rows} rows, the file has {len(rows.ticks)}")
    if meta.rate_hz != meta.robot.controller.rate_hz:
        problems.append(f"rate_hz is {meta.rate_hz:g}, but the robot's is {meta.robot.controller.rate_hz:g}")
    return problems


def _tick_problems(ticks: IntArray, place: str, first: int) -> list[str]:
    """What is wrong with the first tick that is not one more than the tick before it."""
    wrong = np.flatnonzero(ticks != np.arange(len(ticks)))
    if not len(wrong):
        return []
    row = int(wrong[0])
    what = f"expected tick {row}, found {ticks[row]} in {place} {row + first}"
    return [f"{TICK_COLUMN}{what}; {len(wrong)} of {len(ticks)} rows differ"]
