"""The offset of a convex contour, without a search: every segment keeps its place and every corner its sense.

Outside a convex curve the offset of each segment is followed by the round about its end, and nothing else is nearer.
Inside it, the offsets of neighbours are cut off where they meet; where all of them keep a part that runs forwards,
these parts bound what is left of the inside: it is where all the half planes and discs overlap that the segments are
the edges of.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.cutting.trace import FIT, SAME_POINT, SHORTEST, arc_or_line, beside
from deltacam.geometry import curve as curves
from deltacam.geometry.element import Element, meeting_point, shifted
from deltacam.model import Array, Curve

_HOLLOW: Final = 1e-5  # rad; a corner that is hollow by no more is uneven drawing
_UNEVEN: Final = 1e-3  # rad; the most of that along a curve
_MOST: Final = 100  # segments; with more of them a search is faster


def offset_convex(curve: Curve, shift: float) -> Curve | None:
    """The curve at the distance ``shift`` m outside a closed curve, inside it where that is negative.

    Args:
        curve: counter-clockwise, m.
        shift: not 0.

    Returns:
        its exact lines and arcs, counter-clockwise, without rounds at corners that are too small to see; None where the
        curve is not convex, or a segment has no part in the offset, or it has very many segments.
    """
    turns, corners = curves.turns(curve), np.roll(curves.corner_angles(curve), -1)  # each at the end of its segment
    if len(turns) > _MOST or not _is_convex(turns, corners):
        return None
    start, end = curves.headings(curve)
    begins, ends = beside(curve.starts, start, shift), beside(curve.ends, end, shift)
    segments = zip(curve.starts, start.tolist(), curves.curvatures(curve).tolist(), strict=True)
    elements = [shifted(point, heading, curvature, shift) for point, heading, curvature in segments]
    if any(element.radius < 0.0 for element in elements):
        return None
    joins = [
        _join(elements[k - 1], elements[k], ends[k - 1], begins[k], float(corners[k - 1]) * shift)
        for k in range(len(elements))
    ]
    pieces = []
    for k, element in enumerate(elements):
        (_, first), (last, following) = joins[k], joins[(k + 1) % len(elements)]
        pieces.append(arc_or_line(element, first, last, float(turns[k])))
        if not _runs_forwards(element, first, last, pieces[-1][1], float(turns[k])):
            return None
        if last is not following:
            pieces.append(arc_or_line(Element(curve.ends[k], shift), last, following, float(corners[k])))
    points, bulges = (np.concatenate(part) for part in zip(*pieces, strict=True))
    found = Curve(points=points, bulges=bulges)
    return found if _is_at(curve, found, abs(shift)) else None


def _is_convex(turns: Array, corners: Array) -> bool:
    """Whether a curve of these turns and corners, (M,) rad each, is convex, and goes round once."""
    hollow = -np.minimum(corners, 0.0)
    if turns.min() < 0.0 or hollow.max() > _HOLLOW or hollow.sum() > _UNEVEN:
        return False
    return bool(abs(turns.sum() + corners.sum() - 2.0 * np.pi) < _UNEVEN)


def _join(before: Element, after: Element, end: Array, begin: Array, turned: float) -> tuple[Array, Array]:
    """Where the offset of one segment ends and that of the next begins: one place, or two with a round between them.

    Args:
        before: of the segment.
        after: of the next one.
        end: where the segment's own offset ends, (2,) m.
        begin: where that of the next one begins, (2,) m.
        turned: the length of the round about the corner, m; negative inside.
    """
    if abs(turned) < SAME_POINT:
        middle = 0.5 * (end + begin)
        return middle, middle
    if turned > 0.0:
        return end, begin
    place = meeting_point(before, after, 0.5 * (end + begin))
    place = end if place is None else place
    return place, place


def _runs_forwards(element: Element, first: Array, last: Array, bulges: Array, turn: float) -> bool:
    """Whether an offset from ``first`` to ``last`` runs the way of its segment, which turns by ``turn`` rad."""
    if element.radius == 0.0:
        return bool((last - first) @ element.direction > SHORTEST)
    run = 4.0 * float(np.arctan(bulges).sum())
    return bool(run * element.radius > SHORTEST and run <= turn + _HOLLOW)


def _is_at(curve: Curve, found: Curve, distance: float) -> bool:
    """Whether the vertices and middles of the curve ``found`` are at a distance from ``curve``, within `FIT`."""
    every, count = np.arange(len(found.bulges)), len(curve.bulges)
    middle, _ = curves.evaluate(found, every, 0.5 * curves.lengths(found))
    points = np.concatenate([found.points, middle])
    _, gap = curves.project(curve, np.tile(np.arange(count), len(points)), np.repeat(points, count, axis=0))
    return bool(np.abs(gap.reshape(-1, count).min(axis=1) - distance).max() <= FIT)
