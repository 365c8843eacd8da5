"""The path of the beam's centre: half a kerf beside the drawn contour, as lines and arcs.

Shapely's ``buffer`` of the flattened contour decides the topology: what is left of the contour, and in how many pieces.
Each edge of its result is then traced back to the line or arc of the drawing, or to the corner, that it is the offset
of, and the exact offset elements are joined where they meet. So the path keeps the tangency and the radii of the
drawing, and no error of flattening is left in it. Convex contours need none of this; see `convex`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt
import shapely

from deltacam.cutting.convex import offset_convex
from deltacam.cutting.trace import Source, trace_ring
from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import Array, Contour, Curve, Cut, Finding, Operation
from deltacam.units import to_mm

FLATTENING: Final = 1e-6
"""Sagitta, m, at which contours are flattened and rounds approximated for shapely."""

SMALLEST_RING: Final = 2e-5
"""Perimeter, m, below which what a kerf leaves of a contour counts as nothing."""

CLEARANCE_SLACK: Final = 3e-6
"""How far, m, a cut may run into another contour before it is refused: above the errors of reading and flattening."""


@dataclass(frozen=True, slots=True)
class KerfResult:
    """The cuts of a drawing, in the order of its contours, and what a person should know about them."""

    cuts: tuple[Cut, ...]
    findings: tuple[Finding, ...]


def offset(contours: Sequence[Contour], *, kerf: float) -> KerfResult:
    """Shift closed contours that are cut by half the kerf to their waste side, so that the part keeps its drawn size.

    The waste is outside an outline and inside a hole. Convex corners are rounded about the drawn corner, as the exact
    offset is. What is engraved or open is followed on the line itself; engraving may touch and cross anything.

    Args:
        contours: m; those that are closed and cut are counter-clockwise, none crossing another.
        kerf: width of the cut, m, >= 0.

    Returns:
        one cut per contour, or several where the kerf splits it, which is reported; so is an open line whose slot meets
        the edge of a part.

    Raises:
        InfeasibleError: the kerf swallows a contour, or the cut of one runs into another.
    """
    results = [_offset_one(contour, kerf) for contour in contours]
    _refuse_swallowed([contour for contour, result in zip(contours, results, strict=True) if not result.cuts], kerf)
    cuts = tuple(cut for result in results for cut in result.cuts)
    closed = [contour for contour in contours if contour.has_kerf]
    shifted = {contour.number for contour in closed}
    _refuse_collisions(closed, [cut for cut in cuts if cut.contour in shifted], kerf)
    slots = [contour for contour in contours if contour.operation is Operation.CUT and not contour.curve.closed]
    findings = [finding for result in results for finding in result.findings]
    return KerfResult(cuts, (*findings, *_meeting_edges(slots, closed, kerf)))


def _offset_one(contour: Contour, kerf: float) -> KerfResult:
    """The cuts of one contour; none where the kerf swallows it."""
    if kerf == 0.0 or not contour.has_kerf:
        return KerfResult((_cut(contour, contour.curve),), ())
    shift = -kerf / 2.0 if contour.is_hole else kerf / 2.0
    convex = offset_convex(contour.curve, shift)
    if convex is not None and curves.length(convex) > SMALLEST_RING:
        return KerfResult((_cut(contour, convex),), ())
    points, segment = curves.flatten(contour.curve, FLATTENING)
    region = shapely.Polygon(points if len(points) >= 3 else None).buffer(shift, quad_segs=_quad_segments(kerf / 2.0))
    pieces = [piece for piece in getattr(region, "geoms", [region]) if not piece.is_empty]
    parts = [shapely.geometry.polygon.orient(piece) for piece in pieces]
    rings = [ring for part in parts for ring in (part.exterior, *part.interiors) if ring.length > SMALLEST_RING]
    source = Source(contour.curve, points, segment, shift)
    traced = [trace_ring(source, shapely.get_coordinates(ring)[:-1]) for ring in rings]
    return KerfResult(tuple(_cut(contour, ring) for ring in traced), _pieces_finding(contour, rings, kerf))


def _refuse_swallowed(swallowed: Sequence[Contour], kerf: float) -> None:
    """Refuse contours that leave no room for the beam, and say where they all are."""
    if not swallowed:
        return
    first, *others = swallowed
    places = [f"{other.number} at {_place(other.curve.points.mean(axis=0))}" for other in others]
    more = f"; also contours {', '.join(places)}" if places else ""
    raise InfeasibleError(
        f"a kerf of {to_mm(kerf):.3g} mm swallows this contour {_size(first.curve)}{more}",
        where=f"{first.where} at {_place(first.curve.points.mean(axis=0))}",
        hint="use a narrower kerf (--kerf), or take what is too small out of the drawing",
    )


def _quad_segments(radius: float) -> int:
    """How many chords a quarter turn of ``radius`` m needs to stay within a third of ``FLATTENING``."""
    step = 2.0 * np.arccos(max(0.0, 1.0 - FLATTENING / (3.0 * radius)))
    return max(8, int(np.ceil(0.5 * np.pi / step)))


def _cut(contour: Contour, curve: Curve) -> Cut:
    return Cut(
        contour=contour.number,
        layer=contour.layer,
        handles=contour.handles,
        curve=curve,
        operation=contour.operation,
    )


def _pieces_finding(contour: Contour, rings: Sequence[shapely.LinearRing], kerf: float) -> tuple[Finding, ...]:
    if len(rings) <= 1:
        return ()
    places = ", ".join(_place(shapely.get_coordinates(ring.centroid)[0]) for ring in rings)
    return (
        Finding(
            what=f"a kerf of {to_mm(kerf):.3g} mm does not fit through the contour everywhere: it splits into "
            f"{len(rings)} cuts about {places}, and the narrow places between them stay uncut",
            where=contour.where,
            hint="use a narrower kerf (--kerf), or widen the narrow places of the drawing",
        ),
    )


def _refuse_collisions(contours: Sequence[Contour], cuts: Sequence[Cut], kerf: float) -> None:
    """Refuse cuts that come nearer than half a kerf to a contour that is not theirs: they would cut into it."""
    clearance = kerf / 2.0 - CLEARANCE_SLACK
    if clearance <= 0.0 or len(contours) < 2:
        return
    drawn = _outlines([contour.curve for contour in contours])
    paths = _outlines([cut.curve for cut in cuts])
    path, other = shapely.STRtree(drawn).query(paths, predicate="dwithin", distance=clearance)
    numbers = np.array([contour.number for contour in contours])
    hit = numbers[other] != np.array([cut.contour for cut in cuts])[path]
    if not hit.any():
        return
    pairs = sorted({(min(a, b), max(a, b)) for a, b in zip(path[hit].tolist(), other[hit].tolist(), strict=True)})
    first = int(np.flatnonzero(hit)[0])
    cut, contour = cuts[path[first]], contours[other[first]]
    meeting = shapely.get_coordinates(shapely.shortest_line(paths[path[first]], drawn[other[first]]))[1]
    more = f" (and {len(pairs) - 1} more)" if len(pairs) > 1 else ""
    raise InfeasibleError(
        f"a kerf of {to_mm(kerf):.3g} mm is wider than the gap to {contour.where}, which would be cut into{more}",
        where=f"{cut.where} at {_place(meeting)}",
        hint="use a narrower kerf (--kerf), or move the contours apart: by one kerf, and --common-edges cuts the edge "
        "between two parts once; lines shared by two parts must be drawn once",
    )


def _meeting_edges(slots: Sequence[Contour], closed: Sequence[Contour], kerf: float) -> tuple[Finding, ...]:
    """One finding for all open lines that are cut within half a kerf of a closed contour: they open its edge there."""
    if not slots or not closed:
        return ()
    drawn = _outlines([contour.curve for contour in closed])
    lines = _outlines([contour.curve for contour in slots])
    slot, edge = shapely.STRtree(drawn).query(lines, predicate="dwithin", distance=kerf / 2.0)
    if not len(slot):
        return ()
    place = shapely.get_coordinates(shapely.shortest_line(lines[slot[0]], drawn[edge[0]]))[1]
    count = len(set(slot.tolist()))
    lead = "1 open line that is cut meets" if count == 1 else f"{count} open lines that are cut meet"
    return (
        Finding(
            what=f"{lead} the edge of a part, where a slot of {to_mm(kerf):.3g} mm opens it: "
            f"{closed[edge[0]].where} at {_place(place)}" + (", and more" if len(slot) > 1 else ""),
            where=slots[slot[0]].where,
            hint="if that is not meant, shorten the line, or engrave or ignore open lines",
            kind="touching",
            place=(float(place[0]), float(place[1])),
        ),
    )


def _outlines(lines: Sequence[Curve]) -> npt.NDArray[np.object_]:
    """Each curve as a line string, flattened."""
    pack = Pack.of(lines)
    points, owner = rings.flatten(pack, FLATTENING)
    first = np.searchsorted(owner, np.flatnonzero(pack.closed))
    last = np.searchsorted(owner, np.flatnonzero(pack.closed), side="right")  # where the first point comes once more
    points, owner = np.insert(points, last, points[first], axis=0), np.insert(owner, last, owner[first])
    return np.asarray(shapely.linestrings(points, indices=owner))


def _place(point: Array) -> str:
    return f"({to_mm(point[0]):.3f}, {to_mm(point[1]):.3f}) mm"


def _size(curve: Curve) -> str:
    left, bottom, right, top = curves.bounds(curve)
    return f"of {to_mm(right - left):.3g} x {to_mm(top - bottom):.3g} mm"
