"""The fastest time law along a path within every limit, by toppra (Pham and Pham 2018).

toppra gives each gridpoint one second derivative of the path, but where a line meets an arc there are two. So the
constraint here belongs to the intervals, not to the points: at the start of an interval it uses the derivatives seen
from inside it, at the end likewise, and in the middle too. With u the path acceleration, constant in an interval of
length d, and x the squared path speed at its start, x + 2 f d u after the share f of it, a row a u + b x <= g holds
there if (a + 2 f d b) u + b x <= g.
"""

from __future__ import annotations

import logging
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, Final

import numpy as np

from deltacam.errors import InfeasibleError
from deltacam.model import Array, IntArray
from deltacam.motion.path import Path

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

SPACING: Final = 5e-4
"""Longest interval between gridpoints, m."""

STEP: Final = 0.07
"""Largest turn of an arc between gridpoints, rad: the best speed on an arc changes with the angle."""

GROWTH: Final = 0.7
"""How much wider intervals are per distance from the end of their segment, up to ``SPACING``."""

STATIONS: Final = (0.0, 0.5, 1.0)
"""Where in each interval the limits are held; with both ends alone they were exceeded by 0.36 % in between."""

INTERVALS: Final = 4
"""Fewest intervals per line or arc."""

SIDES: Final = 16
"""Sides of the half polygon, drawn inside the half circle, that stands for the cap on the tool's acceleration."""

_CHORD_SHARE: Final = 0.95


@dataclass(frozen=True, slots=True)
class Limits:
    """What bounds the motion along one path, beyond the joints' own limits.

    Attributes:
        speed: of the tool, m/s.
        acceleration: of the tool, m/s2.
        chord: how far the motion may leave the path between ticks, m; None where that does not matter.
    """

    speed: float
    acceleration: float
    chord: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class TimeLaw:
    """How far along a path the tool is at a time.

    Attributes:
        distance: (G,) m, the gridpoints.
        speed: (G,) m/s at the gridpoints; the square is linear in between.
        time: (G,) s at the gridpoints.
    """

    distance: Array
    speed: Array
    time: Array

    @property
    def duration(self) -> float:
        """From rest to rest, s."""
        return float(self.time[-1])

    def at(self, time: Array) -> Array:
        """The distance along the path, (N,) m, at the given times, (N,) s within the duration; exact."""
        interval = np.clip(np.searchsorted(self.time, time, side="right") - 1, 0, len(self.time) - 2)
        since = time - self.time[interval]
        width = np.diff(self.distance)
        acceleration = np.diff(self.speed**2) / (2.0 * width)
        moved = self.speed[interval] * since + 0.5 * acceleration[interval] * since**2
        return np.asarray(self.distance[interval] + np.clip(moved, 0.0, width[interval]))


def parametrize(path: Path, robot: Robot, limits: Limits, *, where: str) -> TimeLaw:
    """The fastest motion along ``path`` from rest to rest.

    Args:
        path: tangent lines and arcs.
        robot: gives joint limits and the tick.
        limits: of the tool.
        where: names the path in an error.

    Raises:
        InfeasibleError: there is none; says where the path stops being drivable.
        RobotError: the path leaves the reach of the robot.
    """
    grid = _Grid.over(path, limits)
    stations = [_Station.of(path, robot, limits, grid, share) for share in STATIONS]
    squared = _solve(grid.distance, stations, _right_hand_side(robot, limits), where)
    speed = np.sqrt(squared)
    duration = 2.0 * np.diff(grid.distance) / (speed[:-1] + speed[1:])
    return TimeLaw(grid.distance, speed, np.concatenate([[0.0], np.cumsum(duration)]))


@dataclass(frozen=True, slots=True, eq=False)
class _Grid:
    """The intervals of a path: every joint of the path is a gridpoint.

    Attributes:
        segment: (I,) the segment of each interval.
        start: (I,) m from the start of the segment.
        end: (I,) m from the start of the segment.
        distance: (I + 1,) m from the start of the path.
    """

    segment: IntArray
    start: Array
    end: Array
    distance: Array

    @classmethod
    def over(cls, path: Path, limits: Limits) -> _Grid:
        """Intervals that are fine where the speed may change fast: near the ends of segments, and on tight arcs.

        At d from the nearer end of a segment they are about h(d) = min(widest, finest + d GROWTH) wide, so that the
        integral of 1 / h counts them; its inverse gives the gridpoints.
        """
        widest = np.minimum(SPACING, STEP / np.maximum(np.abs(path.curvature), 1e-9))
        finest = np.minimum(widest, 0.25 * limits.speed**2 / limits.acceleration)
        half = 0.5 * path.length
        graded = (widest - finest) / GROWTH
        needed = 2.0 * np.where(
            half <= graded,
            np.log1p(GROWTH * half / finest) / GROWTH,
            np.log(widest / finest) / GROWTH + (half - graded) / widest,
        )
        count = np.maximum(INTERVALS, np.ceil(needed - 1e-9)).astype(np.int64)
        segment = np.repeat(np.arange(len(count)), count)
        index = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)

        def place(passed: IntArray) -> Array:
            """Where each segment's ``passed`` first intervals end, (I,) m."""
            nearer = np.minimum(passed, count[segment] - passed) * (needed / count)[segment]
            low, high = finest[segment], widest[segment]
            grown = low * np.expm1(np.minimum(GROWTH * nearer, np.log(high / low))) / GROWTH
            from_end = grown + np.maximum(nearer - np.log(high / low) / GROWTH, 0.0) * high
            from_end = np.minimum(from_end, half[segment])
            return np.asarray(np.where(2 * passed <= count[segment], from_end, path.length[segment] - from_end))

        start, end = place(index), place(index + 1)
        offset = np.concatenate([[0.0], np.cumsum(path.length)])
        return cls(segment, start, end, np.append(offset[segment] + start, offset[-1]))


@dataclass(frozen=True, slots=True, eq=False)
class _Station:
    """The limits at one place in every interval.

    Attributes:
        share: how far into the interval, 0 to 1.
        a: (I, m) factor of the path acceleration in the rows.
        b: (I, m) factor of the squared path speed in the rows.
        bound: (I,) largest squared path speed.
    """

    share: float
    a: Array
    b: Array
    bound: Array

    @classmethod
    def of(cls, path: Path, robot: Robot, limits: Limits, grid: _Grid, share: float) -> _Station:
        segment = grid.segment
        position, tangent, bend = path.evaluate(segment, grid.start + share * (grid.end - grid.start))
        _, dq, ddq = robot.path_derivatives(position, tangent, bend)
        angle = (np.arange(SIDES) + 0.5) * np.pi / SIDES
        curvature = np.abs(path.curvature[segment])
        a = np.concatenate([dq, -dq, np.broadcast_to(np.cos(angle), (len(dq), SIDES))], axis=1)
        b = np.concatenate([ddq, -ddq, curvature[:, None] * np.sin(angle)], axis=1)
        fastest = np.min(np.asarray(robot.joints.max_speed) / np.maximum(np.abs(dq), 1e-12), axis=1)
        bound = np.minimum(fastest, limits.speed) ** 2
        if limits.chord is not None:
            bound = np.minimum(bound, _chord_bound(robot, position, tangent, ddq, limits.chord))
        return cls(share, a, b, bound)

    def rows(self, width: Array) -> tuple[Array, Array]:
        """The factors of u and of x at the start of the interval, (I, m + 1) each; the last row bounds the speed."""
        ahead = 2.0 * self.share * width[:, None]
        bound = self.bound[:, None]
        return np.concatenate([self.a + ahead * self.b, ahead / bound], axis=1), np.concatenate(
            [self.b, 1.0 / bound], axis=1
        )


def _chord_bound(robot: Robot, position: Array, tangent: Array, ddq: Array, chord: float) -> Array:
    """The squared path speed, (I,) m2/s2, at which straight joint motion between ticks leaves the path by ``chord``.

    Straight motion in the joints lags behind by (q' u + q'' x) dt^2 / 8 in the middle of a tick, at the tool by J times
    that. The first part lies along the path and does no harm; the second has a part across.
    """
    lag = np.linalg.solve(robot.inverse_jacobian(position), ddq[:, :, None])[:, :, 0]
    across = np.linalg.norm(lag - np.sum(lag * tangent, axis=1, keepdims=True) * tangent, axis=1)
    tick = 1.0 / robot.controller.rate_hz
    return np.asarray(_CHORD_SHARE * 8.0 * chord / (tick**2 * np.maximum(across, 1e-12)))


def _right_hand_side(robot: Robot, limits: Limits) -> Array:
    """What the rows of a station may be at most, (m + 1,)."""
    joints = np.asarray(robot.joints.max_acceleration)
    tool = limits.acceleration * np.cos(np.pi / (2 * SIDES))
    return np.concatenate([joints, joints, np.full(SIDES, tool), [1.0]])


def _solve(grid: Array, stations: list[_Station], limit: Array, where: str) -> Array:
    """The squared speed at every gridpoint, (I + 1,) m2/s2, 0 at both ends."""
    # toppra takes long to import, because it loads matplotlib.
    from toppra.algorithm import TOPPRA
    from toppra.constraint import LinearConstraint

    rows = [station.rows(np.diff(grid)) for station in stations]
    a, b = (np.concatenate(part, axis=1) for part in zip(*rows, strict=True))
    ceiling = np.max([station.bound.max() for station in stations])

    class Rows(LinearConstraint):  # type: ignore[misc]
        """The rows above, as toppra asks for them; the last point has none of its own."""

        def __init__(self) -> None:
            super().__init__()
            self.identical = True

        def compute_constraint_params(self, *_: object) -> tuple[Any, ...]:
            last = np.zeros((1, a.shape[1]))
            a_all, b_all = np.concatenate([a, last]), np.concatenate([b, last])
            speed = np.tile([0.0, ceiling], (len(grid), 1))
            right = np.tile(limit, len(stations))
            return a_all, b_all, np.zeros_like(a_all), np.eye(a.shape[1]), right, None, speed

    logging.getLogger("toppra").setLevel(logging.ERROR)  # what it warns of is found out, and said, below
    solver = TOPPRA(
        [Rows()], _Interval(grid), gridpoints=grid, solver_wrapper="seidel", parametrizer="ParametrizeConstAccel"
    )
    _, speed, _, controllable = solver.compute_parameterization(0.0, 0.0, return_data=True)
    if speed is None or not np.isfinite(speed).all() or np.any((speed[:-1] + speed[1:]) <= 0.0):
        lost = np.flatnonzero(np.isnan(controllable).any(axis=1))
        place = float(grid[lost[-1]]) if len(lost) else 0.0
        raise InfeasibleError(
            f"no motion within the limits passes {place * 1e3:.3f} mm of {grid[-1] * 1e3:.3f} mm along this path",
            where=where,
            hint="this is likely a fault of deltacam: please report it with the drawing",
        )
    squared = np.asarray(speed, dtype=np.float64) ** 2
    squared[[0, -1]] = 0.0
    return squared


class _Interval:
    """What toppra asks of a geometric path when the constraint brings its own derivatives."""

    def __init__(self, grid: Array) -> None:
        self.path_interval = np.array([grid[0], grid[-1]])
        self.duration = float(grid[-1] - grid[0])
        self.dof = 3
