"""``deltacam process``: the processes that there are, and one of your own."""

from __future__ import annotations

from typing import Final

import click

from deltacam_cli.main import LateGroup

COMMANDS: Final = {
    "list": "List the built-in processes.",
    "show": "Show every value of PROCESS, and where it is from.",
    "new": "Write a process file of your own to FILE.",
    "testcut": "Draw a test cut for PROCESS.",
    "measured": "Write what a test cut of PROCESS showed into a file of its own.",
}
"""The commands and their short help; a command ``x`` is ``deltacam_cli.process.x:command``."""


@click.group("process", cls=LateGroup, table=COMMANDS, package="deltacam_cli.process")
def command() -> None:
    """Choose a process, and make one of your own.

    A process is a built-in name or a process file (.toml): a material and a laser. The built-in ones are starting
    values; make a test cut.
    """
