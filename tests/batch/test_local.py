"""Parts planned by processes of this machine: the same bytes for any number, and a clean end whatever happens."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Generator, Iterator
from functools import partial
from pathlib import Path
from typing import Final

import pytest

from deltacam.batch.parts import Limits, Part, Result, Row, Task
from deltacam.batch.planning import local
from deltacam.batch.run import run
from deltacam.errors import DeltacamError
from tests.batch.killing import batch as started
from tests.batch.scene import bow_tie, children, damage, ended, parts_of, plan_here, plate, tree, with_faults

LIMITS: Final = Limits(time=120.0)


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Small drawings of different sizes, one in a subfolder and one that is refused."""
    folder = tmp_path_factory.mktemp("parts")
    for number in range(4):
        plate(folder / ("sub" if number == 1 else "") / f"plate{number}.dxf", holes=number)
    bow_tie(folder / "bow.dxf")
    return folder


@pytest.fixture(scope="module")
def undisturbed(parts: Path, tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What a batch of them gives that is planned one by one, in the order of the names."""
    out = tmp_path_factory.mktemp("undisturbed")
    run(parts_of(parts), out, planner=plan_here)
    return tree(out)


@pytest.mark.parametrize("jobs", [1, 2, 3])
def test_the_bytes_are_the_same_for_any_number_of_processes(
    parts: Path, undisturbed: dict[str, bytes], tmp_path: Path, jobs: int
) -> None:
    run(parts_of(parts), tmp_path, planner=partial(local.results, jobs=jobs, limits=LIMITS))
    assert tree(tmp_path) == undisturbed
    assert children(os.getpid()) == []


@pytest.mark.parametrize("seed", range(3))
def test_the_bytes_are_the_same_for_any_order(
    parts: Path, undisturbed: dict[str, bytes], tmp_path: Path, seed: int
) -> None:
    chance = random.Random(seed)  # noqa: S311 - no secret

    def planner(tasks: Iterator[Task], *, stop: threading.Event) -> Generator[tuple[Task, Result]]:
        shuffled = list(tasks)
        chance.shuffle(shuffled)
        yield from plan_here(iter(shuffled), stop=stop)

    shuffled = parts_of(parts)
    chance.shuffle(shuffled)
    run(shuffled, tmp_path, planner=planner)
    assert tree(tmp_path) == undisturbed


class Watched:
    """Tasks that count how many were taken."""

    def __init__(self, part: Part, number: int) -> None:
        self.taken = 0
        data = part.path.read_bytes()
        self._left = [Task(f"{n}.dxf", data, part.options, str(n), "") for n in range(number)]

    def __iter__(self) -> Iterator[Task]:
        return self

    def __next__(self) -> Task:
        if not self._left:
            raise StopIteration
        self.taken += 1
        return self._left.pop(0)


def test_few_tasks_are_taken_ahead_and_no_process_is_started_without_a_task(parts: Path) -> None:
    tasks = Watched(parts_of(parts)[1], 4)
    stop = threading.Event()
    found: list[str] = []
    for task, _ in local.results(tasks, jobs=1, limits=LIMITS, stop=stop):
        found.append(task.name)
        assert tasks.taken <= len(found) + 2
    assert sorted(found) == [f"{n}.dxf" for n in range(4)]
    results = local.results(Watched(parts_of(parts)[1], 1), jobs=3, limits=LIMITS, stop=stop)
    next(results)
    assert len(children(os.getpid())) == 1
    results.close()
    assert children(os.getpid()) == []
    assert list(local.results(iter(()), jobs=2, limits=LIMITS, stop=stop)) == []


def test_after_a_stop_what_is_begun_is_finished_and_nothing_else_is(parts: Path) -> None:
    tasks = Watched(parts_of(parts)[1], 4)
    stop = threading.Event()
    results = local.results(tasks, jobs=1, limits=LIMITS, stop=stop)
    first, _ = next(results)
    time.sleep(0.05)  # the next is begun by now
    stop.set()
    rest = [task.name for task, _ in results]
    assert first.name == "0.dxf"
    assert rest in ([], ["1.dxf"], ["1.dxf", "2.dxf"])
    assert children(os.getpid()) == []


def test_where_no_process_can_be_started_that_is_said_and_nothing_is_left(
    parts: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "sitecustomize.py").write_text("import os\nos.write(2, b'no licence\\n')\nos._exit(1)\n")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    told: list[Row] = []
    planner = partial(local.results, jobs=2, limits=LIMITS)
    with pytest.raises(DeltacamError, match="no licence"):
        run(parts_of(parts), tmp_path / "out", planner=planner, tell=told.append)
    assert told == []
    assert damage(tmp_path / "out") == []
    assert children(os.getpid()) == []


@pytest.fixture
def hanging(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A folder of drawings of which one hangs."""
    monkeypatch.setenv("PYTHONPATH", with_faults())
    plate(tmp_path / "parts" / "a.dxf")
    plate(tmp_path / "parts" / "hang.dxf", holes=3)
    return tmp_path


def _planning(process: subprocess.Popen[bytes]) -> list[int]:
    """The processes that a batch plans with, once they have been there for a while."""
    until = time.monotonic() + 60.0
    while len(pids := children(process.pid)) < 2 and process.poll() is None and time.monotonic() < until:
        time.sleep(0.02)
    time.sleep(2.0)
    return pids


def test_the_second_interrupt_ends_at_once_and_leaves_no_process(hanging: Path) -> None:
    process = started(hanging / "parts", hanging / "out")
    pids = _planning(process)
    process.send_signal(signal.SIGINT)
    time.sleep(0.5)
    assert process.poll() is None  # what is planned would be finished
    for _ in range(3):  # nor does a third one leave anything
        process.send_signal(signal.SIGINT)
    assert process.wait(30.0) == 130
    assert len(pids) == 2
    assert ended(pids, within=0.5)
    assert damage(hanging / "out") == []


@pytest.mark.skipif(sys.platform == "win32", reason="a signal of Unix")
def test_the_end_of_a_terminal_ends_the_batch_and_its_processes(hanging: Path) -> None:
    process = started(hanging / "parts", hanging / "out")
    pids = _planning(process)
    process.send_signal(signal.SIGHUP)
    process.wait(30.0)
    assert len(pids) == 2
    assert ended(pids)
    assert damage(hanging / "out") == []
