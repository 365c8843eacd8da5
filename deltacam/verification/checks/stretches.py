"""Checks of what is beside the cut itself: the order of leads, loops and tabs, the overcut, and the width of tabs."""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from typing import Final

import numpy as np
import shapely

from deltacam.model import Array, BlockKind, Check, Operation
from deltacam.verification.checks.measure import at_most, none_of
from deltacam.verification.comparison import Comparison
from deltacam.verification.evidence import Evidence
from deltacam.verification.runs import Run

FOLLOWS: Final = {
    BlockKind.LEAD_IN: frozenset({BlockKind.CUT}),
    BlockKind.LOOP: frozenset({BlockKind.CUT}),
    BlockKind.TAB: frozenset({BlockKind.PIERCE, BlockKind.CUT}),
}
"""What must come after a stretch, of the same contour."""

COMES_AFTER: Final = {
    BlockKind.LOOP: frozenset({BlockKind.CUT}),
    BlockKind.TAB: frozenset({BlockKind.CUT}),
    BlockKind.OVERCUT: frozenset({BlockKind.CUT}),
    BlockKind.LEAD_OUT: frozenset({BlockKind.CUT, BlockKind.OVERCUT}),
}
"""What must come before a stretch, of the same contour."""

_OVERCUT: Final = frozenset({BlockKind.OVERCUT})
_TAB: Final = frozenset({BlockKind.TAB})


def in_order(evidence: Evidence) -> Check:
    """A lead-in is followed by its cut, loops and tabs lie within one, and overcut and lead-out come after it."""
    wrong = np.zeros(len(evidence.kind), dtype=np.bool_)
    edges = [0, *(np.flatnonzero(np.diff(evidence.program.block)) + 1).tolist(), len(wrong)]
    blocks = [(evidence.block_of(first), first) for first, _ in itertools.pairwise(edges)]
    for (before, _), (block, row), (after, _) in zip(
        [(None, 0), *blocks], blocks, [*blocks[1:], (None, 0)], strict=False
    ):
        if block.kind in FOLLOWS and (
            after is None or after.kind not in FOLLOWS[block.kind] or after.contour != block.contour
        ):
            wrong[row] = True
        if block.kind in COMES_AFTER and (
            before is None or before.kind not in COMES_AFTER[block.kind] or before.contour != block.contour
        ):
            wrong[row] = True
    return none_of(evidence, "leads, loops and tabs in their place", wrong, "stretches")


def overcut(comparison: Comparison) -> Check:
    """The overcut of every closed cut is as long as the process says; the laser goes off at a tick, so up to two later.

    Where a cut is shorter than the overcut, it goes round once. One that does not go around has none.
    """
    evidence = comparison.evidence
    wanted, name = evidence.program.process.overcut, "overcut"
    at_feed = evidence.program.process.feed / evidence.rate  # the way of a tick, which the planner adds at any speed
    off, ticks = [], []
    for target in comparison.targets:
        if not target.contour.curve.closed or target.contour.operation is not Operation.CUT:
            continue
        around = [float(np.hypot(*(np.roll(ring, -1, axis=0) - ring).T).sum()) for ring in target.rings]
        for run in target.runs if len(evidence.speed) else ():
            length, step = _overcut_of(evidence, run, target.rings)
            least, most = min(wanted, min(around, default=wanted)), wanted
            if run in target.open_runs:
                least = most = 0.0
            off.append(max(least - length - step, length - most - max(step, at_feed) - step, 0.0))
            ticks.append(run.end - 1)
    limit = 1e6 * (evidence.program.process.tolerance + evidence.program.process.chord_tolerance)
    return at_most(evidence, name, 1e6 * np.array(off), limit, "um off", ticks=np.array(ticks, dtype=np.int64))


def _overcut_of(evidence: Evidence, run: Run, rings: Sequence[Array]) -> tuple[float, float]:
    """How long the overcut of a run is along its path, and the longest step about it, m."""
    length, step = 0.0, 0.0
    for first, end in evidence.stretches(run, _OVERCUT):
        steps = evidence.speed[max(first - 1, 0) : end + 1] / evidence.rate
        way = float(evidence.speed[first:end].sum()) / evidence.rate
        length += _along(rings, evidence.sheet[[first, end]], way)
        step = max(step, float(steps.max()))
    return length, step if length else float(evidence.speed[run.end - 1]) / evidence.rate


def _along(rings: Sequence[Array], ends: Array, way: float) -> float:
    """How far it is along the nearest of the rings from one of the ``ends`` (2, 2) m to the other, m.

    The tool goes about as far, a ``way`` that cuts corners.
    """
    lines = np.array([shapely.LinearRing(ring) for ring in rings], dtype=object)
    if not len(lines):
        return way
    places = shapely.points(ends)
    ring = lines[int(np.argmin(shapely.distance(lines, places[0]) + shapely.distance(lines, places[1])))]
    begin, end = shapely.line_locate_point(ring, places)
    ahead = (end - begin) % ring.length
    once = np.array([ahead, ring.length - ahead])  # whichever way the ring is drawn
    lengths = (once + ring.length * np.arange(np.ceil(way / ring.length) + 1)[:, None]).ravel()
    return float(lengths[np.argmin(np.abs(lengths - way))])


def tab_width(comparison: Comparison) -> Check:
    """What every tab leaves standing is as wide as the process says, within the tolerances; there is none without."""
    evidence = comparison.evidence
    process, name = evidence.program.process, "tab width"
    spans = [span for target in comparison.targets for run in target.runs for span in evidence.stretches(run, _TAB)]
    limit = 1e6 * (process.tolerance + process.chord_tolerance)
    ticks = np.array([first for first, _ in spans], dtype=np.int64)
    if process.tabs is None:
        return none_of(evidence, name, np.isin(np.arange(len(evidence.kind)), ticks), "tabs that nobody asked for")
    widths = np.array([_length(evidence.sheet[first : end + 1]) - process.kerf for first, end in spans])
    return at_most(evidence, name, 1e6 * np.abs(widths - process.tabs.width), limit, "um off", ticks=ticks)


def _length(line: Array) -> float:
    return float(np.hypot(*np.diff(line, axis=0).T).sum())
