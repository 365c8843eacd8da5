"""Better orders of places to visit, by moving short runs of them and by reversing stretches (Or-opt, 2-opt)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model import Array, Cut, IntArray

GAIN: Final = 1e-9
"""Less travel saved, m, is rounding."""

_LONGEST_RUN: Final = 3


@dataclass(frozen=True, slots=True, eq=False)
class Precedence:
    """Which cut must come before which, by index.

    Attributes:
        before: for each cut, the cuts inside its contour.
        after: for each cut, the cuts of the contour around it.
        inner: with ``outer`` the same as pairs, (P,): ``inner[i]`` comes before ``outer[i]``.
        outer: (P,).
    """

    before: tuple[tuple[int, ...], ...]
    after: tuple[tuple[int, ...], ...]
    inner: IntArray
    outer: IntArray

    @classmethod
    def between(cls, cuts: Sequence[Cut], parents: Mapping[int, int | None]) -> Precedence:
        """The rule that what lies directly inside a contour is cut before it."""
        by_contour: dict[int, list[int]] = {}
        for index, cut in enumerate(cuts):
            by_contour.setdefault(cut.contour, []).append(index)
        before: list[list[int]] = [[] for _ in cuts]
        after: list[list[int]] = [[] for _ in cuts]
        for index, cut in enumerate(cuts):
            parent = parents[cut.contour]
            for around in by_contour.get(parent, []) if parent is not None else []:
                before[around].append(index)
                after[index].append(around)
        pairs = np.array([(i, o) for i, outer in enumerate(after) for o in outer], dtype=np.int64).reshape(-1, 2)
        return cls(tuple(map(tuple, before)), tuple(map(tuple, after)), pairs[:, 0], pairs[:, 1])


@dataclass(slots=True, eq=False)
class Tour:
    """A sequence of cuts with where each begins and ends; a stretch that is reversed is run the other way.

    Attributes:
        sequence: (N,) indices of cuts.
        begins: where each cut begins, by its index, (N, 2) m.
        ends: where it ends, likewise.
        start: where the tool is before the first, (2,) m.
        home: where it goes after the last, (2,) m.
    """

    sequence: IntArray
    begins: Array
    ends: Array
    start: Array
    home: Array

    def left(self, sequence: IntArray) -> Array:
        """The places that the tool leaves in turn, the start first, (M + 1, 2) m."""
        return np.concatenate([self.start[None], self.ends[sequence]])

    def reached(self, sequence: IntArray) -> Array:
        """The places that it comes to from there, home last, (M + 1, 2) m."""
        return np.concatenate([self.begins[sequence], self.home[None]])

    def positions(self) -> IntArray:
        """The position of every cut in the sequence, (N,)."""
        position = np.empty(len(self.sequence), dtype=np.int64)
        position[self.sequence] = np.arange(len(self.sequence))
        return position


def improve(tour: Tour, rule: Precedence) -> IntArray:
    """The sequence after one pass of both moves, with the places where cuts begin and end held where they are."""
    count = len(tour.sequence)
    for run in range(_LONGEST_RUN, 0, -1):
        for index in range(count):
            _insert_best(tour, rule, index, run)
    for first in range(count - 1):
        _reverse_best(tour, rule, first)
    return tour.sequence


def _distance(first: Array, second: Array) -> Array:
    return np.asarray(np.hypot(first[..., 0] - second[..., 0], first[..., 1] - second[..., 1]))


def _insert_best(tour: Tour, rule: Precedence, index: int, run: int) -> None:
    """Move the ``run`` cuts from cut ``index`` on to where they cost least, if anywhere less than now."""
    sequence, position = tour.sequence, tour.positions()
    here = int(position[index])
    if here + run > len(sequence):
        return
    moved, rest = sequence[here : here + run], np.concatenate([sequence[:here], sequence[here + run :]])
    low, high = _allowed_slots(moved.tolist(), position, rule)
    before, after = tour.left(rest)[low : high + 1], tour.reached(rest)[low : high + 1]
    head, tail = tour.begins[moved[0]], tour.ends[moved[-1]]
    cost = _distance(before, head) + _distance(tail, after) - _distance(before, after)
    best = int(np.argmin(cost))
    if cost[best] < cost[here - low] - GAIN:
        tour.sequence = np.insert(rest, low + best, moved)


def _allowed_slots(moved: list[int], position: IntArray, rule: Precedence) -> tuple[int, int]:
    """The first and last slot for a run, counted without it: after what lies inside it, before what is around it."""
    inside = [int(position[cut]) for index in moved for cut in rule.before[index] if cut not in moved]
    around = [int(position[cut]) for index in moved for cut in rule.after[index] if cut not in moved]
    # What lies inside stands before the run, what lies around stands behind it, where taking the run out shifts it.
    return max(inside, default=-1) + 1, min(around, default=len(position)) - len(moved)


def _reverse_best(tour: Tour, rule: Precedence, first: int) -> None:
    """Reverse the stretch that begins at position ``first`` and saves most, if any saves."""
    sequence, position = tour.sequence, tour.positions()
    behind = position[rule.inner] >= first
    last = int(position[rule.outer[behind]].min(initial=len(sequence)))
    if last - first < 2:
        return
    left, reached = tour.left(sequence), tour.reached(sequence)
    before, head = left[first], reached[first]
    ends, after = left[first + 2 : last + 1], reached[first + 2 : last + 1]
    gain = _distance(before, head) + _distance(ends, after) - _distance(before, ends) - _distance(head, after)
    best = int(np.argmax(gain))
    if gain[best] <= GAIN:
        return
    turned = sequence[first : first + 2 + best]
    tour.begins[turned], tour.ends[turned] = tour.ends[turned], tour.begins[turned]
    tour.sequence = np.concatenate([sequence[:first], turned[::-1], sequence[first + 2 + best :]])
