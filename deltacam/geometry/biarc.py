"""A smooth curve as a chain of lines and circular arcs that leaves it by at most a tolerance.

Between two places with directions a biarc, two arcs with a common tangent, takes the curve's ends and end directions
(Bolton, Biarc curves, Computer-Aided Design 7(2), 1975); of the family that does, the one with equal tangent lengths.
Intervals are halved, all in one vectorised round, until every sample lies within the tolerance.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Curve

Evaluate = Callable[[Array], tuple[Array, Array]]
"""From parameters (N,) to points (N, 2) m and directions (N, 2) of any length but 0, in the sense of the curve."""

MAX_PIECES: Final = 50_000
"""A curve that needs more biarcs is refused."""

_ROUNDS: Final = 48
_SAMPLES: Final = 12
_CHECK_SAMPLES: Final = 41
_CHECKS: Final = 5
"""How often stretches that the samples of the check show to be too far away are divided."""
_MERGE: Final = 1e-8
_SINGLE: Final = 1e-9
"""A stretch is one line or arc where its samples lie within this, m, and this part of its chord times ``_STEADY``."""
_STEADY: Final = 100.0
_HALF: Final = 0.49 * np.pi
"""Half the angle of the longest arc that is recognised at once."""

_WIDEST: Final = np.pi / 3.0


@dataclass(frozen=True, slots=True, eq=False)
class _Biarcs:
    """Many biarcs: points (N, 3, 2) m, first, joint and last; bulges (N, 2)."""

    points: Array
    bulges: Array


def fit(evaluate: Evaluate, parameters: Array, tolerance: float) -> tuple[Curve, float]:
    """An open, tangent-continuous curve of lines and arcs along a smooth curve, and its largest distance from it, m.

    Straight and circular stretches become single lines and arcs of at most half a turn, exactly where they are
    straight or circular from one of the parameters to the next.

    Args:
        evaluate: the curve; smooth between the first and the last parameter.
        parameters: (K,), increasing: where the curve is cut before it is halved further. Between two of them it must
            be tame enough for 12 samples to show its shape.
        tolerance: largest distance of the samples, m, > 0. The returned distance is measured on more samples.

    Raises:
        ValueError: a place that is not finite, more than ``MAX_PIECES`` pieces, or a curve too wild for the samples.
    """
    parameters = np.asarray(parameters, dtype=float)
    for _ in range(_CHECKS):
        low, high, biarcs = _cover(evaluate, parameters, tolerance)
        samples, _ = _sample(evaluate, low, high, _CHECK_SAMPLES)
        apart = _distances(biarcs, samples).max(axis=1)
        bad = apart > tolerance
        if not bad.any():
            break
        shares = np.linspace(0.0, 1.0, 5)[1:4, None]
        inner = low[bad] + shares * (high[bad] - low[bad])
        parameters = np.unique(np.concatenate([low, high[-1:], inner.ravel()]))
    error = float(apart.max())
    if error > 2.0 * tolerance:
        raise ValueError("it winds too fast between two samples to be followed")
    places = np.concatenate([biarcs.points[:, :2].reshape(-1, 2), biarcs.points[-1:, 2]])
    curve, moved = merge(Curve(points=places, bulges=biarcs.bulges.ravel(), closed=False))
    # Ten samples see each hump of the distance; its top may lie between two of them.
    return curve, 1.02 * error + moved


def _cover(evaluate: Evaluate, parameters: Array, tolerance: float) -> tuple[Array, Array, _Biarcs]:
    """Intervals (N,) and (N,) that follow each other, and the biarc of each; 12 samples lie within the tolerance."""
    low, high = parameters[:-1], parameters[1:]
    biarcs, good = _single(evaluate, low, high)
    done = [(low[good], high[good], biarcs.points[good], biarcs.bulges[good])]
    low, high = low[~good], high[~good]
    for _ in range(_ROUNDS):
        if not len(low):
            break
        biarcs, good = _try(evaluate, low, high, tolerance)
        done.append((low[good], high[good], biarcs.points[good], biarcs.bulges[good]))
        low, high = low[~good], high[~good]
        middle = 0.5 * (low + high)
        low, high = np.concatenate([low, middle]), np.concatenate([middle, high])
        if len(low) + sum(len(piece[0]) for piece in done) > MAX_PIECES:
            raise ValueError(f"it needs more than {MAX_PIECES} arcs")
    else:
        raise ValueError("it does not become smooth however closely one looks")
    low, high, points, bulges = (np.concatenate(each) for each in zip(*done, strict=True))
    order = np.argsort(low, kind="stable")
    return low[order], high[order], _Biarcs(points[order], bulges[order])


def merge(curve: Curve) -> tuple[Curve, float]:
    """An open curve with neighbours on one line or circle made one, and how far that may move it, m.

    Arcs are not made larger than half a turn.
    """
    reach, turn = curves.lengths(curve), curves.turns(curve)
    heading, _ = curves.headings(curve)
    kept, angles, moved = [0], [], 0.0
    while kept[-1] < len(reach):
        i = kept[-1]
        bend = turn[i] / reach[i] if reach[i] > 0.0 else 0.0
        walked, angle, j = reach[i], turn[i], i + 1
        while j < len(reach) and abs(angle + turn[j]) <= np.pi * (1.0 + 1e-9):
            walked += reach[j]
            half = 0.5 * bend * walked
            ahead = walked * np.sinc(half / np.pi) * np.array([np.cos(heading[i] + half), np.sin(heading[i] + half)])
            missed = float(np.hypot(*(curve.points[i] + ahead - curve.points[j + 1])))
            if missed > _MERGE:
                break
            moved = max(moved, 2.0 * missed)
            angle += turn[j]
            j += 1
        kept.append(j)
        angles.append(angle)
    merged = Curve(points=curve.points[kept], bulges=np.tan(0.25 * np.array(angles)), closed=False)
    return merged, moved


def _single(evaluate: Evaluate, low: Array, high: Array) -> tuple[_Biarcs, BoolArray]:
    """The one line or arc of each interval, in two equal halves, and whether the curve runs along it.

    A curve of degree p that meets a circle in more than 2 p places lies on it, so the samples prove what they show.
    """
    samples, directions = _sample(evaluate, low, high, _CHECK_SAMPLES)
    start, middle, end = samples[:, 0], samples[:, _CHECK_SAMPLES // 2], samples[:, -1]
    chord = end - start
    size = np.hypot(*chord.T)
    limit = np.minimum(_SINGLE, _SINGLE * _STEADY * size)
    # The chords to a third place on an arc enclose half the angle that the arc turns through.
    half = _angle(middle - start, end - middle)
    straight = _from_arc(start, end, np.zeros_like(half), samples).max(axis=1) <= limit
    half = np.where(straight | (np.abs(half) > _HALF), 0.0, half)
    bulge = np.tan(0.5 * half)
    near = _from_arc(start, end, bulge, samples).max(axis=1) <= limit
    # Nowhere does it turn back: its directions are within half the angle of the chord, where it has one.
    along = np.einsum("nsk,nk->ns", directions, chord)
    onward = (along >= (np.cos(half) - 1e-6)[:, None] * size[:, None]) | ~directions.any(axis=2)
    rise = 0.5 * bulge[:, None] * np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    points = np.stack([start, 0.5 * (start + end) + rise, end], axis=1)
    quarter = np.tan(0.5 * np.arctan(bulge))
    return _Biarcs(points, np.stack([quarter, quarter], axis=1)), near & onward.all(axis=1) & (size > 0.0)


def _try(evaluate: Evaluate, low: Array, high: Array, tolerance: float) -> tuple[_Biarcs, BoolArray]:
    """The biarc of each interval, and whether it is good."""
    samples, directions = _sample(evaluate, low, high, _SAMPLES)
    chord = samples[:, -1] - samples[:, 0]
    biarcs, tame = _biarcs(samples[:, 0], directions[:, 0], samples[:, -1], directions[:, -1])
    steps = np.hypot(*np.moveaxis(np.diff(samples, axis=1), -1, 0))
    walked = steps.sum(axis=1)
    # A stretch shorter than the tolerance needs no direction: its chord is within the tolerance.
    speck = walked <= tolerance
    straight = np.stack([samples[:, 0], samples[:, 0] + 0.5 * chord, samples[:, -1]], axis=1)
    points = np.where(speck[:, None, None], straight, biarcs.points)
    bulges = np.where(speck[:, None], 0.0, biarcs.bulges)
    biarcs = _Biarcs(points, bulges)
    even = steps.max(axis=1) <= 0.5 * walked
    near = _distances(biarcs, samples).max(axis=1) <= tolerance
    return biarcs, speck | (tame & even & near)


def _sample(evaluate: Evaluate, low: Array, high: Array, count: int) -> tuple[Array, Array]:
    """Points (N, count, 2) and unit directions (N, count, 2) evenly over each interval, both ends included."""
    t = low[:, None] + (high - low)[:, None] * np.linspace(0.0, 1.0, count)
    points, directions = evaluate(t.ravel())
    size = np.hypot(*directions.T)
    if not (np.isfinite(points).all() and np.isfinite(size).all()):
        raise ValueError("it runs to infinity")
    unit = np.divide(directions, size[:, None], out=np.zeros_like(directions), where=size[:, None] > 0.0)
    return points.reshape(len(low), count, 2), unit.reshape(len(low), count, 2)


def _biarcs(start: Array, leave: Array, end: Array, arrive: Array) -> tuple[_Biarcs, BoolArray]:
    """The biarc between two places (N, 2) with unit directions, and whether it turns little enough to be trusted."""
    chord = end - start
    squared = np.sum(chord * chord, axis=1)
    along = np.sum(chord * (leave + arrive), axis=1)
    bend = 1.0 - np.sum(leave * arrive, axis=1)
    # Tangent length d of |chord - d (leave + arrive)| = 2 d, in the form that stays stable for parallel directions.
    denominator = along + np.sqrt(along**2 + 2.0 * bend * squared)
    reach = np.divide(squared, denominator, out=np.zeros_like(squared), where=denominator > 0.0)
    joint = 0.5 * (start + end + reach[:, None] * (leave - arrive))
    first = _angle(leave, joint - start)
    second = _angle(end - joint, arrive)
    tame = (along > 0.0) & (np.abs(first) < _WIDEST) & (np.abs(second) < _WIDEST)
    bulges = np.tan(0.5 * np.stack([first, second], axis=1))
    return _Biarcs(np.stack([start, joint, end], axis=1), np.where(tame[:, None], bulges, 0.0)), tame


def _angle(one: Array, other: Array) -> Array:
    """The signed angle from each vector (N, 2) to the other, (N,) rad."""
    cross = one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0]
    return np.asarray(np.arctan2(cross, np.sum(one * other, axis=1)))


def _distances(biarcs: _Biarcs, samples: Array) -> Array:
    """How far each sample (N, S, 2) is from its biarc, (N, S) m."""
    both = [_from_arc(biarcs.points[:, i], biarcs.points[:, i + 1], biarcs.bulges[:, i], samples) for i in (0, 1)]
    return np.minimum(*both)


def _from_arc(start: Array, end: Array, bulge: Array, samples: Array) -> Array:
    """How far each sample (N, S, 2) is from its arc of less than half a turn, (N, S) m.

    In the frame of the chord c the circle is x^2 + (y - h)^2 = r^2 with r + h = c / (2 b), so the signed distance is
    f / (r + sqrt(r^2 + f)), f = x^2 + (y - h)^2 - r^2; scaled by the curvature it holds for lines, too.
    """
    chord = end - start
    size = np.hypot(*chord.T)
    # An arc that shrank to a point has no direction; any will do to measure from its end.
    unit = np.divide(chord, size[:, None], out=np.tile([1.0, 0.0], (len(chord), 1)), where=size[:, None] > 0.0)
    arm = samples - 0.5 * (start + end)[:, None]
    x = np.einsum("nsk,nk->ns", arm, unit)
    y = arm[..., 1] * unit[:, None, 0] - arm[..., 0] * unit[:, None, 1]
    half, b = 0.5 * size[:, None], bulge[:, None]
    curvature = np.divide(2.0 * b, (1.0 + b * b) * half, out=np.zeros_like(half), where=half > 0.0)
    lift = (1.0 - b * b) / (1.0 + b * b)  # the centre is lift / curvature to the left of the chord
    power = 0.5 * curvature * (x * x + y * y - half * half) - lift * y
    radial = np.abs(2.0 * power / (1.0 + np.sqrt(np.maximum(1.0 + 2.0 * curvature * power, 0.0))))
    # A place belongs to the arc where it lies inside the wedge of the end radii.
    slope = np.divide(2.0 * b, 1.0 - b * b, out=np.zeros_like(b), where=np.abs(b) < 1.0)
    beyond = np.abs(x) > half - y * slope
    ends = np.hypot(np.abs(x) - half, y)
    return np.asarray(np.where(beyond, ends, radial))
