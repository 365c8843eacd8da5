"""``deltacam inspect``."""

from __future__ import annotations

import shlex
from pathlib import Path
from typing import TYPE_CHECKING

import click

from deltacam.errors import DeltacamError
from deltacam_cli import options
from deltacam_cli.main import LONGEST_MESSAGE, show_json

if TYPE_CHECKING:
    from deltacam.model import Drawing, Selection


@click.command("inspect", no_args_is_help=True)
@click.argument("drawing", type=click.Path(path_type=Path))
@options.reading_options
@click.option("--process", help="Whose rules say what is cut, engraved or ignored: a built-in name, or a file (.toml).")
@click.option("--svg", metavar="FILE", type=click.Path(path_type=Path), help="Draw what was read into this file.")
@click.option("--json", "as_json", is_flag=True, help="Print one JSON object instead of the tables.")
def command(
    drawing: Path,
    *,
    units: str | None,
    layers: tuple[str, ...],
    ignored_layers: tuple[str, ...],
    join: str | None,
    process: str | None,
    svg: Path | None,
    as_json: bool,
) -> None:
    """Show what is in DRAWING (a DXF file), and what plan would make of it.

    Nothing is planned. Warnings are no failure: the exit code is 0 unless there is nothing to look at.

    \b
    deltacam inspect part.dxf
    deltacam inspect part.dxf --units mm --svg part.svg
    """
    from deltacam.drawing.reader import read_drawing
    from deltacam.inspection.listing import to_dict
    from deltacam.inspection.text import to_text

    if svg is not None:
        _check_picture(svg, drawing)
    own = options.defaults()
    wanted = options.selection(own, layers=layers, ignored_layers=ignored_layers, join=join)
    read = read_drawing(
        drawing,
        unit=options.unit("--units", units),
        default_unit=own.units,
        selection=_with_rules(wanted, process, own.process, f"{own.file}: process"),
        strict=False,
    )
    if svg is not None:
        _draw(read, svg)
    if as_json:
        show_json(to_dict(read))
        return
    click.echo(to_text(read, again=_plan_command()), nl=False)
    if svg is not None:
        from deltacam.plain import plain

        click.echo(f"wrote {plain(str(svg), longest=LONGEST_MESSAGE)}")


def _with_rules(wanted: Selection, process: str | None, own: str | None, where: str) -> Selection:
    """The selection with the rules of the process that would be used to plan."""
    from dataclasses import replace

    from deltacam.cutting.process import DEFAULT_PROCESS, load_process

    found = options.load(load_process, process, own, DEFAULT_PROCESS, where)
    return replace(wanted, rules=found.rules, open=found.open)


def _plan_command() -> str:
    """The command that plans the drawing, with the options that this one was given."""
    context = click.get_current_context()
    words = ["deltacam", "plan", str(context.params["drawing"])]
    for option in context.command.params:
        if isinstance(option, click.Option) and option.name not in ("svg", "as_json"):
            value = context.params[str(option.name)]
            for one in value if option.multiple else (value,):
                words += [option.opts[0], str(one)] if one is not None else []
    return shlex.join(words)


def _check_picture(svg: Path, drawing: Path) -> None:
    """Refuses to write the picture over the drawing.

    Raises:
        DeltacamError: both are one file.
    """
    if svg.exists() and drawing.exists() and svg.samefile(drawing):
        hint = "give the picture a name of its own: --svg part.svg"
        raise DeltacamError("the picture would overwrite the drawing", where="--svg", hint=hint)


def _draw(read: Drawing, svg: Path) -> None:
    """Write the picture, whole or not at all.

    Raises:
        DeltacamError: the operating system refuses.
    """
    from deltacam.inspection.picture import to_svg
    from deltacam.program.atomic import write_whole

    try:
        write_whole(svg, to_svg(read).encode())
    except DeltacamError as problem:
        hint = "choose another file with --svg, in a folder that exists"
        raise DeltacamError(problem.what, where=problem.where, hint=hint) from problem
