"""Which ends of open curves meet: a spatial index over the ends, in steps.

Ends that coincide, up to rounding in the file, share a node. Only ends that then stand alone may bridge a gap up to
the joining tolerance. So a curve shorter than the tolerance stays a curve where its ends meet others exactly, and a
chain of tiny curves never collapses into one place.

Ends up to ``MOVED`` apart are moved together. Where a person allows wider gaps, an end and the one end that is clearly
nearest to it share a node as well, and a straight piece between them leaves everything drawn where it is.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.drawing.joining import near
from deltacam.model import DEFAULT_JOINING, Array, BoolArray, IntArray

COINCIDENT: Final = 1e-7
"""Ends up to 0.1 um apart are the same: the rounding of the numbers in a file."""

MOVED: Final = 1e-5
"""Ends up to 0.01 mm apart may be moved together; over wider gaps a straight piece is drawn."""


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


def find(ends: Array, reach: Array, joining: float = DEFAULT_JOINING) -> Nodes:
    """The nodes where open curves meet.

    Args:
        ends: (M, 2, 2) m, the start and the end of each curve.
        reach: (M,) m, how long each is.
        joining: how far apart ends may be that are joined, m.

    Raises:
        DrawingError: thousands of ends in one place.
    """
    flat = ends.reshape(-1, 2)
    if not len(flat):
        return Nodes(np.zeros((0, 2), dtype=np.int64), flat, np.zeros(0, dtype=np.bool_))
    labels = near.clusters(flat, COINCIDENT)
    _check_extent(flat, labels)
    specks = np.zeros(len(ends), dtype=np.bool_)
    _bridge_all(flat, labels, specks, reach, min(joining, MOVED))
    if joining > MOVED:
        _match(flat, labels, np.flatnonzero(_alone(labels) & ~np.repeat(specks, 2)), reach, joining)
    _, first, tidy = np.unique(labels, return_index=True, return_inverse=True)
    return Nodes(tidy.reshape(-1, 2).astype(np.int64), flat[first], specks)


def _alone(labels: IntArray) -> BoolArray:
    """Whether each end, (N,), is the only one at its node."""
    return np.asarray(np.bincount(labels)[labels] == 1)


def _check_extent(points: Array, labels: IntArray) -> None:
    """Raises where a row of ends, each near the next, runs further than ends are joined."""
    count = int(labels.max()) + 1
    low, high = np.full((count, 2), np.inf), np.full((count, 2), -np.inf)
    np.minimum.at(low, labels, points)
    np.maximum.at(high, labels, points)
    wide = np.flatnonzero(np.hypot(*(high - low).T) > MOVED)
    if len(wide):
        raise near.crowd(low[wide[0]])


def _bridge_all(flat: Array, labels: IntArray, specks: BoolArray, reach: Array, distance: float) -> None:
    """Gives ends that stand alone, up to ``distance`` m apart, a common node; marks the specks among their curves."""
    alone = np.flatnonzero(_alone(labels))
    groups = near.clusters(flat[alone], distance)
    order = np.argsort(groups, kind="stable")
    counts = np.bincount(groups)
    ends = np.split(alone[order], np.cumsum(counts)[:-1]) if (counts > 2).any() else []
    first = np.cumsum(counts) - counts
    two = first[counts == 2]
    labels[alone[order[two + 1]]] = labels[alone[order[two]]]
    tiny = reach <= distance
    for group in np.flatnonzero(counts > 2).tolist():
        _bridge(ends[group], flat, labels, specks, tiny, distance)


def _bridge(
    group: IntArray, flat: Array, labels: IntArray, specks: BoolArray, tiny: BoolArray, distance: float
) -> None:
    """Gives the more than two ends of a group a common node; tiny curves with both ends in the group are specks."""
    curves_of, times = np.unique(group // 2, return_counts=True)
    inner = curves_of[(times == 2) & tiny[curves_of]]
    specks[inner] = True
    group = group[~np.isin(group // 2, inner)]
    # Neighbours of neighbours may lie far apart; such a row of ends is no place where they meet.
    if len(group) and np.hypot(*np.ptp(flat[group], axis=0)) <= distance:
        labels[group] = labels[group[:1]]


def _match(flat: Array, labels: IntArray, alone: IntArray, reach: Array, distance: float) -> None:
    """Gives two ends a common node where each is the nearest to the other, and any third is twice as far from both."""
    if len(alone) < 2:
        return
    links = alone[near.pairs(flat[alone], distance)]
    gap = np.hypot(*(flat[links[:, 0]] - flat[links[:, 1]]).T)
    # A short line does not close upon itself.
    fair = (links[:, 0] // 2 != links[:, 1] // 2) | (reach[links[:, 0] // 2] > 4.0 * gap)
    links, gap = links[fair], gap[fair]
    nearest, next_to_it = np.full(len(flat), np.inf), np.full(len(flat), np.inf)
    ends, gaps = links.T.reshape(-1), np.concatenate([gap, gap])
    order = np.lexsort((gaps, ends))
    ends, gaps = ends[order], gaps[order]
    new = np.concatenate([[True], ends[1:] != ends[:-1]]) if len(ends) else np.zeros(0, dtype=np.bool_)
    nearest[ends[new]] = gaps[new]
    second = np.flatnonzero(new[:-1] & ~new[1:]) + 1
    next_to_it[ends[second]] = gaps[second]
    clear = [(gap <= nearest[end]) & (2.0 * gap < next_to_it[end]) for end in links.T]
    one, other = links[clear[0] & clear[1]].T
    labels[other] = labels[one]
