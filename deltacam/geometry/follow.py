"""Lines and circular arcs along places in order, such as the setpoints of a motion.

Stretches are halved until one line or arc between their ends runs past all their places within the tolerance; then
neighbours that are one line or arc together are joined. Both go on at all stretches at once.

Of the circles through both ends of a chord of half length h, in its frame, x^2 + y^2 - h^2 = 2 c y with the centre at
(0, c); 1 / (2 c) is found by least squares, and the bulge is tan(a / 4) of the angle a that the arc turns through.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.model import Array, BoolArray, IntArray

MAX_RADIUS: Final = 10.0
"""Of an arc, m; flatter stretches become lines."""
MAX_BULGE: Final = 0.8
"""Of an arc; larger ones are divided."""

_MAX_STEP: Final = 0.5  # rad on an arc from one place to the next: with larger steps the places would not show an arc
_LEAST_ON_ARC: Final = 4  # three places are on a circle, whatever they are on
_ROUNDS: Final = 64


def follow(places: Array, breaks: IntArray, tolerance: float) -> tuple[IntArray, Array]:
    """Where the pieces begin and end, and their bulges.

    Every piece runs from one place to another one, within ``tolerance`` of all places between them and past them in
    order. What it does between two places is that of a line or of an arc that more than three places are on.

    Args:
        places: (N, 2) m.
        breaks: (K,), increasing, from 0 to N - 1: the places where a piece must end.
        tolerance: m, > 0.

    Returns:
        Indices into ``places`` (M + 1,), among them the breaks, and the bulge of each piece (M,).
    """
    first, last = breaks[:-1], breaks[1:]
    done = [(first[:0], last[:0], np.zeros(0))]
    while len(first):
        bulges, good = _try(places, first, last, tolerance)
        done.append((first[good], last[good], bulges[good]))
        first, last = first[~good], last[~good]
        middle = (first + last) // 2
        first, last = np.concatenate([first, middle]), np.concatenate([middle, last])
    first, last, bulges = (np.concatenate(part) for part in zip(*done, strict=True))
    order = np.argsort(first)
    return _join(places, np.append(first[order], breaks[-1]), bulges[order], breaks, tolerance)


def _join(places: Array, knots: IntArray, bulges: Array, breaks: IntArray, tolerance: float) -> tuple[IntArray, Array]:
    """The pieces with neighbours joined that are one line or arc together."""
    changed = np.ones(len(bulges), dtype=np.bool_)
    for _ in range(_ROUNDS):
        free = ~np.isin(knots[1:-1], breaks)
        pairs = np.flatnonzero(free & (changed[:-1] | changed[1:]))
        joined, good = _try(places, knots[pairs], knots[pairs + 2], tolerance)
        pairs, joined = pairs[good], joined[good]
        if not len(pairs):
            break
        chosen = _apart(pairs)
        pairs, joined = pairs[chosen], joined[chosen]
        changed[:] = False
        changed[pairs] = True
        bulges[pairs] = joined
        knots, bulges, changed = (
            np.delete(knots, pairs + 1),
            np.delete(bulges, pairs + 1),
            np.delete(changed, pairs + 1),
        )
    return knots, bulges


def _apart(pairs: IntArray) -> BoolArray:
    """Every second one of each unbroken run of numbers (N,), so that no two chosen ones follow each other."""
    begins = np.concatenate([[True], np.diff(pairs) > 1])
    run = np.maximum.accumulate(np.where(begins, np.arange(len(pairs)), 0))
    return np.asarray((np.arange(len(pairs)) - run) % 2 == 0)


def _try(places: Array, first: IntArray, last: IntArray, tolerance: float) -> tuple[Array, BoolArray]:
    """The bulge of the line or arc from place ``first`` to ``last`` (n,) of each stretch, and whether it is good."""
    if not len(first):
        return np.zeros(0), np.zeros(0, dtype=np.bool_)
    counts = last - first + 1
    starts = np.cumsum(counts) - counts
    owner = np.repeat(np.arange(len(first)), counts)
    here = places[np.arange(len(owner)) + np.repeat(first - starts, counts)]
    chord = places[last] - places[first]
    half = 0.5 * np.hypot(*chord.T)
    unit = np.divide(chord, 2.0 * half[:, None], out=np.tile([1.0, 0.0], (len(chord), 1)), where=half[:, None] > 0.0)
    arm = here - (places[first] + 0.5 * chord)[owner]
    ux, uy = unit[owner].T
    x, y = arm[:, 0] * ux + arm[:, 1] * uy, arm[:, 1] * ux - arm[:, 0] * uy
    step = np.diff(here, axis=0, append=here[-1:])
    back = -(step[:, 0] * ux + step[:, 1] * uy)
    back[starts + counts - 1] = 0.0  # from here the step is to another stretch
    ordered = np.maximum.reduceat(back, starts) <= tolerance
    from_line = np.hypot(np.maximum(np.abs(x) - half[owner], 0.0), y)
    line = ordered & (np.maximum.reduceat(from_line, starts) <= tolerance)
    bulge, near = _arcs(x, y, half, owner, starts, tolerance)
    longest = np.hypot(*step.T)
    longest[starts + counts - 1] = 0.0
    curvature = np.divide(2.0 * np.abs(bulge), (1.0 + bulge**2) * half, out=np.zeros_like(half), where=half > 0.0)
    tame = (np.abs(bulge) <= MAX_BULGE) & (curvature * MAX_RADIUS >= 1.0) & (counts >= _LEAST_ON_ARC)
    tame &= np.maximum.reduceat(longest, starts) * curvature <= _MAX_STEP
    arc = ordered & near & tame & ~line
    return np.where(arc, bulge, 0.0), line | arc


def _arcs(
    x: Array, y: Array, half: Array, owner: IntArray, starts: IntArray, tolerance: float
) -> tuple[Array, BoolArray]:
    """The bulge of the best arc of each stretch (n,), and whether it passes all places (N,) within the tolerance.

    Inside the wedge of the end radii the signed distance is f / (r + sqrt(r^2 + f)), f = x^2 + (y - c)^2 - r^2, here
    scaled by the curvature; elsewhere an end is nearest.
    """
    power = x * x + y * y - (half * half)[owner]
    squares = np.add.reduceat(power * power, starts)
    slope = np.divide(np.add.reduceat(power * y, starts), squares, out=np.zeros_like(half), where=squares > 0.0)
    steep = 2.0 * half * slope  # the tangent of half the angle that the arc turns through
    bulge = steep / (1.0 + np.sqrt(1.0 + steep * steep))
    size = 1.0 + bulge * bulge
    curvature = np.divide(2.0 * bulge, size * half, out=np.zeros_like(half), where=half > 0.0)
    lift = (1.0 - bulge * bulge) / size
    excess = 0.5 * curvature[owner] * power - lift[owner] * y
    off = np.abs(2.0 * excess) / (1.0 + np.sqrt(np.maximum(1.0 + 2.0 * curvature[owner] * excess, 0.0)))
    beyond = np.abs(x) > half[owner] - y * steep[owner]
    off = np.where(beyond, np.hypot(np.abs(x) - half[owner], y), off)
    return bulge, np.asarray(np.maximum.reduceat(off, starts) <= tolerance)
