"""The prescribed workspace: a box or a cylinder on the robot's axis, and points that cover it.

A robot with three equal arms, one of them on -y, is its own mirror image in the plane x = 0; seen along its axis it is
also the same after a third of a turn. So half of a box and a sixth of a cylinder stand for the whole. That part is the
image of the unit cube: searches move in the cube, where every side is as long as the others and a clipped point is
still a point of the workspace.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array

SMALLEST = 0.001
"""The least side of a prescribed workspace, m; the least the robot file takes for a sheet, too."""

LARGEST = 10.0
"""The largest side, m."""


class Shape(Protocol):
    """A prescribed workspace."""

    @property
    def height(self) -> float:
        """Along the robot's axis, m."""

    @property
    def diagonal(self) -> float:
        """The largest distance between two of its points, m."""

    def place(self, unit: Array) -> Array:
        """Points of the unit cube (N, 3) as points about the middle of the workspace, (N, 3) m."""


@dataclass(frozen=True, slots=True)
class BoxShape:
    """A box about the robot's axis.

    Attributes:
        width: along x, m.
        depth: along y, m.
        height: along z, m.

    Raises:
        RobotError: a side is not within `SMALLEST` and `LARGEST`.
    """

    width: float
    depth: float
    height: float

    def __post_init__(self) -> None:
        _check_sides(("width", self.width), ("depth", self.depth), ("height", self.height))

    @property
    def diagonal(self) -> float:
        """From corner to corner, m."""
        return math.hypot(self.width, self.depth, self.height)

    def place(self, unit: Array) -> Array:
        """Points of the unit cube (N, 3) in the half of the box with x >= 0, (N, 3) m."""
        sides = np.array([self.width / 2.0, self.depth, self.height])
        return np.asarray((unit - [0.0, 0.5, 0.5]) * sides)


@dataclass(frozen=True, slots=True)
class CylinderShape:
    """A cylinder about the robot's axis.

    Attributes:
        diameter: m.
        height: along z, m.

    Raises:
        RobotError: a side is not within `SMALLEST` and `LARGEST`.
    """

    diameter: float
    height: float

    def __post_init__(self) -> None:
        _check_sides(("diameter", self.diameter), ("height", self.height))

    @property
    def diagonal(self) -> float:
        """From the rim of the lower disc to the far rim of the upper, m."""
        return math.hypot(self.diameter, self.height)

    def place(self, unit: Array) -> Array:
        """Points of the unit cube (N, 3), which are radius, angle and height, between arm 1 and the gap beside it."""
        angle = -np.pi / 2.0 + unit[:, 1] * np.pi / 3.0
        radius = unit[:, 0] * self.diameter / 2.0
        placed: Array = np.column_stack(
            (radius * np.cos(angle), radius * np.sin(angle), (unit[:, 2] - 0.5) * self.height)
        )
        return placed


def surface(count: int) -> Array:
    """Points of the unit cube whose images cover the surface of a workspace and its mirror planes, (N, 3)."""
    cube = grid(count)
    return np.asarray(cube[(np.abs(cube - 0.5) == 0.5).any(axis=1)])


def grid(count: int) -> Array:
    """``count``^3 points of the unit cube, its surface included, (N, 3)."""
    side = np.linspace(0.0, 1.0, count)
    return np.asarray(np.stack(np.meshgrid(side, side, side, indexing="ij"), axis=-1).reshape(-1, 3))


def _check_sides(*sides: tuple[str, float]) -> None:
    for name, value in sides:
        if not SMALLEST <= value <= LARGEST:  # also true of nan
            what = f"{name} = {value * 1e3:.6g} mm is outside {SMALLEST * 1e3:g} to {LARGEST * 1e3:g} mm"
            raise RobotError(what, where="prescribed workspace")
