"""``deltacam robot``: the commands that study a robot."""

from __future__ import annotations

from typing import Final

import click

from deltacam_cli.main import LateGroup

COMMANDS: Final = {
    "compare": "Compare robots, side by side for DRAWING.",
    "budget": "Show how exactly ROBOT can cut.",
    "show": "Show what ROBOT can do over its sheet.",
    "design": "Find the smallest robot for a prescribed workspace.",
    "place": "Find where on the sheet DRAWING is cut fastest and most accurately.",
}
"""The commands and their short help; a command ``x`` is ``deltacam_cli.robot.x:command``."""


@click.group("robot", cls=LateGroup, table=COMMANDS, package="deltacam_cli.robot")
def command() -> None:
    """Study a robot: what it can do, where, and how exactly.

    A robot is a built-in name or a robot file (.toml). Every command takes --json, and --html for a page with pictures.
    """
