"""What the options of an import say, as text."""

from __future__ import annotations

import re

from deltacam.errors import RobotError
from deltacam.robot.importers.complete import Sheet
from deltacam.units import metres_per, parse_angle, parse_length


def to_sheet(text: str) -> Sheet:
    """The sheet that ``300x300``, ``r150`` (a disc), ``300x300@-650`` or ``12inx12in@-25in`` names; mm unless it says.

    Raises:
        DeltacamError: it names none.
    """
    size, at, height = text.partition("@")
    disc = re.fullmatch(r"\s*r\s*(.+)", size, flags=re.IGNORECASE)
    sides = re.split(r"\s*x\s*", size.strip(), flags=re.IGNORECASE)
    if (disc is None and len(sides) != 2) or (at and not height.strip()):
        hint = "write it like 300x300@-650, or r150@-650 for a disc: size, @, height"
        raise RobotError(f"{text[:40]!r} is not a sheet", hint=hint)
    z = parse_length(height) if at else None
    if disc:
        return Sheet(radius=parse_length(disc[1]), z=z)
    return Sheet(width=parse_length(sides[0]), depth=parse_length(sides[1]), z=z)


def to_range(text: str) -> tuple[float, float]:
    """The smallest and the largest angle, rad, that ``-45..95`` names; degrees unless it says.

    Raises:
        DeltacamError: it names none.
    """
    low, dots, high = text.partition("..")
    if not dots:
        raise RobotError(f"{text[:40]!r} is not a range of angles", hint="write it like --joints=-45..95")
    return parse_angle(low), parse_angle(high)


def to_millimetres(unit: str) -> float:
    """How many millimetres one ``unit`` is.

    Raises:
        DeltacamError: the unit is not known.
    """
    return round(metres_per(unit) * 1e3, 9)
