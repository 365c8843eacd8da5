"""Chains of steps to curves: the pieces one after the other, their ends moved together or bridged."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import chain

import numpy as np

from deltacam.drawing.joining.chains import Steps
from deltacam.drawing.joining.nodes import MOVED
from deltacam.geometry.pack import Pack
from deltacam.model import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class _Run:
    """The steps of many chains, one after the other.

    Attributes:
        steps: (S,).
        first: (K + 1,) where each chain begins in ``steps``, and S.
        closed: whether the last step of each also meets its first.
        begin: (S,) the vertex of the pack where each step begins.
        end: (S,) the vertex where it ends.
    """

    steps: IntArray
    first: IntArray
    closed: bool
    begin: IntArray
    end: IntArray

    @classmethod
    def of(cls, pack: Pack, chains: list[Steps], closed: bool) -> _Run:
        counts = [len(steps) for steps in chains]
        steps = np.fromiter(chain.from_iterable(chains), dtype=np.int64, count=sum(counts))
        curve, turned = steps >> 1, (steps & 1).astype(np.bool_)
        low, high = pack.first[curve], pack.first[curve + 1] - 1
        begin, end = np.where(turned, high, low), np.where(turned, low, high)
        return cls(steps, np.concatenate([[0], np.cumsum(counts)]).astype(np.int64), closed, begin, end)

    def previous(self) -> IntArray:
        """For each step the one before it, (S,); for the first of an open chain the step itself."""
        before = np.arange(len(self.steps)) - 1
        before[self.first[:-1]] = self.first[1:] - 1 if self.closed else self.first[:-1]
        return before


def link(pack: Pack, chains: list[Steps], *, closed: bool) -> tuple[Pack, Array]:
    """The curve of each chain, and how far an end of it had to move, (K,) m.

    Where two ends differ, the end of a line moves to that of an arc; of two of a kind the second moves to the first.
    Ends further apart than they may be moved get a straight piece between them; but where a line runs past the other
    end it is shortened.

    Args:
        pack: open curves.
        chains: K lists of steps, each step beginning about where the one before ends.
        closed: whether the last step of each also ends where its first begins.
    """
    run = _Run.of(pack, chains, closed)
    if not len(run.steps):
        return Pack.of([]), np.zeros(0)
    place, gap, bridged = _joints(pack, run)
    counts = pack.counts[run.steps >> 1]
    start = np.cumsum(counts) - counts
    points, bulges = _vertices(pack, run, counts, start)
    points[start] = place
    keep = np.ones(len(points), dtype=np.bool_)
    keep[start + counts - 1] = False
    meets = np.ones(len(run.steps), dtype=np.bool_)
    if not closed:
        meets[run.first[:-1]] = False
        keep[(start + counts - 1)[run.first[1:] - 1]] = True
    before = run.previous()
    keep[(start + counts - 1)[before[bridged & meets]]] = True
    chain_of = np.repeat(np.arange(len(chains)), np.diff(run.first))
    kept = np.bincount(np.repeat(chain_of, counts)[keep], minlength=len(chains))
    first = np.concatenate([[0], np.cumsum(kept)]).astype(np.int64)
    moved = np.maximum.reduceat(np.where(meets & ~bridged, gap, 0.0), run.first[:-1])
    return Pack(points[keep], bulges[keep], first, np.full(len(chains), closed)), moved


def _joints(pack: Pack, run: _Run) -> tuple[Array, Array, BoolArray]:
    """Where each step begins once it is linked, (S, 2) m; its gap to the step before, (S,) m; whether that stays."""
    before = run.previous()
    end, start = pack.points[run.end[before]], pack.points[run.begin]
    gap = np.hypot(*(end - start).T)
    turned = (run.steps & 1).astype(np.bool_)
    opening = pack.bulges[np.where(turned, run.begin - 1, run.begin)]
    closing = pack.bulges[np.where(turned, run.end, run.end - 1)][before]
    inner = pack.points[np.where(turned, run.end + 1, run.end - 1)][before]
    outer = pack.points[np.where(turned, run.begin - 1, run.begin + 1)]
    # A line that ends beyond the start of the next piece, or starts before the end of the last, is only shortened.
    off_last = np.where((gap > MOVED) & (closing == 0.0), _off(inner, end, start), np.inf)
    off_next = np.where((gap > MOVED) & (opening == 0.0), _off(outer, start, end), np.inf)
    shorten_last, shorten_next = off_last <= MOVED, (off_next <= MOVED) & (off_last > MOVED)
    gap = np.where(shorten_last, off_last, np.where(shorten_next, off_next, gap))
    bridged = gap > MOVED
    to_arc = (gap > 0.0) & (closing == 0.0) & (opening != 0.0) & ~shorten_next
    first_of_open = before == np.arange(len(before)) if not run.closed else np.zeros(len(before), dtype=np.bool_)
    place = np.where((to_arc | bridged | shorten_last | first_of_open)[:, None], start, end)
    return place, gap, bridged


def _off(far: Array, near: Array, points: Array) -> Array:
    """How far points, (S, 2) m, are from the lines that run from ``far`` to ``near``; infinite beyond their ends."""
    chord, arm = near - far, points - far
    length = np.maximum(np.hypot(*chord.T), 1e-300)
    along = np.sum(arm * chord, axis=1) / length
    off = np.abs(chord[:, 0] * arm[:, 1] - chord[:, 1] * arm[:, 0]) / length
    return np.where((along > 0.0) & (along < length), off, np.inf)


def _vertices(pack: Pack, run: _Run, counts: IntArray, start: IntArray) -> tuple[Array, Array]:
    """All vertices of all steps in the order in which they are run, and the bulge of the segment after each."""
    offset = np.arange(counts.sum()) - np.repeat(start, counts)
    turned = np.repeat((run.steps & 1).astype(np.bool_), counts)
    begin = np.repeat(run.begin, counts)
    vertex = np.where(turned, begin - offset, begin + offset)
    last = offset == np.repeat(counts, counts) - 1
    bulges = np.where(turned, -pack.bulges[np.where(turned & ~last, vertex - 1, vertex)], pack.bulges[vertex])
    bulges[last] = 0.0
    return pack.points[vertex], bulges
