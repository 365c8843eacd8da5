"""``deltacam robot import``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from deltacam.errors import DeltacamError
from deltacam_cli.main import LONGEST_MESSAGE, show_json

if TYPE_CHECKING:
    from deltacam.robot.importers.complete import Imported

PATH = click.Path(path_type=Path)
NAMES = ("linuxcnc", "klipper", "reprapfirmware", "classic")


@click.command("import")
@click.argument("files", metavar="FILE...", nargs=-1, required=True, type=PATH)
@click.option(
    "--from", "format_name", type=click.Choice(NAMES), help="Whose file it is; seen from the file if left out."
)
@click.option("-o", "--output", metavar="FILE", type=PATH, help="Write the robot file here, not to the screen.")
@click.option("--sheet", metavar="SIZE@Z", help="The sheet: 300x300@-650, or r150@-650 for a disc; mm.")
@click.option("--speed", metavar="SPEED", help="The rated speed of the tool: 60m/min; mm/s unless a unit is given.")
@click.option("--acceleration", metavar="NUMBER", type=float, help="The rated acceleration of the tool, m/s2.")
@click.option("--joints", metavar="MIN..MAX", help="The range of the joints: --joints=-45..95; degrees, positive down.")
@click.option("--units", metavar="UNIT", help="The unit of the lengths, where the file does not say.")
@click.option("--joints-at", metavar="PLACE", help="For f, e, rf, re: the joints are at the middles or the vertices.")
@click.option("--name", metavar="TEXT", help="The robot's name; that of the file if left out.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object, which holds the robot file too.")
def command(
    files: tuple[Path, ...],
    *,
    format_name: str | None,
    output: Path | None,
    sheet: str | None,
    speed: str | None,
    acceleration: float | None,
    joints: str | None,
    units: str | None,
    joints_at: str | None,
    name: str | None,
    as_json: bool,
) -> None:
    """Make a robot file from the FILE of another program.

    LinuxCNC (rotarydeltakins, HAL and INI), Klipper (rotary_delta), RepRapFirmware (M669 K10), and the f, e, rf, re of
    tutorials. What the file does not say is asked for or marked as an estimate; what is not used is listed.

    \b
    deltacam robot import machine.ini machine.hal --sheet 300x300@-650 -o robot.toml
    deltacam robot import printer.cfg --sheet r60 -o robot.toml
    """
    from deltacam.robot.importers.classic import to_places
    from deltacam.robot.importers.complete import Wishes
    from deltacam.robot.importers.description import Choices
    from deltacam.robot.importers.formats import import_robot
    from deltacam.robot.importers.wishes import to_millimetres, to_range, to_sheet
    from deltacam.units import parse_speed

    choices = Choices(
        millimetres_per_unit=None if units is None else to_millimetres(units),
        joints_at=None if joints_at is None else to_places(joints_at),
    )
    wishes = Wishes(
        name=name,
        sheet=None if sheet is None else to_sheet(sheet),
        speed=None if speed is None else parse_speed(speed),
        acceleration=acceleration,
        joints=None if joints is None else to_range(joints),
    )
    imported = import_robot(files, format_name=format_name, choices=choices, wishes=wishes)
    if output is not None:
        _write(imported, output, files)
    _show(imported, output, as_json=as_json)


def _write(imported: Imported, output: Path, files: tuple[Path, ...]) -> None:
    """Write the robot file, whole or not at all.

    Raises:
        DeltacamError: it would overwrite what it is made from, or the operating system refuses.
    """
    from deltacam.program.atomic import write_whole

    if output.exists() and any(path.exists() and output.samefile(path) for path in files):
        what, hint = "the robot file would overwrite what it is made from", "give it a name of its own: -o robot.toml"
        raise DeltacamError(what, where=f"-o {output}", hint=hint)
    write_whole(output, imported.toml.encode("utf-8"))


def _show(imported: Imported, output: Path | None, *, as_json: bool) -> None:
    from deltacam.plain import plain
    from deltacam.report.imported import to_dict, to_text

    if as_json:
        show_json(to_dict(imported))
        return
    click.echo(to_text(imported), err=output is None)
    if output is None:
        click.echo(imported.toml, nl=False)
    else:
        click.echo(f"wrote {plain(str(output), longest=LONGEST_MESSAGE)}")
