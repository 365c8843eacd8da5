"""The assist gas in use, and the feed that it allows."""

from __future__ import annotations

from dataclasses import replace

from deltacam.errors import ProcessError
from deltacam.model import Process


def with_gas(process: Process, name: str) -> Process:
    """The process with another of the gases that it knows, and with the feed and its range for that gas.

    Raises:
        ProcessError: the process says nothing about that gas.
    """
    if name == process.gas:
        return process
    known = [gas.name for gas in process.gases]
    if name not in known:
        listed = f"it knows {', '.join(known)}" if known else "it knows of one feed only"
        raise ProcessError(
            f"process {process.name} says nothing about the gas {name!r}",
            hint=f"{listed}; write [gases.{name}] with its feed_factor into a process file of your own",
        )
    return _scaled(replace(process, gas=name), _factor(process, name) / _factor(process, process.gas))


def at_feed_of_its_gas(stated: Process) -> Process:
    """A process whose feeds are those that a file states, with the feeds for the gas in use."""
    return _scaled(stated, _factor(stated, stated.gas))


def stated_feed(process: Process) -> float:
    """The feed that a file states for the process, before the factor of the gas in use, m/s."""
    return process.feed / _factor(process, process.gas)


def stated_feeds(process: Process) -> tuple[float, float]:
    """The slowest and the fastest feed as `stated_feed`; the feed itself where the process has no range."""
    low, high = process.feeds or (process.feed, process.feed)
    factor = _factor(process, process.gas)
    return low / factor, high / factor


def _factor(process: Process, name: str) -> float:
    return next((gas.feed_factor for gas in process.gases if gas.name == name), 1.0)


def _scaled(process: Process, factor: float) -> Process:
    if factor == 1.0:
        return process
    feeds = None if process.feeds is None else (process.feeds[0] * factor, process.feeds[1] * factor)
    return replace(process, feed=process.feed * factor, feeds=feeds)
