"""Curves that draw the same line, in whatever direction and however they are split."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.drawing.joining import near
from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Array, BoolArray, Curve, IntArray

SAME: Final = 1e-5
"""Curves nowhere more than 0.01 mm apart draw the same line: a beam is wider."""

_WEIGHT: Final = 0.5 * (5.0**0.5 - 1.0)


def find(drawn: Pack) -> dict[int, int]:
    """For each curve that repeats an earlier one, the index of that one; an open one never repeats a closed one.

    Candidates share their bounding box, found with a spatial index over the boxes. How far apart two may be is a tenth
    of their length for curves so short that neighbours along a fine polyline would count as the same.

    Raises:
        DrawingError: thousands of curves in one place.
    """
    if len(drawn) < 2:
        return {}
    found = _exact(drawn)
    rest = np.setdiff1d(np.arange(len(drawn)), np.fromiter(found, dtype=np.int64, count=len(found)))
    pack = drawn.take(rest)
    lengths = pack.lengths()
    allowed = np.minimum(SAME, 0.1 * lengths)
    pairs = _candidates(pack, lengths, allowed)
    single = ~pack.closed & (pack.counts == 2)
    both = single[pairs].all(axis=1)
    matching = both.copy()
    matching[both] = _same_segments(pack, pairs[both], allowed)
    later: dict[int, int] = {}
    for at in np.flatnonzero(matching | ~both).tolist():
        i, j = pairs[at].tolist()
        if i not in later and j not in later and (both[at] or same(pack[i], pack[j])):
            later[j] = i
    copies = found | {int(rest[j]): int(rest[i]) for j, i in later.items()}
    return {j: copies.get(i, i) for j, i in sorted(copies.items())}


def same(one: Curve, other: Curve) -> bool:
    """Whether two curves draw the same line, nowhere further apart than ``SAME`` and a tenth of their length."""
    reach = curves.length(one)
    tolerance = min(SAME, 0.1 * reach)
    if one.closed != other.closed or abs(reach - curves.length(other)) > 2.0 * tolerance + 1e-6 * reach:
        return False
    return _follows(one, other, tolerance) and _follows(other, one, tolerance)


def _exact(drawn: Pack) -> dict[int, int]:
    """Copies with the same numbers, found without comparing each with each."""
    first: dict[tuple[bool, bytes, bytes], int] = {}
    found = {}
    single = ~drawn.closed & (drawn.counts == 2)
    segments = np.flatnonzero(single)
    which = near.distinct(_segment_rows(drawn, segments))
    _, begin = np.unique(which, return_index=True)
    original = segments[begin[which]]
    repeats = original != segments
    found = dict(zip(segments[repeats].tolist(), original[repeats].tolist(), strict=True))
    for i in np.flatnonzero(~single).tolist():
        low, high = drawn.first[i], drawn.first[i + 1]
        key = (bool(drawn.closed[i]), drawn.points[low:high].tobytes(), drawn.bulges[low:high].tobytes())
        if first.setdefault(key, i) != i:
            found[i] = first[key]
    return found


def _segment_rows(drawn: Pack, which: IntArray) -> Array:
    """The ends and the bulge of curves of one segment each, (K, 5), the same for either direction."""
    low = drawn.first[which]
    start, end, bulge = drawn.points[low], drawn.points[low + 1], drawn.bulges[low]
    swapped = (start[:, 0] > end[:, 0]) | ((start[:, 0] == end[:, 0]) & (start[:, 1] > end[:, 1]))
    ends = np.where(swapped[:, None], np.hstack([end, start]), np.hstack([start, end]))
    return np.column_stack([ends, np.where(swapped, -bulge, bulge)])


def _candidates(pack: Pack, lengths: Array, allowed: Array) -> IntArray:
    """Pairs i < j, (K, 2), of curves of a kind with the same bounding box and about the same length."""
    boxes = pack.bounds()
    # An index over two numbers is several times as fast as over four. With an irrational weight, boxes that differ
    # hardly ever agree in both, even in a drawing on a grid or with many circles about one centre.
    pairs = near.pairs(boxes[:, :2] + _WEIGHT * boxes[:, 2:], 1.5 * (1.0 + _WEIGHT) * SAME)
    one, other = pairs.T
    fits = np.abs(boxes[one] - boxes[other]).max(axis=1, initial=0.0) <= allowed[one]
    fits &= pack.closed[one] == pack.closed[other]
    fits &= np.abs(lengths[one] - lengths[other]) <= 4.0 * allowed[one] + 1e-6 * lengths[one]
    return np.asarray(pairs[fits])


def _same_segments(pack: Pack, pairs: IntArray, allowed: Array) -> BoolArray:
    """Whether each pair, (K, 2), of single lines or arcs has the same ends and middle, in either direction."""
    low = pack.first[:-1]
    start, end = pack.points[low], pack.points[pack.first[1:] - 1]
    step, _ = pack.chords()
    # The middle of an arc rises by bulge * chord / 2 to the right of its chord.
    rise = 0.5 * pack.bulges[low, None] * np.column_stack([step[low, 1], -step[low, 0]])
    middle = 0.5 * (start + end) + rise
    one, other = pairs.T

    def apart(first: Array, second: Array) -> Array:
        return np.asarray(np.hypot(*(first[one] - second[other]).T))

    ends = np.minimum(
        np.maximum(apart(start, start), apart(end, end)), np.maximum(apart(start, end), apart(end, start))
    )
    return np.asarray(np.maximum(ends, apart(middle, middle)) <= allowed[one])


def _follows(one: Curve, other: Curve, tolerance: float) -> bool:
    """Whether every vertex and every middle of a segment of ``one`` lies on ``other``."""
    return all(curves.nearest(other, mark)[2] <= tolerance for mark in _marks(one))


def _marks(curve: Curve) -> Array:
    """The vertices and the middles of the segments, (K, 2) m."""
    middles, _ = curves.evaluate(curve, np.arange(len(curve.bulges)), 0.5 * curves.lengths(curve))
    return np.concatenate([curve.points, middles])
