"""The setpoints of many moves: planned in chunks of bounded size, on several processes where that pays.

A chunk is planned as one route, so that what is done for every gridpoint is done for thousands at a time. Chunks are
the same for any number of processes, and so are the setpoints.
"""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
import warnings
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.machine import cores
from deltacam.model import Array, Corner, Curve, IntArray
from deltacam.motion.corners import Pace, pieces
from deltacam.motion.parametrize import UndrivableError, load_solver
from deltacam.motion.path import Path
from deltacam.motion.route import SPACING, Limits, Route
from deltacam.motion.run import Run, joined, run

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

CHUNK: Final = 20_000
"""About how many gridpoints are planned at a time; each takes about 3 kB."""

_PER_SEGMENT: Final = 10
_BLENDED: Final = 4  # segments of a path per segment of a curve
_PAYS: Final = 6  # chunks, for more than one process
_QUICK: Final = 2  # chunks, for times without each limit


class Drawn(NamedTuple):
    """A curve that is still to be made drivable, with what `corners.pieces` takes; ``z`` m is the height."""

    curve: Curve
    stretch: IntArray
    speed: Array
    corner: Corner
    deviation: float
    pace: Pace | None
    z: float

    def paths(self) -> tuple[Path, ...]:
        """The smooth paths along the curve, each to be run from rest to rest."""
        return pieces(
            self.curve,
            corner=self.corner,
            deviation=self.deviation,
            ramps=self.pace is not None,
            z=self.z,
            pace=self.pace,
            stretch=self.stretch,
            speed=self.speed,
        )


class Move(NamedTuple):
    """One path to be run from rest to rest, or a curve to be run in as few such parts as it takes.

    Attributes:
        path: or curve.
        limits: of the tool along it.
        where: names it in an error.
    """

    path: Path | Drawn
    limits: Limits
    where: str

    @property
    def paths(self) -> tuple[Path, ...]:
        """What is run from rest to rest."""
        return self.path.paths() if isinstance(self.path, Drawn) else (self.path,)

    @property
    def gridpoints(self) -> float:
        """About how many it has."""
        if isinstance(self.path, Drawn):
            length, segments = curves.length(self.path.curve), _BLENDED * len(self.path.curve.bulges)
        else:
            length, segments = self.path.total, len(self.path.length)
        return length / SPACING + _PER_SEGMENT * segments


def schedule(
    moves: Sequence[Move],
    robot: Robot,
    *,
    jobs: int | None = None,
    what_if: bool | None = None,
    progress: Callable[[int], None] = lambda _done: None,
) -> list[Run]:
    """How every move is run.

    Args:
        moves: at one height.
        robot: the machine.
        jobs: processes, >= 1; None takes as many as there are cores, where there is enough to do.
        what_if: whether to find out how long moves would take without each of the limits; None does where there are
            few gridpoints.
        progress: is told how many moves are done.

    Raises:
        InfeasibleError: a move has no time law within the limits.
        RobotError: a move leaves the reach.
    """
    chunks = list(_chunks(moves))
    processes = min(jobs or (cores() if len(chunks) >= _PAYS else 1), len(chunks))
    runs: list[Run] = []
    with _workers(processes) as run_all:
        for found in run_all(partial(_run_chunk, robot, _few(chunks) if what_if is None else what_if), chunks):
            runs += found
            progress(len(runs))
    return runs


def _chunks(moves: Sequence[Move]) -> Iterator[list[Move]]:
    """Consecutive moves that have about `CHUNK` gridpoints; at least one move each."""
    chunk: list[Move] = []
    points = 0.0
    for move in moves:
        chunk.append(move)
        points += move.gridpoints
        if points >= CHUNK:
            yield chunk
            chunk, points = [], 0.0
    if chunk:
        yield chunk


def _few(chunks: Sequence[Sequence[Move]]) -> bool:
    return len(chunks) <= _QUICK


def _run_chunk(robot: Robot, what_if: bool, moves: Sequence[Move]) -> list[Run]:
    paths = [move.paths for move in moves]
    parts = [(path, move.limits) for move, own in zip(moves, paths, strict=True) for path in own]
    ends = np.cumsum([len(own) for own in paths])
    try:
        runs = run(Route.of(parts), robot, what_if=what_if)
    except UndrivableError as problem:
        move = moves[int(np.searchsorted(ends, problem.move, side="right"))]
        raise InfeasibleError(problem.what, where=move.where, hint=problem.hint) from problem
    return [joined(runs[end - len(own) : end]) for end, own in zip(ends.tolist(), paths, strict=True)]


@contextmanager
def _workers(processes: int) -> Iterator[Callable[..., Iterator[list[Run]]]]:
    """A ``map`` that runs in this process, or in several."""
    if processes <= 1:
        yield map
        return
    load_solver()  # once, here, rather than in every process that is forked

    # A fork is ready at once, but only safe where no other thread holds a lock.
    forked = "fork" in multiprocessing.get_all_start_methods() and threading.active_count() == 1
    context = multiprocessing.get_context("fork" if forked else "spawn")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # of fork beside the idle threads of the linear algebra
        with ProcessPoolExecutor(processes, mp_context=context, initializer=_start_worker) as pool:
            try:
                yield pool.map
            except BaseException:
                pool.shutdown(cancel_futures=True)  # what is being planned is finished, which takes seconds at most
                raise


def _start_worker() -> None:
    """Leave an interrupt to the process that waits, and end with it."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_end_with, args=(parent,), daemon=True).start()


def _end_with(parent: multiprocessing.process.BaseProcess) -> None:
    parent.join()
    os._exit(1)
