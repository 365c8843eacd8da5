"""``deltacam plan``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from deltacam_cli import options
from deltacam_cli.main import EXIT_FAILED, LONGEST_MESSAGE, show_json
from deltacam_cli.planning import HOW_NAMES, JOBS, how, how_options, planning_options, settings
from deltacam_cli.progress import ProgressLine

if TYPE_CHECKING:
    from deltacam.defaults import Defaults
    from deltacam.pipeline import Planned
    from deltacam.program.outputs import Outputs


@click.command("plan", no_args_is_help=True)
@click.argument("drawing", type=click.Path(path_type=Path))
@click.option("-o", "--output", "folder", type=click.Path(path_type=Path), default=Path(), help="Folder for the files.")
@planning_options
@how_options
@click.option(
    "--start-at",
    "starts",
    metavar="X,Y",
    multiple=True,
    help="Let the closed contour at this place of the drawing, mm, begin there; may be repeated.",
)
@click.option(
    "--from-contour", type=click.IntRange(1), metavar="N", help="Go on after a stop: leave out what comes before it."
)
@click.option("--jobs", type=JOBS, help="Processes for planning; the result is the same. 0: as many as pay.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the summary.")
def command(
    drawing: Path,
    folder: Path,
    *,
    starts: tuple[str, ...],
    from_contour: int | None,
    jobs: int | None,
    as_json: bool,
    **values: Any,
) -> None:
    """Plan DRAWING (a DXF file) and verify the program.

    Writes NAME.program.csv, NAME.report.json and NAME.report.html. The program is only written if every check passed.

    \b
    deltacam plan part.dxf
    deltacam plan part.dxf --units mm --kerf 0.2 --feed 12m/min -o out
    deltacam plan part.dxf --place auto
    """
    from deltacam.pipeline import plan_to_folder
    from deltacam.program.outputs import Outputs

    Outputs.of(drawing, folder).clear()  # before anything else can be refused
    own = options.defaults()
    if from_contour is not None and values["frame"]:
        raise click.UsageError("--from-contour says what is cut, and --frame cuts nothing")
    given = how(**{name: values.pop(name) for name in HOW_NAMES}, starts=starts)
    with ProgressLine() as progress:
        planned, outputs = plan_to_folder(
            drawing,
            folder,
            from_contour=from_contour,
            jobs=jobs or None,
            progress=progress,
            **given,
            **settings(own, **values),
        )
    _show(planned, outputs, own, as_json=as_json)
    if not planned.report.passed:
        click.echo("error: a check failed, so no program was written; the report says which", err=True)
        raise click.exceptions.Exit(EXIT_FAILED)


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
