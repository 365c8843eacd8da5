"""Measures of a curve of lines and arcs, and the plain operations on it.

A bulge b stands for an arc that turns by 4 atan(b) over the chord c between its ends; its curvature is
4 b / (c (1 + b^2)), positive to the left. Everything here is vectorised over the segments.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from deltacam.model import Array, Curve, IntArray


def circle(centre: Array, radius: float) -> Curve:
    """A circle as two half circles, counter-clockwise from its right-most point."""
    arm = np.array([radius, 0.0])
    return Curve(points=np.array([centre + arm, centre - arm]), bulges=np.ones(2))


def polygon(points: Array) -> Curve:
    """The closed curve of straight lines through ``points``, (N, 2) m."""
    return Curve(points=points, bulges=np.zeros(len(points)))


def turns(curve: Curve) -> Array:
    """The signed angle that each segment turns through, (M,) rad; positive to the left, 0 for a line."""
    return 4.0 * np.arctan(curve.bulges)


def chords(curve: Curve) -> Array:
    """The vector from the start to the end of each segment, (M, 2) m."""
    return curve.ends - curve.starts


def lengths(curve: Curve) -> Array:
    """The arc length of each segment, (M,) m."""
    chord = np.hypot(*chords(curve).T)
    half = 0.5 * np.abs(turns(curve))
    # np.sinc(x / pi) is sin(x) / x, exact at 0.
    return np.asarray(chord / np.sinc(half / np.pi))


def length(curve: Curve) -> float:
    """The arc length of the curve, m."""
    return float(lengths(curve).sum())


def curvatures(curve: Curve) -> Array:
    """The signed curvature of each segment, (M,) 1/m; positive to the left. A segment of length 0 has curvature 0."""
    chord = np.hypot(*chords(curve).T)
    rise = 4.0 * curve.bulges / (1.0 + curve.bulges**2)
    return np.asarray(np.divide(rise, chord, out=np.zeros_like(chord), where=chord > 0.0))


def headings(curve: Curve) -> tuple[Array, Array]:
    """The direction at the start and at the end of each segment, (M,) and (M,) rad, the end not wrapped."""
    chord = chords(curve)
    turn = turns(curve)
    start = np.arctan2(chord[:, 1], chord[:, 0]) - 0.5 * turn
    return start, start + turn


def corner_angles(curve: Curve) -> Array:
    """The change of direction at each vertex that joins two segments, (M,) rad in (-pi, pi]; positive to the left.

    For a closed curve entry i belongs to ``points[i]``; for an open one to ``points[i + 1]``, without the two ends.
    """
    start, end = headings(curve)
    change = start - np.roll(end, 1) if curve.closed else start[1:] - end[:-1]
    return np.asarray(np.pi - np.mod(np.pi - change, 2.0 * np.pi))


def signed_area(curve: Curve) -> float:
    """The enclosed area of a closed curve, m2; positive when it runs counter-clockwise.

    The polygon through the vertices (shoelace, taken about the first point) plus a circular segment r^2 (turn - sin
    turn) / 2 per arc.
    """
    arm = curve.points - curve.points[0]
    after = np.roll(arm, -1, axis=0)
    polygon_area = 0.5 * float(np.sum(arm[:, 0] * after[:, 1] - arm[:, 1] * after[:, 0]))
    turn = turns(curve)
    chord_squared = np.sum(chords(curve) ** 2, axis=1)
    # r^2 = chord^2 / (4 sin^2(turn / 2)); the series of the quotient keeps tiny arcs exact.
    small = np.abs(turn) < 1e-2
    safe = np.where(small, 1.0, turn)
    factor = np.where(
        small, turn / 12.0 * (1.0 + turn**2 / 30.0), (safe - np.sin(safe)) / (8.0 * np.sin(safe / 2.0) ** 2)
    )
    return polygon_area + float(np.sum(chord_squared * factor))


def reverse(curve: Curve) -> Curve:
    """The same curve run the other way; a closed one keeps its first point."""
    if curve.closed:
        points = np.roll(curve.points[::-1], 1, axis=0)
        return Curve(points=points, bulges=-curve.bulges[::-1])
    return Curve(points=curve.points[::-1], bulges=-curve.bulges[::-1], closed=False)


def transform(
    curve: Curve, *, scale: float = 1.0, rotation: float = 0.0, shift: tuple[float, float] = (0.0, 0.0)
) -> Curve:
    """The curve scaled (> 0), then turned by ``rotation`` rad about the origin, then shifted by m."""
    cos, sin = np.cos(rotation), np.sin(rotation)
    points = scale * curve.points @ np.array([[cos, sin], [-sin, cos]]) + np.asarray(shift)
    return replace(curve, points=points)


def evaluate(curve: Curve, segment: IntArray, distance: Array) -> tuple[Array, Array]:
    """The points (N, 2) m and directions (N,) rad at ``distance`` m from the start of the given segments.

    Args:
        curve: any.
        segment: (N,) indices of segments.
        distance: (N,) m; outside [0, length] it continues the line or circle.
    """
    start_heading, _ = headings(curve)
    return advance(curve.starts[segment], start_heading[segment], curvatures(curve)[segment], distance)


def advance(start: Array, heading: Array, curvature: Array, distance: Array) -> tuple[Array, Array]:
    """The point and direction after ``distance`` m along lines and arcs.

    Args:
        start: (N, 2) m.
        heading: (N,) rad at the start.
        curvature: (N,) 1/m.
        distance: (N,) m, of any sign.

    Returns:
        points (N, 2) m, directions (N,) rad. The chord of an arc of length s and turn a is s sin(a/2) / (a/2) long and
        lies at half the turn.
    """
    half = 0.5 * curvature * distance
    chord = distance * np.sinc(half / np.pi)
    direction = heading + half
    points = start + np.stack([chord * np.cos(direction), chord * np.sin(direction)], axis=1)
    return points, heading + 2.0 * half


def flatten(curve: Curve, sagitta: float) -> tuple[Array, IntArray]:
    """The vertices of a polyline that leaves the curve by at most ``sagitta``, all on the curve.

    Args:
        curve: any.
        sagitta: largest distance of a chord from its arc, m, > 0.

    Returns:
        points (K, 2) m and the segment that each belongs to, (K,); a closed curve does not repeat its first point, an
        open one ends with its last point.
    """
    step, turn = chords(curve), turns(curve)
    half = 0.5 * np.abs(turn)
    # np.sinc(x / pi) is sin(x) / x, exact at 0.
    length_of = np.hypot(*step.T) / np.sinc(half / np.pi)
    radius = np.divide(length_of, 2.0 * half, out=np.full_like(half, np.inf), where=half > 0.0)
    # A chord of angle a has the sagitta r (1 - cos(a / 2)); at least a square is left of a circle.
    rise = np.divide(sagitta, radius, out=np.zeros_like(radius), where=radius > 0.0)
    most = np.minimum(2.0 * np.arccos(np.clip(1.0 - rise, -1.0, 1.0)), 0.5 * np.pi)
    pieces = np.ceil(np.divide(2.0 * half, most, out=np.ones_like(half), where=most > 0.0)).astype(np.int64)
    pieces = np.maximum(pieces, 1)
    segment = np.repeat(np.arange(len(turn)), pieces)
    index = np.arange(len(segment)) - np.repeat(np.cumsum(pieces) - pieces, pieces)
    points = curve.starts[segment]
    inner = np.flatnonzero(index)
    points[inner] += _part_of_chord(step, turn, segment[inner], index[inner] / pieces[segment[inner]])
    if not curve.closed:
        points = np.concatenate([points, curve.points[-1:]])
        segment = np.append(segment, len(turn) - 1)
    return points, segment


def _part_of_chord(step: Array, turn: Array, segment: IntArray, share: Array) -> Array:
    """The vectors to the points that are ``share`` of the way along arcs, (N, 2) m.

    Args:
        step: the chord of each segment, (M, 2) m.
        turn: of each segment, (M,) rad.
        segment: which of them, (N,), none of them straight.
        share: (N,) from 0 to 1.
    """
    whole, part = turn[segment], share * turn[segment]
    # The chord to a point of the arc that has turned by b leaves the whole chord by (turn - b) / 2 to the right.
    size, swing = np.sin(0.5 * part) / np.sin(0.5 * whole), 0.5 * (part - whole)
    cos, sin = size * np.cos(swing), size * np.sin(swing)
    x, y = step[segment].T
    return np.stack([cos * x - sin * y, sin * x + cos * y], axis=1)


def bounds(curve: Curve) -> tuple[float, float, float, float]:
    """The smallest x, smallest y, largest x and largest y of the curve, m, arcs included exactly."""
    low, high = curve.points.min(axis=0), curve.points.max(axis=0)
    arcs = np.flatnonzero(curve.bulges)
    if len(arcs):
        start, end = (heading[arcs] for heading in headings(curve))
        curvature = curvatures(curve)[arcs]
        # The direction is a multiple of a quarter turn where x or y is extreme.
        first = np.ceil(np.minimum(start, end) / (np.pi / 2.0))
        for quarter in range(5):
            heading = (first + quarter) * np.pi / 2.0
            inside = heading <= np.maximum(start, end)
            distance = np.divide(heading - start, curvature, out=np.zeros_like(curvature), where=curvature != 0.0)
            points, _ = advance(curve.starts[arcs], start, curvature, np.where(inside, distance, 0.0))
            low, high = np.minimum(low, points.min(axis=0)), np.maximum(high, points.max(axis=0))
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def project(curve: Curve, segment: IntArray, points: Array) -> tuple[Array, Array]:
    """The places on the given segments that are nearest to the given points, pair by pair.

    Args:
        curve: any.
        segment: (N,) indices of segments.
        points: (N, 2) m.

    Returns:
        the distance of each place from the start of its segment, (N,) m, and from its point, (N,) m.
    """
    heading = headings(curve)[0][segment]
    curvature, reach = curvatures(curve)[segment], lengths(curve)[segment]
    start = curve.starts[segment]
    arm = points - start
    cos, sin = np.cos(heading), np.sin(heading)
    along = arm[:, 0] * cos + arm[:, 1] * sin
    across = arm[:, 1] * cos - arm[:, 0] * sin
    # On an arc the nearest point lies at the angle of the point about the centre: tan = k along / (1 - k across).
    angle = np.arctan2(curvature * along, 1.0 - curvature * across) * np.sign(curvature)
    bent = curvature != 0.0
    on_arc = np.divide(np.mod(angle, 2.0 * np.pi), np.abs(curvature), out=np.zeros_like(curvature), where=bent)
    best = np.clip(np.where(bent, on_arc, along), 0.0, reach)
    best_gap = np.hypot(*(advance(start, heading, curvature, best)[0] - points).T)
    for end in (np.zeros_like(reach), reach):
        gap = np.hypot(*(advance(start, heading, curvature, end)[0] - points).T)
        best = np.where(gap < best_gap, end, best)
        best_gap = np.minimum(gap, best_gap)
    return best, best_gap


def nearest(curve: Curve, point: Array) -> tuple[int, float, float]:
    """The place on the curve that is nearest to ``point``, (2,) m.

    Returns:
        the segment, the distance m from its start, and how far ``point`` is from there, m.
    """
    every = np.arange(len(curve.bulges))
    distance, gap = project(curve, every, np.broadcast_to(point, (len(every), 2)))
    segment = int(np.argmin(gap))
    return segment, float(distance[segment]), float(gap[segment])


def start_at(curve: Curve, segment: int, distance: float) -> Curve:
    """A closed curve that begins ``distance`` m into ``segment`` and runs the same line.

    A start within 1 nm of a vertex becomes that vertex.
    """
    start, bulge = curve.points[segment], float(curve.bulges[segment])
    step = curve.points[(segment + 1) % len(curve.points)] - start
    turn, chord = 4.0 * np.arctan(bulge), np.hypot(*step)
    reach = float(chord / np.sinc(0.5 * turn / np.pi))
    if distance <= 1e-9 or reach - distance <= 1e-9:
        first = segment if distance <= 1e-9 else (segment + 1) % len(curve.points)
        return replace(curve, points=np.roll(curve.points, -first, axis=0), bulges=np.roll(curve.bulges, -first))
    quarter = 0.25 * turn
    share = distance / reach
    # The chord to a point of the arc that has turned by b leaves the whole chord by (turn - b) / 2 to the right.
    part = chord * share if turn == 0.0 else chord * np.sin(0.5 * share * turn) / np.sin(0.5 * turn)
    way = np.arctan2(step[1], step[0]) + 0.5 * (share - 1.0) * turn
    place = start[None] + part * np.array([[np.cos(way), np.sin(way)]])
    points = np.concatenate([place, np.roll(curve.points, -(segment + 1), axis=0)])
    rest = np.roll(curve.bulges, -segment)[1:]
    bulges = np.concatenate([[np.tan(quarter * (1.0 - share))], rest, [np.tan(quarter * share)]])
    return replace(curve, points=points, bulges=bulges)


def chain(parts: Sequence[Curve]) -> Curve:
    """Open curves, each of which begins where the one before it ends, as one; a single curve is returned as it is."""
    if len(parts) == 1:
        return parts[0]
    points = np.concatenate([*(part.points[:-1] for part in parts), parts[-1].points[-1:]])
    return Curve(points=points, bulges=np.concatenate([part.bulges for part in parts]), closed=False)


def opened(curve: Curve) -> Curve:
    """A closed curve as an open one that ends where it begins."""
    return Curve(points=np.concatenate([curve.points, curve.points[:1]]), bulges=curve.bulges, closed=False)


def part(curve: Curve, first: float, last: float) -> Curve:
    """The part of an open curve between two distances from its start, 0 <= first < last <= its length, m.

    What is shorter than a nanometre at an end of a segment is left out.
    """
    ends = np.cumsum(lengths(curve))
    starts = ends - lengths(curve)
    inside = np.flatnonzero((ends > first + 1e-9) & (starts < last - 1e-9))
    reach = lengths(curve)[inside]
    low = np.clip(first - starts[inside], 0.0, reach)
    high = np.clip(last - starts[inside], 0.0, reach)
    begin, _ = evaluate(curve, inside, low)
    end, _ = evaluate(curve, inside[-1:], high[-1:])
    points = np.where((low > 0.0)[:, None], begin, curve.starts[inside])
    whole = high[-1] >= reach[-1] - 1e-12
    stop = curve.ends[inside[-1:]] if whole else end
    share = np.divide(high - low, reach, out=np.ones_like(reach), where=reach > 0.0)
    bulges = np.where(share < 1.0, np.tan(share * np.arctan(curve.bulges[inside])), curve.bulges[inside])
    return Curve(points=np.concatenate([points, stop]), bulges=bulges, closed=False)
