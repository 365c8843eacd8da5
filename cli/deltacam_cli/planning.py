"""What the commands that plan take from the command line and from the user's own defaults."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

import click

from deltacam_cli import options

if TYPE_CHECKING:
    from deltacam.defaults import Defaults
    from deltacam.model import Process

Command = TypeVar("Command", bound=Callable[..., Any])

JOBS = click.IntRange(0, 64)

_MACHINE = (
    click.option("--robot", help="A built-in robot, or a robot file (.toml). Without deltacam.toml: delta-300."),
    click.option("--process", help="A built-in process, or a file (.toml). Without deltacam.toml: steel-1mm-fibre."),
)
_VALUES = (
    click.option("--accept-loss", is_flag=True, help="Plan what could be read of a damaged drawing."),
    click.option("--kerf", metavar="LENGTH", help="Width of the cut, mm unless a unit is given (0.008in)."),
    click.option("--feed", metavar="SPEED", help="Cutting speed, mm/s unless a unit is given (12m/min)."),
    click.option(
        "--tolerance", metavar="LENGTH", help="Largest deviation from the kerf path, mm unless a unit is given."
    ),
    click.option("--corner", type=click.Choice(["round", "stop"]), help="Round corners within the tolerance, or stop."),
    click.option(
        "--jerk", metavar="JERK", help="Largest joint jerk, deg/s3 (or 3500rad/s3), or none; else the robot's."
    ),
)


def planning_options(command: Command) -> Command:
    """Add the options that say with what a drawing is planned; `settings` reads them."""
    for add in reversed(_VALUES):
        command = add(command)
    command = options.reading_options(command)
    for add in reversed(_MACHINE):
        command = add(command)
    return command


def settings(
    own: Defaults,
    *,
    robot: str | None,
    jerk: str | None,
    process: str | None,
    units: str | None,
    layers: tuple[str, ...],
    ignored_layers: tuple[str, ...],
    join: str | None,
    accept_loss: bool,
    **single_values: str | None,
) -> dict[str, Any]:
    """What `planning_options` and the user's own defaults say, as the pipeline takes it.

    Raises:
        DeltacamError: a value is wrong; names the option.
    """
    selection = options.selection(own, layers=layers, ignored_layers=ignored_layers, join=join, accept_loss=accept_loss)
    return {
        "robot": options.with_jerk(options.robot(robot, own), jerk),
        "process": _process(process, own, **single_values),
        "unit": options.unit("--units", units),
        "default_unit": own.units,
        "selection": selection,
    }


def _process(
    name: str | None, own: Defaults, *, kerf: str | None, feed: str | None, tolerance: str | None, corner: str | None
) -> Process:
    """The process with the single values that the command line gives."""
    from deltacam.cutting.process import DEFAULT_PROCESS, load_process

    values: dict[str, Any] = {
        "kerf": options.length("--kerf", kerf),
        "feed": options.speed("--feed", feed),
        "tolerance": options.length("--tolerance", tolerance),
        "corner": corner,
    }
    process = options.load(load_process, name, own.process, DEFAULT_PROCESS, f"{own.file}: process")
    return replace(process, **{key: value for key, value in values.items() if value is not None})
