"""Progress on stderr: a line that is rewritten, on a terminal only; and how a long run is interrupted."""

from __future__ import annotations

import os
import signal
import sys
import threading
import time
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from types import FrameType, TracebackType
from typing import TYPE_CHECKING, Any, Final

import click

if TYPE_CHECKING:
    from deltacam.batch.parts import Part, Row

_LONGEST: Final = 300  # characters of a line


class ProgressLine:
    """Shows the stage and how much of it is done; silent where stderr is not a terminal."""

    def __init__(self) -> None:
        self._shown = sys.stderr.isatty()
        self._stage = ""

    def __enter__(self) -> ProgressLine:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._shown:
            click.echo("\r\033[K", nl=False, err=True)

    def __call__(self, stage: str, done: int, total: int) -> None:
        """Rewrite the line."""
        if self._shown and (stage != self._stage or total > 1):
            self._stage = stage
            count = f" {done}/{total}" if total > 1 else ""
            click.echo(f"\r\033[K{stage}{count} ...", nl=False, err=True)


class PartsProgress:
    """Shows how far a batch is: a bar on a terminal, else a line for every part that is planned.

    Args:
        parts: all of them. The time left is told from the sizes of their drawings.
    """

    def __init__(self, parts: Sequence[Part]) -> None:
        self._sizes = {part.name: _size(part) for part in parts}
        self._bar: Any = None
        self._begin = time.monotonic()
        self._done = self._failed = self._planned = 0

    def __enter__(self) -> PartsProgress:
        if sys.stderr.isatty():
            self._bar = click.progressbar(
                length=sum(self._sizes.values()), file=sys.stderr, width=24, item_show_func=lambda _: self._words()
            )
            self._bar.__enter__()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, value: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.__exit__(kind, value, trace)

    def __call__(self, row: Row) -> None:
        """Count a part."""
        self._done += 1
        self._planned += not row.again
        self._failed += row.outcome.status.value != "passed"
        if self._bar is None:
            if not row.again:
                click.echo(self._line(row), err=True)
        elif row.again:
            self._bar.length -= self._sizes[row.part]  # it took no time, and says nothing of what is left
            self._bar.update(0, row)
        else:
            self._bar.update(self._sizes[row.part], row)

    def _words(self) -> str:
        rate = self._planned / max(time.monotonic() - self._begin, 1e-3)
        failed = f", {self._failed} failed" if self._failed else ""
        return f"{self._done}/{len(self._sizes)} parts{failed}, {rate:.2g} parts/s"

    def _line(self, row: Row) -> str:
        from deltacam.plain import plain

        width = len(str(len(self._sizes)))
        reason = f": {row.outcome.reason}" if row.outcome.reason else ""
        name = plain(f"{row.part}{reason}", longest=_LONGEST)
        return f"{self._done:>{width}}/{len(self._sizes)}  {row.outcome.status.value:9}  {name}"


def _size(part: Part) -> int:
    try:
        return max(part.path.stat().st_size, 1)
    except OSError:
        return 1


class Stop:
    """Whether somebody asked for an end; ``event`` is set also where the batch ends itself."""

    def __init__(self) -> None:
        self.event = threading.Event()
        self.asked = False

    def ask(self, _signal: int, _frame: FrameType | None) -> None:
        """End cleanly; the second time, at once."""
        if self.asked:
            signal.signal(signal.SIGINT, signal.SIG_IGN)  # a third time must not come between the end and its tidying
            raise KeyboardInterrupt
        self.asked = True
        self.event.set()
        with suppress(OSError):
            # Not click.echo: it may be writing at this moment.
            os.write(2, b"\nstopping: what is being planned is finished; Ctrl-C again stops at once\n")


@contextmanager
def stopping_cleanly() -> Iterator[Stop]:
    """Within the block, the first interrupt asks for an end, and the second one ends at once."""
    stop = Stop()
    before = signal.signal(signal.SIGINT, stop.ask)
    try:
        yield stop
    finally:
        signal.signal(signal.SIGINT, before)
