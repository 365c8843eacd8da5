"""Where on a closed cut it may begin, by the rule of the process."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve, IntArray, StartRule

_SHARP: Final = np.radians(10.0)
_FLATTENING: Final = 1e-6  # m
_FINER: Final = 8  # times as many places are tried where most of a cut is not free


def starts_off(
    edges: Sequence[Curve], curve: Curve, rule: StartRule, *, count: int, kerf: float
) -> tuple[IntArray, Array]:
    """Places where a closed cut may begin, none within a kerf of some ``edges``.

    Where the rule leaves none there, places are spread around the cut; and where all of it is at edges, the rule
    counts.

    Args:
        edges: open curves, m.
        curve: of the cut.
        rule: as `starts` takes it.
        count: likewise.
        kerf: width of the cut, m.
    """
    rounding = 0.51 * kerf
    found = starts(curve, rule, count=count, rounding=rounding)
    if not edges:
        return found
    lines = [shapely.LineString(curves.flatten(edge, _FLATTENING)[0]) for edge in edges]
    for segment, distance in (found, starts(curve, "best", count=_FINER * count, rounding=rounding)):
        places = shapely.points(curves.evaluate(curve, segment, distance)[0])
        free = shapely.distance(shapely.union_all(lines), places) > kerf
        if free.any():
            return segment[free], distance[free]
    return found


def starts(curve: Curve, rule: StartRule, *, count: int, rounding: float) -> tuple[IntArray, Array]:
    """Places where a closed cut may begin.

    Args:
        curve: of the cut.
        rule: at corners, in the middle of the longest edge, or spread around it.
        count: about how many places where they are spread.
        rounding: the radius that corners may have been rounded with, m.

    Returns:
        the segments (K,) and the distances from their starts (K,) m.
    """
    length = curves.lengths(curve)
    if rule == "corner":
        corners = _corners(curve, length, rounding)
        if len(corners):
            return corners, np.zeros(len(corners))
    if rule == "best":
        return _spread(length, count)
    straight = np.where(curve.bulges == 0.0, length, 0.0)
    longest = int(np.argmax(straight if straight.any() else length))
    return np.array([longest]), 0.5 * length[[longest]]


def _corners(curve: Curve, length: Array, rounding: float) -> IntArray:
    """The segments that begin at a corner, or behind the round of one."""
    behind = np.roll(curve.bulges != 0.0, 1) & (
        np.roll(length / np.maximum(np.abs(curves.turns(curve)), 1e-12), 1) <= rounding
    )
    behind &= np.roll(np.abs(curves.turns(curve)), 1) > _SHARP
    sharp = np.abs(curves.corner_angles(curve)) > _SHARP
    return np.flatnonzero((sharp | behind) & (length > 2.0 * rounding))


def _spread(length: Array, count: int) -> tuple[IntArray, Array]:
    """Places around the cut, each on the longest line or arc of its share of the way, as far from its ends as it can.

    Near the end of a line there is a corner, or a bend, that leaves no room for the blend with a lead.
    """
    ends = np.cumsum(length)
    share = ends[-1] / count
    first, last = share * np.arange(count), share * np.arange(1, count + 1)
    # What every segment has in every share of the way, (count, segments).
    low = np.maximum(first[:, None], (ends - length)[None])
    high = np.minimum(last[:, None], ends[None])
    segment = np.argmax(high - low, axis=1)
    start, reach = (ends - length)[segment], length[segment]
    middle = 0.5 * (low + high)[np.arange(count), segment] - start
    distance = np.where(reach < 2.5 * share, 0.5 * reach, np.clip(middle, 0.5 * share, reach - 0.5 * share))
    places = np.unique(np.stack([segment, distance], axis=1), axis=0)
    return places[:, 0].astype(np.int64), places[:, 1]
