"""Conversion between SI and the units that people write.

Inside deltacam every quantity is SI. These functions stand at the edges: command line, TOML, DXF, reports.
"""

from __future__ import annotations

import math
import re
from typing import Final

from deltacam.errors import DeltacamError

METRES_PER: Final[dict[str, float]] = {
    "um": 1e-6,
    "mm": 1e-3,
    "cm": 1e-2,
    "m": 1.0,
    "mil": 25.4e-6,
    "in": 25.4e-3,
    "ft": 0.3048,
    "pt": 25.4e-3 / 72.0,
}
"""Metres in one of each unit of length that deltacam accepts."""

_LENGTH_ALIASES: Final[dict[str, str]] = {
    "µm": "um",
    "inch": "in",
    "inches": "in",
    '"': "in",
    "feet": "ft",
    "points": "pt",
}
_SECONDS_PER: Final[dict[str, float]] = {"s": 1.0, "min": 60.0}
_NUMBER: Final = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")


def to_mm(metres: float) -> float:
    """The length in millimetres."""
    return metres * 1e3


def to_um(metres: float) -> float:
    """The length in micrometres."""
    return metres * 1e6


def metres_per(unit: str) -> float:
    """How many metres one ``unit`` is.

    Raises:
        DeltacamError: the unit is not known.
    """
    key = _LENGTH_ALIASES.get(unit.lower(), unit.lower())
    if key not in METRES_PER:
        raise DeltacamError(f"unknown unit of length {unit!r}", hint=f"use one of {', '.join(METRES_PER)}")
    return METRES_PER[key]


def parse_length(text: str) -> float:
    """The length in metres that ``text`` states; a bare number is millimetres: ``0.2``, ``0.2mm``, ``0.008in``.

    Raises:
        DeltacamError: not a finite number, or an unknown unit.
    """
    value, unit = _split(text, "length", "0.2mm or 0.008in")
    return value * metres_per(unit or "mm")


def parse_speed(text: str) -> float:
    """The speed in m/s that ``text`` states; a bare number is mm/s: ``200``, ``12m/min``, ``8in/s``.

    Raises:
        DeltacamError: not a finite number, or an unknown unit.
    """
    value, unit = _split(text, "speed", "200mm/s or 12m/min")
    length, slash, time = (unit or "mm/s").partition("/")
    if not slash or time not in _SECONDS_PER:
        raise DeltacamError(f"unknown unit of speed {unit!r}", hint="use mm/s, m/s, m/min, mm/min or in/s")
    return value * metres_per(length) / _SECONDS_PER[time]


def parse_angle(text: str) -> float:
    """The angle in radians that ``text`` states; a bare number is degrees: ``90``, ``90deg``, ``1.57rad``.

    Raises:
        DeltacamError: not a finite number, or an unknown unit.
    """
    value, unit = _split(text, "angle", "90 or 1.5708rad")
    if unit not in ("", "deg", "rad"):
        raise DeltacamError(f"unknown unit of angle {unit!r}", hint="use deg or rad")
    return value if unit == "rad" else math.radians(value)


def _split(text: str, kind: str, example: str) -> tuple[float, str]:
    match = _NUMBER.fullmatch(text)
    value = float(match.group(1)) if match else math.nan
    if match is None or not math.isfinite(value):
        raise DeltacamError(f"{text!r} is not a {kind}", hint=f"write it like {example}")
    return value, match.group(2)
