"""The motion of a program at a few thousand stations that move with the part: what an estimate of its time needs.

Where the part lies changes where the tool is, which limits hold there, and the ways from and to the park position. The
path of the cuts, seen from the part, stays what it is.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from deltacam.model import Array, BoolArray, IntArray, Placement
from deltacam.motion.path import Path, join, straight
from deltacam.motion.route import Route
from deltacam.motion.schedule import Move

_SPACING: Final = 2.5e-3  # of intervals, m
_FEWEST: Final = 4
_MOST: Final = 32
_PER_RAMP: Final = 1  # the middle of the three clothoids of a blend has its largest curvature all along
_HERE: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Sampled:
    """Moves from rest to rest, divided into intervals; the ways from and to the park position are the last two.

    Attributes:
        route: all moves with the part unturned and its place at 0, 0; the two ways have no meaning yet.
        first: (K + 1,) the first interval of each move, and the number of intervals.
        segment: (I,) the segment of each interval.
        middle: (I,) where its middle is, as a share of the segment.
        width: (I,) how long it is, as a share of the segment.
        works: (I,) whether the laser is on there.
        ends: (2, 2) m, where the first way from the park position ends, and where the last one begins.
        park: (2,) m, the park position, in the machine frame.
        resting: s, the time at rest.
    """

    route: Route
    first: IntArray
    segment: IntArray
    middle: Array
    width: Array
    works: BoolArray
    ends: Array
    park: Array
    resting: float

    @classmethod
    def of(
        cls,
        moves: Sequence[tuple[Move, bool]],
        *,
        at: tuple[float, float],
        rotation: float,
        park: Array,
        resting: float,
    ) -> Sampled:
        """The motion of moves, each with whether it cuts, that were made for a place and a turn, m and rad."""
        paths = [(path, move.limits, works) for move, works in moves for path in move.paths]
        inner = [one for k, one in enumerate(paths) if one[2] or 0 < k < len(paths) - 1]
        x, y = -_turn(-rotation) @ np.array(at)
        back = Placement(float(x), float(y), rotation=-rotation, z=0.0)
        own = [(_moved(path, back), limits) for path, limits, _ in inner]
        ends = np.array([own[0][0].start[0], _end(own[-1][0])])
        way = straight(np.zeros(2), np.array([1.0, 0.0]), own[0][0].z)
        rapid = next((limits for _, limits, works in paths if not works), own[0][1])
        route = Route.of([*own, (way, rapid), (way, rapid)])
        segment, middle, width = _divided(route.path)
        first = np.searchsorted(segment, route.first)
        works = np.repeat([*(works for _, _, works in inner), False, False], np.diff(first))
        return cls(route, first, segment, middle, width, works, ends, park, resting)

    def placed(self, at: Array, rotation: float) -> Route:
        """The route with the part's place at ``at``, (2,) m, and turned by ``rotation`` rad."""
        path = _moved(self.route.path, Placement(float(at[0]), float(at[1]), rotation, z=0.0))
        begin, end = self.ends @ _turn(rotation).T + at
        way = [_straight(self.park, begin, path.z), _straight(end, self.park, path.z)]
        whole = join([path.part(0, len(path.length) - 2), *way])
        return Route(whole, self.route.first, self.route.speed, self.route.acceleration, self.route.chord)


def _straight(start: Array, end: Array, z: float) -> Path:
    """The straight path, also where it has almost no length."""
    if np.hypot(*(end - start)) > _HERE:
        return straight(start, end, z)
    return straight(start, start + np.array([_HERE, 0.0]), z)


def _moved(path: Path, by: Placement) -> Path:
    start = path.start @ _turn(by.rotation).T + (by.x, by.y)
    return replace(path, start=start, heading=path.heading + by.rotation)


def _end(path: Path) -> Array:
    last = np.array([len(path.length) - 1])
    return np.asarray(path.evaluate(last, path.length[last])[0][0, :2])


def _turn(rotation: float) -> Array:
    cos, sin = np.cos(rotation), np.sin(rotation)
    return np.array([[cos, -sin], [sin, cos]])


def _divided(path: Path) -> tuple[IntArray, Array, Array]:
    """The segment, the middle and the width of every interval; they are shorter near the ends of lines and arcs."""
    count = np.clip(np.ceil(path.length / _SPACING), _FEWEST, _MOST).astype(np.int64)
    count[path.sharpness != 0.0] = _PER_RAMP
    count[-2:] = _MOST
    segment = np.repeat(np.arange(len(count)), count)
    index = np.arange(len(segment)) - np.repeat(np.cumsum(count) - count, count)
    start, end = (0.5 * (1.0 - np.cos(np.pi * passed / count[segment])) for passed in (index, index + 1))
    return segment, 0.5 * (start + end), end - start
