"""The options that change single values of a process, and how they are read."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Any, Final, cast

import click

from deltacam.errors import DeltacamError
from deltacam_cli import options

if TYPE_CHECKING:
    from deltacam.model import Lead, LeadShape, Process, Tabs

_SHAPES: Final = ("none", "line", "arc", "line+arc")
_AUTO: Final = "auto"

TAB_WIDTH: Final = 0.5e-3
"""How wide tabs are where neither the command line nor the process says, m."""

PROCESS_OPTIONS: Final = (
    click.option("--kerf", metavar="LENGTH", help="Width of the cut, mm unless a unit is given (0.008in)."),
    click.option("--feed", metavar="SPEED", help="Cutting speed, mm/s unless a unit is given (12m/min)."),
    click.option("--power", metavar="SHARE", help="Share of the laser's rated power while cutting, 0.001 to 1."),
    click.option("--gas", metavar="NAME", help="Another of the gases that the process knows, with the feed for it."),
    click.option(
        "--tolerance", metavar="LENGTH", help="Largest deviation from the kerf path, mm unless a unit is given."
    ),
    click.option(
        "--corner",
        type=click.Choice(["round", "stop", "loop"]),
        help="Round corners within the tolerance, stop in them, or loop through the waste.",
    ),
    click.option(
        "--lead-in", metavar="SHAPE[:LENGTH]", help=f"How cuts begin: {', '.join(_SHAPES)}; mm, or {_AUTO} (default)."
    ),
    click.option(
        "--lead-out", metavar="SHAPE[:LENGTH]", help="How cuts end, with the laser off, written like --lead-in."
    ),
    click.option(
        "--start",
        type=click.Choice(["best", "edge", "corner"]),
        help="Where closed cuts begin: best for the order, middle of the longest edge, or a corner.",
    ),
    click.option("--overcut", metavar="LENGTH", help="How far the laser stays on beyond the start of a closed cut."),
    click.option("--tabs", metavar="N[:WIDTH]", help="So many bridges hold every outline in the sheet; 0 for none."),
    click.option("--passes", metavar="N", help="How often every cut is run."),
    click.option(
        "--common-edges/--no-common-edges",
        default=None,
        help="Cut edges that two parts share, one kerf apart, once; else as the process says.",
    ),
)


def with_options(
    process: Process,
    *,
    gas: str | None,
    feed: str | None,
    power: str | None,
    tabs: str | None,
    lead_in: str | None,
    lead_out: str | None,
    common_edges: bool | None = None,
    **single_values: str | None,
) -> Process:
    """The process with the values that the command line gives; a feed given is that with the gas in use.

    Raises:
        DeltacamError: a value cannot be read, or the process knows nothing of the gas; names the option.
    """
    if gas is not None:
        process = _with_gas(process, gas)
    values: dict[str, Any] = {
        "kerf": options.length("--kerf", single_values["kerf"]),
        "feed": _feed(process, feed),
        "power": share("--power", power),
        "tolerance": options.length("--tolerance", single_values["tolerance"]),
        "corner": single_values["corner"],
        "start": single_values["start"],
        "overcut": options.length("--overcut", single_values["overcut"]),
        "passes": None if single_values["passes"] is None else whole("--passes", single_values["passes"]),
        "lead_in": None if lead_in is None else lead("--lead-in", lead_in, process.lead_in),
        "lead_out": None if lead_out is None else lead("--lead-out", lead_out, process.lead_out),
        "common_edges": common_edges,
    }
    changed = replace(process, **{key: value for key, value in values.items() if value is not None})
    return changed if tabs is None else replace(changed, tabs=_tabs(tabs, process.tabs))


def share(option: str, text: str | None) -> float | None:
    """The number that ``text`` states.

    Raises:
        DeltacamError: it is none; names the option.
    """
    if text is None:
        return None
    try:
        return float(text)
    except ValueError as problem:
        hint = "write it like 0.8, a share of the laser's rated power"
        raise DeltacamError(f"{text!r} is not a number", where=option, hint=hint) from problem


def whole(option: str, text: str) -> int:
    """The whole number that ``text`` states.

    Raises:
        DeltacamError: it is none, or negative; names the option.
    """
    if not (text.strip().isascii() and text.strip().isdigit()) or len(text) > 9:
        raise DeltacamError(f"{text!r} is not a whole number", where=option, hint="write it like 2")
    return int(text)


def lead(option: str, text: str, own: Lead) -> Lead:
    """The lead that ``text`` states, ``SHAPE[:LENGTH]``; radius and angle are those of ``own`` for the same shape.

    Raises:
        DeltacamError: no such shape, or not a length; names the option.
    """
    from deltacam.model import Lead

    shape, colon, length = text.strip().partition(":")
    if shape not in _SHAPES:
        hint = f"write it like line+arc or line:3; shapes are {', '.join(_SHAPES)}"
        raise DeltacamError(f"{shape!r} is not a shape of leads", where=option, hint=hint)
    if shape == "none" and colon:
        raise DeltacamError("a lead of shape none has no length", where=option, hint="write none alone")
    metres = None if not colon or length.strip() == _AUTO else options.length(option, length)
    if own.shape == shape and own.shape != "none":
        return replace(own, length=metres, radius=None if shape == "arc" and metres is not None else own.radius)
    return Lead(shape=cast("LeadShape", shape), length=metres)


def _with_gas(process: Process, name: str) -> Process:
    from deltacam.cutting.gas import with_gas

    try:
        return with_gas(process, name)
    except DeltacamError as problem:
        raise DeltacamError(problem.what, where="--gas", hint=problem.hint) from problem


def _feed(process: Process, text: str | None) -> float | None:
    """The feed; says on stderr where it is outside of what the process calls sensible."""
    feed = options.speed("--feed", text)
    if feed is not None and process.feeds is not None and not process.feeds[0] <= feed <= process.feeds[1]:
        low, high = (f"{value * 60.0:.4g}" for value in process.feeds)
        click.echo(f"note: --feed is outside of {low} to {high} m/min, the range of process {process.name}", err=True)
    return feed


def _tabs(text: str, own: Tabs | None) -> Tabs | None:
    """The tabs that ``text`` states, ``N[:WIDTH]``, with what the process says of them otherwise."""
    from deltacam.model import Tabs

    number, colon, width = text.partition(":")
    count = whole("--tabs", number)
    if count == 0:
        return None
    metres = options.length("--tabs", width) if colon else None
    if metres is None:
        metres = TAB_WIDTH if own is None else own.width
    return replace(own or Tabs(metres), width=metres, count=count, spacing=None)
