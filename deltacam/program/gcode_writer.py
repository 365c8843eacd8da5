"""Writing the motion as G-code: lines, arcs and waits in the sheet's plane, with feed and laser power.

It is made from the setpoints, through the forward kinematics. The dialect is that of `deltacam.program.gcode`.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import BinaryIO, Final

import numpy as np

from deltacam.errors import ProgramError, RobotError
from deltacam.geometry.follow import follow
from deltacam.model import Array, Block, BlockKind, BoolArray, IntArray, Placement
from deltacam.program import contents
from deltacam.program.gcode import DECIMALS, FULL_POWER, HEAD, LINE_UNIT, WAIT
from deltacam.program.program import Program
from deltacam.program.rows import exact_angles, whole_angles

TOLERANCE: Final = 2e-6
"""Largest distance of a setpoint from the moves, m, before these are rounded to the nanometre."""

_REST: Final = 0.5e-9  # m; a move that is not longer is a wait
_LEAST_FEED: Final = 1e-3  # mm/min; no controller takes 0
_LEAST_POWER: Final = 1e-3  # of the S word; less would be off
_LONGEST_NAME: Final = 60
_MOST_LEVELS: Final = 8  # that are listed
_HARMLESS: Final = re.compile(r"[^A-Za-z0-9 _.+-]")
_LINE: Final = {
    0: "G0 X%s Y%s F%s",
    1: "G1 X%s Y%s F%s",
    2: "G2 X%s Y%s I%s J%s F%s",
    3: "G3 X%s Y%s I%s J%s F%s",
}


def write(program: Program, stream: BinaryIO) -> None:
    """Write the motion of ``program`` to ``stream``; the same program gives the same bytes.

    Raises:
        ProgramError: the program was read from a damaged file, a power is not from 0 to 1, or the tool leaves the
            sheet's plane.
    """
    contents.refuse_damaged(program)
    if program.power.min() < 0.0 or program.power.max() > 1.0:
        raise ProgramError("a power is not from 0 to 1", hint="plan the drawing again")
    places = _tool_path(program)
    changes = np.flatnonzero((np.diff(program.power[:-1]) != 0.0) | (np.diff(program.block[:-1]) != 0)) + 1
    breaks = np.unique(np.concatenate([[0], changes, [len(places) - 1]]))
    knots, bulges = follow(places, breaks, TOLERANCE)
    x, y = map(_number, (places[0] / LINE_UNIT).tolist())
    lines = [*_head(program), f"G0 X{x} Y{y}"]
    lines += _moves(program, places, knots, bulges)
    lines += ["M5", "M2"]
    stream.write("\n".join(lines).encode("ascii") + b"\n")


def _tool_path(program: Program) -> Array:
    """Where the tool is at every tick, in the drawing's coordinates, (N, 2) m.

    Raises:
        ProgramError: a setpoint that no tool position belongs to, or one that is not in the sheet's plane.
    """
    q = exact_angles(whole_angles(program.q))  # as from the file, so that both give the same bytes
    hint = "find out what is wrong with it: deltacam verify"
    try:
        base = program.robot.forward(q)
    except RobotError as problem:
        raise ProgramError(problem.what, where=problem.where, hint=hint) from problem
    off = np.abs(base[:, 2] - program.placement.z)
    if off.max() > TOLERANCE:
        what = f"the tool is {off.max() / LINE_UNIT:.6g} mm out of the sheet's plane at tick {off.argmax()}"
        raise ProgramError(what, hint=hint)
    return _to_sheet(base, program.placement)


def _to_sheet(base: Array, placement: Placement) -> Array:
    cos, sin = np.cos(placement.rotation), np.sin(placement.rotation)
    x, y = base[:, 0] - placement.x, base[:, 1] - placement.y
    return np.column_stack([cos * x + sin * y, cos * y - sin * x])


def _head(program: Program) -> list[str]:
    words = [f"S{_power(level)}" for level in np.unique(program.power).tolist() if level]
    # Where the power follows the speed there are hundreds, and controllers take lines of some 250 characters.
    levels = ", ".join(words) if len(words) <= _MOST_LEVELS else f"{words[0]} to {words[-1]}"
    return [
        f"(motion of {_harmless(program.drawing.file)}, made by deltacam)",
        f"(robot {_harmless(program.robot.name)}, process {_harmless(program.process.name)})",
        f"(mode {program.mode.value}, power {levels or 'none'} of S{FULL_POWER:g})",
        *HEAD,
    ]


def _moves(program: Program, places: Array, knots: IntArray, bulges: Array) -> Iterator[str]:
    """The lines of all pieces, with a comment where a block begins and a line where the power changes."""
    first, ticks = knots[:-1], np.diff(knots)
    ends = np.round(places[knots] / LINE_UNIT, DECIMALS)
    chord = np.diff(ends, axis=0)
    seconds = ticks / program.rate_hz
    rapid = _rapid(program)[first]
    waits = np.hypot(*np.diff(places[knots], axis=0).T) <= _REST
    kind = np.select([waits, bulges > 0.0, bulges < 0.0, rapid], [WAIT, 3, 2, 0], default=1)
    feed = np.maximum(60.0 * _lengths(chord, bulges) / seconds, _LEAST_FEED)
    centre = _centres(chord, bulges)
    columns = (kind, program.block[first], program.power[first], ends[1:, 0], ends[1:, 1], *centre.T, feed, seconds)
    block, power = None, 0.0
    for code, in_block, level, x, y, i, j, speed, wait in zip(*(column.tolist() for column in columns), strict=True):
        if in_block != block:
            block = in_block
            yield _block_comment(program.blocks, block)
        if level != power:
            power = level
            yield f"M3 S{_power(level)}" if level else "M5"
        if code == WAIT:
            yield f"G4 P{_number(wait)}"
        else:
            words = (x, y, i, j) if code > 1 else (x, y)
            yield _LINE[code] % (*map(_number, words), f"{speed:.3f}")


def _rapid(program: Program) -> BoolArray:
    """Which rows (N,) move as fast as the machine can, with the laser off."""
    kinds = np.array([block.kind is BlockKind.RAPID for block in program.blocks] + [False])
    known = (program.block >= 0) & (program.block < len(program.blocks))
    return np.asarray(kinds[np.where(known, program.block, -1)] & (program.power == 0.0))


def _lengths(chord: Array, bulges: Array) -> Array:
    """The lengths of lines and arcs, (M,), in the unit of ``chord`` (M, 2)."""
    half = 2.0 * np.arctan(bulges)
    return np.asarray(np.hypot(chord[:, 0], chord[:, 1]) / np.sinc(half / np.pi))


def _centres(chord: Array, bulges: Array) -> Array:
    """From the start of each arc to its centre, (M, 2) in the unit of ``chord``; anything for lines."""
    lift = np.divide(1.0 - bulges**2, 4.0 * bulges, out=np.zeros_like(bulges), where=bulges != 0.0)
    return np.asarray(0.5 * chord + lift[:, np.newaxis] * np.column_stack([-chord[:, 1], chord[:, 0]]))


def _block_comment(blocks: tuple[Block, ...], index: int) -> str:
    """What a stretch is, such as ``(block 2: cut, contour 3, layer CUT)``."""
    if not 0 <= index < len(blocks):
        return f"(block {index})"
    block = blocks[index]
    words = [f"block {index}: {block.kind.value}"]
    words += [f"contour {block.contour}"] if block.contour is not None else []
    words += [f"layer {_harmless(block.layer)}"] if block.layer else []
    return f"({', '.join(words)})"


def _harmless(name: str) -> str:
    """A name that cannot end a comment or mean anything in it, and that does not make a line too long."""
    return _HARMLESS.sub("_", name[:_LONGEST_NAME])


def _power(level: float) -> str:
    return _number(max(round(level * FULL_POWER, 3), _LEAST_POWER))


def _number(value: float) -> str:
    """Up to 6 decimals: a nanometre, or a microsecond."""
    text = f"{value:.{DECIMALS}f}".rstrip("0").removesuffix(".")
    return "0" if text == "-0" else text
