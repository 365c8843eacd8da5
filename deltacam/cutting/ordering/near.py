"""The cuts that are near to each cut, which is where better orders are looked for."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from deltacam.cutting.ordering.problem import Problem
from deltacam.model import Array, IntArray

NEAR: Final = 8
"""How many near cuts are tried."""

_CENTRES: Final = 10
_ROWS: Final = 200_000
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
    found: list[list[tuple[int, float]]] = [[] for _ in range(count + 1)]
    for (cut, other), cost in zip(pairs[kept].tolist(), least[kept].tolist(), strict=True):
        found[cut].append((other, cost))
    return found


def _candidates(problem: Problem) -> IntArray:
    """Pairs of a cut and one that may be near, (P, 2), without repetition."""
    owner, count = problem.owner, problem.count
    middle = np.add.reduceat(problem.begins, problem.first[:-1]) / np.diff(problem.first)[:, None]
    tree = cKDTree(middle[:-1])
    _, around = tree.query(middle, k=min(_CENTRES, count))
    pairs = [_pairs(np.arange(count + 1), around)]
    few = int(np.diff(problem.first).max())
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


def _apart(problem: Problem) -> bool:
    return bool((problem.begins[:-1] != problem.ends[:-1]).any())


def _pairs(cut: IntArray, other: IntArray) -> IntArray:
    """Each cut, (R,), with each of the others in its row, (R, K)."""
    other = other.reshape(len(cut), -1)
    return np.stack([np.repeat(cut, other.shape[1]), other.ravel()], axis=1)


def _least(problem: Problem, pairs: IntArray) -> Array:
    """The least cost of a way between the cuts of each pair, (P,) s."""
    sizes = np.diff(problem.first)
    least = np.empty(len(pairs))
    per_pair = sizes[pairs[:, 0]] * sizes[pairs[:, 1]]
    slices = np.searchsorted(np.cumsum(per_pair), np.arange(0, int(per_pair.sum()) + _ROWS, _ROWS))
    for low, high in zip(slices[:-1].tolist(), slices[1:].tolist(), strict=True):
        if high > low:
            part, counts = pairs[low:high], per_pair[low:high]
            start = np.cumsum(counts) - counts
            inside = np.arange(int(counts.sum())) - np.repeat(start, counts)
            width = np.repeat(sizes[part[:, 1]], counts)
            one = np.repeat(problem.first[part[:, 0]], counts) + inside // width
            other = np.repeat(problem.first[part[:, 1]], counts) + inside % width
            there = np.minimum.reduceat(problem.ways(one, other), start)
            least[low:high] = np.minimum(there, np.minimum.reduceat(problem.ways(other, one), start))
    return least
