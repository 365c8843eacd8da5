"""Parts planned on this machine, by as many processes as are asked for."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import Final

from deltacam.batch.parts import Limits, Result, Task
from deltacam.batch.process import WorkerProcess

_AHEAD: Final = 2
"""Tasks for every process: one that it plans, and one that waits while the result of another is stored."""


def results(
    tasks: Iterator[Task], *, jobs: int, limits: Limits, stop: threading.Event
) -> Iterator[tuple[Task, Result]]:
    """What becomes of every task, as soon as it is known; memory holds a few tasks at a time.

    Args:
        tasks: taken as processes get free.
        jobs: how many processes plan, >= 1.
        limits: of every part.
        stop: once it is set no further part is begun; those that are being planned are finished.

    Raises:
        DeltacamError: no process can be started.
    """
    workers = _Workers(limits, stop)
    running: dict[Future[Result | None], Task] = {}
    pool = ThreadPoolExecutor(jobs)
    try:
        while True:
            while len(running) < _AHEAD * jobs and not stop.is_set() and (task := next(tasks, None)) is not None:
                running[pool.submit(workers.perform, task)] = task
            if not running:
                return
            done, _ = wait(running, return_when=FIRST_COMPLETED)
            for future in sorted(done, key=lambda each: running[each].name):
                task = running.pop(future)
                if (result := future.result()) is not None:
                    yield task, result
    finally:
        pool.shutdown(wait=False, cancel_futures=True)
        workers.close()
        pool.shutdown(wait=True)


class _Workers:
    """A process for every thread that asks for one."""

    def __init__(self, limits: Limits, stop: threading.Event) -> None:
        self._limits, self._stop = limits, stop
        self._own = threading.local()
        self._all: list[WorkerProcess] = []

    def perform(self, task: Task) -> Result | None:
        """What becomes of a task; None where it is not begun any more."""
        if self._stop.is_set():
            return None
        worker: WorkerProcess | None = getattr(self._own, "worker", None)
        if worker is None:
            worker = self._own.worker = WorkerProcess(self._limits)
            self._all.append(worker)
        return worker.perform(task)

    def close(self) -> None:
        for worker in list(self._all):
            worker.close()
