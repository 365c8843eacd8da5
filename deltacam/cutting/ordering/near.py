"""The cuts that are near to each cut, which is where better orders are looked for."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from deltacam.cutting.ordering.problem import Problem, distance
from deltacam.model import Array, BoolArray, IntArray

NEAR: Final = 8
"""How many near cuts are tried."""

_OTHER: Final = 4
"""How many of those are tried that other parts begin with, and of those that they end with."""

_PLACES: Final = 12
_CENTRES: Final = 10
_ROWS: Final = 500_000  # ways at a time, which bounds the memory
_DIRECTIONS: Final = 12
_BEYOND: Final = 1.02  # of the distance that heat wants


def near_cuts(problem: Problem) -> list[list[tuple[int, float]]]:
    """For every cut, and for the rest of all, the near cuts, the cheapest first, each with the least cost of the way.

    The way is that from the one to the other or back, between any of their places.
    """
    count = problem.count
    if count == 0:
        return [[]]
    pairs = _candidates(problem)
    least = _least(problem, pairs)
    order = np.lexsort((least, pairs[:, 0]))
    pairs, least = pairs[order], least[order]
    rank = np.arange(len(pairs)) - np.searchsorted(pairs[:, 0], pairs[:, 0])
    kept = rank < NEAR
    for end in _ends_of_parts(problem):
        kept |= _among_first(pairs, end[pairs[:, 1]] & _elsewhere(problem, pairs), _OTHER)
    found: list[list[tuple[int, float]]] = [[] for _ in range(count + 1)]
    for (cut, other), cost in zip(pairs[kept].tolist(), least[kept].tolist(), strict=True):
        found[cut].append((other, cost))
    return found


def _candidates(problem: Problem) -> IntArray:
    """Pairs of a cut and one that may be near, (P, 2), without repetition."""
    owner, count = problem.owner, problem.count
    middle = np.add.reduceat(problem.begins, problem.first[:-1]) / np.diff(problem.first)[:, None]
    pairs = []
    for some in (np.ones(count + 1, dtype=np.bool_), *_ends_of_parts(problem)):
        of = np.flatnonzero(some[:-1])
        _, around = cKDTree(middle[of]).query(middle, k=min(_CENTRES, len(of)))
        pairs.append(_pairs(np.arange(count + 1), of[around]))
    few = min(int(np.diff(problem.first).max()), _PLACES)
    places = cKDTree(problem.begins[:-1])
    for side in (problem.begins, problem.ends) if _apart(problem) else (problem.begins,):
        _, near = places.query(side, k=min(few + NEAR, places.n))
        pairs.append(_pairs(owner, owner[near]))
    if problem.heat is not None:
        turn = np.arange(_DIRECTIONS) * 2.0 * np.pi / _DIRECTIONS
        ring = _BEYOND * problem.heat.distance * np.column_stack([np.cos(turn), np.sin(turn)])
        for step in ring:
            _, near = places.query(problem.ends + step, k=1)
            pairs.append(_pairs(owner, owner[near]))
    both = np.concatenate(pairs)
    back = both[both[:, 0] < count][:, ::-1]
    both = np.concatenate([both, back])
    both = both[(both[:, 0] != both[:, 1])]
    return np.unique(both, axis=0)


def _ends_of_parts(problem: Problem) -> tuple[BoolArray, ...]:
    """Which cuts have nothing inside, and which nothing around, (N + 1,) each; nothing where there is no rule.

    A part that is cut at once is come to at one of the former, and left at one of the latter.
    """
    rest, rule = problem.count, problem.rule
    if (rule.around == rest).all():
        return ()
    return np.append(rule.waiting == 0, False), rule.outermost == np.arange(rest + 1)


def _elsewhere(problem: Problem, pairs: IntArray) -> BoolArray:
    """Whether the cuts of each pair belong to different parts, (P,)."""
    outermost = problem.rule.outermost
    return np.asarray(outermost[pairs[:, 0]] != outermost[pairs[:, 1]])


def _among_first(pairs: IntArray, which: BoolArray, some: int) -> BoolArray:
    """Whether pairs are among the first ``some`` of those that count, for each first cut; (P,)."""
    counted = np.cumsum(which)
    start = np.searchsorted(pairs[:, 0], pairs[:, 0])
    before = np.where(start > 0, counted[start - 1], 0)
    return which & (counted - before <= some)


def _apart(problem: Problem) -> bool:
    return bool((problem.begins[:-1] != problem.ends[:-1]).any())


def _pairs(cut: IntArray, other: IntArray) -> IntArray:
    """Each cut, (R,), with each of the others in its row, (R, K)."""
    other = other.reshape(len(cut), -1)
    return np.stack([np.repeat(cut, other.shape[1]), other.ravel()], axis=1)


def _least(problem: Problem, pairs: IntArray) -> Array:
    """What the way costs between the two places of each pair of cuts that are nearest to each other, (P,) s.

    It is the cheaper one of there and back.
    """
    sizes = np.diff(problem.first)
    counts = sizes[pairs[:, 0]] * sizes[pairs[:, 1]]
    passed = np.concatenate([[0], np.cumsum(counts)])
    slices = np.unique(np.searchsorted(passed, np.arange(0, passed[-1] + _ROWS, _ROWS))).tolist()
    found = [np.zeros(0)]
    for low, high in pairwise([*slices[:-1], len(pairs)]):
        start = passed[low:high] - passed[low]
        inside = np.arange(passed[high] - passed[low]) - np.repeat(start, counts[low:high])
        width = np.repeat(sizes[pairs[low:high, 1]], counts[low:high])
        one = np.repeat(problem.first[pairs[low:high, 0]], counts[low:high]) + inside // width
        other = np.repeat(problem.first[pairs[low:high, 1]], counts[low:high]) + inside % width
        found.append(
            np.minimum(_cheapest(problem, one, other, start), _cheapest(problem, other, one, start))
            if _apart(problem)
            else _cheapest(problem, one, other, start)
        )
    return np.concatenate(found)


def _cheapest(problem: Problem, left: IntArray, reached: IntArray, start: IntArray) -> Array:
    """What the shortest of the ways costs, of those from each ``start`` on."""
    length = distance(problem.ends[left], problem.begins[reached])
    shortest = np.minimum.reduceat(length, start)
    counts = np.diff(np.append(start, len(left)))
    best = np.flatnonzero(length == np.repeat(shortest, counts))
    best = best[np.searchsorted(best, start)]
    return problem.ways(left[best], reached[best])
