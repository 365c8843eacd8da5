"""The best places for a given sequence of cuts: a shortest path through the places of one cut after the other."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from deltacam.cutting.ordering.problem import Problem
from deltacam.model import Array, IntArray

_PAIRS: Final = 500_000  # at a time, which bounds the memory


def best_places(problem: Problem, sequence: Sequence[int]) -> list[int]:
    """The place of each cut of the sequence with which all ways together cost least."""
    rest = problem.count
    cuts = np.array([rest, *sequence, rest])
    first, sizes = problem.first[cuts], np.diff(problem.first)[cuts]
    least, chosen = np.zeros(1), list[IntArray]()
    for costs in _between(problem, first, sizes):
        through = least[:, None] + costs
        chosen.append(through.argmin(axis=0))
        least = through[chosen[-1], np.arange(through.shape[1])]
    place, places = 0, list[int]()
    for base, best in zip(first[-2:0:-1].tolist(), chosen[:0:-1], strict=True):
        place = int(best[place])
        places.append(base + place)
    return places[::-1]


def _between(problem: Problem, first: IntArray, sizes: IntArray) -> Iterator[Array]:
    """What the ways from the places of each cut to those of the next cost, (S, T) s each."""
    pairs = sizes[:-1] * sizes[1:]
    passed = np.concatenate([[0], np.cumsum(pairs)])
    bounds = np.unique(np.searchsorted(passed, np.arange(0, passed[-1], _PAIRS))).tolist()
    for low, high in pairwise([*bounds, len(pairs)]):
        inside = np.arange(passed[high] - passed[low]) - np.repeat(passed[low:high] - passed[low], pairs[low:high])
        width = np.repeat(sizes[low + 1 : high + 1], pairs[low:high])
        left = np.repeat(first[low:high], pairs[low:high]) + inside // width
        reached = np.repeat(first[low + 1 : high + 1], pairs[low:high]) + inside % width
        costs = np.split(problem.ways(left, reached), passed[low + 1 : high] - passed[low])
        for cost, size in zip(costs, sizes[low:high].tolist(), strict=True):
            yield cost.reshape(size, -1)
