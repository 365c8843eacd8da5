"""``deltacam robot``: the commands that study a robot."""

from __future__ import annotations

from typing import Final

import click

from deltacam_cli.main import LateGroup

COMMANDS: Final = {
    "show": "Show what ROBOT can do over its sheet.",
    "workspace": "Show where ROBOT can work, and the largest cylinder and box that it can use.",
    "place": "Find where on the sheet DRAWING is cut fastest and most accurately.",
    "budget": "Show how exactly ROBOT can cut.",
    "design": "Find the smallest robot for a prescribed workspace.",
    "compare": "Compare robots, side by side for DRAWING.",
    "import": "Make a robot file from the FILE of another program.",
}
"""The commands and their short help; a command ``x`` is ``deltacam_cli.robot.x:command``."""


@click.group("robot", cls=LateGroup, table=COMMANDS, package="deltacam_cli.robot")
def command() -> None:
    """Study a robot: what it can do, where, and how exactly.

    A robot is a built-in name or a robot file (.toml). Every command takes --json, and most --html for a page with
    pictures.
    """
