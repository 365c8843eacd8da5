"""Paths of lines, arcs and clothoids by their arc length, and the moves that are run along them from rest to rest."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields

import numpy as np

from deltacam.geometry import clothoid
from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve, IntArray, readonly


@dataclass(frozen=True, slots=True, eq=False)
class Path:
    """Lines, arcs and clothoids in the machine frame's sheet plane.

    Attributes:
        start: (M, 2) m, where each segment starts.
        heading: (M,) rad, its direction there.
        curvature: (M,) 1/m there, positive to the left.
        sharpness: (M,) 1/m^2, the change of the curvature per length; 0 for lines and arcs.
        length: (M,) m, > 0.
        stretch: (M,) of a cut that each segment belongs to.
        speed: (M,) m/s, not to be exceeded in each segment; infinite where only the limits of a move count.
        z: m, the height of the plane.
    """

    start: Array
    heading: Array
    curvature: Array
    sharpness: Array
    length: Array
    stretch: IntArray
    speed: Array
    z: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "start", readonly(self.start, columns=2))
        for name in ("heading", "curvature", "sharpness", "length"):
            object.__setattr__(self, name, readonly(getattr(self, name)))
        stretch, speed = np.array(self.stretch, dtype=np.int64), np.array(self.speed, dtype=np.float64)
        stretch.flags.writeable = speed.flags.writeable = False
        object.__setattr__(self, "stretch", stretch)
        object.__setattr__(self, "speed", speed)

    @property
    def total(self) -> float:
        """The arc length of the whole path, m."""
        return float(self.length.sum())

    @property
    def sharpest(self) -> Array:
        """The largest size of the curvature in each segment, (M,) 1/m: it is at one of the ends."""
        return np.maximum(np.abs(self.curvature), np.abs(self.curvature + self.sharpness * self.length))

    def part(self, first: int, end: int) -> Path:
        """The segments from ``first`` to before ``end``."""
        columns = {field.name: getattr(self, field.name) for field in fields(Path) if field.name != "z"}
        return Path(**{name: column[first:end] for name, column in columns.items()}, z=self.z)

    def evaluate(self, segment: IntArray, distance: Array) -> tuple[Array, Array, Array, Array]:
        """Position and its derivatives by arc length at ``distance`` m from the start of the given segments.

        Args:
            segment: (N,) indices.
            distance: (N,) m, within the segment; both ends belong to it, so that each side of a joint can be asked for.

        Returns:
            p (N, 3) m, p' (N, 3), p'' (N, 3) 1/m, p''' (N, 3) 1/m^2 in the machine frame.
        """
        curvature, sharpness = self.curvature[segment], self.sharpness[segment]
        points, heading = clothoid.advance(self.start[segment], self.heading[segment], curvature, sharpness, distance)
        bend = curvature + sharpness * distance
        cos, sin, flat = np.cos(heading), np.sin(heading), np.zeros_like(heading)
        position = np.column_stack([points, np.full_like(heading, self.z)])
        tangent = np.column_stack([cos, sin, flat])
        second = np.column_stack([-sin * bend, cos * bend, flat])
        third = np.column_stack([-sin * sharpness - cos * bend**2, cos * sharpness - sin * bend**2, flat])
        return position, tangent, second, third

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
    """The path along an open curve, at height ``z`` m."""
    return Path(
        start=curve.starts,
        heading=curves.headings(curve)[0],
        curvature=curves.curvatures(curve),
        sharpness=np.zeros(len(curve.bulges)),
        length=curves.lengths(curve),
        stretch=np.zeros(len(curve.bulges), dtype=np.int64),
        speed=np.full(len(curve.bulges), np.inf),
        z=z,
    )


def straight(start: Array, end: Array, z: float) -> Path:
    """The straight path from ``start`` to ``end``, (2,) m each and apart, at height ``z`` m."""
    return from_curve(Curve(points=np.array([start, end]), bulges=np.zeros(1), closed=False), z)


def join(paths: Sequence[Path]) -> Path:
    """The segments of several paths at one height, one path after the other."""
    names = [field.name for field in fields(Path) if field.name != "z"]
    return Path(**{name: np.concatenate([getattr(path, name) for path in paths]) for name in names}, z=paths[0].z)
