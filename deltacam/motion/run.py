"""How a route is run: its time law, the setpoint at every tick, and what the user wants to know of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.model import Array, Held, IntArray
from deltacam.motion import explain
from deltacam.motion.jerk import limited
from deltacam.motion.law import Law, TimeLaw
from deltacam.motion.parametrize import solve
from deltacam.motion.route import Grid, Route
from deltacam.motion.rows import Rows
from deltacam.motion.sample import chord_deviation, sample, stretches
from deltacam.motion.tempo import Tempo

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

_ROUNDS: Final = 10
_STRICTER: Final = 0.985
_SLOWEST: Final = 0.2  # in one round
_SHORTER: Final = 0.9995


class Run(NamedTuple):
    """How one move is run.

    Attributes:
        q: (N, 3) rad, the setpoint at every tick but that at which it ends.
        stretch: (N,) of the cut in which the setpoint lies, as `Path.stretch` numbers them.
        duration: s, before it is stretched to end on a tick.
        held: for how long each of `explain.NAMES` binds, s.
        without: how long the move would take without each of `explain.KINDS`, s; empty where nobody asked.
    """

    q: Array
    stretch: IntArray
    duration: float
    held: Array
    without: Array


def joined(runs: Sequence[Run]) -> Run:
    """The runs of moves that follow each other as one."""
    q, stretch, durations, held, without = zip(*runs, strict=True)
    rows = np.concatenate(q), np.concatenate(stretch)
    return Run(*rows, sum(durations), np.sum(held, axis=0), np.sum(without, axis=0))


def run(route: Route, robot: Robot, *, what_if: bool = False) -> list[Run]:
    """The fastest motion along every move of a route from rest to rest.

    Args:
        route: the moves.
        robot: the machine.
        what_if: whether to find out how long the moves would take without each of the limits.

    Raises:
        UndrivableError: a move has none.
        RobotError: the path leaves the reach of the robot.
    """
    grid = Grid.over(route, robot)
    rows = Rows.over(route, grid, robot)
    slowness = np.ones(len(rows.width))
    quick = robot.joints.max_jerk is None
    law: TimeLaw | Tempo
    for _ in range(_ROUNDS):
        law = solve(grid, rows, slowness) if quick else limited(route, grid, rows, robot, slowness)
        setpoints = sample(route.path, law, robot)
        slower = _slower(route, grid, law, robot, setpoints)
        if (slower == 1.0).all():
            break
        slowness *= slower
    held, kinds = explain.held(route, grid, rows, robot, law)
    without = np.zeros((len(held), 0))
    if what_if:
        without = explain.without(route, grid, rows, robot, law.durations, kinds)
    stretch = stretches(route.path, law, robot.controller.rate_hz)
    return [Run(*one) for one in zip(setpoints, stretch, law.durations.tolist(), held, without, strict=True)]


def _slower(route: Route, grid: Grid, law: Law, robot: Robot, setpoints: tuple[Array, ...]) -> Array:
    """By which factor the motion in every interval must be slower to stay within the chord tolerance, (I,)."""
    factor = np.ones(len(grid.segment))
    if not np.isfinite(route.chord).any():
        return factor
    ends = grid.rest[1:] - 1
    last, _, _, _ = route.path.evaluate(grid.segment[ends], grid.end[ends])
    works = np.isfinite(route.chord[route.first[:-1]])
    follows = np.append(False, works[1:] & works[:-1])
    off, place = chord_deviation(route.path, law, robot, setpoints, robot.inverse(last), follows)
    interval = np.clip(np.searchsorted(grid.distance, place, side="right") - 1, 0, len(factor) - 1)
    allowed = route.chord[grid.segment[interval]]
    over = np.flatnonzero(off > allowed)
    # The lag of a tick comes from the way that the tool makes in it: all intervals of that way are slowed down.
    before = np.searchsorted(grid.distance, place[np.maximum(over - 1, 0)], side="right") - 1
    after = np.searchsorted(grid.distance, place[np.minimum(over + 1, len(place) - 1)], side="left")
    for tick, first, end in zip(over.tolist(), before.tolist(), after.tolist(), strict=True):
        needed = max(np.sqrt(allowed[tick] / off[tick]) * _STRICTER, _SLOWEST)
        factor[first:end] = np.minimum(factor[first:end], needed)
    return factor


def held_along(contour: int, runs: Sequence[Run]) -> Held:
    """What holds back the motion along a contour, its runs taken together."""
    time = sum(run.duration for run in runs)
    bound = zip(explain.NAMES, np.sum([run.held for run in runs], axis=0).tolist(), strict=True)
    without = zip(explain.KINDS, np.sum([run.without for run in runs], axis=0).tolist(), strict=False)
    return Held(
        contour,
        time,
        {name: value for name, value in bound if value > 0.0},
        {name: value for name, value in without if value < _SHORTER * time},
    )
