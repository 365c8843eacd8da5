"""Curves of single entities to closed loops and open chains; every curve that is part of neither gets a reason."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from itertools import chain as chained
from typing import Final

import numpy as np

from deltacam.drawing import flaws
from deltacam.drawing.flaws import Name, point_mm
from deltacam.drawing.joining import along, chains, duplicates, nodes, overlaps, tangles, tidy
from deltacam.drawing.joining.link import link
from deltacam.drawing.joining.overlaps import Strands
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import DEFAULT_JOINING, Array, Curve, Finding, IntArray, Outcome
from deltacam.units import to_mm

NOTHING_INSIDE: Final = "a closed line that encloses nothing"
"""The reason of a sliver: a line drawn back and forth."""

_TOO_SMALL: Final = (Outcome.IGNORED, "smaller than 0.01 mm overall")

_SPECK: Final = (Outcome.MERGED, "shorter than the joining tolerance of 0.01 mm")

_TANGLED: Final = "meets others at a branch point"


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
    kept = _kept(found, joined)
    strands = Strands(found.take(kept[~found.closed[kept]]), kept[~found.closed[kept]])
    web = _Web.of(strands, joining)
    if web.traced.ambiguous:
        split = overlaps.untangle(strands, [step >> 1 for step in chained.from_iterable(web.traced.ambiguous)])
        if split:
            joined.copies |= split.copies
            web = _Web.of(split.strands, joining)
    for i in np.flatnonzero(web.nodes.specks).tolist():
        joined.notes[int(web.strands.owner[i])] = _SPECK
    _add_loops(found, kept[found.closed[kept]], web, joined)
    _add_chains(web, joined)
    joined.chains.sort(key=lambda chain: min(chain.members))
    _note_copies(joined, name)
    _report(found, web, joined, joining, name)
    return joined


@dataclass(frozen=True, slots=True, eq=False)
class _Web:
    """Open curves, where they meet, and what they form."""

    strands: Strands
    nodes: nodes.Nodes
    traced: chains.Chains

    @classmethod
    def of(cls, strands: Strands, joining: float) -> _Web:
        met = nodes.find(strands.pack.ends(), strands.pack.lengths(), joining)
        return cls(strands, met, chains.trace(met))

    def members(self, steps: Iterable[int]) -> tuple[int, ...]:
        """The curves of the drawing in a chain of steps; one may contribute several pieces."""
        owner = self.strands.owner
        return tuple(dict.fromkeys(int(owner[step >> 1]) for step in steps))


def _kept(found: Pack, joined: Joined) -> IntArray:
    """The indices of the curves to join: those that have a length and repeat no other."""
    points = found.lengths() <= nodes.COINCIDENT
    joined.notes |= dict.fromkeys(np.flatnonzero(points).tolist(), (Outcome.IGNORED, "of length zero"))
    kept = np.flatnonzero(~points)
    repeated = duplicates.find(found.take(kept))
    joined.copies |= {int(kept[later]): int(kept[first]) for later, first in repeated.items()}
    return np.delete(kept, list(repeated))


def _add_loops(found: Pack, closed: IntArray, web: _Web, joined: Joined) -> None:
    """Puts the loops that enclose something, each once, into the result, and what only looks like one elsewhere."""
    pack, moved, members = _rings(found, closed, web)
    small = tidy.tiny(pack)
    slivers = set(tidy.slivers(pack))
    repaired: dict[int, Curve] = {}
    for i in tidy.speckled(pack).tolist():
        curve, shift = (None, 0.0) if small[i] or i in slivers else tidy.cleaned(pack[i])
        if curve is None:
            small[i] |= i not in slivers
        else:
            repaired[i], moved[i] = curve, moved[i] + shift
    for i in np.flatnonzero(small).tolist():
        joined.notes |= dict.fromkeys(members[i], _TOO_SMALL)
    for i in sorted(slivers - set(np.flatnonzero(small).tolist())):
        line = tidy.halved(pack[i])
        gap = float(np.hypot(*(line.points[-1] - line.points[0])))
        joined.chains.append(Chain(line, members[i], NOTHING_INSIDE, gap))
    solid = [i for i in range(len(pack)) if not small[i] and i not in slivers]
    rest = pack.take(np.array(solid, dtype=np.int64))
    if repaired:
        rest = Pack.of(repaired.get(i) or pack[i] for i in solid)
    repeated = duplicates.find(rest)
    for later, first in repeated.items():
        joined.copies |= dict.fromkeys(members[solid[later]], members[solid[first]][0])
    joined.loops = [Loop(rest[at], members[i], float(moved[i])) for at, i in enumerate(solid) if at not in repeated]


def _rings(found: Pack, closed: IntArray, web: _Web) -> tuple[Pack, Array, list[tuple[int, ...]]]:
    """All closed curves, counter-clockwise, how far a point of each was moved, m, and their members."""
    single = found.take(closed)
    single = rings.reverse(single, rings.signed_areas(single) < 0.0)
    loops = web.traced.loops
    linked, moved = link(web.strands.pack, loops, closed=True)
    wrong = rings.signed_areas(linked) < 0.0
    if wrong.any():
        loops = [
            [step ^ 1 for step in (loop[0], *reversed(loop[1:]))] if turned else loop
            for loop, turned in zip(loops, wrong.tolist(), strict=True)
        ]
        linked, moved = link(web.strands.pack, loops, closed=True)
    members = [(i,) for i in closed.tolist()] + [web.members(loop) for loop in loops]
    order = sorted(range(len(members)), key=lambda i: members[i][0])
    pack = rings.both(single, linked).take(np.array(order, dtype=np.int64))
    return pack, np.concatenate([np.zeros(len(single)), moved])[order], [members[i] for i in order]


def _add_chains(web: _Web, joined: Joined) -> None:
    """Puts the lines that do not close into the result; those under 0.01 mm become notes."""
    steps = web.traced.open + web.traced.ambiguous
    pack, _ = link(web.strands.pack, steps, closed=False)
    lengths, small, ends = pack.lengths(), tidy.tiny(pack), pack.ends()
    gaps = np.hypot(*(ends[:, 1] - ends[:, 0]).T)
    for i, run in enumerate(steps):
        members, tangled, gap = web.members(run), i >= len(web.traced.open), float(gaps[i])
        if small[i] and not tangled:
            joined.notes |= dict.fromkeys(members, _TOO_SMALL)
            continue
        curve = pack[i]
        count = "an open line" if len(members) == 1 else f"an open chain of {len(members)} entities"
        why = _TANGLED if tangled else _ends_in_words(curve, gap)
        nearly = not tangled and _is_nearly_closed(curve, gap, float(lengths[i]))
        joined.chains.append(Chain(curve, members, f"{count}, {why}", gap, nearly, tangled))


def _is_nearly_closed(curve: Curve, gap: float, reach: float) -> bool:
    """Whether an open curve is an outline but for a gap, like the holding tab of a part."""
    return len(curve.bulges) > 1 and (gap <= 0.05 * reach or gap <= min(flaws.NEAR, 0.25 * reach))


def _ends_in_words(curve: Curve, gap: float) -> str:
    """Where an open chain ends."""
    start, end = curve.points[0], curve.points[-1]
    if gap <= flaws.NEAR and len(curve.bulges) > 1:
        return f"gap of {to_mm(gap):.3g} mm at {point_mm(start)} mm"
    return f"from {point_mm(start)} to {point_mm(end)} mm"


def _note_copies(joined: Joined, name: Name) -> None:
    """Notes every curve that is drawn twice, with one that is not."""
    for later, first in joined.copies.items():
        while first in joined.copies:
            first = joined.copies[first]
        joined.copies[later] = first
        joined.notes[later] = (Outcome.MERGED, f"duplicate of {name(first)}")


def _report(found: Pack, web: _Web, joined: Joined, joining: float, name: Name) -> None:
    """The findings about how the curves meet."""
    joined.findings += flaws.copies(joined.copies, found, name)
    joined.findings += flaws.branches(web.nodes.places[web.traced.branches])
    joined.findings += tangles.find(web.strands, web.nodes, web.traced.ambiguous, name)
    joined.findings += _on_loops(joined, name)
    opened = [chain for chain in joined.chains if not chain.ambiguous and chain.reason != NOTHING_INSIDE]
    gaps = [chain for chain in opened if chain.gap <= flaws.NEAR and len(chain.curve.bulges) > 1]
    joined.findings += flaws.limited(
        [flaws.gap(chain.gap, chain.curve.points[0], name(chain.members[0])) for chain in gaps]
    )
    joined.findings += flaws.between(*_free_ends(web), joining, name)
    joined.findings += flaws.joined(*_wide_nodes(web), name)
    slivers = [chain for chain in joined.chains if chain.reason == NOTHING_INSIDE]
    joined.findings += flaws.slivers([(chain.curve.points[0], name(chain.members[0])) for chain in slivers])
    short = np.flatnonzero(found.lengths() < nodes.MOVED).tolist()
    dropped = [i for i, note in sorted(joined.notes.items()) if note in (_TOO_SMALL, _SPECK)]
    kept = sum(i not in joined.notes for i in short)
    joined.findings += flaws.tiny(dropped, kept, found, name)


def _on_loops(joined: Joined, name: Name) -> list[Finding]:
    """The findings that open chains lie on loops; it becomes their reason."""
    found = []
    for at, loop in along.find([chain.curve for chain in joined.chains], [loop.curve for loop in joined.loops]).items():
        chain = joined.chains[at]
        reason = f"lies along contour of {name(joined.loops[loop].members[0])}"
        joined.chains[at] = replace(chain, reason=reason)
        found.append(
            Finding(reason, where=name(chain.members[0]), kind="duplicate", place=flaws.place(chain.curve.points[0]))
        )
    return flaws.limited(found)


def _wide_nodes(web: _Web) -> tuple[Array, Array, list[int]]:
    """Nodes that join ends further apart than they are joined unasked: (N, 2) m, how far apart, (N,) m, and a curve."""
    ends, node_of = web.strands.pack.ends().reshape(-1, 2), web.nodes.labels.reshape(-1)
    low, high = np.full((len(web.nodes.places), 2), np.inf), np.full((len(web.nodes.places), 2), -np.inf)
    np.minimum.at(low, node_of, ends)
    np.maximum.at(high, node_of, ends)
    apart = np.hypot(*(high - low).T)
    wide = np.flatnonzero(apart > nodes.MOVED)
    _, first = np.unique(node_of, return_index=True)
    return low[wide], apart[wide], web.strands.owner[first[wide] // 2].tolist()


def _free_ends(web: _Web) -> tuple[Array, list[int], list[int]]:
    """Ends of open chains that meet nothing, (E, 2) m, the chain of each, and a curve of each chain."""
    ends = np.array([(run[0], run[-1] ^ 1) for run in web.traced.open], dtype=np.int64).reshape(-1)
    node_of = web.nodes.labels.reshape(-1)
    met = np.bincount(node_of[np.repeat(~web.nodes.specks, 2)], minlength=len(web.nodes.places))
    free = np.flatnonzero(met[node_of[ends]] == 1)
    curves = [int(web.strands.owner[run[0] >> 1]) for run in web.traced.open]
    return web.strands.pack.ends().reshape(-1, 2)[ends[free]], (free // 2).tolist(), curves
