"""What the entities of a DXF file draw, as exact shapes in space, and their curves in the sheet plane.

A shape is in the entity's own coordinates. A matrix, (3, 3), takes it to the directions of the sheet: [x y z] @ matrix,
metres. Circles, arcs and most polylines never come here: they are traced many at once.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.drawing.entities import splines
from deltacam.drawing.entities.traces import Trace
from deltacam.geometry import biarc
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve, readonly

FIT: Final = 0.5e-6
"""How far, m, the arcs that stand for an ellipse or a spline may lie from it where the fit samples it."""

ROUND: Final = 1e-9
"""An ellipse whose radii differ by less, m, is a circle."""


@dataclass(frozen=True, slots=True, eq=False)
class Lines:
    """A polyline whose segments may be arcs in its own xy plane.

    Attributes:
        points: (N, 3).
        bulges: (N,) if closed, else (N - 1,).
        closed: whether the last point joins the first.
    """

    points: Array
    bulges: Array
    closed: bool = False

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", readonly(self.points, columns=3))
        object.__setattr__(self, "bulges", readonly(self.bulges))


@dataclass(frozen=True, slots=True, eq=False)
class Spline:
    """A B-spline, rational where the weights differ.

    Attributes:
        control: (N, 3) control points.
        weights: (N,), > 0.
        knots: (N + degree + 1,), not decreasing.
        degree: >= 1.
    """

    control: Array
    weights: Array
    knots: Array
    degree: int

    def __post_init__(self) -> None:
        object.__setattr__(self, "control", readonly(self.control, columns=3))
        object.__setattr__(self, "weights", readonly(self.weights))
        object.__setattr__(self, "knots", readonly(self.knots))


Shape = Lines | Spline


def trace(shape: Shape, matrix: Array) -> Trace | None:
    """The curve of a shape in the sheet plane; None where the shape is a single point.

    Args:
        shape: in its own coordinates.
        matrix: (3, 3) to the directions of the sheet, m.

    Raises:
        ValueError: numbers that make no shape, or one so wild that it would need too many arcs.
    """
    if isinstance(shape, Lines):
        return _trace_lines(shape, matrix)
    control = shape.control @ matrix
    heights = (float(control[:, 2].min()), float(control[:, 2].max()))
    curve, error = splines.curve(control[:, :2], shape.weights, shape.knots, shape.degree, FIT)
    return None if curve is None else Trace(curve, heights, error)


def trace_ellipse(frame: Array, start: float, span: float, heights: tuple[float, float]) -> Trace:
    """A stretch of an ellipse.

    Args:
        frame: (3, 2) m: centre, u and v of centre + u cos t + v sin t.
        start: the first t, rad.
        span: how far t runs, rad, 0 < span <= 2 pi.
        heights: the lowest and the highest z that it may reach, m.

    Raises:
        ValueError: numbers that make no ellipse.
    """
    curve, error = _ellipse(frame, start, span)
    return Trace(curve, heights, error)


def _trace_lines(lines: Lines, matrix: Array) -> Trace:
    """A polyline whose arcs, if it has any, become parts of ellipses."""
    points = lines.points @ matrix
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    plane = Curve(points=lines.points[:, :2], bulges=lines.bulges, closed=lines.closed)
    if not plane.bulges.any():
        return Trace(Curve(points=points[:, :2], bulges=lines.bulges, closed=lines.closed), (low, high))
    # An arc that is not level reaches beyond the heights of its ends by less than its length.
    lift = float(curves.lengths(plane).max()) * float(np.hypot(*matrix[:2, 2]))
    curve, error = _squeezed(plane, matrix[:2, :2], points[:, :2])
    return Trace(curve, (low - lift, high + lift), error)


def _squeezed(plane: Curve, linear: Array, points: Array) -> tuple[Curve, float]:
    """The open curve of ``plane`` under a linear map that is no similarity, and its error, m.

    Args:
        plane: in its own coordinates.
        linear: (2, 2), applied from the right.
        points: (N, 2) m, the vertices of ``plane`` in the sheet.
    """
    ends = np.roll(points, -1, axis=0) if plane.closed else points[1:]
    heading, _ = curves.headings(plane)
    curvature = curves.curvatures(plane)
    pieces: list[Curve] = []
    worst = 0.0
    for i, turn in enumerate(curves.turns(plane)):
        pair = np.array([points[i], ends[i]])
        if turn == 0.0 or curvature[i] == 0.0:
            pieces.append(Curve(points=pair, bulges=np.zeros(1), closed=False))
            continue
        # The arc is centre + r (cos t, sin t); a quarter turn right of the heading (left, clockwise) is the start.
        sign = math.copysign(1.0, turn)
        start = float(heading[i]) - 0.5 * math.pi * sign
        u, v = np.eye(2) @ linear / abs(curvature[i])
        centre = pair[0] - math.cos(start) * u - math.sin(start) * v
        piece, error = _ellipse(np.array([centre, u, sign * v]), sign * start, abs(float(turn)))
        inner = piece.points[1:-1]
        pieces.append(Curve(points=np.concatenate([pair[:1], inner, pair[1:]]), bulges=piece.bulges, closed=False))
        worst = max(worst, error)
    points = np.concatenate([pieces[0].points[:1], *(piece.points[1:] for piece in pieces)])
    return Curve(points=points, bulges=np.concatenate([piece.bulges for piece in pieces]), closed=False), worst


def _ellipse(frame: Array, start: float, span: float) -> tuple[Curve, float]:
    """A stretch of an ellipse in the plane, (3, 2) centre, u, v, and its error; exact for a circle.

    A whole circle is a closed curve; everything else is open, a whole ellipse with equal ends.
    """
    centre, u, v = frame
    a, b = np.hypot(*u), np.hypot(*v)
    if abs(a - b) <= ROUND and abs(u @ v) <= ROUND * max(a, b):
        return _arc(centre, u, v, start, span), 0.0

    def evaluate(t: Array) -> tuple[Array, Array]:
        cos, sin = np.cos(t)[:, None], np.sin(t)[:, None]
        return centre + cos * u + sin * v, cos * v - sin * u

    pieces = max(1, math.ceil(span / (math.pi / 4.0)))
    curve, error = biarc.fit(evaluate, start + span * np.arange(pieces + 1) / pieces, FIT)
    if span >= 2.0 * math.pi:
        curve = Curve(points=np.concatenate([curve.points[:-1], curve.points[:1]]), bulges=curve.bulges, closed=False)
    return curve, error


def _arc(centre: Array, u: Array, v: Array, start: float, span: float) -> Curve:
    """A circular arc in halves, so that no bulge is larger than 1; a whole circle is closed."""
    sign = math.copysign(1.0, float(u[0] * v[1] - u[1] * v[0]))
    if span >= 2.0 * math.pi:
        angles = start + np.array([0.0, math.pi])
        bulges = np.full(2, sign)
    else:
        pieces = 2 if span > math.pi else 1
        angles = start + span * np.arange(pieces + 1) / pieces
        bulges = np.full(pieces, sign * math.tan(span / pieces / 4.0))
    points = centre + np.cos(angles)[:, None] * u + np.sin(angles)[:, None] * v
    return Curve(points=points, bulges=bulges, closed=span >= 2.0 * math.pi)
