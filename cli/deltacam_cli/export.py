"""``deltacam export``."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from deltacam.errors import DeltacamError
from deltacam_cli.main import LONGEST_MESSAGE, show_json

if TYPE_CHECKING:
    from deltacam.program.formats import Format


@click.command("export", no_args_is_help=True)
@click.argument("program", type=click.Path(path_type=Path))
@click.option("--to", "name", metavar="FORMAT", required=True, help="csv, parquet, gcode or halstreamer.")
@click.option("-o", "--output", metavar="FILE", type=click.Path(path_type=Path), help="Else NAME.* in this folder.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the name of the file.")
def command(program: Path, name: str, output: Path | None, as_json: bool) -> None:
    """Write PROGRAM in another format.

    A damaged file is refused. Whether the motion is right is not checked: that is what verify is for.

    \b
    deltacam export out/part.program.csv --to parquet
    deltacam export out/part.program.csv --to gcode -o part.ngc
    """
    from deltacam.plain import plain
    from deltacam.program.formats import name_of, read_program, write_as

    known = _format(name)
    path = output or Path(name_of(program) + known.suffix)
    _check_output(path, known, program)
    found = read_program(program)
    try:
        write_as(found, path, known)
    except DeltacamError as problem:
        raise DeltacamError(problem.what, where=problem.where or str(program), hint=problem.hint) from problem
    if as_json:
        show_json({"files": [str(path)]})
    else:
        click.echo(f"wrote {plain(str(path), longest=LONGEST_MESSAGE)}")


def _format(name: str) -> Format:
    """The format of that name.

    Raises:
        DeltacamError: there is none.
    """
    from deltacam.program.formats import FORMATS

    if name not in FORMATS:
        raise DeltacamError(f"{name!r} is not a format", where="--to", hint=f"it is one of {', '.join(FORMATS)}")
    return FORMATS[name]


def _check_output(path: Path, known: Format, program: Path) -> None:
    """Refuses to write over the program itself, and under a name that stands for another format.

    Raises:
        DeltacamError: one of these.
    """
    from deltacam.program.formats import find_format

    if path.exists() and program.exists() and path.samefile(program):
        hint = "give the new file a name of its own: -o FILE"
        raise DeltacamError("the file would overwrite the program that it is made from", where=str(path), hint=hint)
    other = find_format(path)
    if other is not None and other is not known:
        what = f"the name is that of another format, NAME{other.suffix}"
        raise DeltacamError(what, where=str(path), hint=f"call it NAME{known.suffix}")
