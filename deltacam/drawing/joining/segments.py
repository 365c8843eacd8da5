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
        radius: (S,) m; 0 for lines.
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
        bent = bulges != 0.0
        safe = np.where(bent, bulges, 1.0)
        # From the middle of the chord the centre lies (1 - b^2) / (4 b) chords to the left.
        chord = end - start
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
            kind = (one < other) & ((self.radius[one] > 0.0) == (self.radius[other] > 0.0))
            one, other = one[kind], other[kind]
            bent = self.radius[one] > 0.0
            along = np.zeros(len(one), dtype=np.bool_)
            along[~bent] = self._lines_overlap(one[~bent], other[~bent])
            along[bent] = self._arcs_overlap(one[bent], other[bent])
            found.append(np.column_stack([one[along], other[along]]))
        pairs = np.concatenate(found)
        return np.asarray(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))])

    def _lines_overlap(self, one: IntArray, other: IntArray) -> BoolArray:
        """Whether each pair of lines runs along each other."""
        begin, off_begin = self.along(one, self.start[other])
        end, off_end = self.along(one, self.end[other])
        low = np.maximum(np.minimum(begin, end), 0.0)
        high = np.minimum(np.maximum(begin, end), self.lengths[one])
        slope = (off_end - off_begin) / np.where(np.abs(end - begin) > SAME, end - begin, np.inf)
        apart = np.maximum(*(np.abs(off_begin + (place - begin) * slope) for place in (low, high)))
        return np.asarray((high - low > SAME) & (apart <= SAME))

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
