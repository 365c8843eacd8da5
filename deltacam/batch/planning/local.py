"""Parts planned on this machine, by as many processes as are asked for."""

from __future__ import annotations

import queue
import threading
from collections.abc import Generator, Iterator
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from typing import Final

from deltacam.batch.parts import Limits, Result, Task
from deltacam.batch.planning.process import WorkerProcess

_AHEAD: Final = 2
"""Tasks for every process: one that it plans, and one that waits while the result of another is stored."""


def results(
    tasks: Iterator[Task], *, jobs: int, limits: Limits, stop: threading.Event
) -> Generator[tuple[Task, Result]]:
    """What becomes of every task, as soon as it is known; memory holds a few tasks at a time.

    Args:
        tasks: taken as processes get free.
        jobs: how many processes plan, >= 1.
        limits: of every part.
        stop: once it is set no further part is begun; those that are being planned are finished.

    Raises:
        DeltacamError: no process can be started.
    """
    workers = _Workers(jobs, limits, stop)
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
        workers.close()
        pool.shutdown(wait=True, cancel_futures=True)


class _Workers:
    """So many processes; a thread takes the one that was last free, so that no more are started than are of use."""

    def __init__(self, number: int, limits: Limits, stop: threading.Event) -> None:
        self._stop = stop
        self._all = tuple(WorkerProcess(limits) for _ in range(number))
        self._free: queue.LifoQueue[WorkerProcess] = queue.LifoQueue()
        for worker in self._all:
            self._free.put(worker)

    def perform(self, task: Task) -> Result | None:
        """What becomes of a task; None where it is not begun any more."""
        if self._stop.is_set():
            return None
        worker = self._free.get()
        try:
            return worker.perform(task)
        finally:
            self._free.put(worker)

    def close(self) -> None:
        for worker in self._all:
            worker.close()
