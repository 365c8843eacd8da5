"""Parts planned elsewhere: by the workers of a cluster, few at a time, each until it is planned somewhere."""

from __future__ import annotations

import queue
import threading
import uuid
from collections import deque
from collections.abc import Generator, Iterator, Mapping
from dataclasses import dataclass
from itertools import count
from typing import Any, Final

from deltacam.batch.cluster.connection import Answer, Cluster
from deltacam.batch.cluster.remote import pack, unpack
from deltacam.batch.parts import Limits, Result, Status, Task
from deltacam.batch.planning.process import ended

_AHEAD: Final = 2
"""Tasks for every thread of a worker: one that it plans, and one that waits while the result of another is stored."""

_PAUSE: Final = 0.5  # s between two looks at what there is to do


def results(
    tasks: Iterator[Task], *, cluster: Cluster, limits: Limits, stop: threading.Event, share_memory: bool = False
) -> Generator[tuple[Task, Result]]:
    """What becomes of every task, as soon as it is known; memory holds a few tasks at a time, here and there.

    A part whose worker ends is planned again by another one. A part that several workers ended with is planned once
    more when all others are done, so that it is not blamed for another.

    Args:
        tasks: taken as workers get free.
        cluster: plans.
        limits: of every part.
        stop: once it is set no further part is begun; those that are being planned are finished.
        share_memory: let a part take its share of the memory of its worker, in place of what ``limits`` say.

    Raises:
        DeltacamError: the cluster is lost, or none of its workers can plan.
    """
    flight = _Flight(tasks, cluster, limits, share_memory)
    try:
        while True:
            if cluster.lost:
                cluster.reconnect(stop.is_set)
            if stop.is_set():
                flight.halt()
            else:
                flight.fill()
            if flight.is_over:
                return
            if (landed := flight.land()) is not None:
                yield landed
    finally:
        flight.end()


@dataclass(frozen=True, slots=True)
class _Sent:
    """A task that a cluster has.

    Attributes:
        task: itself.
        only: the workers that it is for; empty for all.
        alone: whether it is planned while nothing else is.
    """

    task: Task
    only: frozenset[str]
    alone: bool


class _Flight:
    """The tasks of a batch that are on their way."""

    def __init__(self, tasks: Iterator[Task], cluster: Cluster, limits: Limits, share_memory: bool) -> None:
        self._tasks, self._cluster, self._limits, self._share = tasks, cluster, limits, share_memory
        self._run: Final = uuid.uuid4().hex
        self._count: Final = count()
        self._sent: dict[Any, _Sent] = {}
        self._landed: queue.SimpleQueue[Any] = queue.SimpleQueue()
        self._again: deque[Task] = deque()
        self._suspects: deque[Task] = deque()
        self._no_more = self._halted = False

    @property
    def is_over(self) -> bool:
        """Whether nothing is on its way, and nothing is to follow."""
        return not self._sent and (self._halted or (self._no_more and not self._again and not self._suspects))

    def fill(self) -> None:
        """Send as many tasks as the cluster should have."""
        workers = self._cluster.crew.workers()
        self._call_back_stranded(workers)
        while len(self._sent) < _AHEAD * sum(workers.values()) and (task := self._next()) is not None:
            if not self._send(task, workers):
                return
        if workers and self._no_more and not self._sent and not self._again and self._suspects:
            self._send(self._suspects.popleft(), workers, alone=True)

    def land(self) -> tuple[Task, Result] | None:
        """The next task that is done, and what came of it; None where there is none yet, or it goes off again."""
        try:
            future = self._landed.get(timeout=_PAUSE)
        except queue.Empty:
            return None
        sent = self._sent.pop(future, None)
        if sent is None:  # called back
            return None
        return self._judge(sent, self._cluster.collect(future))

    def halt(self) -> None:
        """Let no further task be begun, and call back those that are not."""
        if self._halted:
            return
        self._halted = True
        answers = self._cluster.everywhere("halt", self._run)
        begun = set().union(*answers.values())
        self._call_back([each for each, sent in self._sent.items() if sent.task.key not in begun and not each.done()])

    def end(self) -> None:
        """Leave nothing of the batch on the cluster."""
        self._call_back(list(self._sent))
        self._cluster.everywhere("leave", self._run)

    def _next(self) -> Task | None:
        if self._again:
            return self._again.popleft()
        task = next(self._tasks, None)
        self._no_more = task is None
        return task

    def _send(self, task: Task, workers: Mapping[str, int], *, alone: bool = False) -> bool:
        """Whether a task is on its way; where not, it is to be sent again."""
        only = frozenset(workers if self._cluster.crew.is_mixed else ())
        work = pack((task, self._limits, self._share))
        key = f"deltacam-part-{task.key}-{self._run}-{next(self._count)}"
        future = self._cluster.submit(work, key=key, run=self._run, only=only)
        if future is None:
            (self._suspects if alone else self._again).append(task)
            return False
        self._sent[future] = _Sent(task, only, alone)
        future.add_done_callback(self._landed.put)
        return True

    def _judge(self, sent: _Sent, answer: Answer) -> tuple[Task, Result] | None:
        task = sent.task
        if answer.kind == "planned":
            result: Result | None = unpack(answer.data)
            return None if result is None else (task, result)
        if answer.kind == "fault":
            what = f"a fault on the cluster: {answer.words}"
            return task, Result(ended(Status.FAULT, task, what, "report it with the drawing"))
        if answer.kind == "killed" and sent.alone:
            what = "every Dask worker that it was given to ended"
            hint = "look into what the workers wrote: they may have run out of memory"
            return task, Result(ended(Status.CRASHED, task, what, hint))
        if answer.kind == "unfit":
            self._cluster.crew.leave_out(answer.worker, answer.words)
        (self._suspects if answer.kind == "killed" else self._again).append(task)
        return None

    def _call_back_stranded(self, workers: Mapping[str, int]) -> None:
        """Take back what is only for workers that have gone."""
        stranded = [each for each, sent in self._sent.items() if sent.only and sent.only.isdisjoint(workers)]
        self._again.extend(self._sent[each].task for each in stranded)
        self._call_back(stranded)

    def _call_back(self, futures: list[Any]) -> None:
        for future in futures:
            del self._sent[future]
        self._cluster.cancel(futures)
