"""What a Dask worker does for a batch: it lets processes of its own plan, as many as it has threads.

A process that hangs, crashes or eats memory is replaced, and the worker goes on.
"""

from __future__ import annotations

import pickle
import threading
import time
import zlib
from collections import deque
from collections.abc import Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any, Final

from deltacam.batch.cluster import versions
from deltacam.batch.parts import Limits, Result, Task
from deltacam.batch.planning import key
from deltacam.batch.planning.process import WorkerProcess
from deltacam.errors import DeltacamError
from deltacam.machine import share_of_memory

_IDLE: Final = 60.0  # s after which processes without work end: who asked for them may be gone
_FRESH: Final = 1.0  # s
_REMEMBERED: Final = 1000
_MOST_OF_MEMORY: Final = 0.8

_LOADED: Final = key.source()
"""What this worker began with; the processes that it starts have what is there by then."""


def perform(work: bytes, *, run: str, ours: Mapping[str, str], threads: int, memory: int | None) -> tuple[str, bytes]:
    """Plan a part of a batch, where this worker is fit for it.

    Args:
        work: a `Task`, its `Limits`, and whether the memory is its share of this worker's, packed.
        run: names the batch.
        ours: the versions of who asks.
        threads: of this worker.
        memory: what this worker may take, bytes; None where that is not limited.

    Returns:
        why nothing can be planned here, or nothing; and the `Result`, or None where the batch was stopped, packed.
    """
    if unlike := versions.differences(_have(int(time.monotonic() / _FRESH)), ours):
        return unlike, b""
    task, limits, share = unpack(work)
    if share:
        limits = replace(limits, memory=_share(threads, memory))
    try:
        return "", pack(_visit(run).perform(task, limits))
    except DeltacamError as problem:
        return f"{problem} ({problem.hint})" if problem.hint else str(problem), b""


def pack(value: Any) -> bytes:
    """The value as few bytes: a scheduler remembers the last 1000 messages to every worker."""
    return zlib.compress(pickle.dumps(value), level=1)


def unpack(data: bytes) -> Any:
    """What was packed, by somebody who may do here whatever they want: who reaches a scheduler may, and a scheduler."""
    return pickle.loads(zlib.decompress(data))  # noqa: S301 - as said


def source() -> str:
    """What deltacam's source is here, and whether that has changed since this worker began."""
    now = key.source()
    return now if now == _LOADED else f"{now}, but {_LOADED} as the worker was started"


@lru_cache(maxsize=1)
def _have(_when: int) -> Mapping[str, str]:
    """The versions that this worker plans with, looked up from time to time: somebody may install others."""
    return {**versions.here(), versions.SOURCE: source()}


def halt(run: str) -> set[str]:
    """Begin no further part of the batch; the keys of the tasks that were begun last."""
    return _visit(run).halt()


def leave(run: str) -> None:
    """End all processes of the batch."""
    with _LOCK:
        visit = _VISITS.pop(run, None)
    if visit is not None:
        visit.close()


class _Visit:
    """A batch on this worker: its processes, of which no more are busy than the worker has threads."""

    def __init__(self) -> None:
        self._idle: list[WorkerProcess] = []
        self._busy: list[WorkerProcess] = []
        self._begun: deque[str] = deque(maxlen=_REMEMBERED)
        self._halted = False
        self._timer: threading.Timer | None = None
        self._lock = threading.Lock()

    def perform(self, task: Task, limits: Limits) -> Result | None:
        """What becomes of a task; None where it is not begun any more."""
        with self._lock:
            if self._halted:
                return None
            self._begun.append(task.key)
            process = self._idle.pop() if self._idle else WorkerProcess(limits)
            self._busy.append(process)
        try:
            return process.perform(task)
        finally:
            self._give_back(process)

    def halt(self) -> set[str]:
        with self._lock:
            self._halted = True
            return set(self._begun)

    def close(self) -> None:
        with self._lock:
            self._halted = True
            processes = [*self._idle, *self._busy]
        for process in processes:
            process.close()

    def _give_back(self, process: WorkerProcess) -> None:
        with self._lock:
            self._busy.remove(process)
            self._idle.append(process)
            if self._timer:
                self._timer.cancel()
            self._timer = threading.Timer(_IDLE, self._rest)
            self._timer.daemon = True
            self._timer.start()

    def _rest(self) -> None:
        """End the processes that nobody has asked for in a while."""
        with self._lock:
            idle, self._idle = self._idle, []
        for process in idle:
            process.close()


_VISITS: Final[dict[str, _Visit]] = {}
_LOCK: Final = threading.Lock()


def _visit(run: str) -> _Visit:
    with _LOCK:
        return _VISITS.setdefault(run, _Visit())


def _share(threads: int, memory: int | None) -> int | None:
    """What each of the processes may take of the worker's memory, bytes."""
    return share_of_memory(threads) if memory is None else int(_MOST_OF_MEMORY * memory) // threads
