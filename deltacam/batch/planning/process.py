"""A process that plans parts for us, and that may hang, crash or eat memory without harm to anybody."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import tempfile
import threading
from contextlib import suppress
from typing import IO, Any, Final

from deltacam.batch.parts import MORE, TOO_LITTLE, Limits, Outcome, Result, Status, Task
from deltacam.batch.planning import worker
from deltacam.errors import DeltacamError
from deltacam.plain import plain

_ENVIRONMENT: Final = {
    # There is a process for every core already.
    **dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1"),
    # glibc keeps up to 256 MiB that an array has left for the next one, also of arrays up to 32 MiB, its most. By
    # itself it gives part of it back, a worker of Dask lets it give back all above 64 kB, and what is given back must
    # be cleared by the kernel before it can be used again: that took up to half of the time.
    "MALLOC_TRIM_THRESHOLD_": str(2**28),
    "MALLOC_MMAP_THRESHOLD_": str(2**25),
}

_ON_ITS_OWN: Final[dict[str, Any]] = (
    {"creationflags": getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0)}
    if sys.platform == "win32"
    else {"start_new_session": True}
)
"""Ctrl-C on the terminal is for us and not for it."""

_OUT_OF_MEMORY: Final = ("MemoryError", "bad_alloc", "Memory allocation still failed")
"""What Python, C++ and OpenBLAS say when they end for want of memory."""

_OVER: Final = "the batch is over"
_LONGEST: Final = 300  # characters of what a process said last
_STARTING: Final = 300.0  # s that a process may take to get ready
_ENDING: Final = 5.0  # s that a process may take to end when it has stopped to answer


class WorkerProcess:
    """Plans one part at a time, in a process that starts with the first and again after each that ended it.

    Args:
        limits: of every part.
    """

    def __init__(self, limits: Limits) -> None:
        self._limits = limits
        self._running: _Running | None = None
        self._closed = False
        self._lock = threading.Lock()

    def perform(self, task: Task) -> Result:
        """Plan and verify a part; what it does to the process is the outcome.

        Raises:
            DeltacamError: no process can be started at all, or any more.
        """
        running = self._ready()
        with _Alarm(self._limits.time, running.process.kill) as alarm:
            result = running.answer(task)
        if result is None:
            if self._is_over():
                raise DeltacamError(_OVER)
            result = Result(self._late(task) if alarm.rang else _crashed(running, task))
        if alarm.rang or result.outcome.status in (Status.MEMORY, Status.CRASHED):
            self._end()
        return result

    def close(self) -> None:
        """End the process at once, from any thread, and start no other."""
        with self._lock:
            self._closed = True
        self._end()

    def _ready(self) -> _Running:
        before = self._running
        if before is not None and before.process.poll() is not None:
            self._end()  # between two parts, so none of them did it
        with self._lock:
            if self._closed:
                raise DeltacamError(_OVER)
            running = self._running = self._running or _Running(self._limits.memory)
        try:
            running.get_ready()
        except DeltacamError as problem:
            self._end()
            raise DeltacamError(_OVER) if self._is_over() else problem from None
        return running

    def _end(self) -> None:
        with self._lock:
            running, self._running = self._running, None
        if running is not None:
            running.kill()

    def _is_over(self) -> bool:
        with self._lock:
            return self._closed

    def _late(self, task: Task) -> Outcome:
        return ended(
            Status.TIMEOUT, task, f"not planned within {self._limits.time:g} s", "let it take longer with --time-limit"
        )


class _Running:
    """A process that plans once it is ready.

    Args:
        memory: what it may take, bytes; None for any.

    Raises:
        DeltacamError: it cannot be started.
    """

    def __init__(self, memory: int | None) -> None:
        self._memory = memory
        self._is_ready = False
        try:
            self._errors = tempfile.TemporaryFile()  # noqa: SIM115 - closed by `kill`
            self.process = _start(memory, self._errors)
        except OSError as problem:
            what = f"a process that plans cannot be started: {(problem.strerror or str(problem)).lower()}"
            raise DeltacamError(what, hint="plan fewer parts at a time with --jobs") from problem
        assert self.process.stdin is not None  # noqa: S101 - for types
        assert self.process.stdout is not None  # noqa: S101 - for types
        self._tasks, self._results = self.process.stdin, self.process.stdout

    def get_ready(self) -> None:
        """Wait until it can plan.

        Raises:
            DeltacamError: it ends instead, or takes too long.
        """
        if self._is_ready:
            return
        with _Alarm(_STARTING, self.process.kill) as alarm, suppress(OSError, ValueError):  # as in `answer`
            self._is_ready = worker.receive(self._results) == worker.READY
        if not self._is_ready:
            words = f"not within {_STARTING:g} s" if alarm.rang else self.last_words() or "it ended at once"
            hint = "" if self._memory is None else "let it have more memory with --memory"
            raise DeltacamError(f"a process that plans cannot be started: {words}", hint=hint)

    def answer(self, task: Task) -> Result | None:
        """What the process makes of the part; None where it ends instead."""
        with suppress(OSError, ValueError):  # ValueError: the pipe was closed by `kill`
            self._errors.seek(0)  # which is where the process goes on writing: its last words are about this part
            self._errors.truncate()
            worker.send(self._tasks, pickle.dumps(task))
            message = worker.receive(self._results)
            if message is not None:
                result: Result = pickle.loads(message)  # noqa: S301 - from our own process, through a pipe
                return result
        return None

    def kill(self) -> None:
        self.process.kill()
        self.process.wait()
        for stream in (self._tasks, self._results, self._errors):
            with suppress(OSError):  # what was on its way to it
                stream.close()

    def last_words(self) -> str:
        """The last line that the process wrote on stderr."""
        with suppress(OSError, ValueError):
            self._errors.seek(0)
            lines = self._errors.read().decode("utf-8", "replace").strip().splitlines()
            return plain(lines[-1], longest=_LONGEST) if lines else ""
        return ""


def _start(memory: int | None, errors: IO[bytes]) -> subprocess.Popen[bytes]:
    """Raises OSError where the system does not allow another process."""
    # -P: what lies in the current folder is not imported.
    return subprocess.Popen(  # noqa: S603 - ourselves
        [sys.executable, "-P", "-m", worker.__name__, *([] if memory is None else [str(memory)])],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        stderr=errors,
        env={**os.environ, **_ENVIRONMENT},
        **_ON_ITS_OWN,
    )


class _Alarm:
    """Calls ``action`` unless the block ends within ``time`` s; never once the block has ended."""

    def __init__(self, time: float | None, action: Any) -> None:
        self._action = action
        self._lock = threading.Lock()
        self._over = False
        self._timer = None if time is None else threading.Timer(time, self._ring)
        self.rang = False

    def __enter__(self) -> _Alarm:
        if self._timer:
            self._timer.daemon = True
            self._timer.start()
        return self

    def __exit__(self, *_: object) -> None:
        with self._lock:
            self._over = True
        if self._timer:
            self._timer.cancel()

    def _ring(self) -> None:
        with self._lock:
            if not self._over:
                self.rang = True
                self._action()


def _crashed(running: _Running, task: Task) -> Outcome:
    """How a process ended by itself."""
    try:
        code = running.process.wait(_ENDING)
    except subprocess.TimeoutExpired:
        return ended(Status.CRASHED, task, "its process stopped to answer")
    what, hint = f"its process ended with exit code {code}", "report it with the drawing"
    if code < 0:
        with suppress(ValueError):
            what = f"its process was ended by {signal.Signals(-code).name}"
        if -code == getattr(signal, "SIGKILL", None):
            hint = "the system may have run out of memory: plan fewer parts at a time"
    words = running.last_words()
    if any(sign in words for sign in _OUT_OF_MEMORY):
        return ended(Status.MEMORY, task, TOO_LITTLE, MORE)
    return ended(Status.CRASHED, task, f"{what}: {words}" if words else what, hint)


def ended(status: Status, task: Task, what: str, hint: str = "") -> Outcome:
    """The outcome of a part that nothing came of."""
    robot, process = (getattr(task.options.get(key), "name", "") for key in ("robot", "process"))
    return Outcome(status, what, hint=hint, robot=robot, process=process)
