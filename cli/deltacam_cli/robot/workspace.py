"""``deltacam robot workspace``."""

from __future__ import annotations

from pathlib import Path

import click

from deltacam_cli import options
from deltacam_cli.studies import show, study_options


@click.command("workspace")
@click.argument("robot", required=False)
@click.option("--slices", default=7, show_default=True, metavar="N", help="How many level slices.")
@click.option("--height", "height_mm", type=float, metavar="MM", help="Height of the largest cylinder and box, mm.")
@click.option("--min-inverse-condition", type=float, metavar="X", help="Require this 1/cond everywhere, 0 to 1.")
@study_options
def command(
    robot: str | None,
    *,
    slices: int,
    height_mm: float | None,
    min_inverse_condition: float | None,
    html: Path | None,
    as_json: bool,
) -> None:
    """Show where ROBOT can work: its usable region, and the largest cylinder and box in it.

    Usable is what keeps the joint range, the pressure angles and the forearm swing of the robot file. The cylinder and
    the box are proved, not sampled: every requirement is kept at every point of them.

    \b
    deltacam robot workspace delta-300
    deltacam robot workspace my-robot.toml --height 50 --html workspace.html
    """
    from deltacam.report.studies.workspace import study
    from deltacam.robot.region.workspace_study import study_workspace

    machine = options.robot(robot, options.defaults())
    height = None if height_mm is None else height_mm / 1e3
    found = study_workspace(machine, slices=slices, height=height, min_inverse_condition=min_inverse_condition)
    show(study(found), as_json=as_json, html=html)
