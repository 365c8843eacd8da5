"""Which workers of a cluster plan: those that have the versions of this machine, for as long as they can."""

from __future__ import annotations

import time
from collections.abc import Callable, Collection, Mapping
from typing import Any, Final, Protocol

from deltacam.batch.cluster import versions
from deltacam.errors import DeltacamError
from deltacam.plain import plain

Tell = Callable[[str], None]
"""Is told in a sentence what a person should know of the cluster."""

_PAUSE: Final = 1.0  # s between two looks at the cluster
_LONGEST: Final = 300  # characters of what a worker said
_LISTED: Final = 5


class Asked(Protocol):
    """A cluster that can be asked."""

    def run(self, function: Callable[..., Any], *given: Any, workers: Collection[str]) -> dict[str, Any]:
        """What a function returns, or raises, on workers, by their addresses."""

    def threads(self) -> dict[str, int] | None:
        """The threads of every worker, by its address; None where the scheduler does not answer."""

    def of_scheduler(self) -> dict[str, str]:
        """The versions there that Dask wants to be the same."""


class Crew:
    """The workers of a cluster.

    Args:
        cluster: is asked.
        address: of the scheduler, for messages.
        tell: is told of workers that do not plan, and when none is left.
    """

    def __init__(self, cluster: Asked, address: str, tell: Tell) -> None:
        self._cluster, self._address, self._tell = cluster, address, tell
        self.ours: Final = versions.here()
        self._compared: set[str] = set()
        self._unfit: dict[str, str] = {}
        self._threads: dict[str, int] = {}
        self._looked = 0.0

    @property
    def is_mixed(self) -> bool:
        """Whether some workers must not be given anything."""
        return bool(self._unfit)

    def gather(self, patience: float) -> None:
        """Wait for a worker, and compare the versions of all.

        Raises:
            DeltacamError: there is none within ``patience`` s, or they differ.
        """
        until = time.monotonic() + patience
        while not (threads := self._cluster.threads() or {}):
            if time.monotonic() > until:
                hint = f"start one with: dask worker {self._address} --host ITS-ADDRESS --nworkers 1 --nthreads CORES"
                raise DeltacamError(f"the scheduler at {self._address} has no worker: waited {patience:g} s", hint=hint)
            time.sleep(_PAUSE / 4)
        of_workers = versions.of_workers(self._cluster.run, threads, self.ours)
        found = {"the scheduler": self._cluster.of_scheduler(), **of_workers}
        unlike = {who: words for who, there in found.items() if (words := versions.differences(there, self.ours))}
        if unlike:
            raise DeltacamError(
                f"the cluster at {self._address} does not have the versions of this machine: {_listed(unlike)}",
                hint=versions.remedy(found.values(), self.ours),
            )
        self._compared, self._threads, self._looked = set(of_workers), threads, time.monotonic()

    def workers(self) -> Mapping[str, int]:
        """The threads of every worker that can plan, by its address; new ones are compared first.

        Raises:
            DeltacamError: none of those that are there can plan.
        """
        if time.monotonic() - self._looked < _PAUSE or (threads := self._cluster.threads()) is None:
            return self._threads
        self._forget_those_that_left(threads)
        new = threads.keys() - self._compared
        for worker, there in versions.of_workers(self._cluster.run, new, self.ours).items():
            self._compared.add(worker)
            if unlike := versions.differences(there, self.ours):
                self.leave_out(worker, unlike)
        fit = {worker: number for worker, number in threads.items() if worker not in self._unfit}
        if threads and not fit:
            raise DeltacamError(f"no worker of {self._address} can plan: {_listed(self._unfit)}")
        if bool(fit) != bool(self._threads):
            self._tell("there are workers again" if fit else "no worker is left: waiting for one")
        self._threads, self._looked = fit, time.monotonic()
        return fit

    def leave_out(self, worker: str, why: str) -> None:
        """Plan nothing more on a worker."""
        if worker not in self._unfit:
            self._unfit[worker] = plain(why, longest=_LONGEST)
            self._looked = 0.0
            self._tell(f"the worker {worker} is not used: {self._unfit[worker]}")

    def _forget_those_that_left(self, threads: Mapping[str, int]) -> None:
        """Who comes back to an address may be another one."""
        self._compared &= threads.keys()
        self._unfit = {worker: why for worker, why in self._unfit.items() if worker in threads}


def _listed(found: Mapping[str, str]) -> str:
    """Who and what, with a few of many."""
    shown = [f"{who}: {words}" for who, words in sorted(found.items())[:_LISTED]]
    return "; ".join([*shown, f"and {len(found) - _LISTED} others"] if len(found) > _LISTED else shown)
