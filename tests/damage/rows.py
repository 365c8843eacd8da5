"""Changing rows of a program such that nothing that the file says about itself gives it away."""

from dataclasses import replace

import numpy as np

from deltacam.model import Array, BoolArray, IntArray
from deltacam.program.program import Program


def gathered(program: Program, index: IntArray) -> Program:
    """The program of the rows ``index``, in that order, with a table of blocks that agrees with them."""
    return tabled(
        replace(program, q=program.q[index], power=program.power[index], block=program.block[index]),
    )


def tabled(program: Program) -> Program:
    """The program with a table that has a block for every stretch of equal indices in its column."""
    column = program.block
    starts = np.flatnonzero(np.diff(column, prepend=column[0] - 1))
    ends = np.append(starts[1:], len(column)) - 1
    blocks = [
        replace(program.blocks[int(column[first])], first=first, last=last)
        for first, last in zip(starts.tolist(), ends.tolist(), strict=True)
    ]
    return replace(program, blocks=tuple(blocks), block=np.repeat(np.arange(len(blocks)), ends - starts + 1))


def with_q(program: Program, rows: IntArray | int, q: Array) -> Program:
    """The program with other joint angles in some rows."""
    changed = program.q.copy()
    changed[rows] = q
    return replace(program, q=changed)


def with_power(program: Program, rows: IntArray | BoolArray | int, power: Array | float) -> Program:
    """The program with another power in some rows."""
    changed = program.power.copy()
    changed[rows] = power
    return replace(program, power=changed)


def at_points(program: Program, rows: IntArray, tool: Array) -> Program:
    """The program with the tool at ``tool`` (M, 3) m of the base frame in the rows (M,)."""
    return with_q(program, rows, program.robot.inverse(tool))
