"""Which limit holds a motion back, for how long, and how long it would take without each."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.model import Array, IntArray
from deltacam.motion.along import Along
from deltacam.motion.law import TimeLaw
from deltacam.motion.parametrize import solve
from deltacam.motion.route import Grid, Route
from deltacam.motion.rows import STATIONS, Rows
from deltacam.motion.tempo import Tempo

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

NAMES: Final = (
    "feed",
    "chord tolerance",
    *(f"joint {joint} speed" for joint in (1, 2, 3)),
    "tool acceleration",
    *(f"joint {joint} acceleration" for joint in (1, 2, 3)),
    *(f"joint {joint} jerk" for joint in (1, 2, 3)),
    "corners",
    "none",
)
"""What may hold a motion back; *corners* is all but the feed on the curves that smooth corners and the ends of arcs."""

KINDS: Final = (
    "feed",
    "chord tolerance",
    "joint speed",
    "tool acceleration",
    "joint acceleration",
    "joint jerk",
    "corners",
)
"""What `without` leaves out in turn."""

_KIND_OF: Final = {
    f"joint {joint} {what}": f"joint {what}" for joint in "123" for what in ("speed", "acceleration", "jerk")
}
_BINDS: Final = 0.97
_INSIDE: Final = (0.25, 0.75)  # of every interval
_UNBOUND: Final = 1e6


class _Places(NamedTuple):
    """Places along the moves, (N,) each or more.

    Attributes:
        move: of each.
        taken: the time that it stands for, s.
        segment: of the path.
        feed: speed of the tool over the largest.
        total: the same for the least of all bounds of the speed.
        joints: (N, 9) the speeds, accelerations and jerks of the joints, over the largest.
        tool: acceleration of the tool over the largest.
    """

    move: IntArray
    taken: Array
    segment: IntArray
    feed: Array
    total: Array
    joints: Array
    tool: Array


def held(route: Route, grid: Grid, rows: Rows, robot: Robot, law: TimeLaw | Tempo) -> tuple[Array, frozenset[str]]:
    """What holds back every move, and for how long.

    Returns:
        for how long each of `NAMES` is at 97 % of its limit or more, and nearest to it, in every move, (K, names) s;
        and the `KINDS` that are so anywhere, also on curves that smooth corners.
    """
    at = _of_tempo(route, robot, law) if isinstance(law, Tempo) else _of_law(route, grid, rows, robot, law)
    speed, rest = at.joints[:, :3], at.joints[:, 3:]
    chord = np.where(at.total > np.maximum(at.feed, speed.max(axis=1)) * (1.0 + 1e-9), at.total, 0.0)
    shares = np.column_stack([at.feed, chord, speed, at.tool, rest])
    name = np.where(shares.max(axis=1) >= _BINDS, shares.argmax(axis=1), NAMES.index("none"))
    found = {_KIND_OF.get(NAMES[index], NAMES[index]) for index in np.unique(name)}
    smoothing = (route.path.sharpness[at.segment] != 0.0) & (at.feed < _BINDS)
    name[smoothing] = NAMES.index("corners")
    kinds = frozenset(found | ({"corners"} if smoothing.any() else set()))
    times = np.zeros((len(law.durations), len(NAMES)))
    np.add.at(times, (at.move, name), at.taken)
    return times, kinds


def _of_law(route: Route, grid: Grid, rows: Rows, robot: Robot, law: TimeLaw) -> _Places:
    """The middles of the intervals of the grid, from what is known there."""
    squared, along = 0.5 * (law.squared[:-1] + law.squared[1:]), law.acceleration
    middle = len(STATIONS) // 2
    largest = np.asarray(robot.joints.max_acceleration) / np.asarray(robot.joints.max_speed)
    speed = np.abs(rows.joint_a[middle]) * largest * np.sqrt(squared)[:, None]
    joints = np.abs(rows.joint_a[middle] * along[:, None] + rows.joint_b[middle] * squared[:, None])
    return _Places(
        np.repeat(np.arange(len(law.rest) - 1), np.diff(law.rest)),
        np.diff(law.time),
        grid.segment,
        np.sqrt(squared) / route.speed[grid.segment],
        np.sqrt(squared / rows.bound[middle]),
        np.hstack([speed, joints, np.zeros_like(joints)]),
        np.hypot(rows.along * along, rows.across[middle] * squared),
    )


def _of_tempo(route: Route, robot: Robot, tempo: Tempo) -> _Places:
    """Some places in every interval of the base."""
    count = len(tempo.base.width)
    interval = np.tile(np.arange(count), len(_INSIDE))
    motion = tempo.motion(interval, np.repeat(_INSIDE, count))
    segment, place = route.locate(tempo.base.move[interval], motion.distance)
    along = Along.at(route, robot, motion, segment, place)
    limits = (robot.joints.max_speed, robot.joints.max_acceleration, robot.joints.max_jerk or (np.inf,) * 3)
    joints = [np.abs(one) / limit for one, limit in zip(along.joints, limits, strict=True)]
    return _Places(
        tempo.base.move[interval],
        np.diff(tempo.time)[interval] / len(_INSIDE),
        segment,
        motion.speed / route.speed[segment],
        motion.speed / np.sqrt(along.bound),
        np.hstack(joints),
        np.hypot(motion.acceleration, along.across) / along.cap,
    )


def without(route: Route, grid: Grid, rows: Rows, robot: Robot, times: Array, kinds: frozenset[str]) -> Array:
    """About how long every move would take without each of `KINDS`: (K, kinds) s.

    What a limit costs is found by solving again without it, all limits of jerk left out; it is then taken from the time
    that the move really takes, ``times`` (K,) s. Limits other than ``kinds`` never bind, so that they cost nothing.
    """
    quick = solve(grid, rows).durations
    found = []
    for kind in KINDS:
        if kind == "joint jerk":
            found.append(quick)
        elif kind in kinds:
            found.append(times - quick + solve(grid, _lifted(rows, route, grid, robot, kind)).durations)
        else:
            found.append(times)
    return np.minimum(np.stack(found, axis=1), times[:, None])


def _lifted(rows: Rows, route: Route, grid: Grid, robot: Robot, kind: str) -> Rows:
    """The rows without one kind of limit."""
    if kind == "tool acceleration":
        return replace(rows, along=rows.along / _UNBOUND, across=rows.across / _UNBOUND)
    if kind == "joint acceleration":
        return replace(rows, joint_a=rows.joint_a / _UNBOUND, joint_b=rows.joint_b / _UNBOUND)
    if kind == "corners":
        smooth = np.where(route.path.sharpness[grid.segment] == 0.0, 1.0, 1.0 / _UNBOUND)
        return replace(
            rows,
            joint_a=rows.joint_a * smooth[:, None],
            joint_b=rows.joint_b * smooth[:, None],
            along=rows.along * smooth,
            across=rows.across * smooth,
        )
    return replace(rows, bound=_bound(rows, route, grid, robot, kind))


def _bound(rows: Rows, route: Route, grid: Grid, robot: Robot, kind: str) -> Array:
    """The largest squared speed without the limit of the feed, the joints' speed or the chord, (S, I) m2/s2."""
    dq = np.abs(rows.joint_a) * np.asarray(robot.joints.max_acceleration)
    joints = np.min(np.asarray(robot.joints.max_speed) / np.maximum(dq, 1e-12), axis=2) ** 2
    feed = np.broadcast_to(route.speed[grid.segment] ** 2, joints.shape)
    tool = np.full_like(joints, robot.tool.max_speed**2)
    chord = np.where(rows.bound < np.minimum(joints, feed) * (1.0 - 1e-9), rows.bound, np.inf)
    if kind == "feed":
        return np.asarray(np.minimum(np.minimum(joints, np.maximum(tool, feed)), chord))
    if kind == "joint speed":
        return np.asarray(np.minimum(feed, chord))
    return np.asarray(np.minimum(joints, feed)) if kind == "chord tolerance" else rows.bound
