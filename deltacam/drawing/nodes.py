"""Which ends of open curves meet: a spatial index over the ends, in two steps.

Ends that coincide, up to rounding in the file, share a node. Only ends that then stand alone may bridge a gap up to
the joining tolerance. So a curve shorter than the tolerance stays a curve where its ends meet others exactly, and a
chain of tiny curves never collapses into one place.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.errors import DrawingError
from deltacam.model import Array, BoolArray, IntArray
from deltacam.units import to_mm

JOINING: Final = 1e-5
"""Ends up to 0.01 mm apart are joined."""

COINCIDENT: Final = 1e-7
"""Ends up to 0.1 um apart are the same: the rounding of the numbers in a file."""

MAX_PAIRS: Final = 5_000_000
"""More pairs of neighbouring ends than this, and 100 per end, are refused: they would not fit into memory."""


@dataclass(frozen=True, slots=True, eq=False)
class Nodes:
    """Where the ends of M curves meet.

    Attributes:
        labels: (M, 2) the node of each curve's start and end.
        places: (K, 2) m, one end at each node.
        specks: (M,) curves shorter than the gap that is bridged across them; they take part in no node.
    """

    labels: IntArray
    places: Array
    specks: BoolArray


def find(ends: Array, reach: Array) -> Nodes:
    """The nodes where open curves meet.

    Args:
        ends: (M, 2, 2) m, the start and the end of each curve.
        reach: (M,) m, how long each is.

    Raises:
        DrawingError: thousands of ends in one place.
    """
    flat = ends.reshape(-1, 2)
    labels = _clusters(flat, COINCIDENT)
    _check_extent(flat, labels)
    alone = np.flatnonzero(np.bincount(labels)[labels] == 1)
    specks, tiny = np.zeros(len(ends), dtype=np.bool_), reach <= JOINING
    groups = _clusters(flat[alone], JOINING)
    order = np.argsort(groups, kind="stable")
    counts = np.bincount(groups)
    for group in np.split(alone[order], np.cumsum(counts)[:-1]):
        if len(group) > 1:
            _bridge(group, flat, labels, specks, tiny)
    _, first, tidy = np.unique(labels, return_index=True, return_inverse=True)
    return Nodes(tidy.reshape(-1, 2).astype(np.int64), flat[first], specks)


def _check_extent(points: Array, labels: IntArray) -> None:
    """Raises where a row of ends, each near the next, runs further than ends are joined."""
    count = int(labels.max()) + 1
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, labels, points)
    np.maximum.at(high, labels, points)
    wide = np.flatnonzero(np.hypot(*(high - low).T) > JOINING)
    if len(wide):
        raise _crowd(low[wide[0]])


def _crowd(place: Array) -> DrawingError:
    """The error for more ends in one place than a drawing has."""
    x, y = to_mm(float(place[0])), to_mm(float(place[1]))
    return DrawingError(f"thousands of line ends crowd in one place, near ({x:.3f}, {y:.3f}) mm")


def _bridge(group: IntArray, flat: Array, labels: IntArray, specks: BoolArray, tiny: BoolArray) -> None:
    """Gives the ends of one group a common node; tiny curves with both ends in a larger group are specks."""
    if len(group) > 2:
        curves_of, times = np.unique(group // 2, return_counts=True)
        inner = curves_of[(times == 2) & tiny[curves_of]]
        specks[inner] = True
        group = group[~np.isin(group // 2, inner)]
    # Neighbours of neighbours may lie far apart; such a row of ends is no place where they meet.
    if len(group) and np.hypot(*np.ptp(flat[group], axis=0)) <= JOINING:
        labels[group] = labels[group[:1]]


def _clusters(points: Array, distance: float) -> IntArray:
    """The connected group, counted from 0, of each point (N, 2) when points up to ``distance`` apart are neighbours."""
    if not len(points):
        return np.zeros(0, dtype=np.int64)
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    unique, inverse = np.unique(points, axis=0, return_inverse=True)
    index = cKDTree(unique)
    if index.count_neighbors(index, distance) > MAX_PAIRS + 100 * len(unique):
        raise _crowd(unique[0])
    pairs = index.query_pairs(distance, output_type="ndarray")
    shape = (len(unique), len(unique))
    links = coo_array((np.ones(len(pairs), dtype=np.int8), (pairs[:, 0], pairs[:, 1])), shape=shape)
    _, labels = connected_components(links, directed=False)
    return np.asarray(labels[inverse.reshape(-1)], dtype=np.int64)
