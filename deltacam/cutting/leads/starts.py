"""Where on a closed cut it may begin: where a person says so, or by the rule of the process."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np
import shapely

from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.model import Array, Contour, Curve, Cut, IntArray, StartRule
from deltacam.units import to_mm

_SHARP: Final = np.radians(10.0)
_FLATTENING: Final = 1e-6  # m
_FINER: Final = 8  # times as many places are tried where most of a cut is not free
_BESIDE: Final = 0.5e-3  # m; a place that is farther from all contours means none of them
_HINT: Final = "give a place on a closed contour that is cut, in the coordinates of the report (--start-at)"


class Start(NamedTuple):
    """A place on a cut: the segment, and the distance from its start, m."""

    segment: int
    distance: float


def given_starts(
    places: Sequence[tuple[float, float]], cuts: Sequence[Cut], contours: Sequence[Contour]
) -> dict[int, Start]:
    """Where cuts begin because a person says so, by the index of the cut.

    Args:
        places: on closed contours that are cut, m.
        cuts: of the contours.
        contours: of the drawing.

    Raises:
        InfeasibleError: a place is on no such contour, or two are on one.
    """
    found: dict[int, Start] = {}
    for x, y in places:
        point, where = np.array([x, y]), f"the start at ({to_mm(x):.3f}, {to_mm(y):.3f}) mm"
        contour = _contour_at(point, contours, where)
        own = [index for index, cut in enumerate(cuts) if cut.contour == contour.number and cut.curve.closed]
        if not own:
            what = f"contour {contour.number} has no cut that goes around and could begin there"
            raise InfeasibleError(what, where=where, hint=_HINT)
        index = min(own, key=lambda one: curves.nearest(cuts[one].curve, point)[2])
        if index in found:
            what = f"the cut of contour {contour.number} already begins elsewhere"
            raise InfeasibleError(what, where=where, hint="give one place for every contour")
        found[index] = Start(*curves.nearest(cuts[index].curve, point)[:2])
    return found


def _contour_at(point: Array, contours: Sequence[Contour], where: str) -> Contour:
    """The closed contour that a place, (2,) m, is on."""
    drawn = [contour for contour in contours if contour.has_kerf]
    if not drawn:
        raise InfeasibleError("no closed contour is cut", where=where, hint=_HINT)
    away = [curves.nearest(contour.curve, point)[2] for contour in drawn]
    nearest = int(np.argmin(away))
    if away[nearest] > _BESIDE:
        what = f"there is no closed contour that is cut; contour {drawn[nearest].number} is nearest, "
        what += f"{to_mm(away[nearest]):.3f} mm away"
        raise InfeasibleError(what, where=where, hint=_HINT)
    return drawn[nearest]


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
