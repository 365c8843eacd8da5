"""``deltacam process measured``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from deltacam_cli import options
from deltacam_cli.process.writing import write_new

if TYPE_CHECKING:
    from deltacam.model import Process


@click.command("measured")
@click.argument("process")
@click.option("--kerf", metavar="LENGTH", help="The kerf that was measured, mm unless a unit is given.")
@click.option("--gap", metavar="LENGTH", help="The gap of a kerf comb that was planned with PROCESS, likewise.")
@click.option("--feed", metavar="SPEED", help="The feed that was found, mm/s unless a unit is given (12m/min).")
@click.option("--power", metavar="SHARE", help="The power that was found, of the laser's rated power, 0.001 to 1.")
@click.option("--source", metavar="TEXT", default="", help="Who measured it, when, on what; goes into the file.")
@click.option("-o", "--output", "file", required=True, type=click.Path(path_type=Path), help="The new file (.toml).")
def command(process: str, *, source: str, file: Path, **found: str | None) -> None:
    """Write what a test cut of PROCESS, a built-in name or a process file, showed into a process file of its own.

    The values are graded "measured". Comments of the file are not kept. A file that is there is never written over.

    \b
    deltacam process measured steel-1mm-fibre --gap 44.25 -o my-steel.toml
    deltacam process measured my-steel.toml --feed 8m/min --power 0.9 -o my-steel-2.toml
    """
    from deltacam.cutting.process import check_process, load_process
    from deltacam.cutting.process_file.measured import with_measured
    from deltacam.cutting.process_file.writing import to_toml

    own = check_process(load_process(process))
    values = _values(own, **found)
    if not values:
        raise click.UsageError("nothing was measured; give --kerf, --gap, --feed or --power")
    changed = check_process(replace(with_measured(own, source=source, **values), name=file.stem))
    heading = f"Made from {own.name}, with values that were measured."
    write_new(file, to_toml(changed, heading=heading, examples=True).encode(), ending=".toml", say=False)
    _say(own, changed, file)


def _values(
    process: Process, *, kerf: str | None, gap: str | None, feed: str | None, power: str | None
) -> dict[str, float]:
    """What was measured, in SI, by its name in a process."""
    from deltacam.drawing.testcuts.kerf_comb import kerf_from_gap
    from deltacam_cli.process_options import share

    if kerf is not None and gap is not None:
        raise click.UsageError("--kerf and --gap both say what the kerf is")
    width = options.length("--gap", gap)
    values: dict[str, Any] = {
        "kerf": options.length("--kerf", kerf) if width is None else kerf_from_gap(width, process),
        "feed": options.speed("--feed", feed),
        "power": share("--power", power),
    }
    return {key: value for key, value in values.items() if value is not None}


def _say(before: Process, after: Process, file: Path) -> None:
    from deltacam.plain import plain
    from deltacam_cli.main import LONGEST_MESSAGE

    click.echo(f"kerf   {after.kerf * 1e3:.3f} mm, was {before.kerf * 1e3:.3f}")
    click.echo(f"feed   {after.feed * 60.0:.4g} m/min, was {before.feed * 60.0:.4g}")
    click.echo(f"power  {after.power:.3g}, was {before.power:.3g}")
    click.echo(f"wrote {plain(str(file), longest=LONGEST_MESSAGE)}")
