"""A real Dask cluster on this machine for tests: a scheduler and workers in processes of their own."""

import json
import os
import signal
import subprocess
import sys
import time
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

ROOT = Path(__file__).parents[2]

SITE = """
import importlib.metadata, os, pathlib, signal, sys, threading, time

def end_with_the_tests():
    while os.read(0, 1):
        pass
    os.killpg(0, signal.SIGKILL)

def planning(task, real):  # in a process that plans
    if "hang" in task.name:
        time.sleep(1000)
    if "slow" in task.name:
        time.sleep(3)
    if "exit" in task.name:
        os._exit(7)
    return real(task)

def working(work, *, real, **others):  # in a Dask worker
    name = remote.unpack(work)[0].name
    if "kill" in name:
        os.kill(os.getpid(), signal.SIGKILL)
    if "sick" in name and not (once := pathlib.Path(os.environ["TEST_FOLDER"], name)).exists():
        if "once" in name:
            once.write_text("")
        return "its disk is full", b""
    return real(work, **others)

if "distributed.cli" in " ".join(sys.orig_argv):
    threading.Thread(target=end_with_the_tests, daemon=True).start()
if os.environ.get("TEST_LIES"):
    name, said = os.environ["TEST_LIES"].split("=")
    version = importlib.metadata.version
    importlib.metadata.version = lambda package: said if package == name else version(package)
if os.environ["TEST_ROLE"] == "scheduler":
    sys.modules["deltacam"] = None  # it needs none
elif "deltacam.batch.planning.worker" in sys.orig_argv:
    from deltacam.batch.planning import task
    task.perform = lambda given, real=task.perform: planning(given, real)
else:
    from deltacam.batch.cluster import remote
    remote.perform = lambda work, real=remote.perform, **others: working(work, real=real, **others)
"""
"""Runs in every process of the cluster: parts of some names do harm there."""


_LOCAL = ("--no-dashboard", "--dashboard-address", "127.0.0.1:0")


class Processes:
    """A scheduler and its workers; all of them end with the block.

    Args:
        folder: for their files.
        options: of all of them, for TLS.
    """

    def __init__(self, folder: Path, options: Sequence[str] = ()) -> None:
        self._folder, self._options = folder, options
        self._all: list[subprocess.Popen[bytes]] = []
        self.workers: list[subprocess.Popen[bytes]] = []
        (folder / "sitecustomize.py").write_text(SITE)
        self._file = folder / "scheduler.json"
        host = "tls://127.0.0.1" if options else "tcp://127.0.0.1"
        self.scheduler = self._start("scheduler", "--host", host, "--port", "0")

    def __enter__(self) -> "Processes":
        return self

    def __exit__(self, *_: object) -> None:
        for process in self._all:
            self.kill(process)

    @property
    def address(self) -> str:
        """Of the scheduler, once it is there."""
        for _ in range(600):
            with suppress(OSError, ValueError):
                return str(json.loads(self._file.read_text())["address"])
            assert self.scheduler.poll() is None, self.words
            time.sleep(0.1)
        raise AssertionError(self.words)

    @property
    def words(self) -> str:
        """What all of them wrote."""
        return (self._folder / "words").read_text()

    def add_worker(self, *options: str, lies: str = "") -> subprocess.Popen[bytes]:
        """Start a worker with one thread; ``lies``: a package and the version that it says."""
        address = self.address
        worker = self._start("worker", address, "--host", "127.0.0.1", "--nthreads", "1", *options, lies=lies)
        self.workers.append(worker)
        return worker

    def kill(self, process: subprocess.Popen[bytes]) -> None:
        """End a process and all that it started, at once."""
        with suppress(ProcessLookupError):
            os.killpg(process.pid, signal.SIGKILL)
        process.wait()
        assert process.stdin is not None
        process.stdin.close()
        self.workers = [worker for worker in self.workers if worker is not process]

    def _start(self, role: str, *options: str, lies: str = "") -> subprocess.Popen[bytes]:
        own = ["--scheduler-file", str(self._file)] if role == "scheduler" else ["--local-directory", str(self._folder)]
        paths = [str(self._folder), str(ROOT), str(ROOT / "cli")]
        added = {"TEST_ROLE": role, "TEST_LIES": lies, "TEST_FOLDER": str(self._folder)}
        with (self._folder / "words").open("ab") as words:
            process = subprocess.Popen(
                [sys.executable, "-m", f"distributed.cli.dask_{role}", *options, *own, *_LOCAL, *self._options],
                stdin=subprocess.PIPE,
                stdout=words,
                stderr=words,
                start_new_session=True,
                env={**os.environ, "PYTHONPATH": os.pathsep.join(paths), **added},
            )
        self._all.append(process)
        return process
