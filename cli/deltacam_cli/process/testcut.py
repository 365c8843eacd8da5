"""``deltacam process testcut``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from deltacam_cli.main import LONGEST_MESSAGE
from deltacam_cli.process.writing import write_new

if TYPE_CHECKING:
    from deltacam.drawing.testcuts.power_grid import Cell
    from deltacam.model import Process


@click.command("testcut")
@click.argument("process")
@click.option("-o", "--output", "file", required=True, type=click.Path(path_type=Path), help="The drawing (.dxf).")
@click.option(
    "--kind",
    type=click.Choice(["kerf", "grid"]),
    default="kerf",
    show_default=True,
    help="A kerf comb, or a grid of powers and feeds.",
)
def command(process: str, *, file: Path, kind: str) -> None:
    """Draw a test cut for PROCESS, a built-in name or a process file, and say how to plan it.

    The kerf comb is measured with a caliper; `deltacam process measured` finds the kerf. The squares of the grid are
    planned one by one, each with its power and its feed. A file that is there is never written over.

    \b
    deltacam process testcut my-steel.toml -o comb.dxf
    deltacam process testcut my-steel.toml --kind grid -o grid.dxf
    """
    from deltacam.cutting.process import check_process, load_process
    from deltacam.drawing.testcuts.kerf_comb import kerf_comb
    from deltacam.drawing.testcuts.power_grid import power_grid
    from deltacam.drawing.testcuts.write import to_dxf

    found = check_process(load_process(process))
    if kind == "kerf":
        write_new(file, to_dxf(kerf_comb(found)), ending=".dxf")
        _say_comb(process, found, file)
        return
    grid = power_grid(found)
    write_new(file, to_dxf(grid.lines), ending=".dxf")
    for cell in grid.cells:
        _say(_plan(process, cell, file))


def _say_comb(name: str, process: Process, file: Path) -> None:
    from deltacam.drawing.testcuts.kerf_comb import BARS, planned_gap

    _say(f"deltacam plan {file} --process {name}")
    click.echo(
        f"push the {BARS} bars together against one end of the window and measure the gap at the other;\n"
        f"{planned_gap(process) * 1e3:.2f} mm is a kerf of {process.kerf * 1e3:.3f} mm, as planned"
    )
    _say(f"deltacam process measured {name} --gap GAP -o own.toml")


def _plan(name: str, cell: Cell, file: Path) -> str:
    from deltacam.drawing.testcuts.power_grid import metres_per_minute

    x, y = (f"{value * 1e3 + 0.0:g}" for value in cell.place)
    words = ["deltacam plan", str(file), "--process", name, "--layer", cell.layer, f"--at={x},{y}"]
    if cell.power is not None and cell.feed is not None:
        words += ["--power", f"{cell.power:g}", "--feed", f"{metres_per_minute(cell.feed)}m/min"]
    return " ".join([*words, "-o", str(file.with_suffix("") / cell.layer)])


def _say(line: str) -> None:
    from deltacam.plain import plain

    click.echo(plain(line, longest=LONGEST_MESSAGE))
