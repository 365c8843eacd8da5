"""Curves that draw the same line, in whatever direction and however they are split."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve


def find(drawn: Sequence[Curve], tolerance: float) -> dict[int, int]:
    """For each curve that repeats an earlier one, the index of that one.

    Candidates share their bounding box, found with a spatial index over the boxes.

    Args:
        drawn: any curves; an open one never repeats a closed one.
        tolerance: largest distance between the two, m; a tenth of the length for curves so short that neighbours
            along a fine polyline would count as the same.
    """
    if len(drawn) < 2:
        return {}
    from scipy.spatial import cKDTree

    boxes = np.array([curves.bounds(curve) for curve in drawn])
    apart = [_allowed(curve, tolerance) for curve in drawn]
    index = cKDTree(boxes)
    crowded = index.query_ball_point(boxes, apart, p=np.inf, return_length=True) > 1
    found: dict[int, int] = {}
    for i in np.flatnonzero(crowded).tolist():
        if i in found:
            continue
        for j in sorted(index.query_ball_point(boxes[i], apart[i], p=np.inf)):
            if j > i and j not in found and same(drawn[i], drawn[j], tolerance):
                found[j] = i
    return found


def same(one: Curve, other: Curve, tolerance: float) -> bool:
    """Whether two curves draw the same line within the tolerance, m, and within a tenth of their length."""
    tolerance = _allowed(one, tolerance)
    if one.closed != other.closed:
        return False
    if not one.closed and len(one.points) == len(other.points) == 2:
        return _same_segment(one, other, tolerance) or _same_segment(one, curves.reverse(other), tolerance)
    if abs(curves.length(one) - curves.length(other)) > 2.0 * tolerance + 1e-6 * curves.length(one):
        return False
    return _follows(one, other, tolerance) and _follows(other, one, tolerance)


def _allowed(curve: Curve, tolerance: float) -> float:
    """How far a duplicate of the curve may be from it, m."""
    return min(tolerance, 0.1 * curves.length(curve))


def _same_segment(one: Curve, other: Curve, tolerance: float) -> bool:
    """Whether two single lines or arcs have the same ends and middle."""
    return bool(np.hypot(*(_marks(one) - _marks(other)).T).max() <= tolerance)


def _follows(one: Curve, other: Curve, tolerance: float) -> bool:
    """Whether every vertex and every middle of a segment of ``one`` lies on ``other``."""
    return all(curves.nearest(other, mark)[2] <= tolerance for mark in _marks(one))


def _marks(curve: Curve) -> Array:
    """The vertices and the middles of the segments, (K, 2) m."""
    middles, _ = curves.evaluate(curve, np.arange(len(curve.bulges)), 0.5 * curves.lengths(curve))
    return np.concatenate([curve.points, middles])
