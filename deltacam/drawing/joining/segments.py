"""Single lines and arcs, many at once: where points lie along them, and which run along each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.drawing.joining.duplicates import SAME
from deltacam.geometry.pack import Pack
from deltacam.model import Array, BoolArray, IntArray

MOST_PAIRS: Final = 20_000_000
"""More pairs of segments with overlapping boxes are not looked at."""

_RISE: Final = 1e-9
"""Arcs that leave their chord by less, m, run along lines: part of them is a line by its numbers already."""

_FLAT: Final = 0.05
"""Bulges below which the circle of an arc is too large to be compared by its centre."""

_BATCH: Final = 1024


@dataclass(frozen=True, slots=True, eq=False)
class Segments:
    """S lines and arcs.

    Attributes:
        pack: S open curves of one segment each.
        start: (S, 2) m.
        end: (S, 2) m.
        bulges: (S,).
        lengths: (S,) m.
        centre: (S, 2) m, of the circle of each arc; the start of each line.
        radius: (S,) m; 0 for lines, and for arcs that are as good as lines.
    """

    pack: Pack
    start: Array
    end: Array
    bulges: Array
    lengths: Array
    centre: Array
    radius: Array

    @classmethod
    def of(cls, start: Array, end: Array, bulges: Array) -> Segments:
        """The segments between points, (S, 2) m each, with their bulges, (S,)."""
        count = len(start)
        both = np.column_stack([bulges, np.zeros(count)]).reshape(-1)
        first = 2 * np.arange(count + 1)
        pack = Pack(np.stack([start, end], axis=1).reshape(-1, 2), both, first, np.zeros(count, dtype=np.bool_))
        chord = end - start
        bent = np.abs(bulges) * np.hypot(*chord.T) > 2.0 * _RISE
        safe = np.where(bent, bulges, 1.0)
        # From the middle of the chord the centre lies (1 - b^2) / (4 b) chords to the left.
        left = np.column_stack([-chord[:, 1], chord[:, 0]])
        centre = 0.5 * (start + end) + left * ((1.0 - safe**2) / (4.0 * safe))[:, None]
        centre = np.where(bent[:, None], centre, start)
        radius = np.where(bent, np.hypot(*(start - centre).T), 0.0)
        return cls(pack, start, end, bulges, pack.lengths(), centre, radius)

    def along(self, which: IntArray, points: Array) -> tuple[Array, Array]:
        """How far along the lines and circles of ``which``, (K,), the points (K, 2) lie, m, and how far off, m.

        On a circle the first is between 0 and its circumference.
        """
        start, centre = self.start[which], self.centre[which]
        chord = self.end[which] - start
        unit = chord / np.maximum(np.hypot(*chord.T), 1e-300)[:, None]
        arm = points - start
        on_line = np.sum(arm * unit, axis=1)
        off_line = unit[:, 0] * arm[:, 1] - unit[:, 1] * arm[:, 0]
        before, after = start - centre, points - centre
        turn = np.arctan2(after[:, 1], after[:, 0]) - np.arctan2(before[:, 1], before[:, 0])
        on_arc = np.mod(turn * np.sign(self.bulges[which]), 2.0 * np.pi) * self.radius[which]
        off_arc = np.hypot(*after.T) - self.radius[which]
        bent = self.radius[which] > 0.0
        return np.where(bent, on_arc, on_line), np.where(bent, off_arc, off_line)

    def at(self, which: IntArray, distance: Array) -> Array:
        """The points, (K, 2) m, at ``distance`` m from the start of the segments of ``which``, (K,)."""
        share = distance / self.lengths[which]
        start, chord = self.start[which], self.end[which] - self.start[which]
        bent = self.radius[which] > 0.0
        turn = share * 4.0 * np.arctan(self.bulges[which])
        cos, sin = np.cos(turn), np.sin(turn)
        arm = start - self.centre[which]
        swung = np.column_stack([cos * arm[:, 0] - sin * arm[:, 1], sin * arm[:, 0] + cos * arm[:, 1]])
        return np.where(bent[:, None], self.centre[which] + swung, start + share[:, None] * chord)

    def overlapping(self) -> IntArray:
        """The pairs, (K, 2), that run along each other for more than ``SAME``, nowhere further apart than that."""
        import shapely

        boxes = self.pack.bounds()
        diagonals = shapely.linestrings(np.stack([boxes[:, :2] - SAME, boxes[:, 2:] + SAME], axis=1))
        tree = shapely.STRtree(diagonals)
        found, seen = [np.zeros((0, 2), dtype=np.int64)], 0
        for first in range(0, len(diagonals), _BATCH):
            one, other = tree.query(diagonals[first : first + _BATCH])
            one = one + first
            seen += len(one)
            if seen > MOST_PAIRS:
                break
            one, other = one[one < other], other[one < other]
            flat = (np.abs(self.bulges) < _FLAT)[np.stack([one, other])].any(axis=0)
            along = np.zeros(len(one), dtype=np.bool_)
            along[flat] = self._run_along(one[flat], other[flat])
            along[~flat] = self._arcs_overlap(one[~flat], other[~flat])
            found.append(np.column_stack([one[along], other[along]]))
        pairs = np.concatenate(found)
        return np.asarray(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))])

    def _run_along(self, one: IntArray, other: IntArray) -> BoolArray:
        """Whether each pair, of which one is a line or nearly so, runs along each other.

        The ends of a common stretch are ends of the two; what they share there and half-way they share everywhere.
        """
        places = []
        for point in (self.start[other], self.end[other]):
            on, place = self._on(one, point)
            places.append(np.where(on, place, np.nan))
        for point, place in ((self.start[one], np.zeros(len(one))), (self.end[one], self.lengths[one])):
            on, _ = self._on(other, point)
            places.append(np.where(on, place, np.nan))
        low, high = np.fmin.reduce(places), np.fmax.reduce(places)
        long = high - low > SAME  # false for nan
        middle, _ = self._on(other, self.at(one, np.where(long, 0.5 * (low + high), 0.0)))
        return np.asarray(long & middle)

    def _on(self, which: IntArray, points: Array) -> tuple[BoolArray, Array]:
        """Whether the points, (K, 2), lie on the segments of ``which``, (K,), and how far along, m."""
        place, off = self.along(which, points)
        lengths, around = self.lengths[which], 2.0 * np.pi * self.radius[which]
        # What is a little before the start of an arc is nearly a whole turn after it.
        place = np.where((around > 0.0) & (place > 0.5 * (lengths + around)), place - around, place)
        return (np.abs(off) <= SAME) & (place >= -SAME) & (place <= lengths + SAME), place

    def _arcs_overlap(self, one: IntArray, other: IntArray) -> BoolArray:
        """Whether each pair of arcs is on one circle and runs along each other."""
        apart = np.hypot(*(self.centre[one] - self.centre[other]).T)
        same = apart + np.abs(self.radius[one] - self.radius[other]) <= SAME
        meets = np.zeros(len(one), dtype=np.bool_)
        for here, there in ((one, other), (other, one)):
            for points in (self.start[there], self.end[there], self.at(there, 0.5 * self.lengths[there])):
                place, _ = self.along(here, points)
                meets |= (place > SAME) & (place < self.lengths[here] - SAME)
        return np.asarray(same & meets)
