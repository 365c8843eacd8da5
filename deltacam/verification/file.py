"""Checks of what the file says about itself: its bytes, its ticks, its table of blocks, its robot."""

from __future__ import annotations

import numpy as np

from deltacam.model import Block, Check, IntArray
from deltacam.program.program import TICK_COLUMN, Program
from deltacam.verification.evidence import Evidence


def integrity(evidence: Evidence) -> Check:
    """The file is as deltacam wrote it."""
    problems = [text for text in evidence.program.integrity if not text.startswith(TICK_COLUMN)]
    return Check("file integrity", not problems, float(len(problems)), 0.0, "problems", where="; ".join(problems))


def tick_continuity(evidence: Evidence) -> Check:
    """The ticks count from 0 without a gap."""
    problems = [text.removeprefix(TICK_COLUMN) for text in evidence.program.integrity if text.startswith(TICK_COLUMN)]
    return Check("tick continuity", not problems, float(len(problems)), 0.0, "problems", where="; ".join(problems))


def block_table(evidence: Evidence) -> Check:
    """The table of blocks covers every tick once, in order, and agrees with the block column."""
    tick, what = _first_disagreement(evidence.program)
    return Check("block table", not what, tick=tick if what else None, where=what)


def robot(evidence: Evidence) -> Check:
    """The program was made for the robot that it is checked against."""
    same = evidence.program.robot.fingerprint == evidence.robot.fingerprint
    words = f"made for {evidence.program.robot.name}, checked against {evidence.robot.name}, whose values differ"
    return Check("robot", same, where="" if same else words)


def _first_disagreement(program: Program) -> tuple[int, str]:
    """The first tick at which table and column differ, and how; empty text where nothing differs."""
    following = 0
    for index, block in enumerate(program.blocks):
        if block.first != following or block.last < block.first:
            what = f"block {index} is stated for ticks {block.first} to {block.last}, but {following} is next"
            return min(following, len(program.q) - 1), what
        following = block.last + 1
    if following != len(program.q):
        what = f"the table covers ticks 0 to {following - 1}, the program has 0 to {len(program.q) - 1}"
        return min(following, len(program.q) - 1), what
    expected = _expected(program.blocks)
    wrong = np.flatnonzero(expected != program.block)
    if not len(wrong):
        return 0, ""
    tick = int(wrong[0])
    what = f"the row says block {program.block[tick]}, the table {expected[tick]}; {len(wrong)} rows differ"
    return tick, what


def _expected(blocks: tuple[Block, ...]) -> IntArray:
    return np.repeat(np.arange(len(blocks)), [block.last - block.first + 1 for block in blocks])
