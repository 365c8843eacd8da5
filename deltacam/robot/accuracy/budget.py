"""The accuracy budget of a robot: what each source of errors does at the tool, and what all do together."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model import Array
from deltacam.robot.accuracy.draws import draw, exact_errors, usual
from deltacam.robot.accuracy.sensitivity import tool_by_error
from deltacam.robot.accuracy.sources import JOINTS, Errors, Source, columns_of
from deltacam.robot.accuracy.spread import AXES, corners, mean_squares
from deltacam.robot.robot import Robot

DRAWS: Final = 4000
SEED: Final = 6
_PLACES: Final = 9  # per side of the sheet, for the machines that are drawn; its middle, its edge and corners are there


@dataclass(frozen=True, slots=True, eq=False)
class Contribution:
    """What one source does, as the root mean square of the tool's distance, m.

    Attributes:
        source: which.
        centre: at the middle of the sheet: in x and y, of the focus.
        worst: the largest over the sheet, likewise.
        at: where these are, (3,) m each.
        share: its part of the mean square of all sources, 0 to 1, where that is largest, likewise.
    """

    source: Source
    centre: tuple[float, float]
    worst: tuple[float, float]
    at: tuple[Array, Array]
    share: tuple[float, float]


@dataclass(frozen=True, slots=True, eq=False)
class Total:
    """What all sources do together, seen in one of the ways of `spread.AXES`; all m.

    Attributes:
        view: which way.
        rms: root mean square, at the middle and the largest over the sheet.
        at: where that largest is, (3,).
        usual: what 95 % of the machines that were drawn stay within, at the middle and at the worst of the places.
        bound: the farthest that is possible to first order, at the middle and the largest over the sheet.
        joints: as ``usual`` at the worst of the places, with the errors of the joints alone: what a calibration leaves.
    """

    view: str
    rms: tuple[float, float]
    at: Array
    usual: tuple[float, float]
    bound: tuple[float, float]
    joints: float


@dataclass(frozen=True, slots=True, eq=False)
class Budget:
    """The accuracy budget.

    Attributes:
        errors: what was assumed.
        contributions: one for each source.
        totals: one for each of `spread.AXES`, in its order.
        places: (N, 3) m, where machines were drawn; the first is the middle of the sheet.
        draws: how many.
        seed: of their random numbers.
        curvature: how far the closed form is from the exact error, at most: a part of the error that 95 % stay within.
    """

    errors: Errors
    contributions: tuple[Contribution, ...]
    totals: tuple[Total, ...]
    places: Array
    draws: int
    seed: int
    curvature: float

    def total(self, view: str) -> Total:
        """The total seen in this way, a key of `spread.AXES`."""
        return self.totals[tuple(AXES).index(view)]


def budget(robot: Robot, errors: Errors, *, draws: int = DRAWS, seed: int = SEED) -> Budget:
    """What the ``errors`` do at the tool over the sheet of the robot.

    Args:
        robot: without errors.
        errors: how large each may be.
        draws: how many machines are drawn, >= 1.
        seed: of the random numbers; the same seed gives the same budget.

    Raises:
        RobotError: a part of the sheet is out of reach, or a machine with such errors does not reach it.
    """
    limits = errors.limits()
    worst = {view: robot.workspace.worst(_rms(robot, limits, view)) for view in AXES}
    places = np.vstack((_middle(robot), *(at for _, at in worst.values()), robot.workspace.grid(_PLACES)))
    machines = draw(draws, seed) * limits
    exact = exact_errors(robot.geometry, places, machines)
    linear = np.einsum("nxk,dk->dnx", tool_by_error(robot.geometry, places), machines)
    joints = exact_errors(robot.geometry, places, machines * _only(JOINTS))
    return Budget(
        errors=errors,
        contributions=tuple(_contribution(robot, limits, source, worst) for source in Source),
        totals=tuple(_total(robot, limits, view, worst[view], (exact, joints)) for view in AXES),
        places=places,
        draws=draws,
        seed=seed,
        curvature=_largest_part(np.linalg.norm(exact - linear, axis=2), np.linalg.norm(exact, axis=2)),
    )


def error_map(robot: Robot, errors: Errors, count: int) -> tuple[Array, Array, dict[str, Array]]:
    """The root mean square of the error over a raster of the sheet.

    Args:
        robot: without errors.
        errors: how large each may be.
        count: of places per side.

    Returns:
        x (count,), y (count,) m; for each of `spread.AXES` (count, count) m, one row per y, nan beside the sheet.
    """
    sheet = robot.workspace
    half = [sheet.radius or (side or 0.0) / 2.0 for side in (sheet.width, sheet.depth)]
    x, y = (np.linspace(-side, side, count) for side in half)
    xy = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    on = sheet.excess(xy) <= 0.0
    points = np.column_stack((xy[on], np.full(on.sum(), sheet.sheet_z)))
    fields = {}
    for view in AXES:
        field = np.full(len(xy), np.nan)
        field[on] = _rms(robot, errors.limits(), view)(points)
        fields[view] = field.reshape(count, count)
    return x, y, fields


def _middle(robot: Robot) -> Array:
    return np.array([[0.0, 0.0, robot.workspace.sheet_z]])


def _rms(robot: Robot, limits: Array, view: str) -> Callable[[Array], Array]:
    def rms(points: Array) -> Array:
        return np.asarray(np.sqrt(mean_squares(tool_by_error(robot.geometry, points), limits, view).sum(axis=1)))

    return rms


def _only(sources: tuple[Source, ...]) -> Array:
    """1 for the independent errors of these sources, 0 for all others."""
    chosen = np.zeros(columns_of(Source.SHEET).stop)
    for source in sources:
        chosen[columns_of(source)] = 1.0
    return chosen


def _contribution(robot: Robot, limits: Array, source: Source, totals: dict[str, tuple[float, Array]]) -> Contribution:
    own, centre, worst, at, share = limits * _only((source,)), [], [], [], []
    for view in ("in_plane", "focus"):
        rms = _rms(robot, own, view)
        value, where = robot.workspace.worst(rms)
        largest, place = totals[view]
        centre.append(float(rms(_middle(robot))[0]))
        worst.append(value)
        at.append(where)
        share.append(float(rms(place[np.newaxis])[0] / largest) ** 2 if largest > 0.0 else 0.0)
    return Contribution(source, _pair(centre), _pair(worst), (at[0], at[1]), _pair(share))


def _total(robot: Robot, limits: Array, view: str, worst: tuple[float, Array], drawn: tuple[Array, Array]) -> Total:
    def bound(points: Array) -> Array:
        ends = corners(tool_by_error(robot.geometry, points), limits)[:, :, AXES[view]]
        return np.asarray(np.linalg.norm(ends, axis=2).max(axis=0))

    middle = _middle(robot)
    distances, joints = (usual(np.linalg.norm(errors[:, :, AXES[view]], axis=2)) for errors in drawn)
    return Total(
        view=view,
        rms=(float(_rms(robot, limits, view)(middle)[0]), worst[0]),
        at=worst[1],
        usual=(float(distances[0]), float(distances.max())),
        bound=(float(bound(middle)[0]), robot.workspace.worst(bound)[0]),
        joints=float(joints.max()),
    )


def _largest_part(differences: Array, distances: Array) -> float:
    """The largest difference by the distance that 95 % stay within; 0 where there is none."""
    scale = usual(distances)
    return float((differences.max(axis=0) / np.where(scale > 0.0, scale, 1.0)).max())


def _pair(values: list[float]) -> tuple[float, float]:
    return values[0], values[1]
