"""What the commands that plan take from the command line and from the user's own defaults."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Final, TypeVar

import click

from deltacam_cli import options
from deltacam_cli.process_options import PROCESS_OPTIONS, with_options

if TYPE_CHECKING:
    from deltacam.defaults import Defaults
    from deltacam.model import Process

Command = TypeVar("Command", bound=Callable[..., Any])

JOBS = click.IntRange(0, 64)
_ORDER_TIME = (0.0, 86_400.0)  # s

_HOW = (
    click.option("--at", metavar="X,Y", help="Where the part's centre goes, mm; without it 0,0."),
    click.option("--rotate", metavar="ANGLE", help="Turn the part by so many degrees."),
    click.option(
        "--place",
        type=click.Choice(["auto", "time", "accuracy"]),
        help="Find the place and the turn: by time and accuracy (auto), or by one of them.",
    ),
    click.option(
        "--order-time", metavar="TIME", help="About how long the order of the cuts is looked for, seconds (or 2min)."
    ),
    click.option(
        "--order-seed", type=click.IntRange(0), default=0, metavar="N", help="Another one may find another order."
    ),
    click.option("--parts-together", is_flag=True, help="Cut all of a part before the next one."),
    click.option("--dry-run", is_flag=True, help="The same motion with the laser off."),
    click.option("--frame", is_flag=True, help="Only trace the bounding box, with the laser off."),
    click.option(
        "--what-if/--no-what-if",
        default=None,
        help="Also say how long each cut would take without each limit. Without either: where that is quick.",
    ),
)

HOW_NAMES: Final = (
    "at",
    "rotate",
    "place",
    "order_time",
    "order_seed",
    "parts_together",
    "dry_run",
    "frame",
    "what_if",
)
"""What `how_options` are called where `how` takes them."""

_MACHINE = (
    click.option("--robot", help="A built-in robot, or a robot file (.toml). Without deltacam.toml: delta-300."),
    click.option("--process", help="A built-in process, or a file (.toml). Without deltacam.toml: steel-1mm-fibre."),
)
_VALUES = (
    click.option("--accept-loss", is_flag=True, help="Plan what could be read of a damaged drawing."),
    *PROCESS_OPTIONS,
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


def how_options(command: Command) -> Command:
    """Add the options that say where a part goes and what is done with it; `how` reads them."""
    for add in reversed(_HOW):
        command = add(command)
    return command


def how(
    *,
    at: str | None,
    rotate: str | None,
    place: str | None,
    order_time: str | None,
    order_seed: int,
    parts_together: bool,
    dry_run: bool,
    frame: bool,
    what_if: bool | None,
    starts: tuple[str, ...] = (),
) -> dict[str, Any]:
    """What `how_options` say, as the pipeline takes it.

    Raises:
        DeltacamError: a value is wrong; names the option.
        UsageError: two options exclude each other.
    """
    from deltacam.model import Mode, Search
    from deltacam.units import parse_duration

    if dry_run and frame:
        raise click.UsageError("--dry-run and --frame exclude each other")
    if place is not None and (at is not None or rotate is not None):
        raise click.UsageError("--place finds the place and the turn; --at and --rotate give them")
    given = {"at": options.place("--at", at or "0,0"), "rotation": options.angle("--rotate", rotate or "0")}
    time = None
    if order_time is not None:
        time = options.bounded("--order-time", order_time, parse_duration, _ORDER_TIME, "from 0 s to 24 h")
    found = {"place": "both" if place == "auto" else place}
    return {
        "mode": Mode.FRAME if frame else Mode.DRY_RUN if dry_run else Mode.CUT,
        "search": Search(time, order_seed, parts_together, tuple(options.place("--start-at", one) for one in starts)),
        "what_if": what_if,
        **(given if place is None else found),
    }


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
    **single_values: Any,
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


def _process(name: str | None, own: Defaults, **single_values: Any) -> Process:
    """The process with the single values that the command line gives."""
    from deltacam.cutting.process import DEFAULT_PROCESS, load_process

    process = options.load(load_process, name, own.process, DEFAULT_PROCESS, f"{own.file}: process")
    return with_options(process, **single_values)
