"""Chunks on one and on several processes: the same setpoints, errors that name their move, nothing left behind."""

import multiprocessing
import subprocess
import sys
import time
from dataclasses import replace
from functools import partial
from multiprocessing.connection import Connection

import numpy as np
import pytest

from deltacam.errors import InfeasibleError, RobotError
from deltacam.geometry import curve as curves
from deltacam.motion import schedule as module
from deltacam.motion.corners import pieces
from deltacam.motion.parametrize import UndrivableError
from deltacam.motion.path import straight
from deltacam.motion.route import Limits, Route
from deltacam.motion.run import Run, run
from deltacam.motion.schedule import Move, schedule
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot
from tests.strategies import slot

DELTA = load_robot("delta-300")
FREE = replace(DELTA, joints=replace(DELTA.joints, max_jerk=None))
LIMITS = Limits(1.0, DELTA.tool.max_acceleration, 20e-6)


@pytest.fixture(autouse=True)
def small_chunks(monkeypatch: pytest.MonkeyPatch) -> None:
    """So that a few moves are several chunks."""
    monkeypatch.setattr(module, "CHUNK", 500)


def moves(robot: Robot = FREE, count: int = 12) -> list[Move]:
    found = []
    for number in range(count):
        curve = curves.transform(slot(0.02 + 1e-3 * number, 0.01), shift=(0.01 * number - 0.05, 0.02))
        ramps = robot.joints.max_jerk is not None
        parts = pieces(curve, corner="round", deviation=17e-6, ramps=ramps, z=robot.workspace.sheet_z)
        found += [Move(part, LIMITS, f"contour {number}") for part in parts]
    return found


def unreachable(robot: Robot = FREE) -> Move:
    return Move(straight(np.zeros(2), np.array([5.0, 0.0]), robot.workspace.sheet_z), LIMITS, "the far contour")


def nothing_is_left() -> bool:
    """Whether all processes end by themselves, at once or after the chunk at which they are."""
    for _ in range(2000):
        if not multiprocessing.active_children():
            return True
        time.sleep(0.01)
    return False


def same(one: list[Run], other: list[Run]) -> bool:
    return [(a.q.tobytes(), a.duration) for a in one] == [(b.q.tobytes(), b.duration) for b in other]


@pytest.mark.parametrize("robot", [FREE, DELTA], ids=["without jerk", "with jerk"])
def test_any_number_of_processes_gives_the_same_bytes(robot: Robot) -> None:
    planned = moves(robot)
    alone = schedule(planned, robot, jobs=1)
    assert len(alone) == len(planned)
    assert same(alone, schedule(planned, robot, jobs=2))
    assert nothing_is_left()


def test_a_move_is_run_as_it_is_by_itself() -> None:
    planned = moves(count=4)
    for move, found in zip(planned, schedule(planned, FREE, jobs=1), strict=True):
        (alone,) = run(Route.of([(move.path, move.limits)]), FREE)
        assert found.duration == pytest.approx(alone.duration, rel=1e-6)
        assert len(found.q) == len(alone.q)
        assert found.q == pytest.approx(alone.q, abs=1e-6)


def test_the_chunks_are_the_moves_in_their_order() -> None:
    planned = moves()
    chunks = list(module._chunks(planned))
    assert [move for chunk in chunks for move in chunk] == planned
    assert len(chunks) > 2
    assert list(module._chunks([])) == []
    assert schedule([], FREE) == []


@pytest.mark.parametrize("jobs", [1, 2])
def test_progress_is_told_after_every_chunk(jobs: int) -> None:
    told: list[int] = []
    planned = moves()
    schedule(planned, FREE, jobs=jobs, progress=told.append)
    sizes = [len(chunk) for chunk in module._chunks(planned)]
    assert told == np.cumsum(sizes).tolist()


def test_a_move_without_a_motion_is_named(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "run", partial(refuse, 0.0231))
    name_the_move(jobs=1)


def test_a_move_without_a_motion_is_named_by_another_process() -> None:
    # Only in a process without threads of other tests are the others forked, and know of the replaced function.
    code = (
        "from tests.motion.test_schedule import *; module.CHUNK = 500; module.run = partial(refuse, 0.0231)\n"
        "name_the_move(jobs=2); print('named')"
    )
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert found.stdout == "named\n", found.stderr


def name_the_move(jobs: int) -> None:
    with pytest.raises(InfeasibleError, match=r"no motion within the limits passes 1\.000 mm") as caught:
        schedule(moves(), FREE, jobs=jobs)
    assert caught.value.where == "contour 3"
    assert "report it" in caught.value.hint
    assert nothing_is_left()


def refuse(at: float, route: Route, robot: Robot, **options: bool) -> list[Run]:
    """Refuse the move whose first segment is of a certain length; run the others."""
    lengths = route.path.length[route.first[:-1]]
    for move, length in enumerate(lengths.tolist()):
        if abs(length - 0.023) < 1e-6:
            raise UndrivableError(move, 1e-3, at)
    return run(route, robot, **options)


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_move_out_of_reach_is_an_error_and_leaves_no_process_behind(jobs: int) -> None:
    with pytest.raises(RobotError):
        schedule([*moves(), unreachable(), *moves()], FREE, jobs=jobs)
    assert nothing_is_left()


@pytest.mark.parametrize("jobs", [1, 2])
@pytest.mark.parametrize("kind", [KeyboardInterrupt, RuntimeError, SystemExit])
def test_what_stops_the_waiting_process_leaves_no_process_behind(kind: type[BaseException], jobs: int) -> None:
    calls: list[int] = []

    def stop(done: int) -> None:
        calls.append(done)
        raise kind

    with pytest.raises(kind):
        schedule(moves(), FREE, jobs=jobs, progress=stop)
    assert len(calls) == 1
    assert nothing_is_left()


def test_processes_end_with_the_one_that_started_them() -> None:
    context = multiprocessing.get_context("fork")
    receive, send = context.Pipe(duplex=False)
    parent = context.Process(target=start_a_worker, args=(send,))
    parent.start()
    assert receive.poll(20.0)
    worker = receive.recv()
    send.close()
    parent.kill()
    parent.join(10.0)
    # The worker holds the other end of the pipe as long as it lives.
    assert receive.poll(10.0)
    with pytest.raises(EOFError):
        receive.recv()
    assert worker > 0


def start_a_worker(send: Connection) -> None:
    context = multiprocessing.get_context("fork")
    worker = context.Process(target=wait_for_ever, args=(send,))
    worker.start()
    worker.join()


def wait_for_ever(send: Connection) -> None:
    module._start_worker()
    send.send(multiprocessing.current_process().pid)
    multiprocessing.Event().wait()
