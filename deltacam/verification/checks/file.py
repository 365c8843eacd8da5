"""Checks of what the file says about itself: its bytes, its ticks, its table of blocks, its robot."""

from __future__ import annotations

import math
from dataclasses import fields, replace

import numpy as np

from deltacam.model import Block, Check, IntArray, Process
from deltacam.program.program import TICK_COLUMN, Program
from deltacam.robot.dimensions import Triple
from deltacam.verification.checks.measure import at_tick
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
    return at_tick(evidence, "block table", not what, tick=tick if what else None, where=what)


def robot(evidence: Evidence) -> Check:
    """The program was made for the robot that it is checked against; only the limit of jerk may be another one.

    A plan may have a limit of its own. Whether the program is within that of the robot is what the check of jerk says.
    """
    planned, given = evidence.program.robot, evidence.robot
    if planned.fingerprint == given.fingerprint:
        return Check("robot", True)
    words = other_jerk_limit(evidence)
    differ = f"made for {planned.name}, checked against {given.name}, whose values differ"
    return Check("robot", bool(words), where=words or differ)


def same_process(planned: Process, given: Process) -> Check:
    """The program was made for the process that it is checked against; what is said for people may differ.

    A gas is a word here too: what it does to the feed is in the feed.
    """
    words = ("name", "source", "material", "gas", "gases", "laser", "laser_power", "feeds", "provenance")
    names = [one.name for one in fields(Process) if one.name not in words]
    differ = [name for name in names if getattr(planned, name) != getattr(given, name)]
    shown = (f"{name} {_shown(getattr(planned, name))} for {_shown(getattr(given, name))}" for name in differ)
    return Check("process", not differ, float(len(differ)), 0.0, "values", where=", ".join(shown))


def _shown(value: object) -> str:
    """A number or a word; rules, leads and the like are too long to be shown."""
    if isinstance(value, float):
        return f"{value:.6g}"
    return str(value) if value is None or isinstance(value, (str, int)) else "others"


def other_jerk_limit(evidence: Evidence) -> str:
    """Both limits of jerk in words where they are all that differs between the two robots, else nothing."""
    planned, given = evidence.program.robot, evidence.robot
    limit = given.joints.max_jerk
    alike = replace(planned, joints=replace(planned.joints, max_jerk=limit)).fingerprint == given.fingerprint
    if planned.joints.max_jerk == limit or not alike:
        return ""
    limits = f"{_in_words(planned.joints.max_jerk)} in the program and {_in_words(limit)} in this robot"
    return f"the limit of joint jerk is {limits}, which is the one checked"


def _in_words(jerk: Triple | None) -> str:
    """The limit in deg/s3, once where it is the same for all joints."""
    if jerk is None:
        return "none"
    numbers = [f"{math.degrees(value):.9g}" for value in jerk]
    return f"{', '.join(numbers[:1] if len(set(numbers)) == 1 else numbers)} deg/s3"


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
