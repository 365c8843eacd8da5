"""Dask without its log: what a person should know is told or raised."""

from __future__ import annotations

import logging
import warnings
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Final

_NOISY: Final = ("distributed", "tornado", "asyncio")


@contextmanager
def quiet(needless: type[Warning]) -> Iterator[None]:
    """Within the block Dask writes nothing on stderr, and warnings of a kind are not shown."""
    names = [name for name in logging.Logger.manager.loggerDict if name.split(".")[0] in _NOISY]
    levels = {logger: logger.level for logger in map(logging.getLogger, (*_NOISY, *names))}
    try:
        for logger in levels:
            logger.setLevel(logging.CRITICAL + 1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", needless)
            yield
    finally:
        for logger, level in levels.items():
            logger.setLevel(level)
