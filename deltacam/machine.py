"""What this computer has."""

from __future__ import annotations

import os
from typing import Final

_MOST_OF_MEMORY: Final = 0.8


def cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def share_of_memory(processes: int) -> int | None:
    """What each of so many processes may take of most of the memory, bytes; None where the system does not say."""
    try:
        total = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES")
    except (AttributeError, OSError, ValueError):
        return None
    return int(_MOST_OF_MEMORY * total) // processes
