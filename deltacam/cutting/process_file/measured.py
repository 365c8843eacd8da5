"""What a test cut showed becomes a part of a process."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from deltacam.model import Process, Provenance

_KEYS: Final = {"kerf": "kerf_mm", "feed": "feed_m_min", "power": "power"}


def with_measured(process: Process, *, source: str = "", **values: float) -> Process:
    """The process with values that were measured, and said to be.

    Args:
        process: any.
        source: who measured them, when and on what; may be empty.
        **values: in SI: ``kerf``, ``feed`` with the gas in use, and ``power``.

    A range of feeds that the new feed is outside of is left out.
    """
    keys = [_KEYS[name] for name in values]
    said = [one for one in process.provenance if one.key not in keys]
    measured = [Provenance(key=key, grade="measured", source=source) for key in keys]
    changed = replace(process, **values, provenance=(*measured, *said))  # type: ignore[arg-type]
    feeds = changed.feeds
    if feeds is None or feeds[0] <= changed.feed <= feeds[1]:
        return changed
    kept = tuple(one for one in changed.provenance if one.key != "feed_range_m_min")
    return replace(changed, feeds=None, provenance=kept)
