"""``deltacam robot place``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from deltacam_cli import options
from deltacam_cli.planning import JOBS, planning_options, settings
from deltacam_cli.progress import ProgressLine
from deltacam_cli.studies import show, study_options

if TYPE_CHECKING:
    from deltacam.placing.find import By


@click.command("place", no_args_is_help=True)
@click.argument("drawing", type=click.Path(path_type=Path))
@click.option(
    "--by",
    type=click.Choice(["both", "time", "accuracy"]),
    default="both",
    show_default=True,
    help="What is to be small: the time, the error of the tool, or both, each as a share of that at the centre.",
)
@planning_options
@click.option("--jobs", type=JOBS, help="Processes for planning; the result is the same. 0: as many as pay.")
@study_options
def command(drawing: Path, *, by: By, jobs: int | None, as_json: bool, html: Path | None, **values: Any) -> None:
    """Find where on the sheet, and how turned, DRAWING (a DXF file) is cut fastest and most accurately.

    Many places and turns are estimated, the best are planned in full, and compared with the centre of the sheet.

    \b
    deltacam robot place part.dxf
    deltacam robot place part.dxf --by time --robot irb360-1600 --html place.html
    """
    from deltacam.pipeline import best_places
    from deltacam.report.studies.place import study

    own = options.defaults()
    with ProgressLine() as progress:
        found, robot = best_places(drawing, by=by, jobs=jobs or None, progress=progress, **settings(own, **values))
    show(study(found, robot=robot, drawing=str(drawing)), as_json=as_json, html=html)
