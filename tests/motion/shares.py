"""The shares of every limit that a motion uses, by derivatives at places of its intervals and by differences at ticks.

Nothing here is of the planner but the path: a motion is given by its places, speeds, accelerations and jerks.
"""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from deltacam.model import Array, IntArray
from deltacam.motion.law import Law, TimeLaw
from deltacam.motion.route import Route
from deltacam.motion.tempo import Tempo
from deltacam.robot.robot import Robot


class Shares(NamedTuple):
    """The largest share of every limit; 1 is the limit, that of jerk is 0 where there is none."""

    feed: float
    tool: float
    speed: float
    acceleration: float
    jerk: float


def of_law(route: Route, law: TimeLaw, robot: Robot, parts: Sequence[float]) -> Shares:
    """At ``parts`` of every interval between gridpoints; 0 and 1 are the ends, seen from inside."""
    width = np.diff(law.distance)
    segment, _ = route.path.locate(law.distance[:-1] + 0.5 * width)
    u = np.diff(law.squared) / (2.0 * width)
    found = []
    for part in parts:
        speed = np.sqrt((1.0 - part) * law.squared[:-1] + part * law.squared[1:])
        place = law.distance[:-1] + part * width - starts(route)[segment]
        place = np.clip(place, 0.0, route.path.length[segment])
        found.append(_shares(route, robot, segment, place, (speed, u, np.zeros_like(u))))
    return Shares(*np.max(found, axis=0).tolist())


def of_tempo(route: Route, tempo: Tempo, robot: Robot, parts: Sequence[float]) -> Shares:
    """At ``parts`` of every interval between knots; 0 and 1 are the ends."""
    interval = np.arange(len(tempo.base.width))
    found = []
    for part in parts:
        distance, *motion = tempo.motion(interval, np.full(len(interval), part))
        found.append(_shares(route, robot, *located(route, tempo.base.move, distance), motion))
    return Shares(*np.max(found, axis=0).tolist())


def starts(route: Route) -> Array:
    """Where every segment starts, (M,) m from the start of the route."""
    return np.asarray(np.cumsum(route.path.length) - route.path.length)


def located(route: Route, move: IntArray, distance: Array) -> tuple[IntArray, Array]:
    """The segments of the given moves (N,) that hold the distances (N,) m, and how far into them these lie.

    Moves need not begin where the one before ends, so that the end of a move is not the start of the next one.
    """
    segment, _ = route.path.locate(distance)
    segment = np.clip(segment, route.first[move], route.first[move + 1] - 1)
    return segment, np.clip(distance - starts(route)[segment], 0.0, route.path.length[segment])


def _shares(route: Route, robot: Robot, segment: IntArray, place: Array, motion: Sequence[Array]) -> list[float]:
    p, dp, ddp, dddp = route.path.evaluate(segment, place)
    _, dq, ddq = robot.path_derivatives(p, dp, ddp)
    v, a, j = (one[:, None] for one in motion)
    joints = robot.joints
    found = [
        v[:, 0] / route.speed[segment],
        np.linalg.norm(dp * a + ddp * v**2, axis=1) / route.acceleration[segment],
        np.abs(dq * v) / joints.max_speed,
        np.abs(dq * a + ddq * v**2) / joints.max_acceleration,
    ]
    if joints.max_jerk is not None:
        third = robot.third_derivative(p, dp, ddp, dddp)
        found.append(np.abs(dq * j + 3.0 * ddq * v * a + third * v**3) / joints.max_jerk)
    return [float(one.max()) for one in found] + [0.0] * (5 - len(found))


def at_ticks(route: Route, law: Law, robot: Robot, *, phase: float = 0.0) -> Shares:
    """By differences of the joints and of the tool at ticks, of each move by itself, its ends held.

    The first tick is at ``phase`` of a tick after the start of every move.
    """
    rate = robot.controller.rate_hz
    # Three ticks at rest before and after every move hold its ends.
    counts = np.ceil(law.durations * rate).astype(np.int64) + 7
    move = np.repeat(np.arange(len(counts)), counts)
    tick = np.arange(len(move)) - np.repeat(np.cumsum(counts) - counts, counts)
    since = np.clip((tick - 3 + phase) / rate, 0.0, law.durations[move])
    segment, place = located(route, move, law.at(move, since))
    tool, *_ = route.path.evaluate(segment, place)
    q = robot.inverse(tool)
    joints = robot.joints
    limits = (joints.max_speed, joints.max_acceleration, joints.max_jerk or (np.inf,) * 3)
    found = []
    for order, limit in enumerate(limits, start=1):
        within = move[order:] == move[:-order]  # no differences from one move to the next
        found.append(float((np.abs(np.diff(q, order, axis=0))[within] * rate**order / limit).max()))
    feed = np.linalg.norm(np.diff(tool, axis=0), axis=1) * rate / route.speed[segment[1:]]
    acceleration = np.linalg.norm(np.diff(tool, 2, axis=0), axis=1) * rate**2 / route.acceleration[segment[1:-1]]
    one, two = move[1:] == move[:-1], move[2:] == move[:-2]
    return Shares(float(feed[one].max()), float(acceleration[two].max()), *found)
