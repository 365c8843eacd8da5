"""Plane curves whose curvature changes evenly along them: clothoids, with arcs and lines as special cases."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.geometry.curve import advance as advance_arc
from deltacam.model import Array

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(12)
_AT: Final = 0.5 * (1.0 + _NODES)
_SHARE: Final = 0.5 * _WEIGHTS


def advance(start: Array, heading: Array, curvature: Array, sharpness: Array, distance: Array) -> tuple[Array, Array]:
    """The point and direction after ``distance`` m along clothoids, arcs and lines.

    The direction is theta(s) = heading + curvature s + sharpness s^2 / 2. The point of a clothoid is the integral of
    (cos theta, sin theta) by Gauss and Legendre with 12 nodes, whose error is below 1e-13 of the distance where the
    direction turns by less than half a turn.

    Args:
        start: (N, 2) m.
        heading: (N,) rad at the start.
        curvature: (N,) 1/m at the start.
        sharpness: (N,) 1/m^2, the change of the curvature per length.
        distance: (N,) m, of any sign.

    Returns:
        points (N, 2) m, directions (N,) rad.
    """
    points, end = advance_arc(start, heading, curvature, distance)
    bent = np.flatnonzero(sharpness)
    if len(bent):
        s = distance[bent, None] * _AT
        angle = heading[bent, None] + s * (curvature[bent, None] + 0.5 * sharpness[bent, None] * s)
        along = np.stack([np.cos(angle) @ _SHARE, np.sin(angle) @ _SHARE], axis=1)
        points[bent] = start[bent] + distance[bent, None] * along
        end[bent] += 0.5 * sharpness[bent] * distance[bent] ** 2
    return points, end
