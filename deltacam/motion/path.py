"""A path of lines and arcs that is run from rest to rest, by its arc length."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve, IntArray, readonly


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """Lines and arcs in the base frame's sheet plane, tangent to each other.

    Attributes:
        start: (M, 2) m, where each segment starts.
        heading: (M,) rad, its direction there.
        curvature: (M,) 1/m, positive to the left.
        length: (M,) m, > 0.
        z: m, the height of the plane.
    """

    start: Array
    heading: Array
    curvature: Array
    length: Array
    z: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", readonly(self.start, columns=2))
        for name in ("heading", "curvature", "length"):
            object.__setattr__(self, name, readonly(getattr(self, name)))

    @property
    def total(self) -> float:
        """The arc length of the whole path, m."""
        return float(self.length.sum())

    def evaluate(self, segment: IntArray, distance: Array) -> tuple[Array, Array, Array]:
        """Position and its derivatives by arc length at ``distance`` m from the start of the given segments.

        Args:
            segment: (N,) indices.
            distance: (N,) m, within the segment; both ends belong to it, so that each side of a joint can be asked for.

        Returns:
            p (N, 3) m, p' (N, 3), p'' (N, 3) 1/m in the base frame.
        """
        curvature = self.curvature[segment]
        points, heading = curves.advance(self.start[segment], self.heading[segment], curvature, distance)
        cos, sin, flat = np.cos(heading), np.sin(heading), np.zeros_like(heading)
        position = np.column_stack([points, np.full_like(heading, self.z)])
        tangent = np.column_stack([cos, sin, flat])
        bend = np.column_stack([-sin * curvature, cos * curvature, flat])
        return position, tangent, bend

    def locate(self, distance: Array) -> tuple[IntArray, Array]:
        """The segments that hold the given distances from the start of the path, and how far into them these lie.

        Args:
            distance: (N,) m; what is outside [0, total] by rounding comes to the end.
        """
        ends = np.cumsum(self.length)
        segment = np.minimum(np.searchsorted(ends, distance, side="right"), len(ends) - 1)
        inside = distance - (ends[segment] - self.length[segment])
        return segment, np.clip(inside, 0.0, self.length[segment])


def from_curve(curve: Curve, z: float) -> Path:
    """The path along an open curve whose segments are tangent, at height ``z`` m."""
    return Path(
        start=curve.starts,
        heading=curves.headings(curve)[0],
        curvature=curves.curvatures(curve),
        length=curves.lengths(curve),
        z=z,
    )


def straight(start: Array, end: Array, z: float) -> Path:
    """The straight path from ``start`` to ``end``, (2,) m each and apart, at height ``z`` m."""
    return from_curve(Curve(points=np.array([start, end]), bulges=np.zeros(1), closed=False), z)
