"""Where contours cross, touch or share a line, among themselves and with themselves."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from deltacam.drawing import flaws
from deltacam.drawing.flaws import place, point_mm
from deltacam.drawing.nesting.outlines import SAGITTA, Outlines, is_mess
from deltacam.drawing.nesting.pieces import Pieces
from deltacam.model import Array, BoolArray, Contour, Finding, IntArray
from deltacam.units import to_mm

OVERLAP: Final = 1e-5
"""Two contours cross where they overlap by more than this, m; by less they touch."""

SHARED: Final = 1e-3
"""Two contours that run along each other for more than this, m, share a line."""

MOST_MEETINGS: Final = 20_000
"""More pairs of contours that meet are not told apart: they count as crossing."""

MOST_POINTS: Final = 1_000_000
"""Nor are more pairs than have so many points together."""

MOST_MEASURED: Final = 2_000_000
"""Nor is the distance of more pairs of short pieces measured."""

_EXAMINED: Final = 1000
_HINT: Final = "separate the outlines in the drawing, or put what is not to be cut on its own layer and leave it out"
_SELF_HINT: Final = "draw each outline as a line that does not meet itself"


@dataclass(frozen=True, slots=True, eq=False)
class Meetings:
    """How contours meet each other.

    Attributes:
        findings: one per pair that meets, and one that counts what is not listed.
        crossing: (K, 2) the pairs that cross.
    """

    findings: list[Finding]
    crossing: IntArray


def with_themselves(contours: Sequence[Contour], shapes: Outlines) -> list[Finding]:
    """One finding per contour that really crosses or touches itself, beyond rounding."""
    suspects = list(shapes.tangled.items())
    found = [_self_crossing(contours[i], ring) for i, ring in suspects[:_EXAMINED]]
    bad = [finding for finding in found if finding]
    return flaws.limited(bad, len(bad) + max(len(suspects) - _EXAMINED, 0)) if bad else []


def between(contours: Sequence[Contour], shapes: Outlines) -> Meetings:
    """The pairs of contours that meet, and how."""
    pairs, complete = _meeting_pieces(shapes.pieces)
    rings, which = np.unique(shapes.pieces.ring_of[pairs], axis=0, return_inverse=True)
    points = np.cumsum(shapes.vertices[rings].sum(axis=1))
    told = int(np.searchsorted(points, MOST_POINTS))
    complete &= told == len(rings)
    rings, used = rings[:told], which.reshape(-1) < told
    which = which.reshape(-1)[used]
    one, other = (shapes.pieces.lines(each) for each in pairs[used].T)
    crossing = _cross(shapes.polygons[rings[:, 0]], shapes.polygons[rings[:, 1]])
    shared, middle = _shared(one, other, which, len(rings), ~crossing)
    places = _places(one, other, which, len(rings))
    crosses, common, touches = [], [], []
    for k, (i, j) in enumerate(rings.tolist()):
        first, second = contours[i].where, contours[j].where
        spot = middle[k] if not crossing[k] and shared[k] > SHARED else places[k]
        at = f"at {point_mm(spot)} mm"
        if crossing[k]:
            crosses.append(Finding(f"it crosses {second} {at}", first, _HINT, "crossing", place(spot), blocks=True))
        elif shared[k] > SHARED:
            what = f"it shares {to_mm(float(shared[k])):.3g} mm of line with {second} {at}"
            common.append(Finding(what, first, _HINT, "common_edge", place(spot), blocks=True))
        else:
            touches.append(Finding(f"it touches {second} {at}", first, kind="touching", place=place(spot)))
    findings = [*flaws.limited(crosses), *flaws.limited(common), *flaws.limited(touches)]
    if not complete:
        what = f"more than {told} pairs of contours meet, too many to tell how"
        findings.append(Finding(what, hint=_HINT, kind="crossing", blocks=True))
    return Meetings(findings, rings[crossing])


def _self_crossing(contour: Contour, ring: Any) -> Finding | None:
    """The finding that a ring that is not simple crosses or touches itself; None where that is rounding."""
    import shapely

    if not is_mess(ring):
        parts = shapely.unary_union(ring)
        faces = shapely.get_parts(shapely.polygonize([parts]))
        wide = _is_wide(faces)
        retraced = float(ring.length - parts.length)
        if np.count_nonzero(wide) <= 1 and retraced <= OVERLAP:
            return None
    reason = str(shapely.is_valid_reason(shapely.Polygon(ring)))
    stated = re.search(r"\[(\S+) (\S+)\]", reason)
    spot = np.array(stated.groups() if stated else ring.coords[0], dtype=float)
    what = f"the contour crosses or touches itself at {point_mm(spot)} mm"
    return Finding(what, contour.where, _SELF_HINT, "self_crossing", place(spot), blocks=True)


def _meeting_pieces(pieces: Pieces) -> tuple[IntArray, bool]:
    """Pairs of pieces of different rings that meet, (K, 2), and whether those are all."""
    found, met, measured = [np.zeros((0, 2), dtype=np.int64)], 0, 0
    complete = True
    for pairs, count in pieces.meetings(SAGITTA):
        found.append(pairs)
        met += len(np.unique(pieces.ring_of[pairs], axis=0))
        measured += count
        complete = met <= MOST_MEETINGS and measured <= MOST_MEASURED
        if not complete:
            break
    pairs = np.concatenate(found)
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))], complete


def _cross(one: Any, other: Any) -> BoolArray:
    """Whether each pair of polygons, (K,), overlaps in part by more than ``OVERLAP``."""
    import shapely

    crossing = _is_wide(shapely.intersection(one, other))
    for first, second in ((one, other), (other, one)):
        crossing[crossing] = _is_wide(shapely.difference(first[crossing], second[crossing]))
    return crossing


def _is_wide(faces: Any) -> BoolArray:
    """Whether each polygon, (K,), holds a disc of the diameter ``OVERLAP``."""
    import shapely

    # No point is further from the edge than the radius of the largest disc inside, so the area is at most that radius
    # times the length of the edge.
    area = shapely.area(faces)
    wide = np.asarray(area > OVERLAP * shapely.length(faces))
    unclear = np.flatnonzero(~wide & (area > 0.0))
    wide[unclear] = ~shapely.is_empty(shapely.buffer(faces[unclear], -0.5 * OVERLAP))
    return wide


def _shared(one: Any, other: Any, pair: IntArray, count: int, wanted: BoolArray) -> tuple[Array, Array]:
    """How long the rings of each pair run along each other, (count,) m, and a middle of that, (count, 2) m.

    Args:
        one: (P,) pieces of the first rings.
        other: (P,) the pieces of the second rings that they meet.
        pair: (P,) the pair of rings that each belongs to.
        count: how many pairs there are.
        wanted: (count,) the pairs to look at.
    """
    import shapely

    used = np.flatnonzero(wanted[pair])
    along = shapely.intersection(one[used], shapely.buffer(other[used], SAGITTA, cap_style="flat"))
    length = shapely.length(along)
    total = np.bincount(pair[used], weights=length, minlength=count)
    middle = np.zeros((count, 2))
    order = np.argsort(length, kind="stable")
    lines = shapely.line_merge(along[order])
    part = shapely.get_geometry(lines, 0)
    spots = shapely.line_interpolate_point(
        np.where(shapely.get_type_id(part) == 1, part, shapely.linestrings([(0, 0), (0, 0)])), 0.5, normalized=True
    )
    middle[pair[used[order]]] = np.column_stack([shapely.get_x(spots), shapely.get_y(spots)])
    return total.astype(np.float64), middle


def _places(one: Any, other: Any, pair: IntArray, count: int) -> Array:
    """The left-most, then lowest place where the pieces of each pair of rings meet, (count, 2) m."""
    import shapely

    points = shapely.get_coordinates(shapely.shortest_line(one, other))[::2]
    order = np.lexsort((points[:, 1], points[:, 0], pair))
    _, first = np.unique(pair[order], return_index=True)
    return np.asarray(points[order[first]]).reshape(count, 2)
