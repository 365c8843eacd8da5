"""Curves that lead from one line or arc to the next without a jump of direction or of curvature.

A blend is three clothoids. It leaves the segment before a joint at a distance of ``reach`` from it, with that segment's
curvature k1, and meets the segment behind it at the same distance, with curvature k2. In between its curvature goes
from k1 to A, from A to B and from B to k2, over the parts `RAMP`, 1 - 2 `RAMP` and `RAMP` of its length L. The two
directions fix A + B for a given L, so that two unknowns are left, L and B - A, and two equations: it must end where the
segment behind the joint is (the G2 Hermite problem of Bertolazzi and Frego 2018, "On the G2 Hermite interpolation
problem with clothoids", with lengths in fixed proportion). Newton's method solves them for all joints at once, in
lengths divided by the reach; the points are integrals by Gauss and Legendre.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np

from deltacam.geometry import clothoid
from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, IntArray

RAMP: Final = 0.3
"""Part of a blend over which the curvature rises, and over which it falls.

Between 0.2 and 0.45 corners are passed in the same time to 1 %; a ramp from a line to an arc can be longest at 0.15."""

PIECES: Final = 3
"""Clothoids of a blend."""

_NEWTON_STEPS: Final = 8
_CONVERGED: Final = 1e-10
_SAME: Final = 1e-10
_EDGES: Final = np.array([0.0, RAMP, 1.0 - RAMP, 1.0])
_SAMPLES: Final = np.arange(1, 9) / 8.0  # of each clothoid
_BETWEEN_SAMPLES: Final = 1.015  # times the largest distance at a sample
_SHORTEST: Final = 1e-6  # of the reach


@dataclass(frozen=True, slots=True, eq=False)
class Joints:
    """Places where one line or arc ends and the next begins.

    Attributes:
        place: (J, 2) m.
        heading: (J,) rad, of the segment before, where it ends.
        angle: (J,) rad, by which the segment behind points more to the left.
        before: (J,) 1/m, the curvature of the segment before.
        behind: (J,) 1/m, the curvature of the segment behind.
    """

    place: Array
    heading: Array
    angle: Array
    before: Array
    behind: Array

    def __getitem__(self, which: IntArray) -> Joints:
        return Joints(*(getattr(self, name)[which] for name in self.__dataclass_fields__))


class Blends(NamedTuple):
    """A blend at each of J joints, as clothoids: (J, PIECES) arrays, and what is known of the whole.

    Attributes:
        start: (J, PIECES, 2) m.
        heading: rad at the start of each clothoid.
        curvature: 1/m there.
        sharpness: 1/m^2.
        length: m.
        deviation: (J,) m, how far blend and joint are from each other at most; infinite where there is no blend.
    """

    start: Array
    heading: Array
    curvature: Array
    sharpness: Array
    length: Array
    deviation: Array


class _Basis(NamedTuple):
    """The integrals of the hat functions of the curvature at nodes of quadrature over a blend of length 1."""

    weight: Array
    before: Array
    plateau: Array
    slope: Array
    behind: Array


def _basis() -> _Basis:
    node, weight = np.polynomial.legendre.leggauss(10)
    start, width = _EDGES[:-1, None], np.diff(_EDGES)[:, None]
    at = (start + width * 0.5 * (node + 1.0)).ravel()

    def integral(*values: float) -> Array:
        """Of the piecewise linear function with these values at the edges, from 0 to every node."""
        inside = np.clip(at - start, 0.0, width)
        rise = np.diff(values)[:, None] / width
        return np.asarray((np.array(values)[:-1, None] * inside + 0.5 * rise * inside**2).sum(axis=0))

    return _Basis(
        (width * 0.5 * weight).ravel(),
        integral(1, 0, 0, 0),
        integral(0, 1, 1, 0),
        integral(0, -1, 1, 0),
        integral(0, 0, 0, 1),
    )


_BASIS: Final = _basis()


def blend(joints: Joints, reach: Array) -> Blends:
    """The blends that begin and end at ``reach`` (J,) m from the joints along the segments there."""
    start, first = curves.advance(joints.place, joints.heading, joints.before, -reach)
    end, _ = curves.advance(joints.place, joints.heading + joints.angle, joints.behind, reach)
    before, behind = joints.before * reach, joints.behind * reach
    goal = ((end - start) @ np.array([1.0, 1j])) * np.exp(-1j * first) / reach
    length, plateau, slope, solved = _solve(goal, before, behind, joints.angle + before + behind)
    # Curvatures at the edges of the three clothoids, in 1/m.
    knots = np.stack([before, plateau - slope, plateau + slope, behind], axis=1) / reach[:, None]
    pieces = np.diff(_EDGES) * (length * reach)[:, None]
    change = np.diff(knots, axis=1)
    change[np.abs(change) < _SAME * np.abs(knots).max(axis=1, keepdims=True)] = 0.0
    sharpness = change / pieces
    starts, headings = [start], [first]
    for piece in range(PIECES):
        columns = (knots[:, piece], sharpness[:, piece], pieces[:, piece])
        place, heading = clothoid.advance(starts[-1], headings[-1], *columns)
        starts.append(place)
        headings.append(heading)
    found = Blends(
        np.stack(starts[:-1], axis=1), np.stack(headings[:-1], axis=1), knots[:, :-1], sharpness, pieces, reach
    )
    deviation = _deviation(joints, found)
    return found._replace(deviation=np.where(solved & np.isfinite(deviation), deviation, np.inf))


def _solve(goal: Array, before: Array, behind: Array, turn: Array) -> tuple[Array, Array, Array, BoolArray]:
    """Length, middle and half difference of the plateau's curvatures, and whether they were found; (J,) each.

    All in lengths divided by the reach; ``goal`` is where the blend must end, as complex numbers, seen from its start.
    """
    basis, sides = _BASIS, np.stack([before, behind], axis=1)
    legs = sides @ np.stack([basis.before, basis.behind])
    shared = 0.5 * RAMP * sides.sum(axis=1) / (1.0 - RAMP)
    slope, miss = np.zeros_like(turn), np.zeros_like(goal)
    length = np.abs(goal)
    for step in range(_NEWTON_STEPS):
        plateau = turn / (1.0 - RAMP) - shared * length  # times the length
        by_length = legs - shared[:, None] * basis.plateau
        angle = length[:, None] * legs + plateau[:, None] * basis.plateau + slope[:, None] * basis.slope
        way = np.exp(1j * angle) * basis.weight
        chord = way.sum(axis=1)
        if step == 0:  # as long as the goal is away
            length = np.abs(goal) / np.abs(chord)
            continue
        miss = length * chord - goal
        by_slope = length * 1j * (way @ basis.slope)
        by_length = chord + length * 1j * (way * by_length).sum(axis=1)
        det = by_slope.real * by_length.imag - by_slope.imag * by_length.real
        det = np.where(det == 0.0, np.nan, det)
        slope = slope - (miss.real * by_length.imag - miss.imag * by_length.real) / det
        length = length - (by_slope.real * miss.imag - by_slope.imag * miss.real) / det
    solved = np.isfinite(length) & (np.abs(miss) <= _CONVERGED) & (length > _SHORTEST)
    length, slope = np.where(solved, length, 1.0), np.where(solved, slope, 0.0)
    return length, turn / (1.0 - RAMP) / length - shared, slope / length, solved


def _deviation(joints: Joints, blends: Blends) -> Array:
    """The largest distance of a blend from the segments and of the joint from the blend, (J,) m."""
    count, inside = len(joints.angle), blends.length[:, :, None] * _SAMPLES
    start, *rest = (np.repeat(column.reshape(-1, *column.shape[2:]), len(_SAMPLES), axis=0) for column in blends[:4])
    heading, curvature, sharpness = rest
    points, heading = clothoid.advance(start, heading, curvature, sharpness, inside.ravel())
    arm = points.reshape(count, -1, 2) - joints.place[:, None]
    to_legs = np.minimum(
        _from_arc(arm, joints.heading, joints.before, side=-1.0),
        _from_arc(arm, joints.heading + joints.angle, joints.behind, side=1.0),
    )
    # From the joint to the circle that touches the blend at the nearest sample.
    nearest = np.arange(count) * arm.shape[1] + np.argmin(np.hypot(arm[..., 0], arm[..., 1]), axis=1)
    curvature = curvature + sharpness * inside.ravel()
    tip = _from_arc(-arm.reshape(-1, 1, 2)[nearest], heading[nearest], curvature[nearest], side=0.0)[:, 0]
    return np.asarray(np.maximum(_BETWEEN_SAMPLES * to_legs.max(axis=1), tip))


def _from_arc(arm: Array, heading: Array, curvature: Array, *, side: float) -> Array:
    """The distance of points at ``arm`` (J, P, 2) m from lines and circles through the origin, (J, P) m.

    Where ``side`` is 1 they begin at the origin, where it is -1 they end there.
    """
    cos, sin, k = np.cos(heading)[:, None], np.sin(heading)[:, None], curvature[:, None]
    along, left = arm[..., 0] * cos + arm[..., 1] * sin, arm[..., 1] * cos - arm[..., 0] * sin
    square = along**2 + left**2
    off = np.abs(k * square - 2.0 * left) / (1.0 + np.sqrt(np.maximum(1.0 + k * (k * square - 2.0 * left), 0.0)))
    return np.asarray(np.where(side * along < 0.0, np.sqrt(square), off))
