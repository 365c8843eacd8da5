"""What a part can do to the process that plans it, and that it does nothing to any other."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator
from functools import partial
from pathlib import Path
from typing import Final

import pytest

from deltacam.batch.parts import Batch, Limits, Outcome, Part, Status, Task
from deltacam.batch.planning import local
from deltacam.batch.planning.key import key_of
from deltacam.batch.planning.process import WorkerProcess
from deltacam.batch.run import run
from deltacam.errors import DeltacamError
from tests.batch.scene import OPTIONS, children, damage, ended, parts_of, plate, with_faults

LIMITS: Final = Limits(time=10.0, memory=500 * 2**20)
PASSED: Final = ("a", "print", "z")


@pytest.fixture(scope="module", autouse=True)
def _faults() -> Iterator[None]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", with_faults())
        yield


@pytest.fixture(scope="module")
def batch(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Batch]:
    """A batch of parts that hang, crash and eat memory among others that do not; and its folder."""
    folder = tmp_path_factory.mktemp("faults")
    for name in (*PASSED, "abort", "break", "close", "eat", "exit", "hang", "words"):
        plate(folder / "parts" / f"{name}.dxf")
    # Alone to split it into lines takes more than there is.
    comment = "999\nnothing that is cut\n" * 3_000_000
    (folder / "parts" / "large.dxf").write_text(f"{comment}0\nSECTION\n2\nENTITIES\n0\nENDSEC\n0\nEOF\n")
    planner = partial(local.results, jobs=2, limits=LIMITS)
    return folder, run(parts_of(folder / "parts"), folder / "out", planner=planner)


@pytest.fixture
def process() -> Iterator[WorkerProcess]:
    process = WorkerProcess(LIMITS)
    yield process
    process.close()


@pytest.fixture
def task(tmp_path: Path) -> Callable[[str], Task]:
    """A small part of a name."""
    part = Part("a.dxf", plate(tmp_path / "a.dxf"), OPTIONS)
    data = part.path.read_bytes()
    return lambda name: Task(name, data, part.options, key_of(part, data), "plotly.min.js")


def outcomes(batch: Batch) -> dict[str, Outcome]:
    return {row.part.removesuffix(".dxf"): row.outcome for row in batch.rows}


def test_what_a_part_does_to_its_process_is_its_row_and_no_other(batch: tuple[Path, Batch]) -> None:
    found = {name: (outcome.status, outcome.what) for name, outcome in outcomes(batch[1]).items()}
    assert found == {
        **dict.fromkeys(PASSED, (Status.PASSED, "")),
        **dict.fromkeys(("abort", "eat", "large"), (Status.MEMORY, "the memory that a part may take is not enough")),
        "break": (Status.CRASHED, "its process was ended by SIGSEGV"),
        "close": (Status.CRASHED, "its process ended with exit code 1: OSError: [Errno 9] Bad file descriptor"),
        "exit": (Status.CRASHED, "its process ended with exit code 3"),
        "hang": (Status.TIMEOUT, "not planned within 10 s"),
        "words": (Status.CRASHED, "its process ended with exit code 4: \\x1b[31mthe \ufffd last word"),
    }
    assert {outcome.robot for outcome in outcomes(batch[1]).values()} == {OPTIONS["robot"].name}


def test_only_the_parts_that_passed_have_files_and_all_are_whole(batch: tuple[Path, Batch]) -> None:
    out = batch[0] / "out"
    assert sorted(path.name.split(".")[0] for path in out.glob("*.report.json")) == [*PASSED]
    assert sorted(path.name.split(".")[0] for path in out.glob("*.program.csv")) == [*PASSED]
    assert damage(out) == []


def test_without_the_fault_the_next_run_plans_what_is_missing(batch: tuple[Path, Batch]) -> None:
    folder = batch[0]
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", with_faults(False))
        planner = partial(local.results, jobs=1, limits=LIMITS)
        parts = [part for part in parts_of(folder / "parts") if part.name in ("a.dxf", "eat.dxf", "exit.dxf")]
        second = run(parts, folder / "out", planner=planner)
    assert second.passed
    assert [row.part for row in second.rows if not row.again] == ["eat.dxf", "exit.dxf"]


def _task(part: Part) -> Task:
    return Task(part.name, part.path.read_bytes(), part.options, "key", "plotly.min.js")


def test_a_process_that_ended_between_two_parts_is_no_fault_of_the_next(
    process: WorkerProcess, task: Callable[[str], Task]
) -> None:
    assert process.perform(task("a.dxf")).outcome.status is Status.PASSED
    (pid,) = children(os.getpid())
    os.kill(pid, signal.SIGKILL)
    os.waitid(os.P_PID, pid, os.WEXITED | os.WNOWAIT)
    assert process.perform(task("print.dxf")).outcome.status is Status.PASSED
    # Nor is a part blamed with the words of the one before.
    assert process.perform(task("exit.dxf")).outcome.what == "its process ended with exit code 3"


@pytest.mark.parametrize("after", [0.0, 3.0], ids=["while it starts", "while it plans"])
def test_closing_ends_a_process_at_once(after: float, task: Callable[[str], Task]) -> None:
    process = WorkerProcess(Limits())
    errors: list[DeltacamError] = []

    def perform() -> None:
        try:
            process.perform(task("hang.dxf"))
        except DeltacamError as problem:
            errors.append(problem)

    thread = threading.Thread(target=perform)
    thread.start()
    until = time.monotonic() + 30.0
    while not children(os.getpid()) and time.monotonic() < until:
        time.sleep(0.01)
    time.sleep(after)
    process.close()
    thread.join(30.0)
    assert not thread.is_alive()
    assert [problem.what for problem in errors] == ["the batch is over"]
    assert children(os.getpid()) == []
    with pytest.raises(DeltacamError, match="the batch is over"):
        process.perform(task("a.dxf"))


def test_a_process_that_cannot_start_says_why(task: Callable[[str], Task], tmp_path: Path) -> None:
    (tmp_path / "sitecustomize.py").write_text("import os, sys\nos.write(2, b'no licence\\n')\nos._exit(1)\n")
    process = WorkerProcess(Limits())
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("PYTHONPATH", f"{tmp_path}{os.pathsep}{os.environ['PYTHONPATH']}")
        with pytest.raises(DeltacamError, match="cannot be started: no licence"):
            process.perform(task("a.dxf"))
    assert process.perform(task("a.dxf")).outcome.status is Status.PASSED
    process.close()


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere one that holds Python's lock outlives its parent")
def test_processes_end_with_their_parent_whatever_they_do(tmp_path: Path) -> None:
    for name in ("hang.dxf", "busy.dxf"):
        plate(tmp_path / "parts" / name)
    with subprocess.Popen([sys.executable, "-c", PARENT, tmp_path / "parts"], stdout=subprocess.PIPE) as parent:
        assert parent.stdout is not None
        assert [parent.stdout.readline() for _ in range(2)] == [b"ready\n"] * 2
        time.sleep(1.0)  # they plan by now
        pids = children(parent.pid)
        parent.kill()
    assert len(pids) == 2
    assert ended(pids)


PARENT: Final = """
import sys, threading
from pathlib import Path
from deltacam.batch.parts import Limits
from deltacam.batch.planning.process import WorkerProcess
from tests.batch.scene import parts_of
from tests.batch.test_process import _task

def perform(part):
    process = WorkerProcess(Limits())
    process._ready()
    print("ready", flush=True)
    process.perform(_task(part))

for part in parts_of(Path(sys.argv[1])):
    threading.Thread(target=perform, args=(part,)).start()
"""
