"""The leads of every cut: as long as they should be, and where there is no room for that, shorter or elsewhere.

At every place where a cut may begin, leads are tried in full size, then smaller ones. Those places stay whose leads are
the longest. Where even that is short in a hole, the tool comes from its middle on half a circle.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, Final, NamedTuple

import numpy as np
import shapely

from deltacam.cutting.leads import shapes, sizes
from deltacam.cutting.leads.shapes import Ends
from deltacam.cutting.leads.sizes import Ability, Size
from deltacam.cutting.leads.starts import starts_off
from deltacam.cutting.leads.waste import Waste
from deltacam.geometry import curve as curves
from deltacam.model import (
    Array,
    BlockKind,
    BoolArray,
    Contour,
    Curve,
    Cut,
    Finding,
    IntArray,
    Operation,
    Process,
    Stretch,
)
from deltacam.units import to_mm

FACTORS: Final = (1.0, 0.8, 0.6, 0.45, 0.33, 0.25, 0.18, 0.12)
"""The sizes that are tried, as parts of what a lead should have."""

CENTRE: Final = (1.0, 0.8, 0.6)
"""The sizes of half circles from the middle of a hole, likewise."""

PLACES: Final = 8
"""Places per cut that are tried where the rule leaves a choice."""

_FEW: Final = 4
_MANY: Final = 3000  # cuts, from which on fewer places are tried
_ENOUGH: Final = 0.5  # of the length; a shorter lead-in in a hole is compared with one from the middle
_NAMED: Final = 5


@dataclass(frozen=True, slots=True, eq=False)
class Approach:
    """A way to begin and to end a closed cut.

    Attributes:
        segment: of the cut at which it begins.
        distance: from the start of the segment, m.
        lead_in: ends there; None where the laser pierces on the contour.
        lead_out: begins where the overcut ends; None where the tool stops there.
        share: how long the lead-in is, as a part of what it should be.
    """

    segment: int
    distance: float
    lead_in: Curve | None
    lead_out: Curve | None
    share: float


class _Rows(NamedTuple):
    """Places of all cuts, (N,) each: whose they are, where they are, and the ends of both leads."""

    cut: IntArray
    segment: IntArray
    distance: Array
    begin: Ends
    end: Ends

    def chosen(self, which: IntArray | BoolArray) -> _Rows:
        return _Rows(
            self.cut[which],
            self.segment[which],
            self.distance[which],
            self.begin.chosen(which),
            self.end.chosen(which),
        )


class Tried(NamedTuple):
    """How large leads can be: the part of what they should have, (N,), 0 for none, and their size."""

    share: Array
    size: Size


def has_leads(process: Process) -> bool:
    """Whether closed cuts begin or end otherwise than on the contour itself."""
    return process.lead_in.shape != "none" or process.lead_out.shape != "none" or process.overcut > 0.0


def approaches(
    cuts: Sequence[Cut],
    contours: Sequence[Contour],
    *,
    process: Process,
    waste: Waste,
    able: Callable[[Array], Ability],
    tick: float,
    clear: Mapping[int, Sequence[Curve]] = MappingProxyType({}),
) -> tuple[list[tuple[Approach, ...]], tuple[Finding, ...]]:
    """The ways in which each cut may begin and end, the best leads only, and what a person should know of them.

    Args:
        cuts: with their kerf, sheet frame.
        contours: of the drawing.
        process: says what leads there are.
        waste: where they may lie.
        able: what the tool can do at places (N, 2) m.
        tick: of the controller, s; an overcut is longer by the way of one.
        clear: by number of contour, edges on which its cut should not begin; it does where there is nothing else.

    Returns:
        for every cut its approaches, none for what is open or engraved, or may begin anywhere without leads.
    """
    closed = [k for k, cut in enumerate(cuts) if cut.curve.closed and cut.operation is Operation.CUT]
    found: list[tuple[Approach, ...]] = [() for _ in cuts]
    if not has_leads(process):
        closed = [k for k in closed if cuts[k].contour in clear]
    if not closed:
        return found, ()
    rows = _rows(cuts, closed, contours, process, tick, clear)
    feed = np.array([cut.feed or process.feed for cut in cuts])[rows.cut]
    deviation = 0.4 * process.tolerance
    at_begin, at_end = able(rows.begin.place), able(rows.end.place)
    inwards = rows.begin.backwards()
    full = sizes.wanted(process.lead_in, feed, at_begin, deviation)
    into = _from_the_middle(_tried(inwards, full, waste), full, rows, inwards, cuts, waste)
    out = _tried(rows.end, sizes.wanted(process.lead_out, feed, at_end, deviation), waste)
    for rows_of_cut in np.split(np.arange(len(rows.cut)), np.flatnonzero(np.diff(rows.cut)) + 1):
        index = int(rows.cut[rows_of_cut[0]])
        kept = rows_of_cut[_best(into.share[rows_of_cut], out.share[rows_of_cut])]
        found[index] = tuple(_approach(rows, into, out, row) for row in kept.tolist())
    return found, _findings(cuts, found, process)


def begun(cut: Cut, approach: Approach, *, process: Process, tick: float) -> Cut:
    """The cut with the way of the tool along an approach."""
    ring = curves.start_at(cut.curve, approach.segment, approach.distance)
    around = curves.opened(ring)
    way = [Stretch(BlockKind.CUT, around)]
    beyond = _overcut(process, cut, tick)
    if approach.lead_in is not None:
        way.insert(0, Stretch(BlockKind.LEAD_IN, approach.lead_in))
    if beyond > 0.0:
        way.append(Stretch(BlockKind.OVERCUT, curves.part(around, 0.0, beyond)))
    if approach.lead_out is not None:
        way.append(Stretch(BlockKind.LEAD_OUT, approach.lead_out))
    return replace(cut, curve=ring, way=tuple(way))


def _overcut(process: Process, cut: Cut, tick: float) -> float:
    """How far the way goes beyond the start of a cut, m: the laser goes off at a tick."""
    if process.overcut == 0.0:
        return 0.0
    return min(process.overcut + (cut.feed or process.feed) * tick, curves.length(cut.curve))


def _rows(
    cuts: Sequence[Cut],
    closed: Sequence[int],
    contours: Sequence[Contour],
    process: Process,
    tick: float,
    clear: Mapping[int, Sequence[Curve]],
) -> _Rows:
    """All places where the closed cuts may begin, with both ends of their leads."""
    drawn = {contour.number: contour for contour in contours}
    count = PLACES if len(closed) < _MANY else _FEW
    columns: list[tuple[Any, ...]] = []
    for index in closed:
        cut = cuts[index]
        edges = clear.get(cut.contour, ())
        segment, distance = starts_off(edges, cut.curve, process.start, count=count, kerf=process.kerf)
        place, heading = curves.evaluate(cut.curve, segment, distance)
        far, onwards = _beyond(cut.curve, segment, distance, _overcut(process, cut, tick))
        side = np.full(len(segment), waste_side(cut, drawn[cut.contour], process.kerf))
        columns.append((np.full(len(segment), index), segment, distance, place, heading, far, onwards, side))
    of, segment, distance, place, heading, far, onwards, side = (
        np.concatenate(part) for part in zip(*columns, strict=True)
    )
    return _Rows(of, segment, distance, Ends(place, heading, side), Ends(far, onwards, side))


def _beyond(curve: Curve, segment: IntArray, distance: Array, way: float) -> tuple[Array, Array]:
    """Where the tool is, and its direction, ``way`` m beyond places of a closed curve."""
    length = curves.lengths(curve)
    ends = np.cumsum(length)
    at = np.mod(ends[segment] - length[segment] + distance + way, ends[-1])
    on = np.minimum(np.searchsorted(ends, at, side="left"), len(length) - 1)
    return curves.evaluate(curve, on, at - (ends[on] - length[on]))


def waste_side(cut: Cut, contour: Contour, kerf: float) -> float:
    """On which side of a cut the waste is: 1 for left, inside of it, and -1 for right, outside."""
    if contour.is_hole:
        return 1.0
    inside = kerf > 0.0 and curves.signed_area(cut.curve) < curves.signed_area(contour.curve)
    return 1.0 if inside else -1.0


def _tried(ends: Ends, size: Size, waste: Waste) -> Tried:
    """The largest leads that fit, of sizes ``size`` and smaller."""
    exists = (size.line + size.radius) > 0.0
    share = np.where(exists, 0.0, 1.0)
    for factor in FACTORS:
        left = np.flatnonzero(share == 0.0)
        if not len(left):
            break
        free = waste.is_free(shapes.ways(ends.chosen(left), size.chosen(left).scaled(factor)))
        share[left[free]] = factor
    return Tried(share, Size(size.line * share, size.radius * share, size.turn, size.angle))


def _from_the_middle(tried: Tried, full: Size, rows: _Rows, inwards: Ends, cuts: Sequence[Cut], waste: Waste) -> Tried:
    """Leads from the middle of holes that leave no room for others; ``full`` is the size that leads should have."""
    best = np.zeros(len(cuts))
    np.maximum.at(best, rows.cut, tried.share)
    short = np.flatnonzero((best[rows.cut] < _ENOUGH) & (rows.begin.side > 0.0))
    if not len(short):
        return tried
    room = {index: _inscribed(cuts[index].curve) for index in np.unique(rows.cut[short]).tolist()}
    half = 0.5 * np.array([room[index] for index in rows.cut[short].tolist()])
    share, size = tried.share.copy(), Size(*(column.copy() for column in tried.size))
    for factor in CENTRE:
        arcs = Size(np.zeros(len(short)), factor * half, np.full(len(short), np.pi), np.zeros(len(short)))
        part = np.minimum(arcs.length / full.length[short], 1.0)
        better = waste.is_free(shapes.ways(inwards.chosen(short), arcs)) & (part > share[short])
        for column, new in zip(size, arcs, strict=True):
            column[short[better]] = new[better]
        share[short[better]] = part[better]
    return Tried(share, size)


def _inscribed(curve: Curve) -> float:
    """The radius of the largest circle in a closed curve, m."""
    points, _ = curves.flatten(curve, 1e-5)
    line = shapely.maximum_inscribed_circle(shapely.Polygon(points), tolerance=1e-5)
    return float(line.length)


def _best(into: Array, out: Array) -> BoolArray:
    """Which places of a cut have the longest lead-ins, and of these the longest lead-outs."""
    longest = into == into.max()
    return np.asarray(longest & (out == out[longest].max()))


def _approach(rows: _Rows, into: Tried, out: Tried, row: int) -> Approach:
    return Approach(
        segment=int(rows.segment[row]),
        distance=float(rows.distance[row]),
        lead_in=shapes.lead_in(rows.begin, into.size, row) if into.share[row] else None,
        lead_out=shapes.lead_out(rows.end, out.size, row) if out.share[row] else None,
        share=float(into.share[row]),
    )


def _findings(cuts: Sequence[Cut], found: Sequence[tuple[Approach, ...]], process: Process) -> tuple[Finding, ...]:
    """What a person should know: which lead-ins are shorter than they should be, and which cuts have none."""
    if process.lead_in.shape == "none":
        return ()
    short = [(choices[0].share, cuts[k]) for k, choices in enumerate(found) if choices and choices[0].share < 1.0]
    some = sorted((one for one in short if one[0] > 0.0), key=lambda one: (one[0], one[1].contour))
    none = [cut for share, cut in short if share == 0.0]
    findings = []
    if some:
        names = ", ".join(f"contour {cut.contour} to {100.0 * share:.0f} %" for share, cut in some[:_NAMED])
        more = f" and {len(some) - _NAMED} more" if len(some) > _NAMED else ""
        what = f"{len(some)} lead-ins are shortened for lack of room: {names}{more}"
        findings.append(Finding(what, where=some[0][1].where, hint=_ROOM, kind="lead"))
    if none:
        places = ", ".join(f"contour {cut.contour} at {_at(cut)}" for cut in none[:_NAMED])
        more = f" and {len(none) - _NAMED} more" if len(none) > _NAMED else ""
        what = f"{len(none)} cuts are pierced on the contour, where no lead-in has room: {places}{more}"
        findings.append(Finding(what, where=none[0].where, hint=_ROOM, kind="lead"))
    return tuple(findings)


_ROOM: Final = "leave more room between the parts, or ask for shorter leads (--lead-in)"


def _at(cut: Cut) -> str:
    x, y = to_mm(cut.curve.points[0][0]), to_mm(cut.curve.points[0][1])
    return f"({x:.3f}, {y:.3f}) mm"
