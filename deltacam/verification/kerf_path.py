"""Where the beam's centre must run, computed from the drawing by another way than the planner's.

The contour is flattened much finer than any tolerance. Where it is closed and cut, the polygon is grown or shrunk by
half the kerf; what is engraved or open is followed on the line itself.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from shapely import MultiPolygon, Polygon

from deltacam.geometry.curve import flatten
from deltacam.model import Array, Contour

ACCURACY: Final = 0.3e-6
"""Largest distance of a ring from the exact kerf path, m."""

_SHARPEST: Final = np.radians(170.0)
_SAGITTA: Final = 0.1e-6  # of the flattened contour, and of the round joins at its corners, m


def flattened(contour: Contour) -> Array:
    """The drawn line itself as a polyline, (K, 2) m, much finer than any tolerance; the first point not repeated."""
    return flatten(contour.curve, _SAGITTA)[0]


def rings(contour: Contour, kerf: float) -> tuple[Array, ...]:
    """The path of a contour as polylines: half a kerf outside an outline, half a kerf inside a hole, else the line.

    Args:
        contour: of the drawing.
        kerf: width of the cut, m, >= 0.

    Returns:
        every ring, (K, 2) m in the sheet frame, the first point not repeated; of an open contour the line from end to
        end. None where the kerf swallows the contour or the contour crosses itself; several where the path falls apart
        or closes a bay.
    """
    line = flattened(contour)
    if not contour.has_kerf:
        return (line,)
    if len(line) < 3 or not (polygon := Polygon(line)).is_valid:
        return ()
    if kerf == 0.0:
        return (line,)
    half = kerf / 2.0
    sides = quarter_sides(half)
    grown = polygon.buffer(-half if contour.is_hole else half, quad_segs=sides, join_style="round")
    parts = list(grown.geoms) if isinstance(grown, MultiPolygon) else [grown]
    found = [ring for part in parts if not part.is_empty for ring in (part.exterior, *part.interiors)]
    return tuple(np.asarray(ring.coords)[:-1, :2] for ring in found)


def quarter_sides(radius: float) -> int:
    """How many chords a quarter of a circle of that ``radius``, m, needs: they leave it by r (1 - cos(pi / 4q))."""
    return max(int(np.ceil(np.pi / 4.0 / np.arccos(1.0 - min(_SAGITTA / radius, 0.2)))), 8)


def sharp_corners(ring: Array, *, closed: bool) -> tuple[Array, Array]:
    """The vertices at which a line turns by more than 10 degrees: (M, 2) m, and by how much, (M,) rad in 0 to pi.

    The ends of a line that is not ``closed`` are no corners.
    """
    before, after = ring - np.roll(ring, 1, axis=0), np.roll(ring, -1, axis=0) - ring
    cross = before[:, 0] * after[:, 1] - before[:, 1] * after[:, 0]
    turn = np.abs(np.arctan2(cross, np.sum(before * after, axis=1)))
    sharp = turn > np.radians(10.0)
    if not closed:
        sharp[[0, -1]] = False
    return ring[sharp], turn[sharp]


def all_corners(lines: Sequence[Array], *, closed: bool) -> tuple[Array, Array]:
    """The `sharp_corners` of all ``lines``, at least one: (M, 2) m, and by how much they turn, (M,) rad.

    What is allowed at a corner grows with its turn; one that is sharper than 170 degrees is taken for that.
    """
    found = [sharp_corners(line, closed=closed) for line in lines]
    turns = np.concatenate([turn for _, turn in found])
    return np.concatenate([corner for corner, _ in found]), np.minimum(turns, _SHARPEST)
