"""Curves of single entities to closed loops; every curve that becomes part of none gets a reason."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from deltacam.drawing import chains, duplicates, nodes, tidy
from deltacam.drawing.entities import Drawn, Entity
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve, Finding, Outcome
from deltacam.units import to_mm

NEAR: Final = 2e-3
"""The ends of an open chain that are closer than this, m, are named as a gap: a micro-joint, or a mistake."""

NOTHING_INSIDE: Final = "a closed line that encloses nothing"
"""The reason of a sliver: a line drawn back and forth."""

_LISTED: Final = 8


@dataclass(frozen=True, slots=True, eq=False)
class Loop:
    """A closed curve and the entities that it is made of.

    Attributes:
        curve: closed, counter-clockwise, m.
        members: indices of its entities in the order of the curve, the first of the file first.
        error: largest distance from what the entities draw, m.
    """

    curve: Curve
    members: tuple[int, ...]
    error: float


@dataclass(slots=True)
class Joined:
    """The result of joining.

    Attributes:
        loops: in the order of their first entity.
        notes: what became of each entity that is on no loop, by index: outcome and reason.
        copies: entities that repeat an entity of a loop, or one without a loop: index to index.
        open_chains: how many there are.
        outlines: open chains that are closed but for a small gap, m.
        tangles: chains between branch points, m; they enclose something, but it is not clear what.
        findings: what a person should know.
    """

    loops: list[Loop] = field(default_factory=list)
    notes: dict[int, tuple[Outcome, str]] = field(default_factory=dict)
    copies: dict[int, int] = field(default_factory=dict)
    open_chains: int = 0
    outlines: list[Curve] = field(default_factory=list)
    tangles: list[Curve] = field(default_factory=list)
    findings: list[Finding] = field(default_factory=list)


def join(found: Drawn) -> Joined:
    """The closed loops that the entities form, joining ends at ``nodes.JOINING``; arcs stay exact.

    Raises:
        DrawingError: thousands of ends in one place.
    """
    joined, entities = Joined(), found.entities
    drawn = _drawn(found, joined)
    repeated = duplicates.find([curve for _, curve in drawn], nodes.JOINING)
    for later, first in repeated.items():
        joined.copies[drawn[later][0]] = drawn[first][0]
    drawn = [pair for i, pair in enumerate(drawn) if i not in repeated]
    loops = [Loop(curve, (i,), entities[i].error) for i, curve in drawn if curve.closed]
    strands = [pair for pair in drawn if not pair[1].closed]
    loops += _loops(strands, entities, joined)
    _keep(sorted(loops, key=lambda loop: loop.members[0]), entities, joined)
    _report_copies(joined, entities)
    return joined


def point_mm(point: Array) -> str:
    """A place for messages: ``(12.000, 3.500)``, mm."""
    return f"({to_mm(float(point[0])):.3f}, {to_mm(float(point[1])):.3f})"


def _drawn(found: Drawn, joined: Joined) -> list[tuple[int, Curve]]:
    """The curves to join, with the index of their entity."""
    drawn = []
    for k, (i, length) in enumerate(zip(found.owner.tolist(), found.curves.lengths(), strict=True)):
        if length <= nodes.COINCIDENT:
            joined.notes[i] = (Outcome.IGNORED, f"a {found.entities[i].kind} of length zero")
            continue
        drawn.append((i, found.curves[k]))
    return drawn


def _loops(strands: list[tuple[int, Curve]], entities: Sequence[Entity], joined: Joined) -> list[Loop]:
    """The loops of open curves; the others get a reason each, and findings that count them."""
    if not strands:
        return []
    ends = np.array([(curve.points[0], curve.points[-1]) for _, curve in strands])
    found = nodes.find(ends, np.array([curves.length(curve) for _, curve in strands]))
    traced = chains.trace(found)
    for i in np.flatnonzero(found.specks).tolist():
        joined.notes[strands[i][0]] = (Outcome.MERGED, "shorter than the joining tolerance of 0.01 mm")
    if traced.branches:
        joined.findings.append(_branch_finding(found.places[traced.branches]))
    ambiguous = [(chain, "meets others at a branch point") for chain in traced.ambiguous]
    open_chains = [(chain, _gap(chain, strands)) for chain in traced.open] + ambiguous
    for chain, reason in open_chains:
        count = "an open line" if len(chain) == 1 else f"an open chain of {len(chain)} entities"
        for i, _ in chain:
            joined.notes[strands[i][0]] = (Outcome.IGNORED, f"{count}, {reason}")
    joined.open_chains = len(open_chains)
    joined.tangles = [_open_curve(chain, strands) for chain in traced.ambiguous]
    opened = [_open_curve(chain, strands) for chain in traced.open]
    joined.outlines = [curve for curve in opened if _is_nearly_closed(curve)]
    joined.findings += _open_findings([entities[strands[chain[0][0]][0]].layer for chain, _ in open_chains])
    return [_loop(chain, strands, entities) for chain in traced.loops]


def _open_curve(chain: list[chains.Step], strands: list[tuple[int, Curve]]) -> Curve:
    """The curve of an open chain."""
    return tidy.link([curves.reverse(strands[i][1]) if turned else strands[i][1] for i, turned in chain], closed=False)[
        0
    ]


def _is_nearly_closed(curve: Curve) -> bool:
    """Whether an open curve is an outline but for a gap, like the holding tab of a part."""
    gap, reach = float(np.hypot(*(curve.points[-1] - curve.points[0]))), curves.length(curve)
    return len(curve.bulges) > 1 and (gap <= 0.05 * reach or gap <= min(NEAR, 0.25 * reach))


def _loop(chain: list[chains.Step], strands: list[tuple[int, Curve]], entities: Sequence[Entity]) -> Loop:
    """The loop of a closed chain, counter-clockwise from its first entity."""
    pieces = [curves.reverse(strands[i][1]) if turned else strands[i][1] for i, turned in chain]
    curve, moved = tidy.link(pieces, closed=True)
    if curves.signed_area(curve) < 0.0:
        chain = chain[:1] + [(i, not turned) for i, turned in reversed(chain[1:])]
        pieces = [curves.reverse(pieces[0]), *(curves.reverse(piece) for piece in reversed(pieces[1:]))]
        curve, moved = tidy.link(pieces, closed=True)
    members = tuple(strands[i][0] for i, _ in chain)
    return Loop(curve, members, moved + max(entities[i].error for i in members))


def _keep(loops: list[Loop], entities: Sequence[Entity], joined: Joined) -> None:
    """Puts the loops that enclose something, each once, into the result."""
    solid = []
    for loop in loops:
        ring = curves.reverse(loop.curve) if curves.signed_area(loop.curve) < 0.0 else loop.curve
        curve, moved = (None, 0.0) if _is_sliver(ring) else tidy.cleaned(ring)
        if curve is None:
            for i in loop.members:
                joined.notes[i] = (Outcome.IGNORED, NOTHING_INSIDE)
            joined.findings.append(
                Finding("a closed line encloses nothing and is not cut", where=entities[loop.members[0]].where)
            )
        else:
            solid.append(replace(loop, curve=curve, error=loop.error + moved))
    repeated = duplicates.find([loop.curve for loop in solid], nodes.JOINING)
    for later, first in repeated.items():
        for i in solid[later].members:
            joined.copies[i] = solid[first].members[0]
    joined.loops = [loop for i, loop in enumerate(solid) if i not in repeated]


def _is_sliver(curve: Curve) -> bool:
    """Whether a closed curve is nowhere as wide as the joining tolerance, like a line drawn back and forth."""
    if 2.0 * abs(curves.signed_area(curve)) > nodes.JOINING * curves.length(curve):
        return False
    # A figure of eight has no signed area either; what it encloses decides.
    from shapely import Polygon, make_valid

    points, _ = curves.flatten(curve, 1e-6)
    if len(points) < 3:
        return True
    return bool(make_valid(Polygon(points)).buffer(-0.5 * nodes.JOINING).is_empty)


def _gap(chain: list[chains.Step], strands: list[tuple[int, Curve]]) -> str:
    """Where an open chain ends, in words."""
    (first, turned), (last, last_turned) = chain[0], chain[-1]
    start = strands[first][1].points[-1 if turned else 0]
    end = strands[last][1].points[0 if last_turned else -1]
    gap = float(np.hypot(*(end - start)))
    if gap <= NEAR and len(chain) + len(strands[first][1].bulges) > 2:
        return f"gap of {to_mm(gap):.3g} mm at {point_mm(start)} mm"
    return f"from {point_mm(start)} to {point_mm(end)} mm"


def _branch_finding(places: Array) -> Finding:
    """The finding that more than two lines meet in the places, (K, 2) m."""
    listed = ", ".join(point_mm(place) for place in places[:_LISTED])
    more = f" and {len(places) - _LISTED} more" if len(places) > _LISTED else ""
    many = "1 place" if len(places) == 1 else f"{len(places)} places"
    hint = "lines that could be closed in more than one way stay open: draw each outline for itself"
    return Finding(f"more than two lines meet in {many}", where=f"{listed}{more} mm", hint=hint)


def _open_findings(layers: list[str]) -> list[Finding]:
    """One finding per layer that counts its open chains."""
    found = []
    for layer, count in Counter(layers).items():
        what = "1 open chain is not cut" if count == 1 else f"{count} open chains are not cut"
        found.append(Finding(what, where=f"layer {layer}", hint="close them in the drawing if they are outlines"))
    return found


def _report_copies(joined: Joined, entities: Sequence[Entity]) -> None:
    """Notes every entity that is drawn twice, and one finding that counts them."""
    for later, first in joined.copies.items():
        joined.notes[later] = (Outcome.MERGED, f"duplicate of #{entities[first].handle}")
    if joined.copies:
        many = "1 entity is" if len(joined.copies) == 1 else f"{len(joined.copies)} entities are"
        first = min(joined.copies)
        joined.findings.append(Finding(f"{many} drawn twice and cut once", where=entities[first].where))
