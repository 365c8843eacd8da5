"""The best places for a given sequence of cuts: a shortest path through the places of one cut after the other."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from deltacam.cutting.ordering.problem import Problem
from deltacam.model import Array, IntArray

_PAIRS: Final = 500_000


def best_places(problem: Problem, sequence: Sequence[int]) -> list[int]:
    """The place of each cut of the sequence with which all ways together cost least."""
    rest = problem.count
    if not len(sequence):
        return []
    cuts = np.array([rest, *sequence, rest])
    first, sizes = problem.first[cuts], np.diff(problem.first)[cuts]
    least, chosen = np.zeros(1), list[IntArray]()
    step = 0
    for costs in _between(problem, first, sizes):
        through = least[:, None] + costs
        best = through.argmin(axis=0)
        chosen.append(best)
        least = through[best, np.arange(len(best))]
        step += 1
    place, places = 0, list[int]()
    for at in range(len(chosen) - 1, 0, -1):
        place = int(chosen[at][place])
        places.append(int(first[at]) + place)
    return places[::-1]


def _between(problem: Problem, first: IntArray, sizes: IntArray) -> list[Array]:
    """What the ways from the places of each cut to those of the next cost, (S, T) s each."""
    pairs = sizes[:-1] * sizes[1:]
    found: list[Array] = []
    cuts = np.unique(np.searchsorted(np.cumsum(pairs), np.arange(0, int(pairs.sum()) + _PAIRS, _PAIRS)))
    bounds = [*cuts.tolist(), len(pairs)] if cuts[-1] < len(pairs) else cuts.tolist()
    for low, high in zip(bounds, bounds[1:], strict=False):
        counts, width = pairs[low:high], sizes[low + 1 : high + 1]
        start = np.cumsum(counts) - counts
        inside = np.arange(int(counts.sum())) - np.repeat(start, counts)
        left = np.repeat(first[low:high], counts) + inside // np.repeat(width, counts)
        reached = np.repeat(first[low + 1 : high + 1], counts) + inside % np.repeat(width, counts)
        costs = problem.ways(left, reached)
        for begin, size, columns in zip(start.tolist(), counts.tolist(), width.tolist(), strict=True):
            found.append(costs[begin : begin + size].reshape(-1, columns))
    return found
