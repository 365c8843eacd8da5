"""Progress on stderr: a line that is rewritten, on a terminal only."""

from __future__ import annotations

import sys
from types import TracebackType

import click


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
