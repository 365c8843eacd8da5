"""What the commands that study something share: how the study is shown."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from deltacam.errors import DeltacamError
from deltacam_cli.main import LONGEST_MESSAGE, show_json

if TYPE_CHECKING:
    from deltacam.report.study import Study

Command = TypeVar("Command", bound=Callable[..., Any])

_SHOWING = (
    click.option("--html", metavar="FILE", type=click.Path(path_type=Path), help="Write a page with pictures."),
    click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the text."),
)


def study_options(command: Command) -> Command:
    """Add ``--html`` and ``--json``; the command receives ``html`` and ``as_json`` and hands them to `show`."""
    for add in reversed(_SHOWING):
        command = add(command)
    return command


def show(study: Study, *, as_json: bool, html: Path | None) -> None:
    """Print the study, and write its page where one is asked for.

    Raises:
        DeltacamError: the page cannot be written.
    """
    from deltacam.plain import plain
    from deltacam.program.atomic import write_whole
    from deltacam.report.study import to_html, to_text

    if html is not None:
        try:
            write_whole(html, to_html(study).encode())
        except DeltacamError as problem:
            hint = "choose another file with --html, in a folder that exists"
            raise DeltacamError(problem.what, where=problem.where, hint=hint) from problem
    if as_json:
        show_json(study.data)
        return
    click.echo(to_text(study))
    if html is not None:
        click.echo(f"wrote {plain(str(html), longest=LONGEST_MESSAGE)}")
