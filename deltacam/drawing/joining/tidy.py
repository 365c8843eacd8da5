"""Small repairs of closed curves that stay within stated distances, and which of them are no contours at all."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.drawing.joining.nodes import MOVED
from deltacam.drawing.nesting.outlines import is_mess
from deltacam.geometry import curve as curves
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import Array, BoolArray, Curve, IntArray

SHORTEST: Final = 1e-6
"""Shorter segments are merged into their neighbours, m."""


def speckled(pack: Pack) -> IntArray:
    """Which curves have segments under ``SHORTEST``."""
    curve = np.repeat(np.arange(len(pack)), pack.counts)
    return np.unique(curve[rings.segment_lengths(pack) < SHORTEST])


def tiny(pack: Pack) -> BoolArray:
    """Whether each curve is smaller than 0.01 mm overall."""
    boxes = pack.bounds()
    return np.asarray((boxes[:, 2:] - boxes[:, :2]).max(axis=1, initial=0.0) < MOVED)


def slivers(pack: Pack) -> list[int]:
    """The closed curves that are nowhere as wide as 0.01 mm, like a line drawn back and forth."""
    thin = 2.0 * np.abs(rings.signed_areas(pack)) <= MOVED * pack.lengths()
    return [i for i in np.flatnonzero(thin).tolist() if _is_sliver(pack[i])]


def halved(curve: Curve) -> Curve:
    """The line, once, that a closed curve draws back and forth."""
    one = int(np.argmax(np.hypot(*(curve.points - curve.points[0]).T)))
    other = int(np.argmax(np.hypot(*(curve.points - curve.points[one]).T)))
    start, end = sorted((one, other))
    return Curve(points=curve.points[start : end + 1], bulges=curve.bulges[start:end], closed=False)


# GEOS may leave a floating point flag behind where faces vanish; what it returns is sound.
@np.errstate(invalid="ignore")
def _is_sliver(curve: Curve) -> bool:
    """Whether a closed curve without much area to one side encloses nothing; a figure of eight does."""
    from shapely import Polygon, make_valid

    points, _ = curves.flatten(curve, 0.1 * MOVED)
    if len(points) < 3:
        return True
    if is_mess(Polygon(points)):
        return False
    return bool(make_valid(Polygon(points)).buffer(-0.5 * MOVED).is_empty)


def cleaned(curve: Curve) -> tuple[Curve | None, float]:
    """A closed curve without segments under ``SHORTEST``, and how far that moves it, m; None where nothing is left.

    Vertices nearer than that, along the curve, to the last one kept are dropped. A kept vertex at the end of a line
    gives way to the start of an arc, so that the arc stays exact.
    """
    reach = curves.lengths(curve)
    if (reach >= SHORTEST).all():
        return curve, 0.0
    first = int(np.argmax(reach))
    if reach[first] < SHORTEST and reach.sum() < 4.0 * SHORTEST:
        return None, 0.0
    points, bulges, reach = (np.roll(each, -first, axis=0) for each in (curve.points, curve.bulges, reach))
    kept, leaving, moved = [points[0]], [bulges[0]], 0.0
    walked = reach[0]
    for i in range(1, len(points)):
        if walked >= SHORTEST:
            kept.append(points[i])
            leaving.append(bulges[i])
            walked = reach[i]
            continue
        moved = max(moved, walked)
        into_arc = bulges[i] != 0.0 and reach[i] >= SHORTEST
        if into_arc and len(kept) > 1 and leaving[-2] == 0.0:
            kept[-1] = points[i]
        leaving[-1] = bulges[i] if reach[i] >= SHORTEST else 0.0
        walked += reach[i]
    if walked < SHORTEST:
        moved = max(moved, walked)
        kept.pop()
        leaving.pop()
    if len(kept) < 2:
        return None, 0.0
    return _rolled(np.array(kept), np.array(leaving), len(curve.points) - first), moved


def _rolled(points: Array, bulges: Array, back: int) -> Curve:
    """A closed curve that starts ``back`` vertices later, as far as there are so many."""
    by = -(back % len(points))
    return Curve(points=np.roll(points, by, axis=0), bulges=np.roll(bulges, by))
