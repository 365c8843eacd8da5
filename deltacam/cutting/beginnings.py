"""Where cuts may begin, and which of these places is nearest: anywhere on a closed one, at the ends of an open one.

A walk through thousands of cuts asks for one place after the other, so that plain numbers beat arrays for the few lines
and arcs that most cuts have.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from math import atan2, hypot, tau
from typing import Final, NamedTuple

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import Array, Cut, IntArray

_FLATTENING: Final = 1e-4
_FEW: Final = 24  # segments; more are faster as an array

_Segment = tuple[float, float, float, float, float, float, float, float]
"""Start x and y, direction there x and y, curvature, length, end x and y."""


class Place(NamedTuple):
    """A place where a cut may begin.

    Attributes:
        segment: of a closed cut; of an open one -1 for its last point, 0 for its first.
        distance: from the start of the segment, m.
        begin: the place, (x, y) m.
        end: where the cut ends that begins there, (x, y) m.
    """

    segment: int
    distance: float
    begin: tuple[float, float]
    end: tuple[float, float]


class Beginnings:
    """The places where each of the ``cuts`` may begin."""

    def __init__(self, cuts: Sequence[Cut]) -> None:
        self._cuts = tuple(cuts)
        pack = Pack.of(cut.curve for cut in cuts)
        step, chord = pack.chords()
        turn = 4.0 * np.arctan(pack.bulges)
        heading = np.arctan2(step[:, 1], step[:, 0]) - 0.5 * turn
        rise = 4.0 * pack.bulges / (1.0 + pack.bulges**2)
        curvature = np.divide(rise, chord, out=np.zeros_like(chord), where=chord > 0.0)
        reach = chord / np.sinc(0.5 * np.abs(turn) / np.pi)
        columns = (*pack.points.T, np.cos(heading), np.sin(heading), curvature, reach, *(pack.points + step).T)
        rows = list(zip(*(column.tolist() for column in columns), strict=True))
        first = pack.first.tolist()
        self._segments: list[list[_Segment]] = [rows[low:high] for low, high in pairwise(first)]
        self._pack = pack

    def nearest(self, index: int, x: float, y: float) -> Place:
        """The place of cut ``index`` that is nearest to (x, y), m; of equally near ones the first."""
        curve, segments = self._cuts[index].curve, self._segments[index]
        if not curve.closed:
            first, last = segments[0][:2], segments[-1][:2]
            if hypot(last[0] - x, last[1] - y) < hypot(first[0] - x, first[1] - y):
                return Place(-1, 0.0, last, first)
            return Place(0, 0.0, first, last)
        if len(segments) > _FEW:
            segment, _, _ = curves.nearest(curve, np.array([x, y]))
        else:
            segment = min(range(len(segments)), key=lambda one: _project(segments[one], x, y)[1])
        distance, _, place = _project(segments[segment], x, y)
        return Place(segment, distance, place, place)

    def walk(self, sequence: IntArray, start: tuple[float, float]) -> list[Place]:
        """Where each cut of the ``sequence`` begins: nearest to the end of the one before, the first to ``start``."""
        places, (x, y) = [], start
        for index in sequence.tolist():
            places.append(self.nearest(index, x, y))
            x, y = places[-1].end
        return places

    def begun(self, index: int, place: Place) -> Cut:
        """The cut ``index``, begun at one of its places."""
        cut = self._cuts[index]
        if cut.curve.closed:
            return replace(cut, curve=curves.start_at(cut.curve, place.segment, place.distance))
        return cut if place.segment == 0 else replace(cut, curve=curves.reverse(cut.curve))

    def samples(self, per_cut: int) -> tuple[Array, IntArray]:
        """Places where cuts may begin, (M, 2) m, and whose they are, (M,): about ``per_cut`` of each cut or more."""
        points, owner = rings.flatten(self._pack, _FLATTENING)
        closed = self._pack.closed[owner]
        first = np.searchsorted(owner, owner)
        last = np.searchsorted(owner, owner, side="right") - 1
        here = np.arange(len(owner))
        step = np.where(closed[:, None], points[np.where(here == last, first, here + 1)] - points, 0.0)
        length = np.hypot(*step.T)
        pieces = np.maximum(np.ceil(length * per_cut * len(self._cuts) / max(length.sum(), 1e-12)), 1).astype(np.int64)
        source = np.repeat(here, pieces)
        share = (np.arange(len(source)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[source]
        used = (closed | (here == first) | (here == last))[source]
        return (points[source] + share[:, None] * step[source])[used], owner[source][used]


def _project(segment: _Segment, x: float, y: float) -> tuple[float, float, tuple[float, float]]:
    """The place on a line or arc nearest to (x, y): its distance from the start, from (x, y), and itself."""
    x0, y0, cos, sin, curvature, reach, x1, y1 = segment
    along, across = (x - x0) * cos + (y - y0) * sin, (y - y0) * cos - (x - x0) * sin
    if curvature == 0.0:
        distance = min(max(along, 0.0), reach)
        return distance, hypot(along - distance, across), (x0 + distance * cos, y0 + distance * sin)
    # On an arc the nearest point lies at the angle of the point about the centre: tan = k along / (1 - k across).
    angle = atan2(curvature * along, 1.0 - curvature * across)
    distance = (angle if curvature > 0.0 else -angle) % tau / abs(curvature)
    radius = 1.0 / curvature
    if distance <= reach:
        out = hypot(along, across - radius) or 1.0
        right, up = along / out * abs(radius), radius + (across - radius) / out * abs(radius)
        return distance, abs(out - abs(radius)), (x0 + right * cos - up * sin, y0 + right * sin + up * cos)
    begin, end = hypot(along, across), hypot(x - x1, y - y1)
    return (0.0, begin, (x0, y0)) if begin <= end else (reach, end, (x1, y1))
