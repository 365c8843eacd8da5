"""B-splines as chains of lines and arcs.

A spline is cut at the knots where its direction may jump; each stretch between is smooth and fitted with biarcs.
Evaluation is de Boor's algorithm on homogeneous coordinates (Piegl and Tiller, The NURBS Book, 1997, eq. 4.6), by
scipy.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Final

import numpy as np

from deltacam.geometry import biarc
from deltacam.model import Array, Curve

MAX_DEGREE: Final = 25
"""The highest degree that CAD programs write."""

_SAME: Final = 1e-9
"""Knots closer than this part of their range are one; files write ten digits or more."""


def regular(control: Array, weights: Array, knots: Array, degree: int, *, closed: bool) -> tuple[Array, Array, Array]:
    """Control points, weights and knots as files write them, in the one form that ``curve`` takes.

    A spline is what its control points, weights and knots draw from knots[degree] to knots[N], whether it is marked as
    closed or not: that is what CAD programs show. Three ways of writing the same numbers are known besides: without
    weights; without the first and the last knot, which have no influence (openNURBS); and, marked as closed, without
    the first control points once more at the end, but with their knots.

    Args:
        control: (N, 3).
        weights: (N,) or (0,).
        knots: the (N + degree + 1,) of the textbook, or those of the other ways.
        degree: >= 1.
        closed: whether it is marked as closed or periodic.

    Raises:
        ValueError: numbers that make no spline.
    """
    if not (np.isfinite(control).all() and np.isfinite(weights).all() and np.isfinite(knots).all()):
        raise ValueError("its coordinates, weights or knots are not numbers")
    weights = weights if len(weights) else np.ones(len(control))
    count = len(control)
    if closed and 1 <= degree <= count and len(knots) == count + 2 * degree + 1 and len(weights) == count:
        period = knots[count:] - knots[: 2 * degree + 1]
        if np.ptp(period) <= _SAME * float(np.ptp(knots)):
            control, weights = np.concatenate([control, control[:degree]]), np.append(weights, weights[:degree])
    elif (
        len(knots) == count + degree - 1 > 2 * degree and knots[0] == knots[degree - 1] and knots[-1] == knots[-degree]
    ):
        knots = np.concatenate([knots[:1], knots, knots[-1:]])
    if len(knots) > 1 and np.diff(knots).min() < 0.0 and np.diff(knots).min() >= -_SAME * float(np.ptp(knots)):
        knots = np.maximum.accumulate(knots)
    _check(control, weights, knots, degree)
    return control, weights, knots


def through(fit: Array, start: Array | None, end: Array | None, *, closed: bool) -> tuple[Array, Array] | None:
    """The cubic spline that CAD programs draw through points: control points (N, 3) and knots; None for one place.

    Its parameter runs with the chords. Where no tangent is given the curvature ends at zero; a closed one is smooth
    everywhere (stackoverflow.com/a/74863330; ezdxf, ``fit_points_to_cad_cv``).

    Args:
        fit: (K, 3).
        start: (3,) direction at the first point, if it is given.
        end: (3,) direction at the last point.
        closed: whether it returns to the first point.

    Raises:
        ValueError: a coordinate that is not a number.
    """
    from scipy.interpolate import CubicSpline

    if not np.isfinite(fit).all():
        raise ValueError("its coordinates are not numbers")
    if closed and len(fit):
        fit = np.concatenate([fit, fit[:1]])
    fit = fit[np.any(np.diff(fit, axis=0, prepend=np.nan) != 0.0, axis=1)]
    if len(fit) < 2:
        return None
    t = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(fit, axis=0), axis=1))])
    ends = [(2, np.zeros(3)) if tangent is None else (1, tangent / np.linalg.norm(tangent)) for tangent in (start, end)]
    slope = CubicSpline(t, fit, bc_type="periodic" if closed else tuple(ends))(t, 1)
    third = np.diff(t)[:, None] / 3.0
    inner = np.stack([fit[:-1] + third * slope[:-1], fit[1:] - third * slope[1:], fit[1:]], axis=1)
    return np.concatenate([fit[:1], inner.reshape(-1, 3)]), np.concatenate([t[:1], np.repeat(t, 3), t[-1:]])


def curve(control: Array, weights: Array, knots: Array, degree: int, tolerance: float) -> tuple[Curve | None, float]:
    """The open curve of a spline and its error, m; None where the spline is a single point.

    Args:
        control: (N, 2) m.
        weights: (N,), > 0.
        knots: (N + degree + 1,), not decreasing; the curve is defined from knots[degree] to knots[N].
        degree: >= 1.
        tolerance: largest distance, m, of the samples from the fit.

    Raises:
        ValueError: the numbers make no spline.
    """
    _check(control, weights, knots, degree)
    if float(np.ptp(control, axis=0).max()) == 0.0:
        return None, 0.0
    if degree == 1:
        apart = np.any(np.diff(control, axis=0, prepend=np.nan) != 0.0, axis=1)
        return Curve(points=control[apart], bulges=np.zeros(int(apart.sum()) - 1), closed=False), 0.0
    pieces: list[Curve] = []
    worst = 0.0
    for evaluate, breaks in stretches(control, weights, knots, degree):
        piece, error = biarc.fit(evaluate, breaks, tolerance)
        if pieces and float(np.hypot(*(piece.points[0] - pieces[-1].points[-1]))) > tolerance:
            raise ValueError("the spline is torn apart at a knot")
        pieces.append(piece)
        worst = max(worst, error)
    points = np.concatenate([pieces[0].points, *(piece.points[1:] for piece in pieces[1:])])
    whole = Curve(points=points, bulges=np.concatenate([piece.bulges for piece in pieces]), closed=False)
    whole, moved = biarc.merge(whole)
    return whole, worst + moved


def stretches(control: Array, weights: Array, knots: Array, degree: int) -> list[tuple[biarc.Evaluate, Array]]:
    """The smooth stretches of a spline: how to evaluate each, and its knots.

    Args:
        control: (N, 2) m.
        weights: (N,).
        knots: (N + degree + 1,).
        degree: >= 2.
    """
    knots = _merged(knots)
    values, first, count = np.unique(knots, return_index=True, return_counts=True)
    inside = (values >= knots[degree]) & (values <= knots[len(control)])
    values, first, count = values[inside], first[inside], count[inside]
    cuts = [0, *(i for i in range(1, len(values) - 1) if count[i] >= degree), len(values) - 1]
    homogeneous = np.column_stack([control * weights[:, None], weights])
    found = []
    for low, high in pairwise(cuts):
        left, right = int(first[low] + count[low] - 1), int(first[high])
        part = slice(left - degree, right)
        evaluate = _evaluator(homogeneous[part], knots[left - degree : right + degree + 1], degree)
        found.append((evaluate, _refined(values[low : high + 1], degree)))
    return found


def _refined(values: Array, degree: int) -> Array:
    """Each span between knots in ``degree - 1`` equal pieces: a first guess that no wiggle hides in."""
    pieces = max(1, degree - 1)
    steps = np.diff(values)[:, None] * np.arange(pieces) / pieces
    return np.append((values[:-1, None] + steps).ravel(), values[-1])


def _evaluator(homogeneous: Array, knots: Array, degree: int) -> Callable[[Array], tuple[Array, Array]]:
    """A function from parameters to points and directions of one smooth stretch."""
    from scipy.interpolate import BSpline

    whole = BSpline(knots, homogeneous, degree)
    slope = whole.derivative()
    low, high = float(knots[degree]), float(knots[len(homogeneous)])
    size = float(np.abs(homogeneous).max()) / (high - low)

    def at(t: Array) -> tuple[Array, Array]:
        place, rate = whole(t), slope(t)
        points = place[:, :2] / place[:, 2:]
        return points, (rate[:, :2] - points * rate[:, 2:]) / place[:, 2:]

    def evaluate(t: Array) -> tuple[Array, Array]:
        points, directions = at(t)
        still = np.flatnonzero(np.hypot(*directions.T) < 1e-9 * size)
        if len(still):  # where control points coincide the direction is that of a place just beside
            beside = t[still] + np.where(t[still] < 0.5 * (low + high), 1e-5, -1e-5) * (high - low)
            directions[still] = at(beside)[1]
        return points, directions

    return evaluate


def _merged(knots: Array) -> Array:
    """The knots with those that differ by rounding made equal."""
    apart = np.diff(knots, prepend=-math.inf) > _SAME * float(knots[-1] - knots[0])
    return np.asarray(knots[np.flatnonzero(apart)[np.cumsum(apart) - 1]])


def _check(control: Array, weights: Array, knots: Array, degree: int) -> None:
    """Raises ValueError where the numbers make no spline."""
    count = len(control)
    if not 1 <= degree <= MAX_DEGREE:
        raise ValueError(f"a spline of degree {degree} is outside 1 to {MAX_DEGREE}")
    if count <= degree:
        raise ValueError(f"a spline of degree {degree} needs more than {count} control points")
    if len(knots) != count + degree + 1:
        raise ValueError(f"{len(knots)} knots do not go with {count} control points of degree {degree}")
    if len(weights) != count or not (weights > 0.0).all():
        raise ValueError("a spline needs one positive weight for each control point")
    if (np.diff(knots) < 0.0).any() or not knots[degree] < knots[count]:
        raise ValueError("the knots of the spline do not increase")
