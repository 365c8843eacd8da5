"""The fastest motion along a route within a limit of the joints' jerk as well.

toppra knows no jerk. Its motion, with the speed held down where steady motion along the path would already need too
much jerk, is averaged over a moving window of time, which makes its acceleration continuous, and becomes the base of a
`Tempo`. The rate at which the base is run is then optimised; it is this step that finds the fastest motion, the base
only has to be near. Between the stations of that step a limit may be exceeded a little: where it is, the step is done
again with a lower limit there, and what is left at the end is taken away by stretching the time of the move.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
from scipy.ndimage import minimum_filter1d, uniform_filter1d

from deltacam.model import Array, IntArray
from deltacam.motion import knots, retime
from deltacam.motion.along import Along
from deltacam.motion.parametrize import solve
from deltacam.motion.route import Grid, Route
from deltacam.motion.rows import Rows
from deltacam.motion.tempo import Base, Tempo

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

_ROUNDS: Final = 2
_CHECKED: Final = np.linspace(0.0, 1.0, 18)
_INSIDE: Final = 0.9
_AROUND: Final = 6
_INSIDE_AGAIN: Final = 0.98
_ALLOWED: Final = 1.002
_CHECKED_LIMIT: Final = 0.9995  # of the limits, for what lies between the places that are checked
_ROUGH_GAP: Final = 1e-1
_ROUGH_ROUNDS: Final = 2  # the second is for the ends of short moves, which the first base does not show well
_GAP_AGAIN: Final = 1e-2
_BISECTIONS: Final = 40


class _Shares(NamedTuple):
    """The largest shares of the limits in every interval: of speed, acceleration and jerk, (I,) each."""

    speed: Array
    acceleration: Array
    jerk: Array


def limited(route: Route, grid: Grid, rows: Rows, robot: Robot, slowness: Array) -> Tempo:
    """The fastest motion along every move of a route from rest to rest, without a jump of acceleration.

    Args:
        route: whose curvature does not jump.
        grid: of the route.
        rows: the limits on its intervals.
        robot: with a limit of jerk.
        slowness: (I,) as `solve` takes it.

    Raises:
        UndrivableError: a move has none.
        RobotError: the path leaves the reach of the robot.
    """
    steady = _steady(route, grid, robot)
    law = solve(grid, replace(rows, bound=np.minimum(rows.bound, steady)), slowness)
    ramps = knots.ramps(law, rows, robot)
    base = knots.averaged(route, grid, law, steady[0], ramps)
    for _ in range(_ROUGH_ROUNDS):
        all_of_it = _Shares(*np.ones((3, len(base.width))))
        slower = slowness[_interval(grid, base)] ** 2
        rough = _fastest(route, robot, base, all_of_it, slower, gap=_ROUGH_GAP)
        base = knots.again(route, grid, rough, ramps, robot)
    return _refined(route, robot, base, slowness[_interval(grid, base)] ** 2)


def _refined(route: Route, robot: Robot, base: Base, slower: Array) -> Tempo:
    """The base at its fastest rate within the limits.

    It is done again with lower limits where it was found over them between the stations. Of what is tried for a move
    that counts which is fastest once its time is stretched to take away what is left.
    """
    lower = _Shares(*np.ones((3, len(base.width))))
    tempo: Tempo = _fastest(route, robot, base, lower, slower, gap=retime.GAP)
    found = _shares(route, robot, tempo, slower)
    best = tempo.stretched(_stretch(base, found))
    for _ in range(_ROUNDS):
        if max(share.max() for share in found) <= _ALLOWED:
            break
        over = _Shares(*(_spread(np.maximum(share, 1.0)) for share in found))
        lower = _Shares(*(low / share for low, share in zip(lower, over, strict=True)))
        tempo = _fastest(route, robot, base, lower, slower, near=_shrunk(tempo, over), gap=retime.GAP)
        found = _shares(route, robot, tempo, slower)
        best = _faster(best, tempo.stretched(_stretch(base, found)))
    return best


def _shrunk(tempo: Tempo, over: _Shares) -> Tempo:
    """The rate, every move so much slower that it is within limits that are lower by these shares (I,)."""
    base, largest = tempo.base, np.maximum(over.speed**2, np.maximum(over.acceleration, over.jerk))
    return tempo.stretched(np.sqrt(np.maximum.reduceat(largest, base.first[:-1]) / _INSIDE_AGAIN))


def _stretch(base: Base, found: _Shares) -> Array:
    """By how much the time of every move must be stretched to take away what it is over the limits, (K,), >= 1."""
    shares = (np.maximum.reduceat(share, base.first[:-1]) / _CHECKED_LIMIT for share in found)
    over = [share ** (1.0 / order) for order, share in enumerate(shares, start=1)]
    return np.asarray(np.maximum(1.0, np.maximum.reduce(over)))


def _faster(one: Tempo, other: Tempo) -> Tempo:
    """Of two rates of one base the one that takes less time, move by move."""
    chosen = np.repeat(other.durations < one.durations, np.diff(one.base.first) + 2)
    return Tempo.of(one.base, np.where(chosen, other.weights, one.weights))


def _steady(route: Route, grid: Grid, robot: Robot) -> Array:
    """The squared speed at which steady motion along the path has the joints' largest jerk, (1, I) m2/s2."""
    found = np.full(len(grid.segment), np.inf)
    for share in (0.0, 0.5, 1.0):
        at = route.path.evaluate(grid.segment, grid.start + share * (grid.end - grid.start))
        third = np.abs(robot.third_derivative(*at)) / np.asarray(robot.joints.max_jerk)
        found = np.minimum(found, np.maximum(third.max(axis=1), 1e-12) ** (-2.0 / 3.0))
    return found[None]


def _fastest(
    route: Route, robot: Robot, base: Base, lower: _Shares, slower: Array, *, near: Tempo | None = None, gap: float
) -> Tempo:
    """The base at its fastest rate within shares (I,) of the limits; ``near`` is a rate strictly within them."""
    u, stations = _stations(route, robot, base, lower, slower)
    rows = retime.Rows.at(base, u, stations)
    if near is not None:
        return Tempo.of(base, retime.fastest(base, rows, near.weights, gap=gap, first_gap=_GAP_AGAIN))
    start = retime.scaled(base, rows, _local(base, stations.steady().min(axis=0)), _INSIDE)
    return Tempo.of(base, retime.fastest(base, rows, start, gap=gap))


def _local(base: Base, rate: Array) -> Array:
    """Weights of a smooth X that is about the least ``rate`` (I,) of some intervals around."""
    low = np.log(minimum_filter1d(rate, 2 * _AROUND + 1, mode="nearest"))
    low = np.exp(uniform_filter1d(uniform_filter1d(low, _AROUND, mode="nearest"), _AROUND, mode="nearest"))
    ends = np.concatenate([base.first[:-1], base.first[1:]])
    return np.insert(low, ends, np.concatenate([low[base.first[:-1]], low[base.first[1:] - 1]]))


def _stations(route: Route, robot: Robot, base: Base, lower: _Shares, slower: Array) -> tuple[Array, retime.Stations]:
    """Stations u (S, I) of the base, and what is there, within shares (I,) of the limits.

    They are spread evenly, but where segments of the path meet in an interval, two are there, one for each segment.
    """
    shape = (retime.STATIONS, len(base.width))
    u = np.repeat(np.linspace(0.0, 1.0, shape[0])[:, None], shape[1], axis=1)
    met, place, before = _meetings(route, base)
    met, chosen = np.unique(met, return_index=True)  # knots are so near that there is hardly ever a second one
    place, before = place[chosen], before[chosen]
    u[1:3, met] = place
    motion = base.at(np.tile(np.arange(shape[1]), shape[0]), u.ravel())
    segment, inside = route.locate(np.tile(base.move, shape[0]), motion.distance)
    one, other = shape[1] + met, 2 * shape[1] + met
    segment[one], inside[one] = before, route.path.length[before]
    segment[other], inside[other] = before + 1, 0.0
    along = Along.at(route, robot, motion, segment, inside)
    first, second, third = (np.ascontiguousarray(one.T).reshape(3, *shape) for one in along.joints)
    speed = motion.speed.reshape(shape)
    limits = np.array([robot.joints.max_acceleration, robot.joints.max_jerk])[:, :, None, None]
    return u, retime.Stations(
        first,
        second,
        third,
        speed,
        motion.acceleration.reshape(shape),
        along.across.reshape(shape),
        highest=lower.speed**2 * slower * along.bound.reshape(shape) / np.maximum(speed**2, 1e-12),
        accelerations=lower.acceleration * slower * limits[0],
        acceleration=lower.acceleration * slower * along.cap.reshape(shape),
        jerks=lower.jerk * limits[1],
    )


def _meetings(route: Route, base: Base) -> tuple[IntArray, Array, IntArray]:
    """Where segments of one move meet: the interval, the place u there, and the segment before, (M,) each."""
    joints = np.cumsum(route.path.length)[:-1]
    inner = np.ones(len(joints), dtype=np.bool_)
    inner[route.first[1:-1] - 1] = False
    before = np.flatnonzero(inner)
    interval = np.searchsorted(base.distance, joints[before], side="right") - 1
    low, high = np.zeros(len(before)), np.ones(len(before))
    for _ in range(_BISECTIONS):
        middle = 0.5 * (low + high)
        late = base.at(interval, middle).distance > joints[before]
        low, high = np.where(late, low, middle), np.where(late, middle, high)
    return interval, high, before


def _shares(route: Route, robot: Robot, tempo: Tempo, slower: Array) -> _Shares:
    """The largest shares of the limits in every interval, between the stations and where segments meet."""
    count = len(tempo.base.width)
    met, place, before = _meetings(route, tempo.base)
    interval = np.concatenate([np.tile(np.arange(count), len(_CHECKED)), met, met])
    motion = tempo.motion(interval, np.concatenate([np.repeat(_CHECKED, count), place, place]))
    segment, inside = route.locate(tempo.base.move[interval], motion.distance)
    ends = len(segment) - 2 * len(met)
    segment[ends:] = np.concatenate([before, before + 1])
    inside[ends:] = np.concatenate([route.path.length[before], np.zeros(len(met))])
    along = Along.at(route, robot, motion, segment, inside)
    slower = slower[interval]
    speed = motion.speed / np.sqrt(slower * along.bound)
    joints = np.abs(along.joints[1]) / np.asarray(robot.joints.max_acceleration)
    tool = np.hypot(motion.acceleration, along.across) / along.cap
    jerk = np.abs(along.joints[2]) / np.asarray(robot.joints.max_jerk)
    found = np.zeros((3, count))
    for row, part in zip(found, (speed, np.maximum(joints.max(axis=1), tool) / slower, jerk.max(axis=1)), strict=True):
        np.maximum.at(row, interval, part)
    return _Shares(*found)


def _spread(values: Array) -> Array:
    """The largest of each value and its neighbours."""
    around = np.concatenate([values[:1], values, values[-1:]])
    return np.asarray(np.maximum(np.maximum(around[:-2], around[2:]), values))


def _interval(grid: Grid, base: Base) -> IntArray:
    """The intervals of the grid in which those of the base begin, (I,)."""
    return np.clip(np.searchsorted(grid.distance, base.distance, side="right") - 1, 0, len(grid.segment) - 1)
