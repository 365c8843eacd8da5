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
    from deltacam.defaults import Defaults
    from deltacam.model import Process
    from deltacam.pipeline import Planned
    from deltacam.program.outputs import Outputs

JOBS = click.IntRange(0, 64)


@click.command("plan", no_args_is_help=True)
@click.argument("drawing", type=click.Path(path_type=Path))
@click.option("-o", "--output", "folder", type=click.Path(path_type=Path), default=Path(), help="Folder for the files.")
@click.option("--robot", help="A built-in robot, or a robot file (.toml). Without deltacam.toml: delta-300.")
@click.option("--process", help="A built-in process, or a file (.toml). Without deltacam.toml: steel-1mm-fibre.")
@options.reading_options
@click.option("--accept-loss", is_flag=True, help="Plan what could be read of a damaged drawing.")
@click.option("--kerf", metavar="LENGTH", help="Width of the cut, mm unless a unit is given (0.008in).")
@click.option("--feed", metavar="SPEED", help="Cutting speed, mm/s unless a unit is given (12m/min).")
@click.option("--tolerance", metavar="LENGTH", help="Largest deviation from the kerf path, mm unless a unit is given.")
@click.option("--corner", type=click.Choice(["round", "stop"]), help="Round corners within the tolerance, or stop.")
@click.option("--jerk", metavar="JERK", help="Largest joint jerk, deg/s3 (or 3500rad/s3), or none; else the robot's.")
@click.option("--at", metavar="X,Y", default="0,0", show_default=True, help="Where the part's centre goes, mm.")
@click.option("--rotate", metavar="ANGLE", default="0", show_default=True, help="Turn the part by so many degrees.")
@click.option("--dry-run", is_flag=True, help="The same motion with the laser off.")
@click.option("--frame", is_flag=True, help="Only trace the bounding box, with the laser off.")
@click.option("--jobs", type=JOBS, help="Processes for planning; the result is the same. 0: as many as pay.")
@click.option(
    "--what-if/--no-what-if",
    default=None,
    help="Also say how long each cut would take without each limit. Without either: where that is quick.",
)
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the summary.")
def command(drawing: Path, folder: Path, *, dry_run: bool, frame: bool, as_json: bool, **values: Any) -> None:
    """Plan DRAWING (a DXF file) and verify the program.

    Writes NAME.program.csv, NAME.report.json and NAME.report.html. The program is only written if every check passed.

    \b
    deltacam plan part.dxf
    deltacam plan part.dxf --units mm --kerf 0.2 --feed 12m/min -o out
    """
    from deltacam.model import Mode
    from deltacam.pipeline import plan_to_folder
    from deltacam.program.outputs import Outputs

    if dry_run and frame:
        raise click.UsageError("--dry-run and --frame exclude each other")
    Outputs.of(drawing, folder).clear()  # before anything else can be refused
    own = options.defaults()
    with ProgressLine() as progress:
        planned, outputs = plan_to_folder(
            drawing,
            folder,
            mode=Mode.FRAME if frame else Mode.DRY_RUN if dry_run else Mode.CUT,
            progress=progress,
            **_settings(own, **values),
        )
    _show(planned, outputs, own, as_json=as_json)
    if not planned.report.passed:
        click.echo("error: a check failed, so no program was written; the report says which", err=True)
        raise click.exceptions.Exit(EXIT_FAILED)


def _settings(
    own: Defaults,
    *,
    robot: str | None,
    jerk: str | None,
    process: str | None,
    units: str | None,
    layers: tuple[str, ...],
    ignored_layers: tuple[str, ...],
    join: str | None,
    accept_loss: bool,
    at: str,
    rotate: str,
    jobs: int | None,
    what_if: bool | None,
    **single_values: str | None,
) -> dict[str, Any]:
    """What the command line and the user's own defaults say, as the pipeline takes it."""
    selection = options.selection(own, layers=layers, ignored_layers=ignored_layers, join=join, accept_loss=accept_loss)
    return {
        "robot": options.with_jerk(options.robot(robot, own), jerk),
        "process": _process(process, own, **single_values),
        "unit": options.unit("--units", units),
        "default_unit": own.units,
        "selection": selection,
        "at": options.place("--at", at),
        "rotation": options.angle("--rotate", rotate),
        "jobs": jobs or None,
        "what_if": what_if,
    }


def _process(
    name: str | None, own: Defaults, *, kerf: str | None, feed: str | None, tolerance: str | None, corner: str | None
) -> Process:
    """The process with the single values that the command line gives."""
    from deltacam.cutting.process import DEFAULT_PROCESS, load_process

    values: dict[str, Any] = {
        "kerf": options.length("--kerf", kerf),
        "feed": options.speed("--feed", feed),
        "tolerance": options.length("--tolerance", tolerance),
        "corner": corner,
    }
    process = options.load(load_process, name, own.process, DEFAULT_PROCESS, f"{own.file}: process")
    return replace(process, **{key: value for key, value in values.items() if value is not None})


def _show(planned: Planned, outputs: Outputs, own: Defaults, *, as_json: bool) -> None:
    from deltacam.plain import plain
    from deltacam.report.listing import to_dict
    from deltacam.report.text import to_text

    files = [outputs.program] if planned.report.passed else []
    files += [outputs.report_json, outputs.report_html]
    if as_json:
        shown = {"defaults": own.file or None, "files": [str(path) for path in files]}
        show_json({**to_dict(planned.report), **shown})
        return
    click.echo(to_text(planned.report))
    for path in files:
        click.echo(f"wrote {plain(str(path), longest=LONGEST_MESSAGE)}")
