"""Makes a cut drivable: corners become small arcs within the tolerance, or places to stop.

The arc that rounds a corner touches both segments beside it. With p1, p2 the points at distances s1 before and s2 after
the corner, n1, n2 the normals there and r the radius, its centre is p1 + r n1 = p2 + r n2: two equations for s1 and s2,
solved by Newton's method for all corners at once; d(p + r n)/ds = t (1 - r k) for a segment of curvature k.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Corner, Curve

SHARPEST_PASSED: Final = np.radians(2.0)
"""A corner that turns by less, rad, is rounded even where corners are stopped at: the drawing is uneven there."""

_TANGENT: Final = 5e-6
_SHORTEST_SEGMENT: Final = 1e-6
_SHORTEST_REACH: Final = 1e-7
_SMALLEST_RADIUS: Final = 1e-6
_LONGEST_REACH: Final = 2e-3
_LARGEST_TURN: Final = 0.2
_SHARE: Final = 0.9
_INNER_RADIUS: Final = 0.8
_SHRINK: Final = 0.6
_ROUNDS: Final = 24
_NEWTON_STEPS: Final = 10
_FARTHEST: Final = 20.0
_CONVERGED: Final = 1e-11
_ROUNDING: Final = 1.0 + 1e-9


def pieces(cut: Curve, *, corner: Corner, deviation: float) -> tuple[Curve, ...]:
    """Split a cut at the corners to stop at, and round the others.

    Args:
        cut: run from ``points[0]``, a closed one around and back, an open one to its last point.
        corner: what to do with sharp corners.
        deviation: how far a rounded corner may lie from the drawn one, m, >= 0.

    Returns:
        open curves of tangent lines and arcs, each to be run from rest to rest, together the whole cut.
    """
    curve = _without_slivers(cut)
    angle = curves.corner_angles(curve)[1 if curve.closed else 0 :]
    meets = np.abs(angle) <= _TANGENT
    rounded = ~meets & (np.abs(angle) <= SHARPEST_PASSED) if corner == "stop" else ~meets
    blend = _blend(curve, angle, rounded, deviation)
    stops = np.flatnonzero(~meets & ~blend.found) + 1
    whole = _assemble(curve, blend)
    # Each vertex before a stop that was rounded has become two.
    cuts_at = stops + np.concatenate([[0], np.cumsum(blend.found)])[stops - 1]
    edges = [0, *cuts_at.tolist(), len(whole.points) - 1]
    return tuple(
        Curve(points=whole.points[a : b + 1], bulges=whole.bulges[a:b], closed=False)
        for a, b in itertools.pairwise(edges)
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Blend:
    """The arcs at the corners 1 to N - 1 of a cut.

    Attributes:
        found: (N - 1,) whether there is one.
        before: (N - 1,) m, where it begins, counted back from the corner.
        after: (N - 1,) m, where it ends, counted on from the corner.
        turn: (N - 1,) rad.
    """

    found: BoolArray
    before: Array
    after: Array
    turn: Array


def _without_slivers(curve: Curve) -> Curve:
    """The curve without segments under a micrometre; the next segment starts where they did."""
    kept = (curves.lengths(curve) >= _SHORTEST_SEGMENT) | (np.abs(curve.bulges) > 0.5)
    if kept.all() or np.count_nonzero(kept) < (2 if curve.closed else 1):
        return curve
    first = np.flatnonzero(kept)
    # Each kept segment starts where the one before it ends, so that it takes the room of the slivers in between.
    points = curve.points[np.concatenate([[0], first[:-1] + 1])]
    if not curve.closed:
        points = np.concatenate([points, curve.points[-1:]])
    return Curve(points=points, bulges=curve.bulges[first], closed=curve.closed)


def _blend(curve: Curve, angle: Array, wanted: BoolArray, deviation: float) -> _Blend:
    """Find the arcs that round the wanted corners; a corner whose arc would be too small to matter gets none."""
    legs = _Legs.beside(curve)
    reach = _reach(angle, legs, curves.lengths(curve), wanted, deviation)
    tangent = np.tan(0.5 * np.abs(angle))
    radius = np.divide(reach, tangent, out=np.zeros_like(reach), where=tangent > 0.0)
    side = np.sign(angle)
    for curvature in (legs.curvature_in, legs.curvature_out):
        inner = curvature * side
        radius = np.where(inner * radius > _INNER_RADIUS, _INNER_RADIUS / np.where(inner > 0.0, inner, 1.0), radius)
    limit_in, limit_out = _limits(reach, curves.lengths(curve))
    open_ = wanted & (reach > _SHORTEST_REACH)
    found = np.zeros_like(wanted)
    before, after, turn = np.zeros_like(reach), np.zeros_like(reach), np.zeros_like(reach)
    for _ in range(_ROUNDS):
        s_in, s_out, t, off, ok = _solve(legs, angle, side * radius, radius * tangent)
        fits = (radius >= _SMALLEST_RADIUS) & (off <= deviation * _ROUNDING)
        good = open_ & ok & fits & (s_in <= limit_in) & (s_out <= limit_out)
        before, after, turn = np.where(good, s_in, before), np.where(good, s_out, after), np.where(good, t, turn)
        found |= good
        open_ &= ~good
        if not open_.any():
            break
        radius = radius * _SHRINK
    return _Blend(found, before, after, turn)


@dataclass(frozen=True, slots=True, eq=False)
class _Legs:
    """The segments on both sides of the corners 1 to N - 1: arrays (N - 1, 2) m, (N - 1,) rad and 1/m."""

    corner: Array
    heading_in: Array
    curvature_in: Array
    heading_out: Array
    curvature_out: Array

    @classmethod
    def beside(cls, curve: Curve) -> _Legs:
        start, end = curves.headings(curve)
        curvature = curves.curvatures(curve)
        return cls(curve.starts[1:], end[:-1], curvature[:-1], start[1:], curvature[1:])


def _reach(angle: Array, legs: _Legs, length: Array, wanted: BoolArray, deviation: float) -> Array:
    """How far from each corner its arc may begin, (N - 1,) m, so that neighbouring arcs do not meet.

    An arc between straight legs that leaves the corner by d begins d sin(a / 2) / (1 - cos(a / 2)) before it.
    """
    half = 0.5 * np.abs(angle)
    versine = 2.0 * np.sin(0.5 * half) ** 2
    reach = np.divide(deviation * np.sin(half), versine, out=np.zeros_like(half), where=wanted & (versine > 0.0))
    bend = np.maximum(np.abs(legs.curvature_in), np.abs(legs.curvature_out))
    reach = np.minimum(reach, np.divide(_LARGEST_TURN, bend, out=np.full_like(bend, np.inf), where=bend > 0.0))
    reach = np.minimum(reach, _LONGEST_REACH)
    # The arc takes no more than both legs have, shared in proportion with the arcs at their other ends.
    needed = np.concatenate([[0.0], reach]) + np.concatenate([reach, [0.0]])
    share = np.minimum(1.0, np.divide(_SHARE * length, needed, out=np.ones_like(needed), where=needed > 0.0))
    return np.asarray(reach * np.minimum(share[:-1], share[1:]))


def _limits(reach: Array, length: Array) -> tuple[Array, Array]:
    """How much of the leg before and of the leg after each corner its arc may take, (N - 1,) m each."""
    asked = np.concatenate([[0.0], reach]) + np.concatenate([reach, [0.0]])
    room = np.divide(length, asked, out=np.ones_like(asked), where=asked > 0.0)
    return reach * room[:-1] * 0.98, reach * room[1:] * 0.98


def _solve(legs: _Legs, angle: Array, radius: Array, guess: Array) -> tuple[Array, Array, Array, Array, BoolArray]:
    """The arcs of the given signed radius: s1, s2, the turn, the distance from the corner, and whether it is an arc.

    ``guess`` is what s1 and s2 would be between straight legs, (N - 1,) m.
    """
    s_in, s_out = guess.copy(), guess.copy()
    miss = np.full_like(guess, np.inf)
    for step in range(_NEWTON_STEPS + 1):
        p_in, h_in = curves.advance(legs.corner, legs.heading_in, legs.curvature_in, -s_in)
        p_out, h_out = curves.advance(legs.corner, legs.heading_out, legs.curvature_out, s_out)
        gap = (p_out + radius[:, None] * _left(h_out)) - (p_in + radius[:, None] * _left(h_in))
        miss = np.hypot(*gap.T)
        if step == _NEWTON_STEPS:
            break
        rate_in, rate_out = 1.0 - radius * legs.curvature_in, 1.0 - radius * legs.curvature_out
        # gap + rate_out t_out ds_out + rate_in t_in ds_in = 0
        ax, ay = rate_in * np.cos(h_in), rate_in * np.sin(h_in)
        bx, by = rate_out * np.cos(h_out), rate_out * np.sin(h_out)
        det = ax * by - ay * bx
        safe = np.where(det == 0.0, 1.0, det)
        s_in = s_in + np.where(det == 0.0, 0.0, (-gap[:, 0] * by + gap[:, 1] * bx) / safe)
        s_out = s_out + np.where(det == 0.0, 0.0, (-gap[:, 1] * ax + gap[:, 0] * ay) / safe)
        s_in, s_out = np.clip(s_in, 0.0, _FARTHEST * guess), np.clip(s_out, 0.0, _FARTHEST * guess)
    turn = angle + legs.curvature_in * s_in + legs.curvature_out * s_out
    centre = p_in + radius[:, None] * _left(h_in)
    off = np.abs(np.hypot(*(centre - legs.corner).T) - np.abs(radius))
    is_arc = (miss <= _CONVERGED) & (turn * radius > 0.0) & (s_in > 0.0) & (s_out > 0.0) & (np.abs(turn) < np.pi)
    return s_in, s_out, turn, off, is_arc


def _left(heading: Array) -> Array:
    """The unit vectors to the left of the given directions, (N, 2)."""
    return np.stack([-np.sin(heading), np.cos(heading)], axis=1)


def _assemble(curve: Curve, blend: _Blend) -> Curve:
    """The open curve along the whole cut, with each blended corner replaced by the two ends of its arc."""
    count = len(curve.bulges)
    length = curves.lengths(curve)
    head = np.concatenate([[0.0], np.where(blend.found, blend.after, 0.0)])
    tail = np.concatenate([np.where(blend.found, blend.before, 0.0), [0.0]])
    every = np.arange(count)
    starts, _ = curves.evaluate(curve, every, head)
    ends, _ = curves.evaluate(curve, every, length - tail)
    starts, ends = np.where(head[:, None] > 0.0, starts, curve.starts), np.where(tail[:, None] > 0.0, ends, curve.ends)
    bulges = np.tan(np.arctan(curve.bulges) * (length - head - tail) / length)
    # Every segment, and after it the arc at its end where there is one.
    arc = np.concatenate([blend.found, [False]])
    arc_bulge = np.concatenate([np.tan(blend.turn / 4.0), [0.0]])
    kept = np.stack([np.ones(count, dtype=bool), arc], axis=1).ravel()
    points = np.stack([starts, ends], axis=1).reshape(-1, 2)[kept]
    all_bulges = np.stack([bulges, arc_bulge], axis=1).ravel()[kept]
    return Curve(points=np.concatenate([points, curve.ends[-1:]]), bulges=all_bulges, closed=False)
