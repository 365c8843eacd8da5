"""The leads of every cut: as long as they should be, and where there is no room for that, shorter or elsewhere.

At every place where a cut may begin, leads are tried in full size, then smaller ones. Those places stay at which the
tool comes fastest, as a part of what the contour allows there. Where that is too slow in a hole, the tool comes from
its middle on half a circle.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np
import shapely

from deltacam.cutting.leads import shapes, sizes
from deltacam.cutting.leads.places import Places, Spots, places
from deltacam.cutting.leads.shapes import Ends
from deltacam.cutting.leads.sizes import Ability, Size
from deltacam.cutting.leads.starts import Start
from deltacam.cutting.waste import Waste
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
    Lead,
    Operation,
    Process,
    Stretch,
)
from deltacam.units import to_mm

SMALLER: Final = (
    (1.0, 1.0),
    (1.0, 0.7),
    (0.8, 1.0),
    (1.0, 0.5),
    (0.6, 1.0),
    (0.8, 0.6),
    (0.6, 0.7),
    (0.45, 1.0),
    (0.33, 1.0),
    (0.25, 1.0),
    (0.18, 1.0),
    (0.12, 1.0),
    (0.08, 1.0),
)
"""The sizes that are tried, as parts of what a lead should have: of its lengths, and of how far its arc turns."""

CENTRE: Final = (1.0, 1.3, 1.5, 0.8, 0.6)
"""The diameters of half circles in a hole, as parts of its radius: the first begins in the middle."""

PLACES: Final = 8
"""Places per cut that are tried where the rule leaves a choice."""

REACHED: Final = 0.97
"""Part of the speed, as it is foretold, from which on it counts as reached."""

_BRIDGE: Final = 0.2e-3  # m, longer than the blends at the ends of leads
_AS_FAST: Final = 0.95  # of the highest speed, for a place that the order may choose
_ALIKE: Final = 0.01  # shares that differ by less are as good
_BLENDED: Final = 0.45  # of the tolerance, for the blend between a lead and the contour
_SPARE: Final = 1.06  # of the speed: leads of full size are made for so much, as what they bring is but foretold
_NAMED: Final = 5
_ROOM: Final = "leave more room between the parts, or lower the feed (--feed)"


@dataclass(frozen=True, slots=True, eq=False)
class Approach:
    """A way to begin and to end a closed cut.

    Attributes:
        segment: of the cut at which it begins.
        distance: from the start of the segment, m.
        lead_in: ends there; None where the laser pierces on the contour.
        lead_out: begins where the overcut ends; None where the tool stops there.
        share: the part of the speed that the tool reaches on the lead-in.
    """

    segment: int
    distance: float
    lead_in: Curve | None
    lead_out: Curve | None
    share: float


class Tried(NamedTuple):
    """Leads that fit: the part of the speed that is reached on them, (N,), 0 where none fits, and their size."""

    share: Array
    size: Size


@dataclass(frozen=True, slots=True, eq=False)
class _Asked:
    """What leads of one kind are for.

    Attributes:
        ends: where they meet contours, as `shapes.ways` takes it.
        spots: the same places.
        able: what the tool can do there.
        speed: that the tool should have there, (N,) m/s.
        full: the size that they should have.
        deviation: that blends may have, m.
    """

    ends: Ends
    spots: Spots
    able: Ability
    speed: Array
    full: Size
    deviation: float

    def shares(self, size: Size, which: IntArray) -> Array:
        """How much of the speed is reached on leads of some places; that of the full size where it is asked for."""
        able, spots = Ability(*(column[which] for column in self.able)), self.spots.chosen(which)
        found = sizes.arrival(size, able, self.deviation, spots.bend, spots.ahead)
        return np.asarray(np.minimum(found / self.speed[which], 1.0))


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
    given: Mapping[int, Start] = MappingProxyType({}),
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
        given: by index of cut, where it begins whatever the rule.

    Returns:
        for every cut its approaches, none for what is open or engraved, or may begin anywhere without leads.
    """
    closed = [k for k, cut in enumerate(cuts) if cut.curve.closed and cut.operation is Operation.CUT]
    found: list[tuple[Approach, ...]] = [() for _ in cuts]
    if not has_leads(process):
        closed = [k for k in closed if cuts[k].contour in clear or k in given]
    if not closed:
        return found, ()
    beyond = [_overcut(process, cuts[index], tick) for index in closed]
    rows = places(cuts, closed, contours, process=process, beyond=beyond, count=PLACES, clear=clear, given=given)
    feed = np.array([cut.feed or process.feed for cut in cuts])[rows.cut]
    begin = _asked(process.lead_in, feed, rows.begin, rows.begin.ends.backwards(), able, process)
    end = _asked(process.lead_out, feed, rows.end, rows.end.ends, able, process)
    into, out = _from_the_middle(_tried(begin, waste), begin, rows, cuts, waste), _tried(end, waste)
    of_cuts = np.split(np.arange(len(rows.cut)), np.flatnonzero(np.diff(rows.cut)) + 1)
    arrival = into.share * begin.speed
    kept = np.concatenate([own[_best(arrival[own], out.share[own])] for own in of_cuts])
    for index, one in zip(rows.cut[kept].tolist(), _chosen(rows, into, out, kept), strict=True):
        found[index] += (one,)
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
    """How far the way goes beyond the start of a cut, m: the laser goes off at a tick.

    Also where no overcut is asked for: leads leave the contour on a blend each, and these must not leave a bridge.
    """
    if not has_leads(process):
        return 0.0
    step = (cut.feed or process.feed) * tick
    return min(process.overcut + (step if process.overcut else min(step, _BRIDGE)), curves.length(cut.curve))


def _asked(
    lead: Lead, feed: Array, spots: Spots, ends: Ends, able: Callable[[Array], Ability], process: Process
) -> _Asked:
    """What the leads of some spots are for."""
    deviation, can = _BLENDED * process.tolerance, able(spots.ends.place)
    speed = spots.allowed(feed, can, process.tolerance)
    full = sizes.wanted(lead, _SPARE * speed, can, deviation, spots.bend)
    if lead.length is not None or lead.radius is not None or lead.shape == "line":
        speed = np.minimum(speed, sizes.arrival(full, can, deviation, spots.bend, spots.ahead))
    else:
        full = sizes.grown(full, _SPARE * speed, can, deviation, spots.bend, spots.ahead)
    return _Asked(ends, spots, can, np.maximum(speed, 1e-6), full, deviation)


def _tried(asked: _Asked, waste: Waste) -> Tried:
    """The best leads that fit, of the full size and of smaller ones."""
    full = asked.full
    exists = full.length > 0.0
    share, size = np.where(exists, 0.0, 1.0), Size(*(np.zeros_like(column) for column in full))
    for factor, turned in SMALLER:
        if turned < 1.0 and not full.turn.any():
            continue
        smaller = full.scaled(factor, turned)
        _improve(share, size, asked, smaller, np.flatnonzero(share < REACHED), waste)
    return Tried(share, size)


def _improve(share: Array, size: Size, asked: _Asked, trial: Size, which: IntArray, waste: Waste) -> None:
    """Put leads of another size, (N,), into ``share`` and ``size`` where they fit and bring more, of some places."""
    found = asked.shares(trial.chosen(which), which)
    better = found > share[which] + _ALIKE
    which, found = which[better], found[better]
    free = waste.is_free(shapely.linestrings(shapes.ways(asked.ends.chosen(which), trial.chosen(which))))
    for column, new in zip(size, trial, strict=True):
        column[which[free]] = new[which[free]]
    share[which[free]] = found[free]


def _from_the_middle(tried: Tried, asked: _Asked, rows: Places, cuts: Sequence[Cut], waste: Waste) -> Tried:
    """Leads from the middle of holes that leave no room for others."""
    best = np.zeros(len(cuts))
    np.maximum.at(best, rows.cut, tried.share)
    short = np.flatnonzero((best[rows.cut] < REACHED) & (rows.begin.ends.side > 0.0) & (asked.full.length > 0.0))
    if not len(short):
        return tried
    room = {index: _inscribed(cuts[index].curve) for index in np.unique(rows.cut[short]).tolist()}
    half = np.zeros(len(rows.cut))
    half[short] = 0.5 * np.array([room[index] for index in rows.cut[short].tolist()])
    none, turn = np.zeros_like(half), np.full_like(half, np.pi)
    for factor in CENTRE:
        _improve(tried.share, tried.size, asked, Size(none, factor * half, turn, none), short, waste)
    return tried


def _inscribed(curve: Curve) -> float:
    """The radius of the largest circle in a closed curve, m."""
    points, _ = curves.flatten(curve, 1e-5)
    line = shapely.maximum_inscribed_circle(shapely.Polygon(points), tolerance=1e-5)
    return float(line.length)


def _best(into: Array, out: Array) -> BoolArray:
    """At which places of a cut the tool comes fastest, (N,) m/s, and of these those with the best lead-outs."""
    fastest = into >= _AS_FAST * into.max()
    return np.asarray(fastest & (out >= min(out[fastest].max(), REACHED) - _ALIKE))


def _chosen(rows: Places, into: Tried, out: Tried, kept: IntArray) -> list[Approach]:
    """The approaches of some rows."""
    lead_ins = shapes.lead_ins(rows.begin.ends.chosen(kept), into.size.chosen(kept))
    lead_outs = shapes.lead_outs(rows.end.ends.chosen(kept), out.size.chosen(kept))
    share = into.share[kept]
    return [
        Approach(*row)
        for row in zip(
            rows.segment[kept].tolist(), rows.distance[kept].tolist(), lead_ins, lead_outs, share.tolist(), strict=True
        )
    ]


def _findings(cuts: Sequence[Cut], found: Sequence[tuple[Approach, ...]], process: Process) -> tuple[Finding, ...]:
    """What a person should know: which lead-ins are shorter than they should be, and which cuts have none."""
    if process.lead_in.shape == "none":
        return ()
    short = [(choices[0].share, cuts[k]) for k, choices in enumerate(found) if choices and choices[0].share < REACHED]
    some = sorted((one for one in short if one[0] > 0.0), key=lambda one: (one[0], one[1].contour))
    none = [cut for share, cut in short if share == 0.0]
    findings = []
    if some:
        names = ", ".join(f"contour {cut.contour} at {100.0 * share:.0f} %" for share, cut in some[:_NAMED])
        more = f" and {len(some) - _NAMED} more" if len(some) > _NAMED else ""
        count = "1 lead-in has" if len(some) == 1 else f"{len(some)} lead-ins have"
        what = f"{count} no room to reach the speed of the cut, which begins slower: {names}{more}"
        findings.append(Finding(what, where=some[0][1].where, hint=_ROOM, kind="lead"))
    if none:
        places = ", ".join(f"contour {cut.contour} at {_at(cut)}" for cut in none[:_NAMED])
        more = f" and {len(none) - _NAMED} more" if len(none) > _NAMED else ""
        count = "1 cut is" if len(none) == 1 else f"{len(none)} cuts are"
        what = f"{count} pierced on the contour, where no lead-in has room: {places}{more}"
        findings.append(Finding(what, where=none[0].where, hint=_ROOM, kind="lead"))
    return tuple(findings)


def _at(cut: Cut) -> str:
    x, y = to_mm(cut.curve.points[0][0]), to_mm(cut.curve.points[0][1])
    return f"({x:.3f}, {y:.3f}) mm"
