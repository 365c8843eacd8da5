"""The shapes that a region may have: an upright box, and an upright cylinder."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array, BoolArray

Triple = tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Box:
    """A box whose edges are along the machine's axes; a side may have no length, so that a sheet is a box.

    Attributes:
        low: smallest x, y and z, m.
        high: largest x, y and z, m.

    Raises:
        RobotError: a coordinate is not finite, or low is above high.
    """

    low: Triple
    high: Triple

    def __post_init__(self) -> None:
        if not np.isfinite([self.low, self.high]).all() or np.greater(self.low, self.high).any():
            raise RobotError(f"there is no box from {self.low} to {self.high}", where="region")

    @property
    def bounds(self) -> tuple[Array, Array]:
        """The corners of the smallest box around it, each (3,) m."""
        return np.array(self.low, dtype=np.float64), np.array(self.high, dtype=np.float64)

    @property
    def volume(self) -> float:
        """Of the box, m^3."""
        return math.prod(high - low for low, high in zip(self.low, self.high, strict=True))

    def nearest(self, points: Array) -> Array:
        """The points of the box nearest to ``points``: (N, 3) m."""
        return np.clip(points, *self.bounds)

    def touches(self, centres: Array, half: Array) -> BoolArray:
        """Whether cells, boxes of half sides ``half`` (3,) m about ``centres`` (N, 3) m, touch the box: (N,)."""
        low, high = self.bounds
        return np.asarray(((centres + half >= low) & (centres - half <= high)).all(axis=1))

    def corners(self) -> Array:
        """Points where the worst is likely: the eight corners, (8, 3) m."""
        return np.stack(np.meshgrid(*np.stack(self.bounds, axis=1), indexing="ij"), axis=-1).reshape(-1, 3)


@dataclass(frozen=True, slots=True)
class Cylinder:
    """A cylinder whose axis is along the machine's z; it may have no height, so that a sheet is a cylinder.

    Attributes:
        centre: x and y of its axis, m.
        radius: m, > 0.
        z_low: its lower end, m.
        z_high: its upper end, m.

    Raises:
        RobotError: a number is not finite, the radius is not positive, or z_low is above z_high.
    """

    centre: tuple[float, float]
    radius: float
    z_low: float
    z_high: float

    def __post_init__(self) -> None:
        finite = np.isfinite([*self.centre, self.radius, self.z_low, self.z_high]).all()
        if not finite or self.radius <= 0.0 or self.z_low > self.z_high:
            raise RobotError(
                f"there is no cylinder of radius {self.radius} from z = {self.z_low} to {self.z_high}", where="region"
            )

    @property
    def bounds(self) -> tuple[Array, Array]:
        """The corners of the smallest box around it, each (3,) m."""
        x, y = self.centre
        low, high = (x - self.radius, y - self.radius, self.z_low), (x + self.radius, y + self.radius, self.z_high)
        return np.array(low), np.array(high)

    @property
    def volume(self) -> float:
        """Of the cylinder, m^3."""
        return math.pi * self.radius**2 * (self.z_high - self.z_low)

    def nearest(self, points: Array) -> Array:
        """The points of the cylinder nearest to ``points``: (N, 3) m."""
        out = points[:, :2] - self.centre
        away = np.hypot(out[:, 0], out[:, 1])
        shrink = self.radius / np.maximum(away, self.radius)
        return np.column_stack((self.centre + out * shrink[:, np.newaxis], np.clip(points[:, 2], *self._heights())))

    def touches(self, centres: Array, half: Array) -> BoolArray:
        """Whether cells, boxes of half sides ``half`` (3,) m about ``centres`` (N, 3) m, touch the cylinder: (N,).

        A cell is beside it where even its edge nearest to the axis is.
        """
        gap = np.maximum(np.abs(centres[:, :2] - self.centre) - half[:2], 0.0)
        near = np.hypot(gap[:, 0], gap[:, 1]) <= self.radius * (1.0 + 1e-12)
        low, high = self._heights()
        return np.asarray(near & (centres[:, 2] + half[2] >= low) & (centres[:, 2] - half[2] <= high))

    def corners(self) -> Array:
        """Points where the worst is likely: 24 on each of the two edges, (48, 3) m."""
        turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
        ring = self.centre + self.radius * np.stack((np.cos(turn), np.sin(turn)), axis=1)
        return np.concatenate([np.column_stack((ring, np.full(len(ring), z))) for z in self._heights()])

    def _heights(self) -> tuple[float, float]:
        return self.z_low, self.z_high


Region = Box | Cylinder
