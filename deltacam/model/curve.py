"""A plane curve of lines and circular arcs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model.arrays import Array, readonly

STRAIGHT: Final = 1e-12
"""Bulge of an arc that is a line: over a chord of 1 m it would rise by half a picometre."""


@dataclass(frozen=True, slots=True, eq=False)
class Curve:
    """Lines and circular arcs joined end to end in the sheet plane.

    Segment i runs from ``points[i]`` to the next point; its bulge is the tangent of a quarter of the angle that it
    turns through: 0 for a line, 1 for half a circle counter-clockwise, -1 for half a circle clockwise. A bulge below
    ``STRAIGHT`` is kept as 0.

    Attributes:
        points: (N, 2) m; a closed curve does not repeat its first point.
        bulges: (N,) for a closed curve, (N - 1,) for an open one.
        closed: whether the last point joins the first.
    """

    points: Array
    bulges: Array
    closed: bool = True

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", readonly(self.points, columns=2))
        bulges = np.asarray(self.bulges, dtype=np.float64)
        object.__setattr__(self, "bulges", readonly(np.where(np.abs(bulges) < STRAIGHT, 0.0, bulges)))
        if len(self.bulges) != len(self.points) - (not self.closed):
            raise ValueError(f"{len(self.points)} points do not go with {len(self.bulges)} bulges")

    @property
    def starts(self) -> Array:
        """The first point of every segment, (M, 2) m."""
        return self.points if self.closed else self.points[:-1]

    @property
    def ends(self) -> Array:
        """The last point of every segment, (M, 2) m."""
        return np.concatenate([self.points[1:], self.points[:1]]) if self.closed else self.points[1:]
