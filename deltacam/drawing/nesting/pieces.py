"""Rings in short pieces with small bounding boxes, and which pieces of different rings meet."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from deltacam.geometry.rings import batches
from deltacam.model import Array, BoolArray, IntArray

_LONGEST: Final = 8
_BATCH: Final = 1024


@dataclass(frozen=True, slots=True, eq=False)
class Pieces:
    """P runs of segments of closed polylines, each towards one quarter of the compass.

    Attributes:
        points: (N, 2) m, the vertices of all rings.
        begin: (P,) the first vertex of each piece.
        end: (P,) its last vertex.
        inner: (P,) the last vertex before that.
        ring_of: (P,) its ring.
        width: (P,) how far it leaves the straight line between its ends, m.
    """

    points: Array
    begin: IntArray
    end: IntArray
    inner: IntArray
    ring_of: IntArray
    width: Array

    @classmethod
    def of(cls, points: Array, ring_of: IntArray) -> Pieces:
        """The pieces of the rings through points, (N, 2) m, given the ring of each, (N,), in ascending order."""
        first = np.flatnonzero(np.diff(ring_of, prepend=-1))
        bounds = np.append(first, len(points))
        parts = []
        for which in batches(len(first)):
            low = int(bounds[which[0]])
            begin, end, inner, width = _split(points[low : bounds[which[-1] + 1]], bounds[which] - low)
            parts.append((begin + low, end + low, inner + low, width))
        nothing = np.zeros(0, dtype=np.int64)
        begin, end, inner = (np.concatenate([nothing, *(part[k] for part in parts)]) for k in range(3))
        width = np.concatenate([np.zeros(0), *(part[3] for part in parts)])
        return cls(points, begin, end, inner, ring_of[begin], width)

    def ends(self, which: IntArray) -> tuple[Array, Array]:
        """The first and the last point of the pieces of ``which``, (K,): (K, 2) and (K, 2) m."""
        return self.points[self.begin[which]], self.points[self.end[which]]

    def lines(self, which: IntArray) -> Any:
        """The pieces of ``which``, (K,), as shapely's linestrings."""
        import shapely

        counts = self.inner[which] - self.begin[which] + 2
        first = np.cumsum(counts) - counts
        vertex = np.repeat(self.begin[which] - first, counts) + np.arange(counts.sum())
        vertex[first + counts - 1] = self.end[which]
        return shapely.linestrings(self.points[vertex], indices=np.repeat(np.arange(len(which)), counts))

    def meetings(self, distance: float) -> Iterator[tuple[IntArray, int]]:
        """Pairs of pieces of different rings, (K, 2), no more than ``distance`` m apart, the lower ring first.

        They come in batches, with the number of pairs that had to be measured for each.
        """
        import shapely

        start, end = self.ends(np.arange(len(self.begin)))
        low, high = np.minimum(start, end) - 0.5 * distance, np.maximum(start, end) + 0.5 * distance
        # The diagonal of a box has the same bounding box and takes less memory.
        diagonals = shapely.linestrings(np.stack([low, high], axis=1))
        tree = shapely.STRtree(diagonals)
        for first in range(0, len(diagonals), _BATCH):
            one, other = tree.query(diagonals[first : first + _BATCH])
            one = one + first
            later = self.ring_of[one] < self.ring_of[other]
            one, other = one[later], other[later]
            close = ~(self._apart(one, other, distance) | self._apart(other, one, distance))
            one, other = one[close], other[close]
            met = shapely.dwithin(self.lines(one), self.lines(other), distance)
            yield np.column_stack([one[met], other[met]]), len(one)

    def _apart(self, one: IntArray, other: IntArray, distance: float) -> BoolArray:
        """Whether the second of each pair of pieces lies wholly on one side of the first, at more than a distance."""
        start, end = self.ends(one)
        ahead, behind = (_side(start, end, points) for points in self.ends(other))
        room = self.width[one] + self.width[other] + distance
        return np.asarray((np.minimum(ahead, behind) > room) | (np.maximum(ahead, behind) < -room))


def _split(points: Array, first: IntArray) -> tuple[IntArray, IntArray, IntArray, Array]:
    """Begin, end, inner and width of the pieces of rings that begin at ``first`` in points, (N, 2) m."""
    after = np.arange(1, len(points) + 1)
    after[np.append(first[1:], len(points)) - 1] = first
    x, y = np.sign(points[after] - points).T
    begins = np.ones(len(points), dtype=np.bool_)
    begins[1:] = (x[1:] != x[:-1]) | (y[1:] != y[:-1])
    begins[first] = True
    run = np.cumsum(begins) - 1
    begins |= (np.arange(len(points)) - np.flatnonzero(begins)[run]) % _LONGEST == 0
    begin = np.flatnonzero(begins)
    inner = np.append(begin[1:] - 1, len(points) - 1)
    piece = np.cumsum(begins) - 1
    away = np.abs(_side(points[begin][piece], points[after[inner]][piece], points))
    return begin, after[inner], inner, np.maximum.reduceat(away, begin)


def _side(start: Array, end: Array, points: Array) -> Array:
    """How far points, (K, 2) m, lie to the left of the lines from start to end, (K, 2) m each; (K,) m."""
    along = end - start
    reach = np.hypot(*along.T)
    arm = points - start
    across = along[:, 0] * arm[:, 1] - along[:, 1] * arm[:, 0]
    # A piece that ends where it starts has no side; its points lie around its start.
    return np.asarray(np.where(reach > 0.0, across / np.where(reach > 0.0, reach, 1.0), np.hypot(*arm.T)))
