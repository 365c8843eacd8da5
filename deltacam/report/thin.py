"""Polylines without the points that they can spare."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final

import numpy as np

from deltacam.model import Array, BoolArray

_BATCH: Final = 65_536  # points at a time, which bounds the memory; one line is never split


def thin_lines(lines: Sequence[Array], tolerance: float) -> list[Array]:
    """The polylines, (K, 2) m each, without the points that they can spare within ``tolerance`` m; ends stay."""
    found: list[Array] = []
    counts = np.cumsum([len(line) for line in lines])
    batch = counts // _BATCH
    for first, last in pairwise([*np.flatnonzero(np.diff(batch, prepend=-1)).tolist(), len(lines)]):
        points, end = np.vstack(lines[first:last]), counts[first:last] - counts[first] + len(lines[first]) - 1
        fixed = np.zeros(len(points), dtype=bool)
        fixed[0] = fixed[end] = fixed[end[:-1] + 1] = True
        kept = np.flatnonzero(thin(points, fixed, tolerance))
        found += np.split(points[kept], np.searchsorted(kept, end[:-1] + 1))
    return found


def thin_way(points: Array, fixed: BoolArray, tolerance: float) -> BoolArray:
    """As `thin`, for a way that may be very long: some further points stay so that the memory is bounded."""
    kept = np.zeros(len(points), dtype=bool)
    for first in range(0, max(len(points) - 1, 1), _BATCH):
        part = slice(first, first + _BATCH + 1)
        ends = fixed[part].copy()
        ends[[0, -1]] = True
        kept[part] |= thin(points[part], ends, tolerance)
    return kept


def thin(points: Array, fixed: BoolArray, tolerance: float) -> BoolArray:
    """Which points are enough to draw a polyline within ``tolerance`` m (Ramer 1972; Douglas and Peucker 1973).

    All stretches between the ``fixed`` points (N,), which stay, are split at once where they are farthest from their
    chord. The first and the last of the points (N, 2) m are fixed.
    """
    kept, place = fixed.copy(), np.arange(len(points))
    rest = np.flatnonzero(~kept)
    left = np.maximum.accumulate(np.where(kept, place, 0))[rest]
    right = np.minimum.accumulate(np.where(kept, place, len(points) - 1)[::-1])[::-1][rest]
    while len(rest):
        gap = _gap(points[rest], points[left], points[right])
        first = np.flatnonzero(np.diff(left, prepend=-1))
        worst = np.maximum.reduceat(gap, first)
        count = np.diff(first, append=len(rest))
        far = np.repeat(worst > tolerance, count)
        farthest = np.flatnonzero(far & (gap == np.repeat(worst, count)))
        split = rest[farthest[np.unique(left[farthest], return_index=True)[1]]]
        kept[split] = True
        middle = np.repeat(split, count[worst > tolerance])
        rest, left, right = rest[far], left[far], right[far]
        left, right = np.where(rest > middle, middle, left), np.where(rest < middle, middle, right)
        rest, left, right = (values[rest != middle] for values in (rest, left, right))
    return kept


def _gap(point: Array, start: Array, end: Array) -> Array:
    """The distance of each point from the straight stretch between its start and end, (K,) m."""
    along, arm = end - start, point - start
    square = np.sum(along**2, axis=1)
    share = np.divide(np.sum(arm * along, axis=1), square, out=np.zeros_like(square), where=square > 0.0)
    return np.asarray(np.linalg.norm(arm - np.clip(share, 0.0, 1.0)[:, None] * along, axis=1))
