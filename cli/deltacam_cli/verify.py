"""``deltacam verify``."""

from __future__ import annotations

from pathlib import Path

import click

from deltacam_cli.main import EXIT_FAILED, show_json


@click.command("verify", no_args_is_help=True)
@click.argument("program", type=click.Path(path_type=Path))
@click.option("--drawing", type=click.Path(path_type=Path), help="Also check the cut against this DXF file.")
@click.option("--robot", help="Also check that the program is for this robot: a built-in name or a file.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the summary.")
def command(program: Path, drawing: Path | None, robot: str | None, as_json: bool) -> None:
    """Verify PROGRAM, trusting nothing the planner said.

    Positions are recomputed from the joint setpoints, and the cut is measured against the drawing itself.

    \b
    deltacam verify out/part.program.csv --drawing part.dxf
    """
    from deltacam.pipeline import verify
    from deltacam.report.listing import to_dict
    from deltacam.report.text import to_text

    report = verify(program, drawing=drawing, robot=robot)
    if as_json:
        show_json(to_dict(report))
    else:
        click.echo(to_text(report))
    if not report.passed:
        raise click.exceptions.Exit(EXIT_FAILED)
