"""A batch on a real Dask cluster: a scheduler that has no deltacam, and two workers that share no folder with us."""

import os
import signal
import subprocess
import sys
import textwrap
import threading
import time
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import distributed
import ezdxf
import numpy as np
import psutil
import pytest

from deltacam.batch.cluster import connection, elsewhere, remote
from deltacam.batch.parts import Batch, Limits, Part, Result, Row, Status, Task
from deltacam.batch.planning import local
from deltacam.batch.run import run
from deltacam.errors import DeltacamError
from tests.batch.daskprocesses import ROOT, Processes

LIMITS = Limits(time=30.0, memory=2 * 2**30)
LARGE = 11_000_000
"""Bytes of a task from which on Dask advises against."""


@pytest.fixture(scope="module")
def processes(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Processes]:
    with Processes(tmp_path_factory.mktemp("cluster")) as started:
        started.add_worker("--nworkers", "1")
        started.add_worker("--nworkers", "1")
        yield started


@pytest.fixture
def dask(processes: Processes) -> Iterator[distributed.Client]:
    """A connection of our own to the cluster, which has two workers."""
    while len(processes.workers) < 2:
        processes.add_worker("--nworkers", "1")
    with distributed.Client(processes.address, set_as_default=False) as client:
        until(lambda: len(client.nthreads()) == 2)
        yield client


@pytest.fixture(scope="module")
def parts(tmp_path_factory: pytest.TempPathFactory) -> list[Part]:
    """Six discs and a large file that is no drawing."""
    folder = tmp_path_factory.mktemp("parts")
    (folder / "large.dxf").write_bytes(np.random.default_rng(1).bytes(LARGE))
    return [*discs(folder, *(f"{number}/disc.dxf" for number in range(6))), part(folder, "large.dxf")]


@pytest.fixture(scope="module")
def at_home(parts: list[Part], tmp_path_factory: pytest.TempPathFactory) -> dict[str, bytes]:
    """What comes of the parts on this machine."""
    output = tmp_path_factory.mktemp("home")
    run(parts, output, planner=partial(local.results, jobs=2, limits=LIMITS))
    return tree(output)


def until(there: Callable[[], bool]) -> None:
    for _ in range(450):  # less than it takes for processes without work to end by themselves
        if there():
            return
        time.sleep(0.1)
    raise AssertionError("it never was so")


def part(folder: Path, name: str) -> Part:
    return Part(name, folder / name, {"what_if": False})


def discs(folder: Path, *names: str) -> list[Part]:
    """Drawings of a circle, each of another size; where it is slow, with a hole, so that it is the first one to go."""
    for number, name in enumerate(names):
        document = ezdxf.new(units=4)
        for radius in (2.0 + 0.25 * number, *([1.0] if "slow" in name else [])):
            document.modelspace().add_circle((0.0, 0.0), radius)
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        document.saveas(folder / name)
    return [part(folder, name) for name in names]


def tree(folder: Path) -> dict[str, bytes]:
    """Every file of a folder of results but the lock."""
    files = (path for path in folder.rglob("*") if path.is_file() and path.name != "lock")
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def plan(
    processes: Processes,
    parts: Sequence[Part],
    output: Path,
    *,
    limits: Limits = LIMITS,
    tell: Callable[[Row], None] = lambda _row: None,
    say: Callable[[str], None] = lambda _words: None,
    **options: Any,
) -> Batch:
    """A batch on the cluster."""
    with connection.connect(processes.address, tell=say, **options) as found:
        return run(parts, output, planner=partial(elsewhere.results, cluster=found, limits=limits), tell=tell)


def outcomes(batch: Batch) -> dict[str, Status]:
    return {row.part: row.outcome.status for row in batch.rows}


def workers_of(dask: distributed.Client) -> set[int]:
    return set(dask.run(os.getpid).values())


def planning(dask: distributed.Client) -> list[psutil.Process]:
    """The processes that the workers of the cluster plan with."""
    children = (child for pid in workers_of(dask) for child in psutil.Process(pid).children())
    return [child for child in children if "deltacam.batch.planning.worker" in child.cmdline()]


def scheduled(dask: distributed.Client) -> int:
    """How many tasks the scheduler knows."""
    return int(dask.run_on_scheduler(lambda dask_scheduler: len(dask_scheduler.tasks)))


def test_a_batch_has_the_same_bytes_as_on_this_machine_and_leaves_nothing_behind(
    processes: Processes, dask: distributed.Client, parts: list[Part], at_home: dict[str, bytes], tmp_path: Path
) -> None:
    known: list[int] = []
    batch = plan(processes, parts, tmp_path, tell=lambda _row: known.append(scheduled(dask)))
    assert tree(tmp_path) == at_home
    assert Counter(outcomes(batch).values()) == {Status.PASSED: 6, Status.REFUSED: 1}
    assert max(known) <= 4  # two for every thread
    assert scheduled(dask) == 0
    until(lambda: planning(dask) == [])


def test_a_worker_that_is_killed_in_the_middle_loses_and_doubles_nothing(
    processes: Processes, dask: distributed.Client, parts: list[Part], at_home: dict[str, bytes], tmp_path: Path
) -> None:
    told: list[str] = []
    victim = processes.workers[-1]

    def tell(row: Row) -> None:
        told.append(row.part)
        if len(told) == 2:
            processes.kill(victim)

    batch = plan(processes, parts, tmp_path, tell=tell)
    assert victim not in processes.workers
    assert sorted(told) == sorted(part.name for part in parts)
    assert len(batch.rows) == len(parts)
    assert len((tmp_path / ".deltacam-batch" / "record.jsonl").read_text().splitlines()) == len(parts)
    assert tree(tmp_path) == at_home


def test_a_part_that_hangs_or_ends_its_process_does_not_touch_the_worker(
    processes: Processes, dask: distributed.Client, tmp_path: Path
) -> None:
    before = workers_of(dask)
    batch = plan(processes, discs(tmp_path, "exit.dxf", "fine.dxf", "hang.dxf"), tmp_path, limits=Limits(time=6.0))
    found = outcomes(batch)
    assert found == {"exit.dxf": Status.CRASHED, "fine.dxf": Status.PASSED, "hang.dxf": Status.TIMEOUT}
    assert "exit code 7" in batch.rows[0].outcome.what
    assert workers_of(dask) == before


def test_a_part_that_kills_every_worker_is_to_blame_and_no_other(
    processes: Processes, dask: distributed.Client, tmp_path: Path
) -> None:
    dask.run_on_scheduler(lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 0))
    names = ("fine/1.dxf", "fine/2.dxf", "kill.dxf", "fine/3.dxf")
    batch = plan(processes, discs(tmp_path, *names), tmp_path)
    dask.run_on_scheduler(lambda dask_scheduler: setattr(dask_scheduler, "allowed_failures", 3))
    assert outcomes(batch) == {name: Status.CRASHED if name == "kill.dxf" else Status.PASSED for name in names}
    assert "Dask worker" in batch.rows[-1].outcome.what


def test_a_worker_that_cannot_plan_is_left_out_and_its_parts_are_planned_elsewhere(
    processes: Processes, dask: distributed.Client, tmp_path: Path
) -> None:
    said: list[str] = []
    batch = plan(processes, discs(tmp_path, "1.dxf", "sick-once.dxf", "2.dxf"), tmp_path, say=said.append)
    assert batch.passed
    assert [words.partition(" is not used")[2] for words in said] == [": its disk is full"]


def test_a_batch_ends_where_no_worker_can_plan(processes: Processes, dask: distributed.Client, tmp_path: Path) -> None:
    with pytest.raises(DeltacamError, match=r"no worker of .* can plan: tcp://.*: its disk is full; tcp://") as refused:
        plan(processes, discs(tmp_path, "sick.dxf"), tmp_path)
    assert all(worker in refused.value.what for worker in dask.nthreads())


def test_a_worker_with_another_version_is_not_used_where_it_joins_and_refused_at_the_start(
    processes: Processes, dask: distributed.Client, parts: list[Part], at_home: dict[str, bytes], tmp_path: Path
) -> None:
    said: list[str] = []
    begun: list[Row] = []
    stranger = None

    def tell(row: Row) -> None:
        nonlocal stranger
        begun.append(row)
        if stranger is None:
            stranger = processes.add_worker("--no-nanny", lies="numpy=1.0.0")
            until(lambda: len(dask.nthreads()) == 3)

    plan(processes, parts, tmp_path, tell=tell, say=said.append)
    assert tree(tmp_path) == at_home
    with pytest.raises(DeltacamError) as refused:
        plan(processes, parts, tmp_path)
    assert stranger is not None
    processes.kill(stranger)
    until(lambda: len(dask.nthreads()) == 2)
    (words,) = said
    assert ": numpy 1.0.0 (here " in words
    worker = words.removeprefix("the worker ").partition(" is not used")[0]
    assert f"{worker}: numpy 1.0.0 (here " in refused.value.what
    assert refused.value.what.count("tcp://") == 2  # the scheduler's address, and that of the only one who differs
    assert "pip install numpy==" in refused.value.hint


def test_a_stop_finishes_what_is_planned_and_leaves_the_rest(
    processes: Processes, dask: distributed.Client, tmp_path: Path
) -> None:
    stop = threading.Event()
    parts = discs(tmp_path, "slow.dxf", *(f"{number}.dxf" for number in range(7)))
    with connection.connect(processes.address) as found:
        planner = partial(elsewhere.results, cluster=found, limits=LIMITS)
        batch = run(parts, tmp_path, planner=planner, stop=stop, tell=lambda _row: stop.set())
    found_statuses = outcomes(batch)
    assert found_statuses["slow.dxf"] is Status.PASSED
    assert set(found_statuses.values()) == {Status.PASSED, Status.LEFT}
    assert scheduled(dask) == 0
    until(lambda: planning(dask) == [])


def test_an_interrupt_ends_everything_on_the_cluster_and_says_nothing(
    processes: Processes, dask: distributed.Client, tmp_path: Path
) -> None:
    discs(tmp_path, "hang1.dxf", "hang2.dxf", "hang3.dxf")
    script = textwrap.dedent(f"""
        import sys
        from functools import partial
        from pathlib import Path
        from deltacam.batch.cluster import connection
        from deltacam.batch.cluster import elsewhere
        from deltacam.batch.parts import Limits, Part
        from deltacam.batch.run import run
        parts = [Part(path.name, path, {{}}) for path in Path({str(tmp_path)!r}).glob("*.dxf")]
        try:
            with connection.connect({processes.address!r}) as found:
                planner = partial(elsewhere.results, cluster=found, limits=Limits(time=120.0))
                run(parts, Path({str(tmp_path)!r}), planner=planner)
        except KeyboardInterrupt:
            sys.exit(130)
    """)
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join([str(ROOT), str(ROOT / "cli")])}
    client = subprocess.Popen([sys.executable, "-W", "error", "-c", script], stderr=subprocess.PIPE, env=environment)
    try:
        until(lambda: len(planning(dask)) == 2)
        client.send_signal(signal.SIGINT)
        _, words = client.communicate(timeout=60)
    finally:
        client.kill()
    assert (client.returncode, words.decode()) == (130, "")
    assert scheduled(dask) == 0
    until(lambda: planning(dask) == [])


def test_no_more_tasks_are_taken_than_the_cluster_has_room_for(
    processes: Processes, dask: distributed.Client, parts: list[Part]
) -> None:
    taken = 0

    def tasks() -> Iterator[Task]:
        nonlocal taken
        for number in range(20):
            taken += 1
            yield Task(f"{number}.dxf", b"no drawing", {}, str(number), "plotly.min.js")

    with connection.connect(processes.address) as found:
        stop = threading.Event()
        found_results = elsewhere.results(tasks(), cluster=found, limits=LIMITS, stop=stop)
        done: list[tuple[Task, Result]] = []
        for one in found_results:
            done.append(one)
            assert taken <= len(done) + 4
    assert sorted(int(task.name.removesuffix(".dxf")) for task, _ in done) == list(range(20))


def test_a_worker_plans_nothing_for_who_has_other_versions() -> None:
    ours = {"numpy": "1.0.0", "deltacam": "0.0.1"}
    unfit, data = remote.perform(b"not even looked at", run="1", ours=ours, threads=1, memory=None)
    assert "deltacam " in unfit
    assert "(here 1.0.0)" in unfit
    assert data == b""
