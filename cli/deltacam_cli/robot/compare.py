"""``deltacam robot compare``."""

from __future__ import annotations

from pathlib import Path

import click

from deltacam_cli import options
from deltacam_cli.progress import ProgressLine
from deltacam_cli.studies import show, study_options


@click.command("compare")
@click.argument("drawing", required=False, type=click.Path(path_type=Path))
@click.option("--robot", "robots", multiple=True, help="Only this built-in robot or file; may be repeated.")
@click.option("--process", help="A built-in process, or a file (.toml). Without deltacam.toml: steel-1mm-fibre.")
@options.reading_options
@study_options
def command(
    drawing: Path | None,
    *,
    robots: tuple[str, ...],
    process: str | None,
    units: str | None,
    layers: tuple[str, ...],
    ignored_layers: tuple[str, ...],
    join: str | None,
    html: Path | None,
    as_json: bool,
) -> None:
    """Compare robots, side by side for DRAWING where one is given.

    For a drawing: whether it fits, how long it takes, what binds, and how much a joint error matters. Without one: the
    robots with their geometry, and what producers publish, with the source of every row.

    \b
    deltacam robot compare
    deltacam robot compare part.dxf --robot delta-300 --robot my-robot.toml
    """
    from deltacam.report.studies import compare as studies

    if drawing is None:
        from deltacam.robot.comparison import profiles
        from deltacam.robot.producers import read_producers

        show(studies.study_of_robots(profiles(robots), read_producers()), as_json=as_json, html=html)
        return
    from deltacam.compare import compare
    from deltacam.cutting.process import DEFAULT_PROCESS, load_process

    own = options.defaults()
    with ProgressLine() as progress:
        outcomes = compare(
            drawing,
            robots,
            progress=progress,
            process=options.load(load_process, process, own.process, DEFAULT_PROCESS, f"{own.file}: process"),
            unit=options.unit("--units", units),
            default_unit=own.units,
            selection=options.selection(
                own, layers=layers, ignored_layers=ignored_layers, join=join, accept_loss=False
            ),
        )
    show(studies.study_of_outcomes(drawing.name, outcomes), as_json=as_json, html=html)
