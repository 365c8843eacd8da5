"""Checks of the laser: its power, when it is on, and that it pierces at rest."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.model import BlockKind, Check, IntArray, Mode, Operation
from deltacam.verification.checks.measure import MICROMETRE, at_most, none_of
from deltacam.verification.evidence import KINDS, LASER_KINDS, Evidence, Run

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
    """A program for cutting has the power of its process in all pierces and cuts, and that for engraving elsewhere."""
    process = evidence.program.process
    engraving = np.nan if process.engrave_power is None else process.engrave_power  # nan is no power at all
    wanted = np.where(evidence.kind == _ENGRAVE, engraving, process.power)
    wrong = evidence.program.power != wanted
    wrong = wrong & evidence.is_kind(LASER_KINDS) & (evidence.program.mode is Mode.CUT)
    return none_of(evidence, "laser on in all cuts", wrong)


def pierce_at_rest(evidence: Evidence) -> Check:
    """The tool stays where it is from the first tick of a pierce to the tick after its last."""
    rows = np.flatnonzero(evidence.kind == _PIERCE)
    rows = rows[rows < len(evidence.kind) - 1]
    start = _stretch_starts(evidence)[rows]
    moved = np.linalg.norm(evidence.tool[rows + 1] - evidence.tool[start], axis=1)
    return at_most(evidence, "rest while piercing", moved * 1e6, MICROMETRE * 1e6, "um", ticks=rows)


def pierce_before_cut(evidence: Evidence) -> Check:
    """Every cut follows a pierce of its contour that is as long as the process says, to within half a tick."""
    start = _stretch_starts(evidence)
    needed = evidence.program.process.pierce_time
    cuts = [run for run in evidence.runs if run.operation is Operation.CUT]
    missing = np.array([needed - _pierced_for(evidence, run, start) for run in cuts])
    ticks = np.array([run.first for run in cuts], dtype=np.int64)
    limit = 0.5 / evidence.rate
    return at_most(evidence, "pierce before every cut", missing * 1e3, limit * 1e3, "ms missing", ticks=ticks)


def cut_after_pierce(evidence: Evidence) -> Check:
    """Every pierce is followed by a cut, or the lead-in of one, of its contour: nothing else burns a hole."""
    last = np.flatnonzero((evidence.kind == _PIERCE) & (np.append(evidence.kind[1:], -1) != _PIERCE))
    wrong = np.zeros(len(evidence.kind), dtype=np.bool_)
    for row in last.tolist():
        following = evidence.block_of(row + 1) if row + 1 < len(wrong) else None
        wrong[row] = (
            following is None
            or following.kind not in (BlockKind.LEAD_IN, BlockKind.CUT)
            or following.contour != evidence.block_of(row).contour
        )
    return none_of(evidence, "cut after every pierce", wrong, "pierces")


def _pierced_for(evidence: Evidence, run: Run, start: IntArray) -> float:
    """How long the laser pierces before a cut, a lead-in between them allowed, s."""
    row = run.first
    if row and evidence.kind[row - 1] == _LEAD_IN:
        row = int(start[row - 1])
    if not row or evidence.kind[row - 1] != _PIERCE or evidence.block_of(row - 1).contour != run.contour:
        return 0.0
    return (row - int(start[row - 1])) / evidence.rate


def _stretch_starts(evidence: Evidence) -> IntArray:
    """For every row, the first row of the stretch of the same kind that it is in, (N,)."""
    changes = np.diff(evidence.kind, prepend=-1) != 0
    return np.asarray(np.flatnonzero(changes)[np.cumsum(changes) - 1])
