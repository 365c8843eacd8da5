"""Finds arcs and lines in chains of short segments, as flattened circles and splines are written.

A chain from one vertex to another becomes one arc where every vertex and every middle of a segment is within the
allowance of it. Of the arcs through both ends, each point chooses one; the arc that is taken is their mean, weighted by
how far a point moves with the arc.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Curve, IntArray

LONGEST_TURN: Final = np.radians(150.0)
"""Largest angle that one arc turns through, rad."""

SHARPEST_IN_CHAIN: Final = np.radians(20.0)
"""Corners that turn by more, rad, are meant."""

_FEWEST: Final = 3


def fit(
    curve: Curve, *, allowance: float, largest_corner: float = SHARPEST_IN_CHAIN, stretch: IntArray | None = None
) -> tuple[Curve, Array, IntArray]:
    """The curve with its chains of short segments replaced by arcs and lines.

    Args:
        curve: any; where a closed one begins a vertex stays.
        allowance: how far an arc may be from the segments that it stands for, m, >= 0.
        largest_corner: chains do not go through corners that turn by more, rad.
        stretch: that each segment belongs to, (M,); no chain goes from one to another.

    Returns:
        the curve, how far each of its segments is from what it stands for, (M,) m, and the first of the segments that
        it stands for, (M,).
    """
    count = len(curve.bulges)
    corner = curves.corner_angles(curve)[1 if curve.closed else 0 :]
    smooth = np.abs(corner) <= largest_corner
    if stretch is not None:
        smooth &= stretch[1:] == stretch[:-1]
    closing = curve.points[:1] if curve.closed else curve.points[:0]
    vertices = np.concatenate([curve.points, closing])
    middles, _ = curves.evaluate(curve, np.arange(count), 0.5 * curves.lengths(curve))
    heads = np.flatnonzero(_promising(vertices, smooth, allowance))
    kept, at = [0], 0
    bulges: list[float] = []
    off: list[float] = []
    for head in heads.tolist():
        if head < at:
            continue
        end, bulge, worst = _longest(vertices, middles, smooth, head, allowance)
        if end - head < _FEWEST:
            continue
        kept.extend(range(at + 1, head + 1))
        bulges.extend(curve.bulges[at:head])
        off.extend([0.0] * (head - at))
        kept.append(end)
        bulges.append(bulge)
        off.append(worst)
        at = end
    if not bulges:
        return curve, np.zeros(count), np.arange(count)
    kept.extend(range(at + 1, count + 1))
    bulges.extend(curve.bulges[at:])
    off.extend([0.0] * (count - at))
    points = vertices[kept[:-1]] if curve.closed else vertices[kept]
    return replace(curve, points=points, bulges=np.array(bulges)), np.array(off), np.array(kept[:-1])


def _promising(vertices: Array, smooth: BoolArray, allowance: float) -> BoolArray:
    """Which segments begin `_FEWEST` that may be one arc, (M,): their vertices are near one circle or line."""
    count = len(vertices) - 1
    found = np.zeros(count, dtype=np.bool_)
    if count < _FEWEST:
        return found
    a, b, c, d = (vertices[shift : shift + count - _FEWEST + 1] for shift in range(_FEWEST + 1))
    first, second = _half_turn(a, d, b), _half_turn(a, d, c)
    chord = np.hypot(*(d - a).T)
    # The two arcs through a and d differ in height by about a quarter of the chord times the difference of half turns.
    near = 0.25 * chord * np.abs(first - second) <= 8.0 * allowance
    found[: len(near)] = near & smooth[: len(near)] & smooth[1 : len(near) + 1]
    return found


def _half_turn(start: Array, end: Array, point: Array) -> Array:
    """Half the angle through which the arc from ``start`` by ``point`` to ``end`` turns, (N,) rad; all (N, 2) m."""
    before, behind = point - start, end - point
    cross = before[..., 0] * behind[..., 1] - before[..., 1] * behind[..., 0]
    return np.asarray(np.arctan2(cross, np.sum(before * behind, axis=-1)))


def _longest(
    vertices: Array, middles: Array, smooth: BoolArray, head: int, allowance: float
) -> tuple[int, float, float]:
    """The vertex at which the longest arc from vertex ``head`` ends, its bulge, and how far it is from the chain."""
    limit = head + 1 + int(np.argmin(np.append(smooth[head:], False)))
    good, bad = head + 1, limit + 1
    best = (good, 0.0, 0.0)
    step = 2
    while bad - good > 1:
        end = min(head + step, limit) if bad > limit else (good + bad) // 2
        bulge, worst = _arc(vertices, middles, head, end)
        if worst <= allowance:
            good, best, step = end, (end, bulge, worst), 2 * (end - head)
        else:
            bad = end
    return best


def _arc(vertices: Array, middles: Array, head: int, end: int) -> tuple[float, float]:
    """The bulge of the arc for the chain from vertex ``head`` to vertex ``end``, and how far it is from it, m."""
    start, stop = vertices[head], vertices[end]
    points = np.concatenate([vertices[head + 1 : end], middles[head:end]])
    chord = np.hypot(*(stop - start))
    if chord == 0.0:
        return 0.0, np.inf
    half = _half_turn(start, stop, points)
    to_start, to_stop = np.hypot(*(points - start).T), np.hypot(*(points - stop).T)
    weight = (to_start * to_stop) ** 2  # a point moves by about the product over the chord
    turn = 2.0 * float(np.sum(weight * half) / np.sum(weight))
    if abs(turn) > LONGEST_TURN or np.abs(half).max() > 0.6 * LONGEST_TURN:
        return 0.0, np.inf
    arm = points - start
    heading = np.arctan2(*(stop - start)[::-1]) - 0.5 * turn
    curvature = 2.0 * np.sin(0.5 * turn) / chord
    along = arm @ np.array([np.cos(heading), np.sin(heading)])
    left = arm @ np.array([-np.sin(heading), np.cos(heading)])
    square = curvature * (along**2 + left**2)
    off = np.abs(square - 2.0 * left) / (1.0 + np.sqrt(np.maximum(1.0 + curvature * (square - 2.0 * left), 0.0)))
    return float(np.tan(0.25 * turn)), float(off.max())
