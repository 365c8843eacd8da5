"""Moves that follow each other from rest to rest, with what bounds the tool along them, and the grid for their time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from deltacam.model import Array, IntArray
from deltacam.motion.path import Path, join

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

SPACING: Final = 4e-4
"""Longest interval between gridpoints, m."""

STEP: Final = 0.038
"""Largest turn of an arc between gridpoints, rad: the best speed on an arc changes with the angle."""

FINEST: Final = 0.1
"""The interval at an end of a segment, as part of the way in which the tool can stop there."""

GROWTH: Final = 0.4
"""How much wider intervals are per distance from the end of their segment, up to ``SPACING``."""

LONGEST: Final = 20.0
"""How many of its longest intervals a line or arc could hold: the speed turns from rising to falling within one."""

INTERVALS: Final = 6
"""Fewest intervals per line or arc."""

RAMP_INTERVALS: Final = 20
"""Fewest intervals per clothoid."""


@dataclass(frozen=True, slots=True)
class Limits:
    """What bounds the motion along one path, beyond the joints' own limits.

    Attributes:
        speed: of the tool, m/s.
        acceleration: of the tool, m/s2.
        chord: how far the motion may leave the path between ticks, m; infinite where that does not matter.
    """

    speed: float
    acceleration: float
    chord: float = np.inf


@dataclass(frozen=True, slots=True, eq=False)
class Route:
    """Moves one after the other, each from rest to rest.

    Attributes:
        path: of all moves.
        first: (K + 1,) the first segment of every move, and the number of segments.
        speed: (M,) m/s, the largest speed of the tool in every segment.
        acceleration: (M,) m/s2, likewise.
        chord: (M,) m, how far the motion may leave the path between ticks; infinite where that does not matter.
    """

    path: Path
    first: IntArray
    speed: Array
    acceleration: Array
    chord: Array

    @classmethod
    def of(cls, moves: Sequence[tuple[Path, Limits]]) -> Route:
        """The given paths, at one height, each a move within its limits."""
        counts = np.array([len(path.length) for path, _ in moves])
        columns = np.array([(one.speed, one.acceleration, one.chord) for _, one in moves])
        path, (speed, acceleration, chord) = join([path for path, _ in moves]), np.repeat(columns, counts, axis=0).T
        first = np.concatenate([[0], np.cumsum(counts)])
        return cls(path, first, np.minimum(speed, path.speed), acceleration, chord)

    def locate(self, move: IntArray, distance: Array) -> tuple[IntArray, Array]:
        """The segments of moves (N,) that hold places, and how far into them these lie.

        Args:
            move: (N,) of each place: the end of one move and the start of the next are at the same distance.
            distance: (N,) m from the start of the route.
        """
        ends = np.cumsum(self.path.length)
        segment = np.searchsorted(ends, distance, side="right")
        segment = np.clip(segment, self.first[move], self.first[move + 1] - 1)
        inside = distance - (ends[segment] - self.path.length[segment])
        return segment, np.clip(inside, 0.0, self.path.length[segment])


def _braking(route: Route, robot: Robot) -> Array:
    """About the way in which the tool can stop from the speed that it may have near every segment, (M,) m, doubled.

    That is v^2 / a where the feed v bounds the speed, and the radius where a bend does.
    """
    path = route.path
    _, dq, _ = robot.path_derivatives(*path.evaluate(np.arange(len(path.length)), np.zeros(len(path.length)))[:3])
    by_joints = np.min(np.asarray(robot.joints.max_acceleration) / np.maximum(np.abs(dq), 1e-12), axis=1)
    around = np.concatenate([[0.0], path.sharpest, [0.0]])
    bend = np.maximum(np.maximum(around[:-2], around[2:]), path.sharpest)
    by_feed = route.speed**2 / np.minimum(route.acceleration, by_joints)
    return np.asarray(np.minimum(by_feed, 1.0 / np.maximum(bend, 1e-9)))


@dataclass(frozen=True, slots=True, eq=False)
class Grid:
    """The intervals of a route: every joint of its path is a gridpoint.

    Attributes:
        segment: (I,) the segment of each interval.
        start: (I,) m from the start of the segment.
        end: (I,) m from the start of the segment.
        distance: (I + 1,) m from the start of the route.
        rest: (K + 1,) the gridpoints at which the moves begin, and the last one.
    """

    segment: IntArray
    start: Array
    end: Array
    distance: Array
    rest: IntArray

    @classmethod
    def over(cls, route: Route, robot: Robot) -> Grid:
        """Intervals that are fine where the speed may change fast: near the ends of segments, and on tight arcs.

        At d from the nearer end of a segment they are about h(d) = min(widest, finest + d GROWTH) wide, so that the
        integral of 1 / h counts them; its inverse gives the gridpoints.
        """
        path = route.path
        widest = np.minimum(SPACING, STEP / np.maximum(path.sharpest, 1e-9))
        widest = np.where(path.sharpness == 0.0, np.minimum(widest, path.length / LONGEST), widest)
        finest = np.minimum(widest, FINEST * _braking(route, robot))
        half = 0.5 * path.length
        graded = (widest - finest) / GROWTH
        needed = 2.0 * np.where(
            half <= graded,
            np.log1p(GROWTH * half / finest) / GROWTH,
            np.log(widest / finest) / GROWTH + (half - graded) / widest,
        )
        fewest = np.where(path.sharpness == 0.0, INTERVALS, RAMP_INTERVALS)
        count = np.maximum(fewest, np.ceil(needed - 1e-9)).astype(np.int64)
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
        rest = np.concatenate([[0], np.cumsum(count)])[route.first]
        return cls(segment, start, end, np.append(offset[segment] + start, offset[-1]), rest)
