"""Options that several commands share, and the values of options that carry a unit.

Values are read by the command and not by click, so that a value that is wrong is an error like any other: with a place,
a hint, in JSON where that is asked for, and after the program of an earlier run is out of the way.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

import click

from deltacam.errors import DeltacamError
from deltacam.units import (
    METRES_PER,
    metres_per,
    parse_angle,
    parse_fine_angle,
    parse_jerk,
    parse_length,
    parse_speed,
    to_mm,
)
from deltacam_cli.main import LONGEST_MESSAGE

if TYPE_CHECKING:
    from deltacam.defaults import Defaults
    from deltacam.model import Selection
    from deltacam.robot.robot import Robot

T = TypeVar("T")
Command = TypeVar("Command", bound=Callable[..., Any])

_READING = (
    click.option(
        "--units",
        metavar="UNIT",
        help=f"What one unit of the drawing is: {', '.join(METRES_PER)}; overrides its header.",
    ),
    click.option(
        "--layer",
        "layers",
        metavar="PATTERN",
        multiple=True,
        help="Only layers of this name, or like it: CUT*; may be repeated.",
    ),
    click.option(
        "--ignore-layer",
        "ignored_layers",
        metavar="PATTERN",
        multiple=True,
        help="No layers of this name, or like it; may be repeated.",
    ),
    click.option("--join", metavar="LENGTH", help="Join ends that are up to so far apart, mm unless a unit is given."),
)


def reading_options(command: Command) -> Command:
    """Add the options that say how a drawing is read.

    The command receives ``units``, ``layers``, ``ignored_layers`` and ``join`` as they were written; `unit` and
    `selection` read them.
    """
    for add in reversed(_READING):
        command = add(command)
    return command


def defaults() -> Defaults:
    """The user's own defaults, from the current folder or the folder for settings; says on stderr where from.

    Raises:
        DeltacamError: the file that holds them is wrong.
    """
    from deltacam.defaults import find
    from deltacam.plain import plain

    found = find([Path(), Path(click.get_app_dir("deltacam"))])
    if found.file:
        click.echo(f"note: defaults from {plain(found.file, longest=LONGEST_MESSAGE)}", err=True)
    return found


def selection(
    defaults: Defaults,
    *,
    layers: tuple[str, ...],
    ignored_layers: tuple[str, ...],
    join: str | None,
    accept_loss: bool = False,
) -> Selection:
    """Which lines of the drawing are read, and how far apart their ends may be.

    Raises:
        DeltacamError: a value is wrong; names the option.
    """
    from deltacam.defaults import JOINING
    from deltacam.model import DEFAULT_JOINING, Selection

    joining = length("--join", join)
    if joining is not None and not JOINING[0] <= joining <= JOINING[1]:
        low, high = map(to_mm, JOINING)
        what = f"{to_mm(joining):.6g} mm is out of range"
        raise DeltacamError(what, where="--join", hint=f"it must be from {low:g} to {high:g} mm")
    for option, patterns in (("--layer", layers), ("--ignore-layer", ignored_layers)):
        if not all(pattern.strip() for pattern in patterns):
            raise DeltacamError("the name of a layer is empty", where=option, hint="leave it away for all layers")
    return Selection(
        layers=layers,
        ignored_layers=ignored_layers,
        joining=next(value for value in (joining, defaults.joining, DEFAULT_JOINING) if value is not None),
        accept_loss=accept_loss,
    )


def load(read: Callable[[str], T], given: str | None, own: str | None, built_in: str, where: str) -> T:
    """What the command line names, else what the user's own defaults name (``where``), else what is built in.

    Raises:
        DeltacamError: what is named cannot be read; where it has no place of its own, names ``where``.
    """
    if given is not None or own is None:
        return read(built_in if given is None else given)
    try:
        return read(own)
    except DeltacamError as problem:
        raise DeltacamError(problem.what, where=problem.where or where, hint=problem.hint) from problem


def robot(name: str | None, own: Defaults) -> Robot:
    """The robot that the command line names, else the user's own, else the built-in one.

    Raises:
        DeltacamError: it cannot be read.
    """
    from deltacam.robot.reader import DEFAULT_ROBOT, load_robot

    return load(load_robot, name, own.robot, DEFAULT_ROBOT, f"{own.file}: robot")


def length(option: str, text: str | None) -> float | None:
    """The length in metres; a bare number is millimetres.

    Raises:
        DeltacamError: it is not a length; names the option.
    """
    return _read(option, text, parse_length)


def speed(option: str, text: str | None) -> float | None:
    """The speed in m/s; a bare number is mm/s.

    Raises:
        DeltacamError: it is not a speed; names the option.
    """
    return _read(option, text, parse_speed)


def angle(option: str, text: str) -> float:
    """The angle in radians; a bare number is degrees.

    Raises:
        DeltacamError: it is not an angle; names the option.
    """
    return _read(option, text, parse_angle) or 0.0


def fine_angle(option: str, text: str | None) -> float | None:
    """The small angle in radians; a bare number is degrees.

    Raises:
        DeltacamError: it is not a small angle; names the option.
    """
    return _read(option, text, parse_fine_angle)


def with_jerk(robot: Robot, text: str | None) -> Robot:
    """The robot with the limit of joint jerk that the command line gives to all joints, or with its own.

    Says on stderr where that is looser than its own.

    Raises:
        DeltacamError: it is not a jerk, or out of range; names the option.
    """
    from deltacam.robot.bounds import BOUNDS

    if text is None:
        return robot
    jerk, bound = _read("--jerk", text, parse_jerk), BOUNDS["max_jerk"]
    if jerk is not None and not bound.to_si(bound.minimum) <= jerk <= bound.to_si(bound.maximum):
        hint = f"it must be from {bound.minimum:g} to {bound.maximum:g} deg/s3, or none"
        raise DeltacamError(f"{math.degrees(jerk):.6g} deg/s3 is out of range", where="--jerk", hint=hint)
    own = robot.joints.max_jerk
    if own and (jerk is None or jerk > min(own)):
        what = "note: --jerk is looser than the robot's own limit; `deltacam verify --robot` checks against that"
        click.echo(what, err=True)
    return replace(robot, joints=replace(robot.joints, max_jerk=None if jerk is None else (jerk, jerk, jerk)))


def unit(option: str, text: str | None) -> str | None:
    """The name of a unit of length.

    Raises:
        DeltacamError: there is no such unit; names the option.
    """
    _read(option, text, metres_per)
    return text


def bounded(
    option: str, text: str, parse: Callable[[str], T | None], bounds: tuple[float, float], said: str
) -> T | None:
    """What ``text`` states, within the bounds, as they are ``said``; None for ``none``.

    Raises:
        DeltacamError: it cannot be read or is out of bounds; names the option.
    """
    value = _read(option, text, parse)
    if value is not None and not bounds[0] <= value <= bounds[1]:  # type: ignore[operator]
        raise DeltacamError(f"{text.strip()} is out of range", where=option, hint=f"it must be {said}, or none")
    return value


def place(option: str, text: str) -> tuple[float, float]:
    """Two lengths in metres, written ``X,Y``; bare numbers are millimetres.

    Raises:
        DeltacamError: it is not a place; names the option.
    """
    x, comma, y = text.partition(",")
    if not comma:
        raise DeltacamError(f"{text!r} is not a place", where=option, hint="write it like 20,-15")
    return length(option, x) or 0.0, length(option, y) or 0.0


def _read(option: str, text: str | None, parse: Callable[[str], T]) -> T | None:
    try:
        return None if text is None else parse(text)
    except DeltacamError as problem:
        raise DeltacamError(problem.what, where=option, hint=problem.hint) from problem
