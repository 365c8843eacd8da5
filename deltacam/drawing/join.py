"""Curves of single entities to closed loops and open chains; every curve that is part of neither gets a reason."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from typing import Final

import numpy as np

from deltacam.drawing import chains, duplicates, nodes, tidy
from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import DEFAULT_JOINING, Array, Curve, Finding, Outcome
from deltacam.units import to_mm

NEAR: Final = 2e-3
"""The ends of an open chain that are closer than this, m, are named as a gap: a micro-joint, or a mistake."""

NOTHING_INSIDE: Final = "a closed line that encloses nothing"
"""The reason of a sliver: a line drawn back and forth."""

_LISTED: Final = 8


Name = Callable[[int], str]
"""How messages name a curve, by its index: ``layer CUT, LINE #2F``."""


@dataclass(frozen=True, slots=True, eq=False)
class Loop:
    """A closed curve and the curves that it is made of.

    Attributes:
        curve: closed, counter-clockwise, m.
        members: indices of the curves in the order of the loop, the first of the file first.
        error: how far joining moved a point, m.
    """

    curve: Curve
    members: tuple[int, ...]
    error: float


@dataclass(frozen=True, slots=True, eq=False)
class Chain:
    """A line that does not close, and the curves that it is made of.

    Attributes:
        curve: open, m.
        members: indices of the curves in the order of the chain.
        reason: why it is open, in words.
        gap: between its ends, m.
        nearly_closed: whether it is an outline but for a small gap.
        ambiguous: whether it runs between branch points, so that it could be closed in more than one way.
    """

    curve: Curve
    members: tuple[int, ...]
    reason: str
    gap: float
    nearly_closed: bool = False
    ambiguous: bool = False


@dataclass(slots=True)
class Joined:
    """The result of joining.

    Attributes:
        loops: in the order of their first curve.
        chains: lines that do not close, in the order of their first curve.
        notes: what became of each curve that is in no loop or chain, by index: outcome and reason.
        copies: curves that repeat a curve of a loop or chain: index to index.
        findings: what a person should know.
    """

    loops: list[Loop] = field(default_factory=list)
    chains: list[Chain] = field(default_factory=list)
    notes: dict[int, tuple[Outcome, str]] = field(default_factory=dict)
    copies: dict[int, int] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)


def join(found: Pack, *, joining: float = DEFAULT_JOINING, name: Name) -> Joined:
    """The closed loops and open chains that curves form; arcs stay exact.

    Args:
        found: the curves of the drawing, m.
        joining: how far apart ends may be that are joined, m.
        name: how messages name a curve.

    Raises:
        DrawingError: thousands of ends in one place.
    """
    joined = Joined()
    drawn = _drawn(found, joined)
    repeated = duplicates.find([curve for _, curve in drawn], nodes.JOINING)
    for later, first in repeated.items():
        joined.copies[drawn[later][0]] = drawn[first][0]
    drawn = [pair for i, pair in enumerate(drawn) if i not in repeated]
    loops = [Loop(curve, (i,), 0.0) for i, curve in drawn if curve.closed]
    strands = [pair for pair in drawn if not pair[1].closed]
    loops += _loops(strands, joined)
    _keep(sorted(loops, key=lambda loop: loop.members[0]), joined, name)
    _report_copies(joined, name)
    return joined


def point_mm(point: Array) -> str:
    """A place for messages: ``(12.000, 3.500)``, mm."""
    return f"({to_mm(float(point[0])):.3f}, {to_mm(float(point[1])):.3f})"


def _drawn(found: Pack, joined: Joined) -> list[tuple[int, Curve]]:
    """The curves to join, with their indices."""
    drawn = []
    for i, length in enumerate(found.lengths()):
        if length <= nodes.COINCIDENT:
            joined.notes[i] = (Outcome.IGNORED, "of length zero")
            continue
        drawn.append((i, found[i]))
    return drawn


def _loops(strands: list[tuple[int, Curve]], joined: Joined) -> list[Loop]:
    """The loops of open curves; the others become chains."""
    if not strands:
        return []
    ends = np.array([(curve.points[0], curve.points[-1]) for _, curve in strands])
    found = nodes.find(ends, np.array([curves.length(curve) for _, curve in strands]))
    traced = chains.trace(found)
    for i in np.flatnonzero(found.specks).tolist():
        joined.notes[strands[i][0]] = (Outcome.MERGED, "shorter than the joining tolerance of 0.01 mm")
    if traced.branches:
        joined.findings.append(_branch_finding(found.places[traced.branches]))
    every = [(chain, False) for chain in traced.open] + [(chain, True) for chain in traced.ambiguous]
    joined.chains = sorted((_chain(chain, strands, tangled) for chain, tangled in every), key=lambda c: min(c.members))
    return [_loop(chain, strands) for chain in traced.loops]


def _chain(chain: list[chains.Step], strands: list[tuple[int, Curve]], tangled: bool) -> Chain:
    """The chain of steps that do not close."""
    pieces = [curves.reverse(strands[i][1]) if turned else strands[i][1] for i, turned in chain]
    curve, _ = tidy.link(pieces, closed=False)
    count = "an open line" if len(chain) == 1 else f"an open chain of {len(chain)} entities"
    why = "meets others at a branch point" if tangled else _gap(curve)
    return Chain(
        curve=curve,
        members=tuple(strands[i][0] for i, _ in chain),
        reason=f"{count}, {why}",
        gap=float(np.hypot(*(curve.points[-1] - curve.points[0]))),
        nearly_closed=not tangled and _is_nearly_closed(curve),
        ambiguous=tangled,
    )


def _is_nearly_closed(curve: Curve) -> bool:
    """Whether an open curve is an outline but for a gap, like the holding tab of a part."""
    gap, reach = float(np.hypot(*(curve.points[-1] - curve.points[0]))), curves.length(curve)
    return len(curve.bulges) > 1 and (gap <= 0.05 * reach or gap <= min(NEAR, 0.25 * reach))


def _loop(chain: list[chains.Step], strands: list[tuple[int, Curve]]) -> Loop:
    """The loop of a closed chain, counter-clockwise from its first entity."""
    pieces = [curves.reverse(strands[i][1]) if turned else strands[i][1] for i, turned in chain]
    curve, moved = tidy.link(pieces, closed=True)
    if curves.signed_area(curve) < 0.0:
        chain = chain[:1] + [(i, not turned) for i, turned in reversed(chain[1:])]
        pieces = [curves.reverse(pieces[0]), *(curves.reverse(piece) for piece in reversed(pieces[1:]))]
        curve, moved = tidy.link(pieces, closed=True)
    return Loop(curve, tuple(strands[i][0] for i, _ in chain), moved)


def _keep(loops: list[Loop], joined: Joined, name: Name) -> None:
    """Puts the loops that enclose something, each once, into the result."""
    solid = []
    for loop in loops:
        ring = curves.reverse(loop.curve) if curves.signed_area(loop.curve) < 0.0 else loop.curve
        curve, moved = (None, 0.0) if _is_sliver(ring) else tidy.cleaned(ring)
        if curve is None:
            for i in loop.members:
                joined.notes[i] = (Outcome.IGNORED, NOTHING_INSIDE)
            what = "a closed line encloses nothing and is not cut"
            joined.findings.append(Finding(what, where=name(loop.members[0]), kind="sliver"))
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


def _gap(curve: Curve) -> str:
    """Where an open chain ends, in words."""
    start, end = curve.points[0], curve.points[-1]
    gap = float(np.hypot(*(end - start)))
    if gap <= NEAR and len(curve.bulges) > 1:
        return f"gap of {to_mm(gap):.3g} mm at {point_mm(start)} mm"
    return f"from {point_mm(start)} to {point_mm(end)} mm"


def _branch_finding(places: Array) -> Finding:
    """The finding that more than two lines meet in the places, (K, 2) m."""
    listed = ", ".join(point_mm(place) for place in places[:_LISTED])
    more = f" and {len(places) - _LISTED} more" if len(places) > _LISTED else ""
    many = "1 place" if len(places) == 1 else f"{len(places)} places"
    hint = "lines that could be closed in more than one way stay open: draw each outline for itself"
    return Finding(f"more than two lines meet in {many}", where=f"{listed}{more} mm", hint=hint, kind="branch")


def _report_copies(joined: Joined, name: Name) -> None:
    """Notes every curve that is drawn twice, and one finding that counts them."""
    for later, first in joined.copies.items():
        joined.notes[later] = (Outcome.MERGED, f"duplicate of {name(first)}")
    if joined.copies:
        many = "1 entity is" if len(joined.copies) == 1 else f"{len(joined.copies)} entities are"
        where = name(min(joined.copies))
        joined.findings.append(Finding(f"{many} drawn twice and cut once", where=where, kind="duplicate"))
