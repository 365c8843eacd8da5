"""Reads the values of options that carry a unit.

They are read by the command and not by click, so that a value that is wrong is an error like any other: with a place, a
hint, in JSON where that is asked for, and after the program of an earlier run is out of the way.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

from deltacam.errors import DeltacamError
from deltacam.units import metres_per, parse_angle, parse_length, parse_speed

T = TypeVar("T")


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


def unit(option: str, text: str | None) -> str | None:
    """The name of a unit of length.

    Raises:
        DeltacamError: there is no such unit; names the option.
    """
    _read(option, text, metres_per)
    return text


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
