"""``deltacam process list``."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Final

import click

from deltacam.errors import DeltacamError
from deltacam_cli import options
from deltacam_cli.main import show_json

if TYPE_CHECKING:
    from deltacam.model import Process

_SAME_THICKNESS: Final = 1e-9  # m

_COLUMNS: Final = ("name", "material", "mm", "laser", "W", "gas", "m/min", "kerf mm", "feed from", "worst")
_NUMBERS: Final = (2, 4, 6, 7)


@click.command("list")
@click.option("--material", metavar="TEXT", help="Only materials whose name contains this: steel, ply.")
@click.option("--laser", type=click.Choice(["fibre", "co2"]), help="Only this kind of laser.")
@click.option("--thickness", metavar="LENGTH", help="Only this thickness, mm unless a unit is given.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the table.")
def command(*, material: str | None, laser: str | None, thickness: str | None, as_json: bool) -> None:
    """List the built-in processes, with the grade of the feed and the worst grade of what matters.

    Grades are measured, vendor, community and estimate, the best first; `deltacam process show` gives that of each
    value.

    \b
    deltacam process list
    deltacam process list --laser co2 --material plywood
    """
    from deltacam.cutting.process import load_process, process_names

    metres = options.length("--thickness", thickness)
    found = [
        process
        for process in map(load_process, process_names())
        if (material is None or material.strip().lower() in process.material.lower())
        and laser in (None, process.laser)
        and (metres is None or abs(process.thickness - metres) <= _SAME_THICKNESS)
    ]
    if as_json:
        show_json({"processes": [_as_dict(process) for process in found]})
        return
    if not found:
        what, hint = "no built-in process is like that", "ask for less, or see all: deltacam process list"
        raise DeltacamError(what, where="deltacam process list", hint=hint)
    _show([_as_dict(process) for process in found])


def _as_dict(process: Process) -> dict[str, Any]:
    from deltacam.cutting.process_file.values import NOT_SAID, provenance_of, worst_grade

    feed = provenance_of(process, "", "feed_m_min")
    return {
        "name": process.name,
        "material": process.material,
        "thickness_mm": round(process.thickness * 1e3, 9),
        "laser": process.laser,
        "laser_power_w": process.laser_power,
        "gas": process.gas,
        "feed_m_min": round(process.feed * 60.0, 9),
        "kerf_mm": round(process.kerf * 1e3, 9),
        "feed_grade": NOT_SAID if feed is None else feed.grade,
        "worst_grade": worst_grade(process),
    }


def _show(rows: list[dict[str, Any]]) -> None:
    from deltacam.inspection.table import aligned

    cells = [[f"{value:g}" if isinstance(value, float) else str(value) for value in row.values()] for row in rows]
    click.echo("\n".join(aligned([_COLUMNS, *cells], right=_NUMBERS, indent="")))
