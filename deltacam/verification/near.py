"""How far points are from lines, for millions of points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import shapely
from scipy.spatial import cKDTree

from deltacam.model import Array

SPACING: Final = 0.1e-3
"""Largest distance between neighbouring samples of a line where nobody says otherwise, m."""

_MANY: Final = 20_000  # points: fewer are looked up before a thread has started
_SHORTEST: Final = 1e-12  # m; shorter steps are rounding
_MOST_SAMPLES: Final = 2_000_000  # of one set of lines; a longer one is sampled more coarsely and rechecked more often


class Lines:
    """Polylines that answer how far points are from them.

    A tree of samples finds the neighbourhood of a point, the two pieces at the nearest sample bound its distance from
    above, and where that bound is not small, a tree of the pieces gives the exact distance.

    Args:
        lines: (K, 2) m each, K >= 1; at least one.
        closed: whether the last point of every line joins its first.
        spacing: largest distance between neighbouring samples of a line, m.

    Attributes:
        samples: (M, 2) m, at most ``spacing`` apart along a line, both ends of an open one among them.
        share: the length of line that every sample stands for, (M,) m.
    """

    def __init__(self, lines: Sequence[Array], *, closed: bool, spacing: float = SPACING) -> None:
        loops = [np.concatenate([line, line[:1]]) if closed else line for line in lines]
        total = sum(float(np.hypot(*np.diff(loop, axis=0).T).sum()) for loop in loops)
        spacing = max(spacing, total / _MOST_SAMPLES)
        parts = [_subdivide(loop, spacing) for loop in loops]
        counts = np.array([len(part) - 1 for part in parts])
        self._starts = np.concatenate([part[:-1] for part in parts])
        ends = np.concatenate([part[1:] for part in parts])
        # Samples are the starts of the pieces, so that the end of an open line needs one of its own.
        first = np.repeat(np.cumsum(counts) - counts, counts)
        last = first + np.repeat(counts, counts) - 1
        here = np.arange(len(self._starts))
        self._before = np.where(here > first, here - 1, last if closed else here).astype(np.int32)
        self._extra = np.unique(last)
        step = ends - self._starts
        square = step[:, 0] ** 2 + step[:, 1] ** 2
        self._pieces = (*self._starts.T, *step.T, np.divide(1.0, square, out=square, where=square > 0.0))
        self.samples, self.share = self._starts, np.hypot(*step.T)
        if not closed:
            half = 0.5 * self.share[self._extra]
            self.share[self._extra] = half
            self.samples = np.concatenate([self._starts, ends[self._extra]])
            self.share = np.concatenate([self.share, half])
        # Samples of a line come in order, so that a tree by middles is as good as one by medians, and sooner built.
        self._tree = cKDTree(self.samples, balanced_tree=False, compact_nodes=False)
        self._lines: shapely.STRtree | None = None

    def distance(self, points: Array, *, exact_above: float) -> Array:
        """How far every point is from the nearest line.

        Args:
            points: (N, 2) m.
            exact_above: m; a value below it may be too large, but stays below it.

        Returns:
            (N,) m.
        """
        _, nearest = self._tree.query(points, workers=-1 if len(points) > _MANY else 1)
        extra = nearest >= len(self._starts)
        piece = np.where(extra, self._extra[np.where(extra, nearest - len(self._starts), 0)], nearest)
        found = np.minimum(self._to_piece(points, piece), self._to_piece(points, self._before[piece]))
        far = np.flatnonzero(found > exact_above)
        if len(far):
            found[far] = self._exact(points[far])
        return np.asarray(found)

    def _to_piece(self, points: Array, piece: np.ndarray) -> Array:
        x, y, along, up, inverse = (column[piece] for column in self._pieces)
        np.subtract(points[:, 0], x, out=x)
        np.subtract(points[:, 1], y, out=y)
        share = (x * along + y * up) * inverse
        np.clip(share, 0.0, 1.0, out=share)
        x -= share * along
        y -= share * up
        return np.asarray(np.sqrt(x * x + y * y))

    def _exact(self, points: Array) -> Array:
        if self._lines is None:
            ends = self._starts + np.stack(self._pieces[2:4], axis=1)
            self._lines = shapely.STRtree(shapely.linestrings(np.stack([self._starts, ends], axis=1)))
        _, piece = self._lines.query_nearest(shapely.points(points), all_matches=False)
        return self._to_piece(points, piece)


def _subdivide(line: Array, spacing: float) -> Array:
    """A line with further points on it, at most ``spacing`` apart, without repeated ones: (M, 2) m, M >= 2."""
    step = np.diff(line, axis=0)
    length = np.hypot(*step.T)
    moving = length > _SHORTEST
    if not moving.any():
        return np.repeat(line[:1], 2, axis=0)
    start, step, length = line[:-1][moving], step[moving], length[moving]
    pieces = np.maximum(np.ceil(length / spacing), 1.0).astype(np.int64)
    index = np.arange(pieces.sum()) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    share = index / np.repeat(pieces, pieces)
    points = np.repeat(start, pieces, axis=0) + share[:, np.newaxis] * np.repeat(step, pieces, axis=0)
    return np.concatenate([points, line[-1:]])
