"""A line of a test cut."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model import Array, readonly

CUT: Final = "CUT"
ENGRAVED: Final = "ENGRAVE"
"""The layer of what is engraved, which the default rules know."""


@dataclass(frozen=True, slots=True, eq=False)
class Line:
    """A chain of straight lines.

    Attributes:
        layer: that it lies on.
        points: (N, 2) m; a closed one does not repeat its first point.
        closed: whether the last point joins the first.
    """

    layer: str
    points: Array
    closed: bool

    def __post_init__(self) -> None:
        """Copy the points and lock them."""
        object.__setattr__(self, "points", readonly(self.points, columns=2))


def rectangle(layer: str, left: float, bottom: float, width: float, height: float) -> Line:
    """A rectangle, counter-clockwise, m."""
    right, top = left + width, bottom + height
    return Line(layer, np.array([[left, bottom], [right, bottom], [right, top], [left, top]]), closed=True)
