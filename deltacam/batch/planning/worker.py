"""The process that plans parts one after the other: tasks come on stdin, results go to stdout.

It ends with its parent, also where that is killed: the pipe that the tasks come through closes then.
"""

from __future__ import annotations

import os
import pickle
import queue
import struct
import sys
import threading
import traceback
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from typing import IO, Final, NoReturn

_HEAD: Final = struct.Struct("<Q")
READY: Final = b"ready"
"""The first message of a worker."""


def send(stream: IO[bytes], message: bytes) -> None:
    """Write a message, its length first.

    Raises:
        OSError: the other side has gone.
    """
    stream.write(_HEAD.pack(len(message)))
    stream.write(message)
    stream.flush()


def receive(stream: IO[bytes]) -> bytes | None:
    """Read a message; None where the other side has gone, also in the middle of one."""
    head = stream.read(_HEAD.size)
    if len(head) < _HEAD.size:
        return None
    (size,) = _HEAD.unpack(head)
    message = stream.read(size)
    return message if len(message) == size else None


def limit_memory(size: int) -> None:
    """Let this process have so many bytes of its own, where the system can do that: Linux.

    Python raises MemoryError where it would take more. What it has in files and in reserve does not count.
    """
    if sys.platform == "linux":
        import resource

        resource.setrlimit(resource.RLIMIT_DATA, (size, size))


def leave_no_core() -> None:
    """Let a crash leave no image of the memory in the current folder, which is the user's."""
    if sys.platform != "win32":
        import resource

        resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


@contextmanager
def ending_with(stream: IO[bytes]) -> Iterator[None]:
    """Within the block the process ends as soon as the stream does, also where Python does not get its turn: Linux.

    Nothing may come through the stream meanwhile.
    """
    if sys.platform != "linux":
        yield
        return
    import fcntl
    import signal

    signal.signal(signal.SIGIO, signal.SIG_DFL)  # ends the process
    fcntl.fcntl(stream, fcntl.F_SETOWN, os.getpid())
    flags = fcntl.fcntl(stream, fcntl.F_GETFL)
    fcntl.fcntl(stream, fcntl.F_SETFL, flags | os.O_ASYNC)
    try:
        yield
    finally:
        fcntl.fcntl(stream, fcntl.F_SETFL, flags)


def main(memory: int | None) -> NoReturn:
    """Plan what comes until nothing comes any more.

    Ends without Python's own end, which would wait for the thread that listens, or abort because of it.
    """
    try:
        plan_all(memory)
    except BaseException:  # noqa: BLE001 - what Python would do
        with suppress(BaseException):  # there may be no memory for it
            traceback.print_exc()
        os._exit(1)
    os._exit(0)


def plan_all(memory: int | None) -> None:
    """Plan what comes, up to a part for which the memory is not enough."""
    tasks, results = sys.stdin.buffer, os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints must not come between the results
    leave_no_core()
    messages = listen(tasks)
    from deltacam.batch.parts import Result, Status
    from deltacam.batch.planning.task import get_ready, perform

    get_ready()
    if memory is not None:
        limit_memory(memory)
    send(results, READY)
    while True:
        message = messages.get()
        with ending_with(tasks):
            result: Result = perform(pickle.loads(message))  # noqa: S301 - from our own parent, through a pipe
            answer = pickle.dumps(result)
        send(results, answer)
        if result.outcome.status is Status.MEMORY:
            return  # a fresh process has its memory in one piece


def listen(stream: IO[bytes]) -> queue.SimpleQueue[bytes]:
    """What comes through the stream; the process ends where the stream does, also while it is planning."""
    waiting: queue.SimpleQueue[bytes] = queue.SimpleQueue()

    def receive_all() -> None:
        try:
            while (message := receive(stream)) is not None:
                waiting.put(message)
        except MemoryError:
            os.write(2, b"MemoryError\n")
        finally:
            os._exit(1)  # whatever it was: nobody would hear of a task any more

    threading.Thread(target=receive_all, daemon=True).start()
    return waiting


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else None)
