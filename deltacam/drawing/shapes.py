"""What the entities of a DXF file draw, as exact shapes in space, and their curves in the sheet plane.

A shape is in the entity's own coordinates. A matrix, (4, 4), takes it to the sheet: [x y z 1] @ matrix, metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.drawing import splines
from deltacam.geometry import biarc
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve, readonly

FIT: Final = 0.5e-6
"""How far, m, the arcs that stand for an ellipse or a spline may lie from it where the fit samples it."""

_ROUND: Final = 1e-9
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
class Conic:
    """A stretch of the ellipse centre + u cos t + v sin t, from t = ``start`` to ``start + span``.

    Attributes:
        frame: (3, 3): centre, u and v.
        start: rad.
        span: rad, 0 < span <= 2 pi.
    """

    frame: Array
    start: float = 0.0
    span: float = 2.0 * math.pi

    def __post_init__(self) -> None:
        object.__setattr__(self, "frame", readonly(self.frame, columns=3))


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


Shape = Lines | Conic | Spline


@dataclass(frozen=True, slots=True, eq=False)
class Trace:
    """A shape in the sheet plane.

    Attributes:
        curve: m; None where the shape is a single point.
        heights: the lowest and the highest z that it reaches, m.
        error: largest distance of the curve from the shape, m.
    """

    curve: Curve | None
    heights: tuple[float, float]
    error: float = 0.0


def trace(shape: Shape, matrix: Array) -> Trace:
    """The curve of a shape in the sheet plane; lines, arcs and circles stay exact.

    Args:
        shape: in its own coordinates.
        matrix: (4, 4) to the sheet, m.

    Raises:
        ValueError: a spline that is not defined, or so wild that it would need too many arcs.
    """
    if isinstance(shape, Lines):
        return _trace_lines(shape, matrix)
    if isinstance(shape, Conic):
        frame = shape.frame @ matrix[:3, :3]
        frame[0] += matrix[3, :3]
        lift = float(np.hypot(frame[1, 2], frame[2, 2]))
        curve, error = _ellipse(frame[:, :2], shape.start, shape.span)
        return Trace(curve, (float(frame[0, 2]) - lift, float(frame[0, 2]) + lift), error)
    control = shape.control @ matrix[:3, :3] + matrix[3, :3]
    heights = (float(control[:, 2].min()), float(control[:, 2].max()))
    spline_curve, error = splines.curve(control[:, :2], shape.weights, shape.knots, shape.degree, FIT)
    return Trace(spline_curve, heights, error)


def _trace_lines(lines: Lines, matrix: Array) -> Trace:
    """A polyline: exact where the matrix keeps circles round, else its arcs become parts of ellipses."""
    points = lines.points @ matrix[:3, :3] + matrix[3, :3]
    low, high = float(points[:, 2].min()), float(points[:, 2].max())
    if len(points) < 2:
        return Trace(None, (low, high))
    plane = Curve(points=lines.points[:, :2], bulges=lines.bulges, closed=lines.closed)
    if not plane.bulges.any():
        return Trace(Curve(points=points[:, :2], bulges=lines.bulges, closed=lines.closed), (low, high))
    reach = float(curves.lengths(plane).max())
    lift = reach * float(np.hypot(*matrix[:2, 2]))
    heights = (low - lift, high + lift)
    singular = np.linalg.svd(matrix[:2, :2], compute_uv=False)
    if (singular[0] - singular[1]) * reach > _ROUND:
        curve, error = _squeezed(plane, matrix[:2, :2], points[:, :2])
        return Trace(curve, heights, error)
    bulges = lines.bulges * np.sign(np.linalg.det(matrix[:2, :2]))
    return Trace(_moderate(Curve(points=points[:, :2], bulges=bulges, closed=lines.closed)), heights)


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
    if abs(a - b) <= _ROUND and abs(u @ v) <= _ROUND * max(a, b):
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


def _moderate(curve: Curve) -> Curve:
    """The same curve with every arc of more than half a turn split in two."""
    wide = np.abs(curve.bulges) > 1.0
    if not wide.any():
        return curve
    after = np.flatnonzero(wide)
    middle, _ = curves.evaluate(curve, after, 0.5 * curves.lengths(curve)[after])
    bulges = np.where(wide, np.tan(0.5 * np.arctan(curve.bulges)), curve.bulges)
    return Curve(
        points=np.insert(curve.points, after + 1, middle, axis=0),
        bulges=np.insert(bulges, after + 1, bulges[after]),
        closed=curve.closed,
    )
