"""Parts planned by the workers of a Dask cluster that is there already. Import this late: Dask is heavy, and optional.

What goes to the cluster and back is bytes, so neither the scheduler nor the transport needs to know deltacam.
"""

from __future__ import annotations

import asyncio
import platform
import time
from collections.abc import Callable, Collection, Iterator, Mapping
from concurrent.futures import CancelledError, ThreadPoolExecutor
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from importlib import metadata
from typing import Any, Final, Literal

from deltacam.batch.cluster import remote, versions
from deltacam.batch.cluster.crew import Crew, Tell
from deltacam.batch.cluster.quiet import quiet
from deltacam.batch.cluster.scheduler import Address, Tls, address_of, reach
from deltacam.errors import DeltacamError
from deltacam.plain import plain

try:
    import dask
    import distributed
    from distributed.versions import VersionMismatchWarning
except ImportError as missing:
    raise DeltacamError(
        "a cluster needs the package distributed, which is not installed", hint='pip install "deltacam[cluster]"'
    ) from missing

_ANSWERS: Final = 10.0  # s that workers may take to answer a question
_FETCHED: Final = 60.0  # s for a result to be fetched; after that the part is planned again
_RECONNECTS: Final = 120.0  # s
_PAUSE: Final = 1.0  # s between two attempts to connect again
_LONGEST: Final = 300  # characters of what a worker said
_NO_LIMIT: Final = 2**60  # bytes of a task above which Dask would warn
_REMEMBERED: Final = 10  # messages; Dask would keep the last 1000, with the drawings in them


@contextmanager
def connect(
    address: str,
    *,
    tls: Tls | None = None,
    tell: Tell = lambda _words: None,
    timeout: float = 10.0,
    patience: float = 30.0,
) -> Iterator[Cluster]:
    """A cluster to plan on, while the block lasts.

    Args:
        address: of its scheduler: ``tcp://host:8786``, ``tls://host:8786``, or ``host:8786``, which means tcp.
        tls: for an address with ``tls://``.
        tell: is told, in the thread that takes the results, of workers that are not used, and when none is left.
        timeout: for the scheduler to answer, s.
        patience: for the first worker to be there, s.

    Raises:
        DeltacamError: no scheduler answers there, or not in this way; it has no worker; or the cluster does not have
            the versions of this machine.
    """
    where = address_of(address, tls)
    with quiet(VersionMismatchWarning):  # they are compared
        reach(where, timeout=timeout)
        cluster = Cluster(where, _client(where, timeout), timeout, tell)
        try:
            cluster.crew.gather(patience)
            yield cluster
        finally:
            cluster.close()


@dataclass(frozen=True, slots=True)
class Answer:
    """What a cluster made of a task.

    Attributes:
        kind: planned; unfit: the worker cannot plan; killed: every worker that it was given to ended; gone: the task is
            lost, and nobody knows what would have become of it; fault: what should not happen.
        worker: its address.
        words: why it is unfit, or what the fault is.
        data: as `remote.perform` returns it.
    """

    kind: Literal["planned", "unfit", "killed", "gone", "fault"]
    worker: str = ""
    words: str = ""
    data: bytes = b""


class Cluster:
    """A Dask cluster that is there. Nothing of it is started or ended by us.

    Args:
        address: of the scheduler.
        client: connected to it.
        timeout: for the scheduler to answer, s.
        tell: as `connect`.
    """

    def __init__(self, address: Address, client: Any, timeout: float, tell: Tell) -> None:
        self._address, self._client, self._timeout, self._tell = address, client, timeout, tell
        self.crew: Final = Crew(self, str(address), tell)

    @property
    def connected(self) -> bool:
        """Whether the scheduler can be told something now; where not, Dask may be about to connect again."""
        return bool(self._client.status == "running")

    @property
    def lost(self) -> bool:
        """Whether Dask has given up."""
        return self._client.status in ("closing", "closed")

    def submit(self, work: bytes, *, key: str, run: str, only: Collection[str]) -> Any:
        """Let a part be planned.

        Args:
            work: as `remote.perform` takes it.
            key: names the task.
            run: names the batch.
            only: the workers that may plan it; empty for all.

        Returns:
            the future, of what `_plan_there` returns; None where the connection has just been lost.
        """
        workers = sorted(only) or None
        try:
            with dask.config.set({"distributed.admin.large-graph-warning-threshold": _NO_LIMIT}):
                return self._client.submit(
                    _plan_there(), work, run, self.crew.ours, key=key, pure=False, workers=workers
                )
        except Exception:
            if self.connected:
                raise
            return None

    def collect(self, future: Any) -> Answer:
        """What came of a future that is done."""
        try:
            if future.status == "error":
                problem = future.exception(timeout=_ANSWERS)
                if isinstance(problem, distributed.KilledWorker):
                    return Answer("killed")
                return Answer("fault", words=plain(f"{type(problem).__name__}: {problem}", longest=_LONGEST))
            worker, unfit, data = future.result(timeout=_FETCHED)
        except (OSError, TimeoutError, asyncio.CancelledError, CancelledError):
            return Answer("gone")
        return Answer("unfit", worker, unfit) if unfit else Answer("planned", worker, data=data)

    def cancel(self, futures: Collection[Any]) -> None:
        """Let the cluster forget tasks."""
        if futures and self.connected:
            with suppress(OSError, TimeoutError):
                self._client.cancel(list(futures))

    def everywhere(self, name: str, run: str) -> dict[str, Any]:
        """What a function of `remote` answers for a batch on every worker that has deltacam."""
        answers = self.run(versions.by_code(remote.__name__, name), run)
        return {worker: answer for worker, answer in answers.items() if not isinstance(answer, Exception)}

    def reconnect(self, is_over: Callable[[], bool]) -> None:
        """Connect again where the connection was lost.

        Raises:
            DeltacamError: that cannot be done within two minutes.
        """
        until = time.monotonic() + _RECONNECTS
        self._tell("the connection to the scheduler is lost: trying again for 2 min")
        while True:
            try:
                reach(self._address, timeout=self._timeout)
                self._client = _client(self._address, self._timeout)
            except DeltacamError as problem:
                if is_over() or time.monotonic() > until:
                    what = f"the connection to the scheduler at {self._address} was lost: {problem.what}"
                    raise DeltacamError(what, hint="run it again once the cluster is there: it goes on") from problem
                time.sleep(_PAUSE)
            else:
                self._tell("there is a connection to the scheduler again")
                return

    def close(self) -> None:
        """Hang up."""
        with suppress(OSError, TimeoutError):
            self._client.close(timeout=_ANSWERS)

    def run(self, function: Callable[..., Any], *given: Any, workers: Collection[str] | None = None) -> dict[str, Any]:
        """What a function returns, or raises, on workers, by their addresses; without ``workers``, on all."""

        async def run() -> Any:
            chosen = None if workers is None else list(workers)
            return await self._client.run(function, *given, workers=chosen, on_error="return", asynchronous=True)

        return self._ask(run) or {}

    def threads(self) -> dict[str, int] | None:
        """The threads of every worker, by its address; None where the scheduler does not answer."""

        async def ask() -> Any:
            return await self._client.scheduler.ncores()

        found: dict[str, int] | None = self._ask(ask)
        return found

    def of_scheduler(self) -> dict[str, str]:
        """The versions there that Dask wants to be the same."""

        async def ask() -> dict[str, str]:
            there = self._client.run_on_scheduler
            full = await there(platform.python_version, asynchronous=True)
            dask_there = await there(metadata.version, distribution_name="distributed", asynchronous=True)
            return {versions.PYTHON: versions.python(full), "distributed": dask_there}

        return self._ask(ask) or {}

    def _ask(self, question: Callable[[], Any]) -> Any:
        """What a coroutine answers; None where there is no connection, or no answer in time."""

        async def ask() -> Any:
            return await question() if self.connected else None

        with suppress(OSError, TimeoutError):
            return self._client.sync(ask, callback_timeout=_ANSWERS) if self.connected else None
        return None


def _plan_there() -> Callable[..., tuple[str, str, bytes]]:
    """`remote.perform` on a worker, sent as `versions.by_code` sends functions."""

    def plan(work: bytes, run: str, ours: Mapping[str, str]) -> tuple[str, str, bytes]:
        """The address of the worker, why it cannot plan, and what `remote.perform` gave."""
        from importlib.metadata import version

        from distributed import get_worker

        worker = get_worker()
        try:
            if version("deltacam") != ours["deltacam"]:  # its modules may be other ones
                return worker.address, f"deltacam {version('deltacam')}, here {ours['deltacam']}", b""
            from deltacam.batch.cluster.remote import perform

            memory = worker.memory_manager.memory_limit
            unfit, data = perform(work, run=run, ours=ours, threads=worker.state.nthreads, memory=memory)
        except (ImportError, OSError) as problem:
            return worker.address, f"{type(problem).__name__}: {problem}", b""
        return worker.address, unfit, data

    return plan


def _client(address: Address, timeout: float) -> Any:
    """A connection to a scheduler that has been reached.

    Raises:
        DeltacamError: it does not answer as a scheduler of Dask does.
    """
    dask_of: Any = distributed  # whose types are not complete
    tls = address.tls
    files = (
        {"tls_ca_file": tls.ca_file, "tls_client_cert": tls.cert_file, "tls_client_key": tls.key_file} if tls else {}
    )
    security = dask_of.Security(require_encryption=tls is not None, **{name: str(file) for name, file in files.items()})
    try:
        with ThreadPoolExecutor(1) as elsewhere:  # this thread may have a loop that runs already
            elsewhere.submit(asyncio.run, _check_role(address, security, timeout)).result()
        with dask.config.set({"distributed.admin.low-level-log-length": _REMEMBERED}):
            return dask_of.Client(
                str(address), timeout=timeout, security=security, set_as_default=False, name="deltacam"
            )
    except (OSError, TimeoutError, ValueError, ImportError, RuntimeError) as problem:
        reason = plain(str(problem) or type(problem).__name__, longest=_LONGEST)
        what = f"what listens at {address} does not answer as a scheduler: {reason}"
        raise DeltacamError(what, hint="the scheduler says its address when it starts, as 'Scheduler at:'") from problem


async def _check_role(address: Address, security: Any, timeout: float) -> None:
    """Ask who is there: a worker would let a client wait for ever.

    Raises:
        OSError, TimeoutError: it does not answer.
        ValueError: it is no scheduler.
    """
    dask_of: Any = distributed
    async with asyncio.timeout(timeout):
        connection = await dask_of.comm.connect(str(address), timeout=timeout, **security.get_connection_args("client"))
        try:
            await connection.write({"op": "identity", "reply": True})
            found: dict[str, Any] = await connection.read()
        finally:
            connection.abort()
    if "workers" not in found:
        raise ValueError(f"it says that it is a {found.get('type', 'stranger')}")
