"""``deltacam plan``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from deltacam_cli import options
from deltacam_cli.main import EXIT_FAILED, LONGEST_MESSAGE, show_json
from deltacam_cli.progress import ProgressLine

if TYPE_CHECKING:
    from deltacam.model import Process
    from deltacam.pipeline import Outputs, Planned


@click.command("plan", no_args_is_help=True)
@click.argument("drawing", type=click.Path(path_type=Path))
@click.option("-o", "--output", "folder", type=click.Path(path_type=Path), default=Path(), help="Folder for the files.")
@click.option("--robot", default="delta-300", show_default=True, help="A built-in robot, or a robot file (.toml).")
@click.option("--process", default="steel-1mm-fibre", show_default=True, help="A built-in process, or a file (.toml).")
@click.option("--units", metavar="UNIT", help="What one unit of the drawing is: mm, in, ...; overrides its header.")
@click.option("--kerf", metavar="LENGTH", help="Width of the cut, mm unless a unit is given (0.008in).")
@click.option("--feed", metavar="SPEED", help="Cutting speed, mm/s unless a unit is given (12m/min).")
@click.option("--tolerance", metavar="LENGTH", help="Largest deviation from the kerf path, mm unless a unit is given.")
@click.option("--corner", type=click.Choice(["round", "stop"]), help="Round corners within the tolerance, or stop.")
@click.option("--at", metavar="X,Y", default="0,0", show_default=True, help="Where the part's centre goes, mm.")
@click.option("--rotate", metavar="ANGLE", default="0", show_default=True, help="Turn the part by so many degrees.")
@click.option("--dry-run", is_flag=True, help="The same motion with the laser off.")
@click.option("--frame", is_flag=True, help="Only trace the bounding box, with the laser off.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the summary.")
def command(
    drawing: Path,
    folder: Path,
    robot: str,
    process: str,
    units: str | None,
    at: str,
    rotate: str,
    dry_run: bool,
    frame: bool,
    as_json: bool,
    **single_values: str | None,
) -> None:
    """Plan DRAWING (a DXF file) and verify the program.

    Writes NAME.program.csv, NAME.report.json and NAME.report.html. The program is only written if every check passed.

    \b
    deltacam plan part.dxf
    deltacam plan part.dxf --units mm --kerf 0.2 --feed 12m/min -o out
    """
    from deltacam.model import Mode
    from deltacam.pipeline import Outputs, plan_to_folder

    if dry_run and frame:
        raise click.UsageError("--dry-run and --frame exclude each other")
    Outputs.of(drawing, folder).clear()  # before anything else can be refused
    with ProgressLine() as progress:
        planned, outputs = plan_to_folder(
            drawing,
            folder,
            robot=robot,
            process=_process(process, **single_values),
            unit=options.unit("--units", units),
            at=options.place("--at", at),
            rotation=options.angle("--rotate", rotate),
            mode=Mode.FRAME if frame else Mode.DRY_RUN if dry_run else Mode.CUT,
            progress=progress,
        )
    _show(planned, outputs, as_json=as_json)
    if not planned.report.passed:
        click.echo("error: a check failed, so no program was written; the report says which", err=True)
        raise click.exceptions.Exit(EXIT_FAILED)


def _process(name: str, *, kerf: str | None, feed: str | None, tolerance: str | None, corner: str | None) -> Process:
    """The process with the single values that the command line gives."""
    from deltacam.cutting.process import load_process

    values: dict[str, Any] = {
        "kerf": options.length("--kerf", kerf),
        "feed": options.speed("--feed", feed),
        "tolerance": options.length("--tolerance", tolerance),
        "corner": corner,
    }
    return replace(load_process(name), **{key: value for key, value in values.items() if value is not None})


def _show(planned: Planned, outputs: Outputs, *, as_json: bool) -> None:
    from deltacam.plain import plain
    from deltacam.verification.report_json import to_dict
    from deltacam.verification.report_text import to_text

    files = [outputs.program] if planned.report.passed else []
    files += [outputs.report_json, outputs.report_html]
    if as_json:
        show_json({**to_dict(planned.report), "files": [str(path) for path in files]})
        return
    click.echo(to_text(planned.report))
    for path in files:
        click.echo(f"wrote {plain(str(path), longest=LONGEST_MESSAGE)}")
