"""Common edges: where parts are one kerf apart, one cut serves both of them.

The paths of two outlines whose edges are a kerf apart run along the same line there. The one that comes first keeps its
closed cut; the path of the other loses what is shared, and open cuts are left of it, each of which begins and ends
where its path leaves the other one. The round about a corner both of whose sides are shared is left out as well: of
two cuts that end where it begins and ends, the half discs meet in the drawn corner and overlap from there on.

Outlines are ranked by the length of their path, the longest first, so that a long edge beside many short ones is cut in
one go. One whose whole path is shared would have no cut left, and what lies in it nothing to come before: it moves to
the first rank, where it keeps its own.

Why the later one must wait (`Shared.after`): its open cuts free it only where the shared edge has been cut. When they
come last, everything inside a part is cut before it is free, as for closed cuts, and no part comes loose while the
cut that frees it still has to pass along another part.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Contour, Curve, Cut, Finding, IntArray
from deltacam.units import to_mm

SHORTEST: Final = 2e-3
"""Length, m, of what two paths must share at least, so that it pays to begin anew."""

_FLATTENING: Final = 1e-6  # m
_SAME: Final = 2e-6  # m; what is shared on both sides of a smaller gap is shared in one
_PARALLEL: Final = 0.01  # rad
_NAMED: Final = 3  # pairs in a finding


class Shared(NamedTuple):
    """Cuts that cut common edges once.

    Attributes:
        cuts: in the order that they came in; open ones in the place of a closed one that shares an edge.
        after: for each contour that lost an edge those whose cuts must come before its own.
        edges: for each contour that kept a shared edge what is shared: open curves on its path, m. No cut should begin
            there and no tab be there, for the other part is right behind it.
        findings: what a person should know.
    """

    cuts: tuple[Cut, ...]
    after: Mapping[int, tuple[int, ...]]
    edges: Mapping[int, tuple[Curve, ...]]
    findings: tuple[Finding, ...]


def share_edges(
    cuts: Sequence[Cut], contours: Sequence[Contour], *, kerf: float, tolerance: float, shortest: float = SHORTEST
) -> Shared:
    """Cuts of which each common edge of neighbouring outlines is cut once.

    Args:
        cuts: as the kerf leaves them, m.
        contours: that they are of; only outlines share edges.
        kerf: width of the cut, m, >= 0.
        tolerance: how far the two paths may be apart, m, > 0: so much is the edge of the later part off.
        shortest: the least length of a common edge, m, > 0.
    """
    outlines = {one.number: one.curve.points for one in contours if one.has_kerf and not one.is_hole}
    closed = [index for index, cut in enumerate(cuts) if cut.curve.closed and cut.contour in outlines]
    if len(closed) < 2:
        return Shared(tuple(cuts), {}, {}, ())
    mine = [cuts[index] for index in closed]
    corners = [outlines[cut.contour] for cut in mine]
    kept, lost, left = _spans(_overlaps(mine, tolerance), mine, corners, kerf, shortest)
    replaced = {closed[local]: left[local] for local in lost}
    after, edges = _relations(kept, lost, mine)
    found = tuple(one for index, cut in enumerate(cuts) for one in replaced.get(index, (cut,)))
    return Shared(found, after, edges, _findings(after, lost, contours))


class _Overlaps(NamedTuple):
    """Stretches of one cut's path that run along another one's, M of them.

    Attributes:
        cut: whose path, (M,).
        other: along whose, (M,).
        begin: where on the path of the first it begins, (M,) m.
        end: where it ends, (M,) m.
    """

    cut: IntArray
    other: IntArray
    begin: Array
    end: Array


class _Span(NamedTuple):
    """A part of a closed path from ``begin`` to ``end``, m, which is past the length where it goes over the start."""

    begin: float
    end: float
    others: frozenset[int]


def _overlaps(cuts: Sequence[Cut], tolerance: float) -> _Overlaps:
    """Where the paths of cuts run along each other: pairs of segments, each a stretch of the first one."""
    first = np.cumsum([0, *(len(cut.curve.bulges) for cut in cuts)])
    owner = np.repeat(np.arange(len(cuts)), np.diff(first))
    lines = np.concatenate([_segments(cut.curve) for cut in cuts])
    one, other = shapely.STRtree(lines).query(lines, predicate="dwithin", distance=tolerance + 2.0 * _FLATTENING)
    number = np.array([cut.contour for cut in cuts])
    mates = number[owner[one]] != number[owner[other]]
    one, other = one[mates], other[mates]
    points = np.concatenate([cut.curve.starts for cut in cuts])
    ends = np.concatenate([cut.curve.ends for cut in cuts])
    bulges = np.concatenate([cut.curve.bulges for cut in cuts])
    # Each segment as a curve of its own: two vertices, of which the second begins nothing that is used.
    every = Curve(
        points=np.stack([points, ends], axis=1).reshape(-1, 2),
        bulges=np.stack([bulges, np.zeros(len(bulges))], axis=1).ravel(),
    )
    low, high = _along(every, 2 * one, 2 * other, tolerance)
    good = high - low > _SAME
    before = np.concatenate([np.cumsum(curves.lengths(cut.curve)) - curves.lengths(cut.curve) for cut in cuts])
    at = before[one[good]]
    return _Overlaps(owner[one[good]], owner[other[good]], at + low[good], at + high[good])


def _segments(curve: Curve) -> Array:
    """Every segment of a closed curve as a line string, (M,)."""
    points, segment = curves.flatten(curve, _FLATTENING)
    following = np.roll(points, -1, axis=0)
    last = np.flatnonzero(segment != np.roll(segment, -1)) if len(curve.bulges) > 1 else np.array([len(points) - 1])
    points = np.insert(points, last + 1, following[last], axis=0)
    return np.asarray(shapely.linestrings(points, indices=np.insert(segment, last + 1, segment[last])))


def _along(every: Curve, one: IntArray, other: IntArray, tolerance: float) -> tuple[Array, Array]:
    """From where to where the segments ``one`` run along the segments ``other``, (M,) m each; equal where not at all.

    Lines and arcs that are near each other and parallel at the ends and in the middle of a stretch are so all along it.
    """
    places = [curves.project(every, one, ends[other])[0] for ends in (every.starts, every.ends)]
    low, high = np.minimum(*places), np.maximum(*places)
    near = np.ones(len(one), dtype=np.bool_)
    for share in (0.0, 0.5, 1.0):
        points, headings = curves.evaluate(every, one, low + share * (high - low))
        place, gap = curves.project(every, other, points)
        along = curves.evaluate(every, other, place)[1]
        near &= (gap <= tolerance) & (np.abs(np.sin(headings - along)) <= _PARALLEL)
    return low, np.where(near, high, low)


def _spans(
    overlaps: _Overlaps, cuts: Sequence[Cut], corners: Sequence[Array], kerf: float, shortest: float
) -> tuple[dict[int, list[_Span]], dict[int, list[_Span]], dict[int, tuple[Cut, ...]]]:
    """What each cut shares with later ones, which it keeps, what with earlier ones, which it loses, and what is left.

    Only cuts that keep or lose something have entries.
    """
    lengths = [curves.length(cut.curve) for cut in cuts]
    rank = sorted(range(len(cuts)), key=lambda cut: (-round(lengths[cut], 6), cuts[cut].contour))
    never: set[int] = set()  # have had the first rank already
    while True:
        place = np.argsort(rank)
        earlier = place[overlaps.other] < place[overlaps.cut]
        spans = {cut: _merged(overlaps, earlier, cut, lengths[cut], shortest) for cut in rank if cut not in never}
        lost = {cut: found for cut, found in spans.items() if found}
        left = {cut: _remaining(cuts[cut], found, corners[cut], kerf) for cut, found in lost.items()}
        whole = [cut for cut in lost if not left[cut]]
        if not whole:
            break
        first = _apart(whole, overlaps)
        never |= set(first)
        rank = [*first, *(cut for cut in rank if cut not in first)]
    kept = {cut: _merged(overlaps, ~earlier, cut, lengths[cut], shortest) for cut in rank}
    return {cut: found for cut, found in kept.items() if found}, lost, left


def _apart(cuts: Sequence[int], overlaps: _Overlaps) -> list[int]:
    """As many of the cuts, which are at least one, as share nothing with each other."""
    chosen: list[int] = []
    for cut in cuts:
        if not np.isin(overlaps.other[overlaps.cut == cut], chosen).any():
            chosen.append(cut)
    return chosen


def _merged(overlaps: _Overlaps, which: BoolArray, cut: int, length: float, shortest: float) -> list[_Span]:
    """The stretches of a closed path that are shared, joined where they touch, in their order; short ones left out."""
    mine = np.flatnonzero(which & (overlaps.cut == cut))
    mine = mine[np.argsort(overlaps.begin[mine], kind="stable")]
    spans: list[_Span] = []
    columns = (overlaps.begin, overlaps.end, overlaps.other)
    for begin, end, other in zip(*(column[mine].tolist() for column in columns), strict=True):
        if spans and begin <= spans[-1].end + _SAME:
            last = spans[-1]
            spans[-1] = _Span(last.begin, max(last.end, end), last.others | {other})
        else:
            spans.append(_Span(begin, end, frozenset({other})))
    if len(spans) > 1 and spans[0].begin <= _SAME and spans[-1].end >= length - _SAME:
        first, last = spans[0], spans.pop()
        spans = [*spans[1:], _Span(last.begin, length + first.end, last.others | first.others)]
    return [span for span in spans if span.end - span.begin >= shortest]


def _remaining(cut: Cut, lost: Sequence[_Span], corners: Array, kerf: float) -> tuple[Cut, ...]:
    """The open cuts that are left of a closed one, without rounds between two stretches that are shared."""
    length = curves.length(cut.curve)
    twice = curves.chain([curves.opened(cut.curve)] * 2)
    ends = [*(span.begin for span in lost[1:]), lost[0].begin + length]
    gaps = [(span.end, end) for span, end in zip(lost, ends, strict=True) if end - span.end > _SAME]
    parts = (curves.part(twice, begin, end) for begin, end in gaps)
    return tuple(replace(cut, curve=part) for part in parts if not _is_round(part, corners, kerf))


def _is_round(part: Curve, corners: Array, kerf: float) -> bool:
    """Whether a part of a path is but the round about one of the drawn corners, (K, 2) m."""
    middle, _ = curves.evaluate(part, np.arange(len(part.bulges)), 0.5 * curves.lengths(part))
    points = np.concatenate([part.points, middle])
    away = np.hypot(*(points[:, None] - corners[None, :]).transpose(2, 0, 1))
    return bool(np.any(np.all(np.abs(away - 0.5 * kerf) <= _SAME, axis=0)))


def _relations(
    kept: Mapping[int, Sequence[_Span]], lost: Mapping[int, Sequence[_Span]], cuts: Sequence[Cut]
) -> tuple[dict[int, tuple[int, ...]], dict[int, tuple[Curve, ...]]]:
    """Which contours come after which, and what is shared on the paths of those that keep it."""
    after: dict[int, set[int]] = {}
    for cut, spans in lost.items():
        others = {cuts[other].contour for span in spans for other in span.others}
        after.setdefault(cuts[cut].contour, set()).update(others)
    edges: dict[int, tuple[Curve, ...]] = {}
    for cut, spans in kept.items():
        twice = curves.chain([curves.opened(cuts[cut].curve)] * 2)
        parts = tuple(curves.part(twice, span.begin, span.end) for span in spans)
        edges[cuts[cut].contour] = edges.get(cuts[cut].contour, ()) + parts
    return {number: tuple(sorted(others)) for number, others in sorted(after.items())}, edges


def _findings(
    after: Mapping[int, Sequence[int]], lost: Mapping[int, Sequence[_Span]], contours: Sequence[Contour]
) -> tuple[Finding, ...]:
    """How much is cut once for two parts."""
    if not after:
        return ()
    total = sum(span.end - span.begin for spans in lost.values() for span in spans)
    pairs = [f"{number} with {', '.join(map(str, others))}" for number, others in after.items()]
    named = "; ".join(pairs[:_NAMED]) + (f" and {len(pairs) - _NAMED} more" if len(pairs) > _NAMED else "")
    first = next(one for one in contours if one.number == min(after))
    what = f"{to_mm(total):.1f} mm of common edges are cut once: contours {named}"
    return (Finding(what, where=first.where, kind="common"),)
