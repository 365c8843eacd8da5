"""``deltacam process new``."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import click

from deltacam_cli.process.writing import write_new


@click.command("new")
@click.argument("file", type=click.Path(path_type=Path))
@click.option(
    "--from",
    "source",
    metavar="PROCESS",
    default="steel-1mm-fibre",
    show_default=True,
    help="A built-in process or a file to begin with.",
)
def command(file: Path, *, source: str) -> None:
    """Write a process file of your own to FILE (.toml), with a comment at every value, ready to be edited.

    It is called as its file. A file that is there is never written over.

    \b
    deltacam process new my-steel.toml
    deltacam process new my-plywood.toml --from birch-plywood-3mm-co2-60w
    """
    from deltacam.cutting.process import check_process, load_process
    from deltacam.cutting.process_file.writing import to_toml

    found = check_process(load_process(source))
    heading = f"Made from {found.name}: make a test cut (deltacam process testcut)."
    text = to_toml(replace(found, name=file.stem), heading=heading, examples=True)
    write_new(file, text.encode(), ending=".toml")
