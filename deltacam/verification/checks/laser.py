"""Checks of the laser: its power, when it is on, and that it pierces at rest."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.model import Array, BlockKind, Check, IntArray, Mode, Operation
from deltacam.verification import energy
from deltacam.verification.checks.measure import MICROMETRE, at_most, none_of
from deltacam.verification.evidence import KINDS, LASER_KINDS, Evidence, length
from deltacam.verification.runs import Run

REST: Final = 0.02
"""How long the laser may stay on at rest beyond the pierce, s."""
POWER_STEP: Final = 1e-3
"""How far the power of a tick may be from that for its speed, of the rated power."""
SPEED_KNOWN: Final = 1e-6
"""How exactly the speed from a tick to the next is known, m/s; for laws that are steep at rest."""

_SAME_JOINTS: Final = 1e-9  # rad
_PIERCE: Final = KINDS.index(BlockKind.PIERCE)
_LEAD_IN: Final = KINDS.index(BlockKind.LEAD_IN)
_ENGRAVE: Final = KINDS.index(BlockKind.ENGRAVE)


def power_range(evidence: Evidence) -> Check:
    """The power is 0..1 of the rated power."""
    power = evidence.program.power
    return none_of(evidence, "laser power from 0 to 1", (power < 0.0) | (power > 1.0))


def laser_off(evidence: Evidence) -> Check:
    """The laser is off outside pierces, cuts and engraving, and everywhere unless the program is for cutting."""
    wrong = evidence.program.power != 0.0
    if evidence.program.mode is Mode.CUT:
        wrong = wrong & ~evidence.is_kind(LASER_KINDS)
    return none_of(evidence, "laser off outside cuts", wrong)


def laser_on(evidence: Evidence) -> Check:
    """A program for cutting has the power of its process in all pierces and cuts, and that for engraving elsewhere.

    Where the process has a power law, what moves has the power for its speed, to within `POWER_STEP`.
    """
    least, most = _power_range(evidence)
    power = evidence.program.power
    wrong = ~((power >= least) & (power <= most))  # nan is no power at all
    wrong = wrong & evidence.is_kind(LASER_KINDS) & (evidence.program.mode is Mode.CUT)
    return none_of(evidence, "laser on in all cuts", wrong)


def _power_range(evidence: Evidence) -> tuple[Array, Array]:
    """The least and the most power that every row may have, (N,) each; nan where the process does not say."""
    process = evidence.program.process
    engraves, pierces = evidence.kind == _ENGRAVE, evidence.kind == _PIERCE
    full = np.where(engraves, np.nan if process.engrave_power is None else process.engrave_power, process.power)
    full = np.where(pierces & (process.pierce_power is not None), process.pierce_power or 0.0, full)
    law = process.power_law
    if law is None:
        return full, full
    feed = np.where(engraves, process.engrave_feed or np.nan, process.feed)
    slow, fast = np.zeros_like(full), np.full_like(full, np.inf)
    if len(evidence.tool):  # else any speed is possible
        slow, fast = (_true_speed(evidence) + change for change in (-SPEED_KNOWN, SPEED_KNOWN))

    def power(speed: Array, step: float) -> Array:
        share = np.clip(speed / feed, 0.0, 1.0) ** law.exponent
        return np.clip((law.at_rest + (1.0 - law.at_rest) * share) * full + step, np.minimum(law.lowest, full), full)

    return np.where(pierces, full, power(slow, -POWER_STEP)), np.where(pierces, full, power(fast, POWER_STEP))


def _true_speed(evidence: Evidence) -> Array:
    """The mean speed of the tool from every tick to the next by way of where it is between them, (N,) m/s."""
    way = length(evidence.between - evidence.tool[:-1]) + length(evidence.tool[1:] - evidence.between)
    return np.append(way * evidence.rate, 0.0)


def pierce_at_rest(evidence: Evidence) -> Check:
    """The tool stays where it is from the first tick of a pierce to the tick after its last."""
    rows = np.flatnonzero(evidence.kind == _PIERCE)
    rows = rows[rows < len(evidence.kind) - 1]
    start = _stretch_starts(evidence)[rows]
    moved = np.linalg.norm(evidence.tool[rows + 1] - evidence.tool[start], axis=1)
    return at_most(evidence, "rest while piercing", moved * 1e6, MICROMETRE * 1e6, "um", ticks=rows)


def pierce_before_cut(evidence: Evidence) -> Check:
    """Every cut follows a pierce of its contour that is as long as the process says, to within half a tick.

    Where the process pierces everything first, that was somewhere before, in the place where the cut begins.
    """
    start = _stretch_starts(evidence)
    needed = evidence.program.process.pierce_time
    cuts = [run for run in evidence.runs if run.operation is Operation.CUT]
    missing = [needed - _pierced_for(evidence, run, start) for run in cuts]
    ticks = [run.first for run in cuts]
    for run in cuts:
        # Behind a tab the laser comes on again.
        for _, end in evidence.stretches(run, frozenset({BlockKind.TAB})):
            others = np.flatnonzero(evidence.kind[end:] != KINDS.index(BlockKind.PIERCE))
            missing.append(needed - float(others[0] if len(others) else 0) / evidence.rate)
            ticks.append(end)
    limit = 0.5 / evidence.rate
    where = np.array(ticks, dtype=np.int64)
    return at_most(evidence, "pierce before every cut", np.array(missing) * 1e3, limit * 1e3, "ms missing", ticks=where)


def cut_after_pierce(evidence: Evidence) -> Check:
    """Every pierce is followed by a cut, or the lead-in of one, of its contour: nothing else burns a hole.

    Where the process pierces everything first, a cut of its contour begins in its place later.
    """
    last = np.flatnonzero((evidence.kind == _PIERCE) & (np.append(evidence.kind[1:], -1) != _PIERCE))
    wrong = np.zeros(len(evidence.kind), dtype=np.bool_)
    for row in last.tolist():
        following = evidence.block_of(row + 1) if row + 1 < len(wrong) else None
        wrong[row] = (
            following is None
            or following.kind not in (BlockKind.LEAD_IN, BlockKind.CUT)
            or following.contour != evidence.block_of(row).contour
        )
        if evidence.program.process.pre_pierce and wrong[row]:
            contour = evidence.block_of(row).contour
            later = [run for run in evidence.runs if run.contour == contour and run.begin > row]
            wrong[row] = not any(_same_place(evidence, row, run.begin) for run in later)
    return none_of(evidence, "cut after every pierce", wrong, "pierces")


def laser_at_rest(evidence: Evidence) -> Check:
    """How long the laser burns in one place beyond the pierce there: `REST`, or three ticks, for a stop in a corner.

    At rest is slower than a ten-thousandth of the feed.
    """
    process, on = evidence.program.process, (evidence.program.power > 0.0)[:-1]
    still = on & (evidence.speed < 1e-4 * min(process.feed, process.engrave_feed or process.feed))
    edges = np.flatnonzero(np.diff(still, prepend=False, append=False))
    first, end = edges[::2], edges[1::2]
    pierced = np.concatenate([[0], np.cumsum(evidence.kind == _PIERCE)])
    excess = (end - first) / evidence.rate - process.pierce_time * (pierced[end] > pierced[first])
    limit = max(REST, 3.0 / evidence.rate)
    return at_most(evidence, "laser on at rest", excess * 1e3, limit * 1e3, "ms beyond the pierce", ticks=first)


def line_energy(evidence: Evidence) -> Check:
    """The most energy along a millimetre of a cut, as a multiple of what the process gives at its feed; no limit.

    Where the tool slows down at constant power, in corners and bends and at both ends, it burns more. A file may state
    a process without power: then nothing is usual, and `laser_on` says what is wrong.
    """
    found = energy.line_energy(evidence)
    ticks = np.flatnonzero(np.isfinite(found))
    return at_most(evidence, "energy per mm", found[ticks], None, "times that at the feed", ticks=ticks)


def _pierced_for(evidence: Evidence, run: Run, start: IntArray) -> float:
    """How long the laser pierces before a cut, a lead-in between them allowed, s."""
    if evidence.program.process.pre_pierce:
        return _pierced_first(evidence, run, start)
    row = run.first
    if row and evidence.kind[row - 1] == _LEAD_IN:
        row = int(start[row - 1])
    if not row or evidence.kind[row - 1] != _PIERCE or evidence.block_of(row - 1).contour != run.contour:
        return 0.0
    return (row - int(start[row - 1])) / evidence.rate


def _pierced_first(evidence: Evidence, run: Run, start: IntArray) -> float:
    """How long the laser pierced where a cut begins, some time before, s."""
    rows = np.flatnonzero(evidence.kind[: run.begin] == _PIERCE)
    lasts = rows[np.append(evidence.program.block[rows[1:]] != evidence.program.block[rows[:-1]], True)[: len(rows)]]
    for row in lasts.tolist():
        if evidence.block_of(row).contour == run.contour and _same_place(evidence, row, run.begin):
            return float(row + 1 - int(start[row])) / evidence.rate
    return 0.0


def _same_place(evidence: Evidence, row: int, other: int) -> bool:
    """Whether the joints are the same at two rows."""
    q = evidence.program.q
    return bool(np.abs(q[row] - q[other]).max() <= _SAME_JOINTS)


def _stretch_starts(evidence: Evidence) -> IntArray:
    """For every row, the first row of the stretch of the same kind that it is in, (N,)."""
    changes = np.diff(evidence.kind, prepend=-1) != 0
    return np.asarray(np.flatnonzero(changes)[np.cumsum(changes) - 1])
