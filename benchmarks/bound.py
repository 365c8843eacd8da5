"""A lower bound on the time along a path from rest to rest, by other means than the planner's.

With s the distance along the path and x the squared speed, the acceleration along the path is u = dx / 2 ds, and every
limit bounds some a(s) u + b(s) x; that of the tool's acceleration is u^2 + (k x)^2 <= A^2 with the curvature k. On a
grid much finer than the planner's, x is linear in every interval and the accelerations are bounded only in its middle;
what bounds x alone is asked for at the gridpoints. So an interval allows a convex set of pairs (x_before, x_after) with
(0, 0) in it, and

- a pass from the end gives the largest x at every gridpoint from which the end can be reached at rest,
- a pass from the start gives the largest x that can be reached without ever being above the first pass.

No motion within the limits is above the second pass anywhere, whatever it does before or behind. Its time is therefore
less than that of any motion on this grid: nothing is said about there being a motion as fast, which is what the planner
has to show.

Every step is a program in two variables, max x_before over the pairs with x_after <= what the pass has reached. The
largest x_before for a given x_after is concave in it; where it is largest does not depend on the pass and is found for
all intervals of all paths at once. Then a step is an evaluation, done for all paths at once.

Halving the intervals changes the times of the contours of ``motion_optimum.py`` by less than 0.01 %.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.model import Array, IntArray

if TYPE_CHECKING:
    from deltacam.motion.path import Path
    from deltacam.motion.route import Limits
    from deltacam.robot.robot import Robot

FINEST: Final = 1e-6
"""Length of the intervals at the ends of segments, m."""

WIDEST: Final = 2e-4
"""Longest interval, m."""

GROWTH: Final = 0.05
"""How much longer an interval is than its neighbour on the side of the nearer end of the segment."""

TURN: Final = 0.01
"""Largest turn within an interval, rad."""

FEWEST: Final = 16
"""Fewest intervals of a segment."""

_TOGETHER: Final = 500_000
_BISECTIONS: Final = 60
_PARALLEL: Final = 1e-12


@dataclass(frozen=True, slots=True, eq=False)
class Profile:
    """What no motion along a path exceeds.

    Attributes:
        distance: (G,) m from the start of the path, the gridpoints.
        squared: (G,) m2/s2, the squared speed there; linear in between.
    """

    distance: Array
    squared: Array

    @property
    def time(self) -> float:
        """The time that is needed at least, s."""
        speed = np.sqrt(self.squared)
        return float(np.sum(2.0 * np.diff(self.distance) / (speed[:-1] + speed[1:])))


def profiles(moves: Sequence[tuple[Path, Limits]], robot: Robot, *, fineness: float = 1.0) -> list[Profile]:
    """The largest squared speeds along every one of the paths within its limits.

    Args:
        moves: paths and what bounds the tool along them.
        robot: the machine.
        fineness: by which the intervals are shorter than usual.
    """
    grids = [_grid(path, fineness) for path, _ in moves]
    found: dict[int, Profile] = {}
    batch: list[int] = []
    for number in sorted(range(len(moves)), key=lambda one: len(grids[one].segment)):
        if batch and len(grids[number].segment) * (len(batch) + 1) > _TOGETHER:
            found.update(zip(batch, _together([(moves[one], grids[one]) for one in batch], robot), strict=True))
            batch = []
        batch.append(number)
    found.update(zip(batch, _together([(moves[one], grids[one]) for one in batch], robot), strict=True))
    return [found[number] for number in range(len(moves))]


class _Grid(NamedTuple):
    """Intervals of a path: the segment of each, and where in it the interval starts and ends, m; (I,) each."""

    segment: IntArray
    start: Array
    end: Array


def _grid(path: Path, fineness: float) -> _Grid:
    """Intervals that grow from both ends of every segment."""
    bend = np.maximum(np.abs(path.curvature), np.abs(path.curvature + path.sharpness * path.length))
    starts, ends = [], []
    for length, sharpest in zip(path.length, bend, strict=True):
        widest = min(WIDEST, TURN / max(sharpest, 1e-9), length / FEWEST)
        rungs = np.arange(np.ceil(max(np.log(widest / FINEST), 0.0) / np.log1p(GROWTH)))
        graded = np.minimum(FINEST * (1.0 + GROWTH) ** rungs, widest)
        even = np.full(int(np.ceil(max(0.5 * length - graded.sum(), 0.0) / widest)), widest)
        usual = np.concatenate([[0.0], np.cumsum(np.concatenate([graded, even]))])
        usual = usual[: max(int(np.searchsorted(usual, 0.5 * length)), 1) + 1]
        count = len(usual) - 1
        half = np.interp(np.linspace(0.0, count, round(count * fineness) + 1), np.arange(count + 1), usual)
        half *= 0.5 * length / half[-1]
        points = np.concatenate([half, length - half[-2::-1]])
        starts.append(points[:-1])
        ends.append(points[1:])
    segment = np.repeat(np.arange(len(starts)), [len(one) for one in starts])
    return _Grid(segment, np.concatenate(starts), np.concatenate(ends))


class _Steps(NamedTuple):
    """What a pass may do in every interval, where it goes from the squared speed y on one side to x on the other.

    For every joint |x + slope y| <= reach, for the tool |x - share y| <= (room - loss y^2)^(1/2).

    Attributes:
        reach: (..., 3, I) m2/s2.
        slope: (..., 3, I).
        share: (..., I).
        room: (..., I) m4/s4.
        loss: (..., I).
        turning: (..., I) m2/s2, the y at which the largest x that is allowed is largest.
    """

    reach: Array
    slope: Array
    share: Array
    room: Array
    loss: Array
    turning: Array


def _together(moves: Sequence[tuple[tuple[Path, Limits], _Grid]], robot: Robot) -> list[Profile]:
    """The profiles of some paths, in passes over all of them at once."""
    counts = np.array([len(grid.segment) for _, grid in moves])
    bound = np.zeros((counts.max() + 1, len(moves)))
    both = [
        _Steps(
            *(np.zeros((counts.max(), *([3] * (name in ("reach", "slope"))), len(moves))) for name in _Steps._fields)
        )
        for _ in range(2)
    ]
    distances = []
    for number, ((path, limits), grid) in enumerate(moves):
        offset = np.cumsum(path.length) - path.length
        distances.append(np.append(offset[grid.segment] + grid.start, path.total))
        bound[: counts[number] + 1, number] = _ceiling(path, limits, grid, robot)
        for padded, steps in zip(both, _allowed(path, limits, grid, robot, bound[:, number]), strict=True):
            for column, own in zip(padded, steps, strict=True):
                column[: counts[number], ..., number] = own.T
    backwards, forwards = both
    highest = _pass(_Steps(*(column[::-1] for column in backwards)), bound[::-1])[::-1]
    squared = _pass(forwards, highest)
    return [Profile(distances[n], squared[: counts[n] + 1, n]) for n in range(len(moves))]


def _pass(steps: _Steps, bound: Array) -> Array:
    """The largest squared speed at every gridpoint on the way from rest, (I + 1, P) m2/s2, at most ``bound``."""
    squared = np.zeros_like(bound)
    for point, (reach, slope, share, room, loss, turning) in enumerate(zip(*steps, strict=True)):
        y = np.minimum(squared[point], turning)
        tool = share * y + np.sqrt(np.maximum(room - loss * y**2, 0.0))
        joints = np.min(reach - slope * y, axis=0)
        squared[point + 1] = np.clip(np.minimum(tool, joints), 0.0, bound[point + 1])
    return squared


def _ceiling(path: Path, limits: Limits, grid: _Grid, robot: Robot) -> Array:
    """The squared speed that feed, joints and chord allow on both sides of every gridpoint, (I + 1,) m2/s2."""
    sides = []
    for place in (grid.start, grid.end):
        position, tangent, bend, _ = path.evaluate(grid.segment, place)
        _, dq, ddq = robot.path_derivatives(position, tangent, bend)
        slowest = np.min(np.asarray(robot.joints.max_speed) / np.maximum(np.abs(dq), _PARALLEL), axis=1)
        squared = np.minimum(slowest, limits.speed) ** 2
        if np.isfinite(limits.chord):
            squared = np.minimum(squared, by_chord(robot, position, tangent, ddq, limits.chord))
        sides.append(squared)
    return np.minimum(np.append(sides[0], 0.0), np.insert(sides[1], 0, 0.0))


def by_chord(robot: Robot, position: Array, tangent: Array, ddq: Array, chord: float) -> Array:
    """The squared speed, (N,) m2/s2, at which the tool is ``chord`` m beside the path in the middle of a tick.

    In the middle of a tick of length T joints that move straight are behind by q'' x T^2 / 8, besides what is along the
    path. The tool is off by the solution of (inverse Jacobian) off = that, of which the part across the path counts.
    """
    off = np.linalg.solve(robot.inverse_jacobian(position), ddq[:, :, None])[:, :, 0]
    across = np.linalg.norm(np.cross(off, tangent), axis=1)
    return 8.0 * chord * robot.controller.rate_hz**2 / np.maximum(across, _PARALLEL)


def _allowed(path: Path, limits: Limits, grid: _Grid, robot: Robot, ceiling: Array) -> tuple[_Steps, _Steps]:
    """The steps backwards and forwards through every interval."""
    count, width = len(grid.segment), grid.end - grid.start
    position, tangent, bend, _ = path.evaluate(grid.segment, 0.5 * (grid.start + grid.end))
    _, dq, ddq = robot.path_derivatives(position, tangent, bend)
    joints = np.asarray(robot.joints.max_acceleration)
    by_change, by_mean = dq / joints / (2.0 * width[:, None]), 0.5 * ddq / joints
    # (x_after - x_before)^2 + (k d)^2 (x_before + x_after)^2 <= (2 d A)^2
    turn, room = (np.linalg.norm(bend, axis=1) * width) ** 2, (2.0 * width * limits.acceleration) ** 2
    tool = ((1.0 - turn) / (1.0 + turn), room / (1.0 + turn), 4.0 * turn / (1.0 + turn) ** 2)
    steps = []
    for sign, other in ((-1.0, ceiling[1 : count + 1]), (1.0, ceiling[:count])):
        own = by_mean + sign * by_change
        least = _PARALLEL * (np.abs(by_mean) + np.abs(by_change)) + 1e-300
        own = np.where(np.abs(own) < least, least, own)
        slope = (by_mean - sign * by_change) / own
        found = _Steps((1.0 / np.abs(own)).T, slope.T, *tool, turning=other)
        steps.append(found._replace(turning=_turning(found)))
    return steps[0], steps[1]


def _turning(steps: _Steps) -> Array:
    """The y, up to ``steps.turning``, at which the largest x that is allowed is largest: (I,) m2/s2.

    The largest x is concave in y and something is allowed at y = 0, so that y is found by bisection.
    """
    found = steps.turning.copy()
    open_ = np.flatnonzero(_beyond(steps, found))
    if len(open_):
        some = _Steps(*(column[..., open_] for column in steps))
        low, high = np.zeros(len(open_)), found[open_]
        for _ in range(_BISECTIONS):
            middle = 0.5 * (low + high)
            beyond = _beyond(some, middle)
            low, high = np.where(beyond, low, middle), np.where(beyond, middle, high)
        found[open_] = low
    return found


def _beyond(steps: _Steps, y: Array) -> Array:
    """Where nothing is allowed at ``y``, or the largest x falls there: (I,) of bool."""
    square = steps.room - steps.loss * y**2
    root = np.sqrt(np.maximum(square, 0.0))
    highest, lowest = steps.reach - steps.slope * y, -steps.reach - steps.slope * y
    joint = np.argmin(highest, axis=0)
    by_joints, by_tool = highest.min(axis=0), steps.share * y + root
    least = np.maximum(np.maximum(lowest.max(axis=0), steps.share * y - root), 0.0)
    by_joint_falls = np.take_along_axis(steps.slope, joint[None], axis=0)[0] > 0.0
    falls = np.where(by_joints < by_tool, by_joint_falls, steps.share * root < steps.loss * y)
    return (square < 0.0) | (np.minimum(by_joints, by_tool) < least) | falls
