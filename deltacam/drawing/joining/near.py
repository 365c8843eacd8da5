"""Which points of a drawing are near each other, with a spatial index and a bound on the work."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.errors import DrawingError
from deltacam.model import Array, IntArray
from deltacam.units import to_mm

MAX_PAIRS: Final = 5_000_000
"""More pairs of neighbours than this, and 100 per point, are refused: they would not fit into memory."""


def clusters(points: Array, distance: float) -> IntArray:
    """The connected group of each point, (N,) counted from 0, where points up to ``distance`` apart are neighbours.

    Args:
        points: (N, 2) m.
        distance: m.

    Raises:
        DrawingError: thousands of points in one place.
    """
    if len(points) < 2:
        return np.zeros(len(points), dtype=np.int64)
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    which = distinct(points)
    count = int(which.max()) + 1
    unique = np.empty((count, 2))
    unique[which] = points
    links = pairs(unique, distance)
    if not len(links):
        return which
    matrix = coo_array((np.ones(len(links), dtype=np.int8), (links[:, 0], links[:, 1])), shape=(count, count))
    _, labels = connected_components(matrix, directed=False)
    return np.asarray(labels[which], dtype=np.int64)


def distinct(rows: Array) -> IntArray:
    """For each row, (N, K), the number of its value among the different ones, (N,)."""
    if not len(rows):
        return np.zeros(0, dtype=np.int64)
    order = np.lexsort(rows.T[::-1])
    ordered = rows[order]
    new = np.any(ordered[1:] != ordered[:-1], axis=1)
    which = np.empty(len(rows), dtype=np.int64)
    which[order] = np.concatenate([[0], np.cumsum(new)])
    return which


def pairs(points: Array, distance: float) -> IntArray:
    """The pairs i < j of points, (K, 2), that are no more than ``distance`` apart.

    Args:
        points: (N, 2) m.
        distance: m.

    Raises:
        DrawingError: thousands of points in one place.
    """
    from scipy.spatial import cKDTree

    index = cKDTree(points, balanced_tree=False, compact_nodes=False)
    if index.count_neighbors(index, distance) > MAX_PAIRS + 100 * len(points):
        raise crowd(points[0])
    found = index.query_pairs(distance, output_type="ndarray")
    return np.asarray(found[np.lexsort((found[:, 1], found[:, 0]))], dtype=np.int64)


def crowd(place: Array) -> DrawingError:
    """The error for more lines in one place than a drawing has."""
    x, y = to_mm(float(place[0])), to_mm(float(place[1]))
    return DrawingError(f"thousands of line ends crowd in one place, near ({x:.3f}, {y:.3f}) mm")
