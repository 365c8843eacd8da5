"""Bases for a smooth motion: with knots close to each other where the acceleration changes, and far apart elsewhere."""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.model import Array, BoolArray, IntArray
from deltacam.motion.along import Along
from deltacam.motion.law import TimeLaw
from deltacam.motion.route import Grid, Route
from deltacam.motion.rows import Rows
from deltacam.motion.tempo import Base, Tempo

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

COARSEST: Final = 0.02
"""Largest distance of knots, s, where nothing happens."""

_FINEST: Final = 0.25e-3  # s
_GROWTH: Final = 0.15  # of the distance of knots per distance from a place where it must be small
_PER_RAMP: Final = 6.0  # knots while the acceleration is built up
_PER_ROUGH_RAMP: Final = 4.0
_PER_CLOTHOID: Final = 2.5
_WINDOW: Final = 5.0  # in distances of knots
_BUSY: Final = 0.3  # of the limit of jerk
_JUMP: Final = 0.2  # of the limit of acceleration
_FEWEST: Final = 16
_BETWEEN: Final = np.arange(4) / 4.0  # of every interval


def ramps(law: TimeLaw, rows: Rows, robot: Robot) -> Array:
    """How long every move takes to build up its largest acceleration, (K,) s.

    A short move never has the acceleration of the law: under a jerk j alone, a way L takes four times (L / 2j)^(1/3).
    """
    acceleration = np.abs(rows.joint_a[1] * law.acceleration[:, None] + rows.joint_b[1] * law.squared[:-1, None])
    taken = acceleration * np.asarray(robot.joints.max_acceleration) / np.asarray(robot.joints.max_jerk)
    whole = np.maximum.reduceat(taken.max(axis=1), law.rest[:-1])
    largest = np.maximum.reduceat(np.abs(law.acceleration), law.rest[:-1])
    return np.asarray(np.minimum(whole, np.cbrt(0.5 * np.diff(law.distance[law.rest]) * whole / largest)))


def averaged(route: Route, grid: Grid, law: TimeLaw, steady: Array, ramps: Array) -> Base:
    """The law, its speed averaged over a window of some knots.

    Args:
        route: the moves.
        grid: of the route.
        law: along it.
        steady: (I,) m2/s2, the squared speed at which steady motion needs all the jerk there is.
        ramps: (K,) s, as `ramps` gives them.
    """
    busy = np.abs(np.diff(law.acceleration, prepend=0.0)) > _JUMP * route.acceleration[grid.segment]
    busy |= (law.squared[:-1] / steady) ** 1.5 > _BUSY
    begin, durations = law.time[law.rest[:-1]], law.durations
    move = np.repeat(np.arange(len(ramps)), np.diff(law.rest))
    samples = _Samples(move, law.time[:-1] - begin[move], grid.segment, np.sqrt(law.squared[:-1]), busy)
    spacing = samples.spacing(route, ramps / _PER_ROUGH_RAMP)
    margin, behind = (0.5 * _WINDOW * spacing[ends] for ends in (law.rest[:-1], law.rest[1:] - 1))
    first, width = _knots(samples, spacing, durations, margin, behind)

    def speed(move: IntArray, place: Array) -> Array:
        at = place - margin[move]
        window = _WINDOW * np.interp(begin[move] + np.clip(at, 0.0, durations[move]), law.time[:-1], spacing)
        ends = (np.clip(at + side * window, 0.0, durations[move]) for side in (-0.5, 0.5))
        before, after = (law.at(move, end) for end in ends)
        return (after - before) / window

    distance = law.distance[law.rest]
    return Base.through(first, width, speed, distance[:-1], np.diff(distance))


def again(route: Route, grid: Grid, tempo: Tempo, ramps: Array, robot: Robot) -> Base:
    """The motion of a tempo as a base with knots where it needs them."""
    base, places = tempo.base, np.repeat(_BETWEEN, len(tempo.base.width))
    interval = np.tile(np.arange(len(base.width)), len(_BETWEEN))
    motion = tempo.motion(interval, places)
    along = Along.of(route, robot, motion, base.move[interval])
    jerk = (np.abs(along.joints[2]) / np.asarray(robot.joints.max_jerk)).max(axis=1)
    # When each gridpoint is passed, how fast, and with how much jerk.
    order = np.lexsort((places, interval))
    passed, speed, jerk = motion.distance[order], motion.speed[order], jerk[order]
    time = tempo.time_at(interval, places)[order]
    move = np.repeat(np.arange(len(ramps)), np.diff(grid.rest))
    at = grid.distance[:-1]
    since = np.interp(at, passed, time) - tempo.time[base.first[move]]
    samples = _Samples(
        move,
        np.clip(since, 0.0, tempo.durations[move]),
        grid.segment,
        np.interp(at, passed, speed),
        np.interp(at, passed, jerk) > _BUSY,
    )
    first, width = _knots(
        samples, samples.spacing(route, ramps / _PER_RAMP), tempo.durations, *np.zeros((2, len(ramps)))
    )
    start = base.distance[base.first[:-1]]
    length = np.diff(np.append(start, route.path.total))
    return Base.through(first, width, lambda move, at: tempo.motion(*tempo.locate(move, at)).speed, start, length)


class _Samples(NamedTuple):
    """Places along moves in their order, (N,) each.

    Attributes:
        move: of each.
        time: s since the move began.
        segment: of the path.
        speed: m/s.
        busy: whether the acceleration changes there.
    """

    move: IntArray
    time: Array
    segment: IntArray
    speed: Array
    busy: BoolArray

    def spacing(self, route: Route, least: Array) -> Array:
        """How far apart knots may be at each sample, (N,) s.

        That is ``least`` (K,) s where the acceleration changes, and less on short clothoids.
        """
        path, ends = route.path, np.flatnonzero(np.diff(self.move, prepend=-1, append=-1))
        busy = self.busy.copy()
        busy[ends[:-1]] = busy[ends[1:] - 1] = True
        wanted = np.where(busy, least[self.move], COARSEST)
        passing = path.length[self.segment] / np.maximum(self.speed, 1e-9) / _PER_CLOTHOID
        wanted = np.where(path.sharpness[self.segment] == 0.0, wanted, np.minimum(wanted, passing))
        wanted = np.clip(wanted, _FINEST, COARSEST)
        # Away from a place it grows evenly. Moves follow each other with a pause in which it is as large as it may be.
        time = self.time + self.move * COARSEST / _GROWTH
        time = time + np.concatenate([[0.0], np.cumsum(np.where(np.diff(self.move) > 0, self.time[:-1], 0.0))])
        after = np.minimum.accumulate(wanted - _GROWTH * time) + _GROWTH * time
        before = np.minimum.accumulate((wanted + _GROWTH * time)[::-1])[::-1] - _GROWTH * time
        return np.asarray(np.minimum(after, before))


def _knots(samples: _Samples, spacing: Array, durations: Array, margin: Array, behind: Array) -> tuple[IntArray, Array]:
    """The first interval of every move, and the widths of the intervals, s.

    The intervals cover the durations (K,) s and (K,) s as a ``margin`` before and others ``behind`` them.
    """
    firsts = np.flatnonzero(np.diff(samples.move, prepend=-1))
    ends = np.append(firsts[1:], len(samples.move))
    widths = []
    for move, (first, end) in enumerate(zip(firsts.tolist(), ends.tolist(), strict=True)):
        time = np.concatenate(
            [[-margin[move]], samples.time[first:end], [durations[move], durations[move] + behind[move]]]
        )
        apart = np.concatenate([[spacing[first]], spacing[first:end], [spacing[end - 1]] * 2])
        passed = np.concatenate([[0.0], np.cumsum(np.diff(time) * 0.5 * (1.0 / apart[1:] + 1.0 / apart[:-1]))])
        count = max(_FEWEST, int(np.ceil(passed[-1])))
        widths.append(np.diff(np.interp(np.linspace(0.0, passed[-1], count + 1), passed, time)))
    return np.concatenate([[0], np.cumsum([len(one) for one in widths])]), np.concatenate(widths)
