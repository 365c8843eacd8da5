"""Turns the polyline that ``buffer`` gives back into the exact offset lines and arcs it stands for.

Every edge of the polyline gets a label: 2k where it is the offset of segment k of the drawn contour, 2k + 1 where it
is the round about the corner at the end of segment k. So labels count up along the contour, and two neighbouring
labels meet in a point that is known exactly.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.geometry.element import Element, meeting_point, shifted, turn_between
from deltacam.model import Array, Curve, IntArray

FIT: Final = 1e-6
"""Largest error, m, in the distance of a traced path from the drawn contour."""

SAME_POINT: Final = 5e-7
"""How far apart, m, the offsets of two neighbouring segments may be to be joined without a round between them."""

SHORTEST: Final = 1e-8
"""Shorter pieces of a path, m, are left out."""

_SEARCH: Final = 1e-4


@dataclass(frozen=True, eq=False)
class Source:
    """A drawn contour, and how it was flattened and shifted.

    Attributes:
        curve: closed, counter-clockwise, m.
        flat: (K, 2) m, its flattened points.
        segment: (K,) the segment of each flattened point.
        shift: m, positive outwards.
    """

    curve: Curve
    flat: Array
    segment: IntArray
    shift: float

    @cached_property
    def chords(self) -> shapely.STRtree:
        """The index of the flattened chords; chord i starts at flattened point i."""
        return shapely.STRtree(_edges(self.flat))

    @cached_property
    def headings(self) -> tuple[Array, Array]:
        """The direction at the start and at the end of each segment, rad."""
        return curves.headings(self.curve)

    @cached_property
    def rounds(self) -> Array:
        """The length of the round about the end of each segment, (M,) m; not positive where the corner is hollow."""
        return np.roll(curves.corner_angles(self.curve), -1) * self.shift

    @cached_property
    def curvature(self) -> Array:
        """The curvature of each segment, (M,) 1/m."""
        return curves.curvatures(self.curve)

    def element(self, label: int) -> Element:
        """The offset line or circle that a label stands for."""
        k, corner = divmod(label, 2)
        if corner:
            return Element(anchor=self.curve.ends[k], radius=self.shift)
        return shifted(self.curve.starts[k], float(self.headings[0][k]), float(self.curvature[k]), self.shift)

    def offset_end(self, k: int) -> Array:
        """Where the offset of segment k ends, (2,) m."""
        return beside(self.curve.ends[k], self.headings[1][k], self.shift)

    def offset_start(self, k: int) -> Array:
        """Where the offset of segment k starts, (2,) m."""
        return beside(self.curve.starts[k], self.headings[0][k], self.shift)


def trace_ring(source: Source, ring: Array) -> Curve:
    """The offset of a contour along ``ring`` as lines and arcs, counter-clockwise.

    Args:
        source: the drawn contour.
        ring: (K, 2) m, one ring of the buffered contour, the buffered region to its left, first point not repeated.

    Returns:
        a closed curve whose distance from the contour is right within ``FIT``; where tracing does not get there, the
        lines of ``ring`` themselves.
    """
    labels, first = _runs(source, _labels(source, ring))
    traced = _assemble(source, labels, first, ring) if len(labels) > 1 else None
    if traced is None or not _matches(source, traced, ring):
        traced = curves.polygon(ring)
    return traced if curves.signed_area(traced) > 0.0 else curves.reverse(traced)


def _edges(points: Array) -> Array:
    """The edges of a closed polyline as an array of line strings, (K,)."""
    return np.asarray(shapely.linestrings(np.stack([points, np.concatenate([points[1:], points[:1]])], axis=1)))


def _nearest(source: Source, points: Array) -> tuple[IntArray, Array, Array]:
    """The segment nearest to each point, how far along it the nearest place is, and how far away, (N,) each."""
    chord = source.chords.query_nearest(shapely.points(points), all_matches=False)[1]
    count = len(source.curve.bulges)
    # The nearest chord tells the segment, but for points beside its ends.
    choices = (source.segment[chord][None, :] + np.array([[0], [-1], [1]])) % count
    places = [curves.project(source.curve, choice, points) for choice in choices]
    best = np.argmin([gap for _, gap in places], axis=0)
    every = np.arange(len(points))
    distance, gap = (np.array(part)[best, every] for part in zip(*places, strict=True))
    return choices[best, every], distance, gap


def _labels(source: Source, ring: Array) -> IntArray:
    """The label of every edge of ``ring``, by the place on the contour that is nearest to the edge's middle."""
    k, distance, _ = _nearest(source, 0.5 * (ring + np.roll(ring, -1, axis=0)))
    count = len(source.curve.bulges)
    after = (distance >= curves.lengths(source.curve)[k]) & (source.rounds[k] > 0.0)
    before = (distance <= 0.0) & (source.rounds[(k - 1) % count] > 0.0)
    return np.asarray(np.where(after, 2 * k + 1, np.where(before, 2 * k - 1, 2 * k)) % (2 * count))


def _runs(source: Source, labels: IntArray) -> tuple[list[int], list[int]]:
    """The labels without repeats, and for each the first vertex of the ring that carries it.

    Rounds shorter than half a micrometre are left out: the motion passes a small corner faster than a tiny arc.
    """
    tiny = (labels % 2 == 1) & (source.rounds[labels // 2] < SAME_POINT)
    kept = np.flatnonzero(~tiny)
    first = kept[labels[kept] != np.roll(labels[kept], 1)]
    return labels[first].tolist(), first.tolist()


def _join(source: Source, label: int, following: int, about: Array) -> Array:
    """The point where the element of ``label`` ends and that of ``following`` begins; near ``about``."""
    count = len(source.curve.bulges)
    if following == (label + 1) % (2 * count):
        return source.offset_start(following // 2) if label % 2 else source.offset_end(label // 2)
    if label % 2 == 0 and following == (label + 2) % (2 * count):
        end, start = source.offset_end(label // 2), source.offset_start(following // 2)
        if np.hypot(*(end - start)) <= SAME_POINT:
            return np.asarray(0.5 * (end + start))
    place = meeting_point(source.element(label), source.element(following), about)
    return about if place is None or np.hypot(*(place - about)) > _SEARCH else place


def _assemble(source: Source, labels: list[int], first: list[int], ring: Array) -> Curve | None:
    """The closed curve of the elements that the labels stand for; None where that is no curve."""
    count = len(labels)
    joins = [_join(source, labels[i - 1], labels[i], ring[first[i]]) for i in range(count)]
    edge = np.hypot(*(np.roll(ring, -1, axis=0) - ring).T)
    travelled = np.concatenate([[0.0], np.cumsum(edge)])
    pieces: list[tuple[Array, Array]] = []
    for i, label in enumerate(labels):
        start, end = joins[i], joins[(i + 1) % count]
        element = source.element(label)
        run = travelled[first[(i + 1) % count]] - travelled[first[i]]
        about = float(run % travelled[-1]) / element.radius if abs(element.radius) > SHORTEST else 0.0
        points, bulges = arc_or_line(element, start, end, about)
        if np.hypot(*(end - start)) > SHORTEST or 4.0 * abs(np.arctan(bulges).sum()) >= np.pi:
            pieces.append((points, bulges))
    if not pieces:
        return None
    points, bulges = (np.concatenate(part) for part in zip(*pieces, strict=True))
    return Curve(points=points, bulges=bulges) if len(points) >= 2 else None


def arc_or_line(element: Element, start: Array, end: Array, about: float) -> tuple[Array, Array]:
    """The part of an element from ``start`` to ``end``, (2,) m each, that turns by ``about`` rad.

    Returns:
        its vertices but for the last, (n, 2) m, and their bulges, (n,); two of them where it turns by more than half.
    """
    if abs(element.radius) <= SHORTEST:
        return start[None], np.zeros(1)
    turn = turn_between(element, start, end, about)
    if abs(turn) <= np.pi * 1.001:
        return start[None], np.array([np.tan(turn / 4.0)])
    arm = start - element.anchor
    cos, sin = np.cos(turn / 2.0), np.sin(turn / 2.0)
    middle = element.anchor + np.array([cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1]])
    return np.stack([start, middle]), np.full(2, np.tan(turn / 8.0))


def beside(points: Array, headings: Array, shift: float) -> Array:
    """The points ``shift`` m to the right of ``points``, (..., 2) m, run along ``headings``, (...,) rad."""
    return np.asarray(points + shift * np.stack([np.sin(headings), -np.cos(headings)], axis=-1))


def _matches(source: Source, traced: Curve, ring: Array) -> bool:
    """Whether all of the traced path lies at the right distance from the drawn contour, and goes where ``ring`` goes.

    The ring's own distance is less exact: flattening moves the tip of a sharp corner by many times the sagitta.
    """
    flat, _ = curves.flatten(traced, FIT / 4.0)
    middle = 0.5 * (flat + np.roll(flat, -1, axis=0))
    off = np.abs(_nearest(source, np.concatenate([flat, middle]))[2] - abs(source.shift)).max()
    return bool(off <= FIT and _all_near(traced.points, ring) and _all_near(ring, flat))


def _all_near(points: Array, ring: Array) -> bool:
    """Whether all of the ``points`` (N, 2) m are within ``_SEARCH`` of the closed polyline ``ring`` (K, 2) m."""
    near, _ = shapely.STRtree(_edges(ring)).query(shapely.points(points), predicate="dwithin", distance=_SEARCH)
    return len(np.unique(near)) == len(points)
