"""The moves that shorten a way through places, by new steps between near places.

A way of N cuts has N + 1 steps: step s leads from the place ``left[s]``, where the cut before it ends, to
``reached[s]``, where the next cut begins. A move takes out the steps p < q < r, or p and r alone, and joins the loose
ends again. With A the cuts from step p to step q, and B those from q to r, and A' a stretch that is run backwards:

    REVERSE  (A B)'     left[p] to left[r], reached[p] to reached[r]; there is no q
    SWAP     B A        left[p] to reached[q], left[r] to reached[p], left[q] to reached[r]
    BEHIND   B A'       left[p] to reached[q], left[r] to left[q], reached[p] to reached[r]
    BEFORE   B' A       left[p] to left[r], reached[q] to reached[p], left[q] to reached[r]
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.spatial import cKDTree

from deltacam.model import Array, BoolArray, IntArray

REVERSE, SWAP, BEHIND, BEFORE = range(4)


class Steps(NamedTuple):
    """The steps of a way.

    Attributes:
        left: where each begins, (N + 1, 2) m.
        reached: where it ends, (N + 1, 2) m.
        length: (N + 1,) m.
    """

    left: Array
    reached: Array
    length: Array

    @classmethod
    def between(cls, left: Array, reached: Array) -> Steps:
        """The steps from place to place."""
        return cls(left, reached, _distance(left, reached))


LONGEST_RUN: Final = 6
"""The most cuts of a stretch that is tried beside all near places; of longer ones two new steps must be near."""

_COUNT: Final = 9  # of near places, the place itself or that of its own cut among them
_PAIRS: Final = 6  # near places, of those that are tried with each other
_ROWS: Final = 2048  # steps at a time, which bounds the memory

_NEW: Final = (
    ((0, 0, 0, 2), (1, 0, 1, 2)),
    ((0, 0, 1, 1), (0, 2, 1, 0), (0, 1, 1, 2)),
    ((0, 0, 1, 1), (0, 2, 0, 1), (1, 0, 1, 2)),
    ((0, 0, 0, 2), (1, 1, 1, 0), (0, 1, 1, 2)),
)  # the new steps by kind: from 0 left or 1 reached of p, q or r, to 0 left or 1 reached of another


@dataclass(frozen=True, slots=True, eq=False)
class Moves:
    """Moves that shorten the way.

    Attributes:
        kind: of each, (M,).
        steps: p, q and r of each, (M, 3); q is p where there is no q.
        gain: how much shorter the way becomes, (M,) m.
    """

    kind: IntArray
    steps: IntArray
    gain: Array


def find(steps: Steps, wanted: BoolArray, *, above: float) -> Moves:
    """Moves with a new step to a near place, which is shorter than one that it takes the place of.

    Args:
        steps: of the way.
        wanted: the steps that moves are looked for about, (N + 1,).
        above: the least that a move must save, m.
    """
    trees = cKDTree(steps.left), cKDTree(steps.reached)
    found = [(np.zeros(0, dtype=np.int64), np.zeros((0, 3), dtype=np.int64), np.zeros(0))]
    rows = np.flatnonzero(wanted)
    for first in range(0, len(rows), _ROWS):
        for kind, taken in _candidates(_near(steps, trees, rows[first : first + _ROWS]), len(wanted)):
            gain = saved(steps, kind, taken)
            good = np.flatnonzero(gain > above)
            found.append((np.full(len(good), kind), taken[good], gain[good]))
    return Moves(*(np.concatenate(part) for part in zip(*found, strict=True)))


def saved(steps: Steps, kind: int, taken: IntArray) -> Array:
    """How much shorter each move of one kind makes the way that takes out the steps p, q and r, (M, 3): (M,) m."""
    gain = steps.length[taken[:, 0]] + steps.length[taken[:, 2]]
    if kind != REVERSE:
        gain += steps.length[taken[:, 1]]
    for begin, of, end, to in _NEW[kind]:
        gain -= _distance(steps[begin][taken[:, of]], steps[end][taken[:, to]])
    return gain


def _distance(first: Array, second: Array) -> Array:
    off = first - second
    return np.asarray(np.sqrt(off[:, 0] ** 2 + off[:, 1] ** 2))


class _Pairs(NamedTuple):
    """Steps ``here`` and steps ``there`` of which a place is near, (M,) each.

    ``worth`` says for which of them the way between the two is shorter than one of the steps, (M,).
    """

    here: IntArray
    there: IntArray
    worth: BoolArray

    def chosen(self, which: BoolArray) -> tuple[IntArray, IntArray]:
        return self.here[which], self.there[which]


class _Near(NamedTuple):
    """What is near the places of some steps: first which place of theirs is meant, then which place is near."""

    left_left: _Pairs
    left_reached: _Pairs
    reached_left: _Pairs
    reached_reached: _Pairs


def _near(steps: Steps, trees: tuple[cKDTree, cKDTree], rows: IntArray) -> _Near:
    """What is near the places of the steps ``rows``, (R,), by the trees of ``left`` and of ``reached``."""
    some = min(_COUNT, trees[0].n)
    found = []
    for places in steps[:2]:
        for tree in trees:
            away, near = (np.reshape(each, (len(rows), some)) for each in tree.query(places[rows], k=some))
            worth = away < np.maximum(steps.length[rows, None], steps.length[near])
            found.append(_Pairs(np.repeat(rows, some), near.ravel(), worth.ravel()))
    return _Near(*found)


def _candidates(near: _Near, count: int) -> Iterator[tuple[int, IntArray]]:
    """Kinds and steps (M, 3) of moves of ``count`` steps, given what is near those that moves are looked for about."""
    for pairs in (near.left_left, near.reached_reached):
        here, there = pairs.chosen(pairs.worth)
        low, high = np.minimum(here, there), np.maximum(here, there)
        yield REVERSE, np.stack([low, low, high], axis=1)[high > low]
    # A step is the one that a run is put into, or one beside the run: where the run begins, or where it ends.
    for begins, ends, turned in (
        (near.reached_left, near.left_reached, False),
        (near.reached_reached, near.left_left, True),
    ):
        to_begin, begin = _either(begins, near.left_reached if begins is near.reached_left else begins)
        to_end, end = _either(ends, near.reached_left if ends is near.left_reached else ends)
        for run in range(1, min(LONGEST_RUN + 1, count)):
            fits = begin + run < count
            yield from _moved(begin[fits], begin[fits] + run, to_begin[fits], turned=turned)
            fits = end >= run
            yield from _moved(end[fits] - run, end[fits], to_end[fits], turned=turned)
    yield from _swaps(near.left_reached, near.reached_left)


def _either(run: _Pairs, slot: _Pairs) -> tuple[IntArray, IntArray]:
    """The steps that a run is put into, and those beside the run, (M,) each.

    Args:
        run: steps beside a run, and what is near that it may be put into.
        slot: steps that a run may be put into, and what is near beside a run.
    """
    (beside, into), (also_into, also_beside) = run.chosen(run.worth), slot.chosen(slot.worth)
    return np.concatenate([into, also_into]), np.concatenate([beside, also_beside])


def _moved(first: IntArray, last: IntArray, to: IntArray, *, turned: bool) -> Iterator[tuple[int, IntArray]]:
    """The moves that put the run between the steps ``first`` and ``last`` into the step ``to``, (M,) each."""
    behind, before = to > last, to < first
    yield BEHIND if turned else SWAP, np.stack([first, last, to], axis=1)[behind]
    yield BEFORE if turned else SWAP, np.stack([to, first, last], axis=1)[before]


def _swaps(before: _Pairs, after: _Pairs) -> Iterator[tuple[int, IntArray]]:
    """The swaps of stretches of any length with two new steps to near places.

    Args:
        before: which steps end near to where a step begins.
        after: which begin near to where it ends.
    """
    some = len(before.here) // max(len(np.unique(before.here)), 1)
    kept = min(_PAIRS, some)
    one, other = (pairs.there.reshape(-1, some)[:, :kept] for pairs in (before, after))
    worth_one, worth_other = (pairs.worth.reshape(-1, some)[:, :kept] for pairs in (before, after))
    worth = (worth_one[:, :, None] | worth_other[:, None, :]).ravel()
    here = np.repeat(before.here[::some], kept * kept)[worth]
    first, second = np.repeat(one, kept, axis=1).ravel()[worth], np.tile(other, kept).ravel()[worth]
    for p, q, r in ((here, first, second), (second, here, first), (first, second, here)):
        right = (p < q) & (q < r)
        yield SWAP, np.stack([p[right], q[right], r[right]], axis=1)
