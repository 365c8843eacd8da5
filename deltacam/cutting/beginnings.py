"""Where cuts may begin: anywhere on a closed one, at the ends of an open one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Array, Cut, IntArray


class Place(NamedTuple):
    """A place where a cut may begin.

    Attributes:
        begin: where the tool comes to, (x, y) m in the sheet frame.
        end: where it leaves.
    """

    begin: tuple[float, float]
    end: tuple[float, float]


class Beginnings:
    """The places along each of the ``cuts``, by their distance from its first point."""

    def __init__(self, cuts: Sequence[Cut]) -> None:
        self.cuts = tuple(cuts)
        self._pack = pack = Pack.of(cut.curve for cut in cuts)
        self._step, chord = pack.chords()
        self._turn = 4.0 * np.arctan(pack.bulges)
        self._heading = np.arctan2(self._step[:, 1], self._step[:, 0]) - 0.5 * self._turn
        reach = chord / np.sinc(0.5 * np.abs(self._turn) / np.pi)
        self._curvature = np.divide(self._turn, reach, out=np.zeros_like(reach), where=reach > 0.0)
        self._passed = np.concatenate([[0.0], np.cumsum(reach)])
        self.lengths = np.diff(self._passed[pack.first])
        """Of every cut, (N,) m."""

    def at(self, cut: IntArray, along: Array) -> Array:
        """The places ``along`` (P,) m from the first points of the cuts (P,), (P, 2) m; a closed cut goes round."""
        segment, distance = self._locate(cut, along)
        points, _ = curves.advance(
            self._pack.points[segment], self._heading[segment], self._curvature[segment], distance
        )
        return points

    def corner(self, cut: IntArray, along: Array) -> Array:
        """How far along the cuts (P,) the vertex is that is nearest to the places ``along``, (P,) m."""
        segment, distance = self._locate(cut, along)
        before = self._passed[segment] - self._passed[self._pack.first[cut]]
        size = self._passed[segment + 1] - self._passed[segment]
        return np.asarray(before + np.where(2.0 * distance > size, size, 0.0))

    def begun(self, index: int, along: float) -> Cut:
        """The cut ``index``, begun ``along`` m from its first point; an open one at its last point for any but 0."""
        cut = self.cuts[index]
        if not cut.curve.closed:
            return replace(cut, curve=curves.reverse(cut.curve)) if along else cut
        segment, distance = self._locate(np.array([index]), np.array([along]))
        first = int(self._pack.first[index])
        return replace(cut, curve=curves.start_at(cut.curve, int(segment[0]) - first, float(distance[0])))

    def _locate(self, cut: IntArray, along: Array) -> tuple[IntArray, Array]:
        """The segments, of all, that hold places along cuts, and how far into them these lie, m."""
        first, last = self._pack.first[cut], self._pack.first[cut + 1]
        length = np.maximum(self.lengths[cut], 1e-300)
        inside = np.where(self._pack.closed[cut], along % length, np.minimum(along, length))
        total = self._passed[first] + inside
        segment = np.clip(np.searchsorted(self._passed, total, side="right") - 1, first, last - 1)
        size = self._passed[segment + 1] - self._passed[segment]
        return segment, np.clip(total - self._passed[segment], 0.0, size)
