"""``deltacam robot show``."""

from __future__ import annotations

from pathlib import Path

import click

from deltacam_cli import options
from deltacam_cli.studies import show, study_options


@click.command("show")
@click.argument("robot", required=False)
@study_options
def command(robot: str | None, *, html: Path | None, as_json: bool) -> None:
    """Show what ROBOT can do over its sheet.

    Its geometry and limits and where each comes from; the joint speed and acceleration that the rated tool needs, where
    most, and which joint binds; the tool speed and acceleration that the joints allow everywhere on the sheet.

    \b
    deltacam robot show delta-300
    deltacam robot show my-robot.toml --html my-robot.html
    """
    from deltacam.report.studies.show import study
    from deltacam.robot.rating import rate

    machine = options.robot(robot, options.defaults())
    show(study(machine, rate(machine)), as_json=as_json, html=html)
