"""Where the sheet lies, and the worst of anything over it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot.bounds import BOUNDS

DEFAULT_PRESSURE_ANGLE_DEG: Final = 60.0
"""Largest pressure angle where the robot file gives none.

At 60 degrees half of the force in a forearm does work, and a small error of a joint or a length is doubled at the tool;
it is also the bound that published designs use for mu2. The built-in robots stay below 50 degrees on their sheets.
"""

_GRID: Final = 61  # points per side of the first grid
_SEEDS: Final = 12  # of them are refined
_ZOOM: Final = np.linspace(-1.0, 1.0, 9)  # the finer grid about a seed, in steps of the coarser one
_ROUNDS: Final = 8  # of refinement, each four times as fine: 2 / 60 / 4**8 is 5e-7 of half a side


@dataclass(frozen=True, slots=True)
class Workspace:
    """The sheet: a rectangle or a disc about the machine's axis, and where the tool waits.

    Attributes:
        sheet_z: height of the sheet in the machine, m; below the base where that hangs upright.
        width: along x, m; None for a disc.
        depth: along y, m; None for a disc.
        radius: of a disc, m; None for a rectangle.
        park: x and y where a program starts and ends, m, on the sheet.
        max_pressure_angle: largest pressure angle allowed, mu1 and mu2, rad.
        max_forearm_swing: largest lean of a forearm out of its arm's plane, rad; None where the joints allow any.

    Raises:
        RobotError: a value out of its bounds, neither or both of disc and rectangle, or park beside the sheet.
    """

    sheet_z: float
    width: float | None = None
    depth: float | None = None
    radius: float | None = None
    park: tuple[float, float] = (0.0, 0.0)
    max_pressure_angle: float = math.radians(DEFAULT_PRESSURE_ANGLE_DEG)
    max_forearm_swing: float | None = None

    def __post_init__(self) -> None:
        for name in ("sheet_z", "width", "depth", "radius", "max_pressure_angle", "max_forearm_swing"):
            value = getattr(self, name)
            if value is not None:
                BOUNDS[name].check(name, (value,), "workspace")
        BOUNDS["park"].check("park", self.park, "workspace")
        rectangle, disc = (self.width is not None, self.depth is not None), self.radius is not None
        if rectangle != (not disc, not disc):
            raise RobotError("the sheet must be either width and depth, or a radius", where="workspace")
        outside = float(self.excess(np.array([self.park]))[0])
        if outside > 0.0:
            raise RobotError(f"park is {outside * 1e3:.3f} mm outside the sheet", where="workspace")

    def excess(self, xy: npt.ArrayLike) -> Array:
        """How far outside the sheet every point is.

        Args:
            xy: (N, 2) in the machine frame, m.

        Returns:
            (N,) m; 0 on the sheet and on its edge.
        """
        points = np.asarray(xy, dtype=np.float64)
        if self.radius is not None:
            return np.maximum(np.hypot(points[:, 0], points[:, 1]) - self.radius, 0.0)
        over = np.maximum(np.abs(points) - self._half_sides(), 0.0)
        return np.asarray(np.hypot(over[:, 0], over[:, 1]))

    def grid(self, count: int = _GRID) -> Array:
        """Points at the sheet's height that cover it, its edge included: (count * count, 3) m."""
        return self._points(_square(count))

    def worst(self, measure: Callable[[Array], Array]) -> tuple[float, Array]:
        """The largest value of ``measure`` over the sheet, and where it is.

        The best points of a grid are refined by finer and finer grids about each of them, all within the sheet. That
        finds the largest value of a function that is smooth on the scale of the grid, a sixtieth of the sheet.

        Args:
            measure: takes points (N, 3) m, returns (N,).

        Returns:
            the value, and the point (3,) m.
        """
        at = _square(_GRID)
        values = measure(self._points(at))
        seeds = np.argsort(values)[::-1][:_SEEDS]
        at, values, step = at[seeds], values[seeds], 2.0 / (_GRID - 1)
        around = np.stack(np.meshgrid(_ZOOM, _ZOOM, indexing="ij"), axis=-1).reshape(1, -1, 2)
        for _ in range(_ROUNDS):
            near = np.clip(at[:, np.newaxis] + step * around, -1.0, 1.0)
            found = measure(self._points(near.reshape(-1, 2))).reshape(len(at), -1)
            best = found.argmax(axis=1)
            at, values, step = near[np.arange(len(at)), best], found.max(axis=1), step / 4.0
        top = int(values.argmax())
        return float(values[top]), self._points(at[top : top + 1])[0]

    def _half_sides(self) -> Array:
        return np.array([self.width or 0.0, self.depth or 0.0]) / 2.0

    def _points(self, square: Array) -> Array:
        """Points of the sheet for ``square`` (N, 2) in -1..1; for a disc, squares about the middle become rings."""
        if self.radius is None:
            xy = square * self._half_sides()
        else:
            ring, length = np.abs(square).max(axis=1), np.hypot(square[:, 0], square[:, 1])
            xy = square * (self.radius * ring / np.where(length > 0.0, length, 1.0))[:, np.newaxis]
        return np.column_stack((xy, np.full(len(xy), self.sheet_z)))


def _square(count: int) -> Array:
    side = np.linspace(-1.0, 1.0, count)
    return np.stack(np.meshgrid(side, side, indexing="ij"), axis=-1).reshape(-1, 2)
