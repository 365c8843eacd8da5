"""About how long a program takes at many places, and how exactly the tool is held there.

The time is that of the fastest motion along the sampled path: a pass from the end of every move and one from its start,
with the limits as they are in the middle of each interval. All moves and many places take their steps at once.

A limit of jerk is allowed for afterwards. It holds the speed v below (J / |q'''|)^(1/3), and rounds every corner of the
speed over time. Where the acceleration jumps up by du, the motion cannot be faster than before the jump, and so it
loses the time du / 2j (1 - v / V), with j the jerk along the path and V the largest speed of the move; du is at most
what builds up and down again within the change of speed, sqrt(j (V - v)).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.model import Array, IntArray
from deltacam.motion.rows import limits_at
from deltacam.placing.sampled import Sampled
from deltacam.robot import measures

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

_BATCH: Final = 500_000  # values of one kind that are held at a time
_TINY: Final = 1e-12


class Estimate(NamedTuple):
    """What is estimated at places, (P,) each.

    Attributes:
        time: s.
        worst: m/rad, the largest error of the tool in the sheet's plane by the error of the joints, over the cuts.
        rms: m/rad, its root mean square over the length of the cuts.
    """

    time: Array
    worst: Array
    rms: Array


def estimate(sampled: Sampled, robot: Robot, at: Array, rotation: Array) -> Estimate:
    """The estimate for places ``at`` (P, 2) m and turns (P,) rad.

    Raises:
        RobotError: a place is out of reach.
    """
    size = max(1, _BATCH // len(sampled.segment))
    parts = [
        _estimate(sampled, robot, at[start : start + size], rotation[start : start + size])
        for start in range(0, len(at), size)
    ]
    return Estimate(*(np.concatenate(column) for column in zip(*parts, strict=True)))


def _estimate(sampled: Sampled, robot: Robot, at: Array, rotation: Array) -> Estimate:
    motions = [_Motion.at(sampled, robot, place, turn) for place, turn in zip(at, rotation, strict=True)]
    both = _Motion(*(np.stack(one, axis=1) for one in zip(*motions, strict=True)))
    squared = _profile(sampled, both)
    time = sampled.resting + _time(sampled, both, squared)
    length = both.width * sampled.works[:, None]
    rms = np.sqrt((length * both.error**2).sum(axis=0) / length.sum(axis=0))
    return Estimate(time, np.where(sampled.works[:, None], both.error, 0.0).max(axis=0), rms)


class _Motion(NamedTuple):
    """What limits the motion in every interval, (I, ...) each; for several places, (I, P, ...).

    Attributes:
        width: (I,) m.
        room: (I, 3) m/s2, the acceleration along the path from rest that each joint allows.
        cost: (I, 3) 1/m, how much of it the squared speed takes, of a positive acceleration.
        tool: (I,) m/s2.
        bend: (I,) 1/m.
        bound: (I,) m2/s2, the largest squared speed.
        jerk: (I,) m/s3, along the path; infinite without a limit.
        error: (I,) m/rad, of the tool by that of the joints.
    """

    width: Array
    room: Array
    cost: Array
    tool: Array
    bend: Array
    bound: Array
    jerk: Array
    error: Array

    @classmethod
    def at(cls, sampled: Sampled, robot: Robot, place: Array, rotation: float) -> _Motion:
        route = sampled.placed(place, rotation)
        distance = sampled.middle * route.path.length[sampled.segment]
        first, second, bend, bound = limits_at(route, robot, sampled.segment, distance)
        acceleration = np.asarray(robot.joints.max_acceleration)
        steep = np.maximum(np.abs(first), _TINY)
        tool = route.acceleration[sampled.segment]
        steady = np.min(acceleration / np.maximum(np.abs(second), _TINY), axis=1)
        bound = np.minimum(bound, np.minimum(steady, tool / np.maximum(bend, _TINY)))
        jerk = np.full(len(bend), np.inf)
        points = route.path.evaluate(sampled.segment, distance)
        if robot.joints.max_jerk is not None:
            third = np.maximum(np.abs(robot.third_derivative(*points)), _TINY)
            limit = np.asarray(robot.joints.max_jerk)
            bound = np.minimum(bound, np.min(limit / third, axis=1) ** (2.0 / 3.0))
            jerk = np.min(limit / steep, axis=1)
        error = measures.tool_error_per_joint_error_in_plane(robot.geometry, points[0])
        width = sampled.width * route.path.length[sampled.segment]
        return cls(width, acceleration / steep, second * np.sign(first) / steep, tool, bend, bound, jerk, error)


def _profile(sampled: Sampled, motion: _Motion) -> Array:
    """The squared speed at every gridpoint, (I + K, P) m2/s2: those of a move follow each other."""
    first, moves = sampled.first[:-1], np.arange(len(sampled.first) - 1)
    counts = np.diff(sampled.first)
    behind = np.arange(len(sampled.segment)) + np.repeat(moves, counts)  # the gridpoint at which an interval begins
    squared = np.full((behind[-1] + 2, motion.bound.shape[1]), np.inf)
    np.minimum.at(squared, behind, motion.bound)
    np.minimum.at(squared, behind + 1, motion.bound)
    squared[first + moves] = squared[first + moves + counts] = 0.0
    for interval in _steps(sampled.first, backwards=True):
        _reach(squared, behind[interval] + 1, behind[interval], motion, interval, -1.0)
    for interval in _steps(sampled.first, backwards=False):
        _reach(squared, behind[interval], behind[interval] + 1, motion, interval, 1.0)
    return squared


def _steps(first: IntArray, *, backwards: bool) -> list[IntArray]:
    """The intervals that are taken at once: the first of every move, the second, and so on, or from the end."""
    counts = np.diff(first)
    steps = []
    for k in range(int(counts.max())):
        move = np.flatnonzero(counts > k)
        steps.append(first[move + 1] - 1 - k if backwards else first[move] + k)
    return steps


def _reach(squared: Array, start: IntArray, end: IntArray, motion: _Motion, interval: IntArray, sign: float) -> None:
    """Lower the squared speed at the ``end`` of intervals to what can be reached from that at their ``start``."""
    x = squared[start]
    joints = np.min(motion.room[interval] - sign * motion.cost[interval] * x[:, :, None], axis=2)
    tool = np.sqrt(np.maximum(motion.tool[interval] ** 2 - (motion.bend[interval] * x) ** 2, 0.0))
    gained = 2.0 * motion.width[interval] * np.maximum(np.minimum(joints, tool), 0.0)
    squared[end] = np.minimum(squared[end], x + gained)


def _time(sampled: Sampled, motion: _Motion, squared: Array) -> Array:
    """The time of all moves, (P,) s."""
    counts = np.diff(sampled.first)
    moves = np.repeat(np.arange(len(counts)), counts)
    behind = np.arange(len(moves)) + moves
    speed = np.sqrt(squared)
    taken = 2.0 * motion.width / np.maximum(speed[behind] + speed[behind + 1], _TINY)
    pushed = (squared[behind + 1] - squared[behind]) / (2.0 * motion.width)
    before = np.where((moves == np.roll(moves, 1))[:, None], np.roll(pushed, 1, axis=0), 0.0)
    last = sampled.first[1:] - 1
    fastest = np.maximum.reduceat(speed, sampled.first[:-1] + np.arange(len(counts)), axis=0)[moves]
    slower = np.maximum(fastest - speed[behind], 0.0)
    rise = np.minimum(np.maximum(pushed - before, 0.0), _most(slower, motion.jerk))
    lost = rise / (2.0 * motion.jerk) * slower / np.maximum(fastest, _TINY)
    stop = np.minimum(np.maximum(-pushed[last], 0.0), _most(fastest[last], motion.jerk[last])) / (
        2.0 * motion.jerk[last]
    )
    return np.asarray((taken + lost).sum(axis=0) + stop.sum(axis=0))


def _most(change: Array, jerk: Array) -> Array:
    """The largest acceleration on the way through a ``change`` of the speed, m/s2; infinite without a limit of jerk."""
    return np.sqrt(np.where(np.isfinite(jerk), np.where(np.isfinite(jerk), jerk, 1.0) * change, np.inf))
