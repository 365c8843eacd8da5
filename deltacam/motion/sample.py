"""A setpoint at every tick, exactly on the path, and how far the controller leaves the path in between."""

from __future__ import annotations

import itertools
from typing import TYPE_CHECKING, Final

import numpy as np

from deltacam.model import Array, BoolArray, IntArray
from deltacam.motion.law import Law
from deltacam.motion.path import Path

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

_ROUNDING: Final = 1e-9


def tick_counts(law: Law, rate: float) -> IntArray:
    """How many ticks every move takes, (K,); each is stretched by less than one tick, so that it ends on one."""
    return np.maximum(1, np.ceil(law.durations * rate - _ROUNDING)).astype(np.int64)


def sample(path: Path, law: Law, robot: Robot) -> tuple[Array, ...]:
    """The joint setpoints of every move, (N, 3) rad each, without the one at which it ends.

    Stretching a move only lowers its speed, acceleration and jerk.
    """
    counts = tick_counts(law, robot.controller.rate_hz)
    first = np.cumsum(counts) - counts
    move = np.repeat(np.arange(len(counts)), counts)
    tick = np.arange(len(move)) - first[move]
    q = robot.inverse(_places(path, law, move, tick / counts[move])[0])
    return tuple(np.split(q, first[1:]))


def stretches(path: Path, law: Law, rate: float) -> tuple[IntArray, ...]:
    """The stretch of the cut in which every setpoint of every move lies, (N,) each, as `sample` returns them."""
    counts = tick_counts(law, rate)
    first = np.cumsum(counts) - counts
    move = np.repeat(np.arange(len(counts)), counts)
    tick = np.arange(len(move)) - first[move]
    segment, _ = path.locate(law.at(move, tick / counts[move] * law.durations[move]))
    return tuple(np.split(path.stretch[segment], first[1:]))


def chord_deviation(
    path: Path, law: Law, robot: Robot, setpoints: tuple[Array, ...], ends: Array, follows: BoolArray | None = None
) -> tuple[Array, Array]:
    """How far the controller leaves the path half-way between ticks.

    Args:
        path: of the moves.
        law: of the moves.
        robot: gives the interpolation.
        setpoints: of every move, as `sample` returns them.
        ends: (K, 3) rad, the setpoint at which each move ends.
        follows: (K,) whether a move begins without a rest after the one before; under cubic interpolation that matters;
            by default all do.

    Returns:
        the distance from the path, m, and the place on it, m from its start, for every tick of every move, (N,) each.
    """
    counts = np.array([len(q) for q in setpoints])
    move = np.repeat(np.arange(len(counts)), counts)
    tick = np.arange(len(move)) - np.repeat(np.cumsum(counts) - counts, counts)
    place = _places(path, law, move, (tick + 0.5) / counts[move])
    starts = np.flatnonzero(~follows) if follows is not None else np.zeros(0, dtype=np.int64)
    groups = itertools.pairwise(np.unique([0, *starts.tolist(), len(counts)]).tolist())
    q = [halfway(np.concatenate([*setpoints[a:b], ends[b - 1 : b]]), robot) for a, b in groups]
    position, tangent, distance = place
    tool = robot.forward(np.concatenate(q))
    # The point of the path beside the tool, and the part across the path of the way there.
    along = np.sum((tool - position) * tangent, axis=1)
    position, tangent, _, _ = path.evaluate(*path.locate(np.clip(distance + along, 0.0, path.total)))
    off = tool - position
    off -= np.sum(off * tangent, axis=1, keepdims=True) * tangent
    return np.asarray(np.linalg.norm(off, axis=1)), distance


def halfway(q: Array, robot: Robot) -> Array:
    """Where the joints are half-way between ticks, (N - 1, 3) rad, of setpoints ``q`` (N, 3) rad with rests around."""
    middle = 0.5 * (q[:-1] + q[1:])
    if robot.controller.interpolation == "linear":
        return middle
    held = np.concatenate([q[:1], q, q[-1:]])
    slope = 0.5 * (held[2:] - held[:-2])  # per tick
    return np.asarray(middle + (slope[:-1] - slope[1:]) / 8.0)


def _places(path: Path, law: Law, move: IntArray, share: Array) -> tuple[Array, Array, Array]:
    """Position, tangent and distance along the path after a share of the time of moves."""
    distance = law.at(move, share * law.durations[move])
    position, tangent, _, _ = path.evaluate(*path.locate(distance))
    return position, tangent, distance
