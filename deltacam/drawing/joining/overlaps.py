"""Lines drawn more than once and split at other vertices: cut at each other's vertices, each piece is kept once."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from deltacam.drawing.joining import duplicates, near
from deltacam.drawing.joining.duplicates import SAME
from deltacam.drawing.joining.nodes import COINCIDENT
from deltacam.drawing.joining.segments import Segments
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import Array, BoolArray, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Strands:
    """Open curves, or pieces of curves.

    Attributes:
        pack: M open curves.
        owner: (M,) the curve of the drawing that each is, or is a piece of; ascending.
    """

    pack: Pack
    owner: IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Untangled:
    """What is left when pieces that others cover are taken away.

    Attributes:
        strands: the curves and pieces that are kept.
        copies: curves of the drawing that others cover whole: index to index.
    """

    strands: Strands
    copies: dict[int, int] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, eq=False)
class _Atoms:
    """Parts of segments between cuts, in the order of the curves.

    Attributes:
        curve: (A,) the strand of each.
        segment: (A,) its segment, counted over all strands.
        low: (A,) m, where it begins along its segment.
        high: (A,) m, where it ends.
        reach: (A,) m, how long the segment is.
        start: (A, 2) m.
        end: (A, 2) m.
        bulges: (A,) of the whole segments.
    """

    curve: IntArray
    segment: IntArray
    low: Array
    high: Array
    reach: Array
    start: Array
    end: Array
    bulges: Array

    def pack(self) -> Pack:
        """Each as a curve."""
        return Segments.of(self.start, self.end, _part(self.bulges, (self.high - self.low) / self.reach)).pack


def untangle(strands: Strands, tangled: Iterable[int]) -> Untangled | None:
    """The strands without what is drawn twice among the tangled ones; None where nothing is.

    Args:
        strands: open curves.
        tangled: which of them may be looked at.

    Raises:
        DrawingError: thousands of lines in one place.
    """
    which = np.unique(np.fromiter(tangled, dtype=np.int64))
    curve, vertex = _segments_of(strands.pack, which)
    segments = Segments.of(strands.pack.points[vertex], strands.pack.points[vertex + 1], strands.pack.bulges[vertex])
    pairs = segments.overlapping()
    if not len(pairs):
        return None
    involved = np.isin(curve, curve[pairs])
    atoms = _cut(segments, pairs, curve, np.flatnonzero(involved))
    covered = duplicates.find(atoms.pack())
    if not covered:
        return None
    kept = np.ones(len(atoms.curve), dtype=np.bool_)
    kept[list(covered)] = False
    others = np.setdiff1d(np.arange(len(strands.pack)), curve[involved])
    runs, run_of = _runs(atoms, kept, strands.pack.take(others))
    pieces = _pieces(atoms, np.flatnonzero(kept), runs)
    owner = np.concatenate([strands.owner[others], strands.owner[run_of]])
    order = np.argsort(owner, kind="stable")
    pack = rings.both(strands.pack.take(others), pieces).take(order)
    return Untangled(Strands(pack, owner[order]), _copies(atoms, covered, strands.owner))


def _segments_of(pack: Pack, which: IntArray) -> tuple[IntArray, IntArray]:
    """The segments of the curves of ``which`` that have a length: the curve of each, and the vertex where it begins."""
    counts = pack.counts[which] - 1
    curve = np.repeat(which, counts)
    vertex = np.repeat(pack.first[which] - (np.cumsum(counts) - counts), counts) + np.arange(counts.sum())
    long = (pack.points[vertex] != pack.points[vertex + 1]).any(axis=1)
    return curve[long], vertex[long]


def _part(bulges: Array, share: Array) -> Array:
    """The bulges of a share of the arcs with the given bulges; a whole one keeps its own."""
    return np.where(share == 1.0, bulges, np.tan(np.arctan(bulges) * share))


def _cut(segments: Segments, pairs: IntArray, curve: IntArray, wanted: IntArray) -> _Atoms:
    """The wanted segments, cut where a segment that runs along one begins or ends."""
    one = np.concatenate([pairs[:, 0], pairs[:, 0], pairs[:, 1], pairs[:, 1]])
    other = np.concatenate([pairs[:, 1], pairs[:, 1], pairs[:, 0], pairs[:, 0]])
    half = np.tile(np.repeat([False, True], len(pairs)), 2)
    points = np.where(half[:, None], segments.end[other], segments.start[other])
    place, _ = segments.along(one, points)
    inner = (place > SAME) & (place < segments.lengths[one] - SAME)
    one, place, points = one[inner], place[inner], points[inner]
    order = np.lexsort((place, one))
    one, place, points = one[order], place[order], points[order]
    new = np.ones(len(one), dtype=np.bool_)
    new[1:] = (one[1:] != one[:-1]) | (np.diff(place) > SAME)
    one, place, points = one[new], place[new], points[new]
    exact = segments.at(one, place)
    close = np.hypot(*(exact - points).T) <= COINCIDENT
    points = np.where(close[:, None], points, exact)
    counts = np.bincount(one, minlength=len(segments.lengths))[wanted] + 1
    segment = np.repeat(wanted, counts)
    first = np.cumsum(counts) - counts
    begins = np.zeros(len(segment), dtype=np.bool_)
    begins[first] = True
    ends = np.roll(begins, -1)
    low, high = np.zeros(len(segment)), segments.lengths[segment].copy()
    start, end = segments.start[segment].copy(), segments.end[segment].copy()
    low[~begins], start[~begins] = place, points
    high[~ends], end[~ends] = place, points
    return _Atoms(curve[segment], segment, low, high, segments.lengths[segment], start, end, segments.bulges[segment])


def _runs(atoms: _Atoms, kept: BoolArray, others: Pack) -> tuple[IntArray, IntArray]:
    """Kept atoms that stay together: the run of each, and the strand of each run.

    A run ends where an atom is missing, and where something else ends too.
    """
    which = np.flatnonzero(kept)
    ends = np.concatenate([atoms.start[which], atoms.end[which], others.ends().reshape(-1, 2)])
    place = near.clusters(ends, SAME)
    crowded = np.bincount(place)[place[: len(which)]] > 2
    begins = np.ones(len(which), dtype=np.bool_)
    begins[1:] = (np.diff(which) > 1) | (np.diff(atoms.curve[which]) > 0) | crowded[1:]
    return np.cumsum(begins) - 1, atoms.curve[which[begins]]


def _pieces(atoms: _Atoms, which: IntArray, run: IntArray) -> Pack:
    """The curve of each run of the atoms of ``which``; atoms of one segment become one segment again."""
    begins = np.ones(len(which), dtype=np.bool_)
    begins[1:] = (np.diff(run) > 0) | (np.diff(atoms.segment[which]) > 0)
    first = np.flatnonzero(begins)
    last = np.append(first[1:] - 1, len(which) - 1)
    one, other = which[first], which[last]
    bulges = _part(atoms.bulges[one], (atoms.high[other] - atoms.low[one]) / atoms.reach[one])
    ends = np.append(np.diff(run[first]) > 0, True)
    at = np.flatnonzero(ends) + 1
    points = np.insert(atoms.start[one], at, atoms.end[other[ends]], axis=0)
    counts = np.bincount(run[first]) + 1
    bounds = np.concatenate([[0], np.cumsum(counts)]).astype(np.int64)
    return Pack(points, np.insert(bulges, at, 0.0), bounds, np.zeros(len(counts), dtype=np.bool_))


def _copies(atoms: _Atoms, covered: dict[int, int], owner: IntArray) -> dict[int, int]:
    """The curves of the drawing of which nothing is left, each with one that covers its beginning."""
    gone = np.ones(len(owner), dtype=np.bool_)
    gone[atoms.curve] = True
    kept = np.ones(len(atoms.curve), dtype=np.bool_)
    kept[list(covered)] = False
    gone[atoms.curve[kept]] = False
    copies: dict[int, int] = {}
    for later, first in sorted(covered.items()):
        if gone[atoms.curve[later]]:
            copies.setdefault(int(owner[atoms.curve[later]]), int(owner[atoms.curve[first]]))
    return copies
