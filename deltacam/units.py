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

_OTHER_SPELLINGS: Final[dict[str, tuple[str, ...]]] = {
    "um": ("\N{MICRO SIGN}m", "\N{GREEK SMALL LETTER MU}m", "micron", "microns"),
    "mm": ("millimetre", "millimetres", "millimeter", "millimeters"),
    "cm": ("centimetre", "centimetres", "centimeter", "centimeters"),
    "m": ("metre", "metres", "meter", "meters"),
    "mil": ("mils", "thou"),
    "in": ("inch", "inches", '"'),
    "ft": ("foot", "feet", "'"),
    "pt": ("point", "points"),
}
_LENGTH_ALIASES: Final = {other: unit for unit, others in _OTHER_SPELLINGS.items() for other in others}
_FINE_ANGLES: Final = {
    "arcmin": math.radians(1.0 / 60.0),
    "arcsec": math.radians(1.0 / 3600.0),
    "deg": math.radians(1.0),
    "rad": 1.0,
}
_SECONDS_PER: Final[dict[str, float]] = {"s": 1.0, "min": 60.0}
_LONGER_TIMES: Final[dict[str, float]] = {**_SECONDS_PER, "h": 3600.0}
_BYTES_PER: Final[dict[str, float]] = {"mb": 1e6, "gb": 1e9, "mib": 2.0**20, "gib": 2.0**30}

USUAL_SIZES: Final = (10e-3, 1.5)
"""Smallest and largest size of a part that is no surprise, m."""

POSSIBLE_SIZES: Final = (0.1e-3, 10.0)
"""Smallest and largest size of a drawing that can be meant, m."""

_GUESSES: Final = (
    (("mm", "in", "cm", "m"), USUAL_SIZES),
    (("mm", "in", "cm", "m"), (1e-3, POSSIBLE_SIZES[1])),
)
"""Units and sizes, those that are likeliest first."""

_RARE: Final = ("mil", "um")
"""Units that are likely only where no other one is."""

_ISO_SIDES: Final = (419.53, 595.28, 841.89, 1190.55, 1683.78, 2383.94)
"""Sides of the sheets A5 to A1 in points; hardly a length that somebody draws in millimetres."""

_US_SHEETS: Final = ((612.0, 792.0), (612.0, 1008.0), (792.0, 1224.0))
"""Letter, legal and tabloid in points."""

_SAME_SIDE: Final = 0.01

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
    word = unit.strip().lower()
    key = _LENGTH_ALIASES.get(word, word)
    if key not in METRES_PER:
        raise DeltacamError(f"unknown unit of length {unit!r}", hint=f"use one of {', '.join(METRES_PER)}")
    return METRES_PER[key]


def likely_units(width: float, height: float) -> tuple[str, ...]:
    """The units in which a drawing would be of a size that parts have, the likeliest first; to propose, not to choose.

    Args:
        width: of the drawing in its own numbers, >= 0.
        height: likewise.
    """
    larger = max(width, height)
    found = ["pt"] if _is_page(width, height) else []
    for units, sizes in _GUESSES:
        found += [unit for unit in units if _within(larger * METRES_PER[unit], sizes)]
    rare = [unit for unit in _RARE if _within(larger * METRES_PER[unit], USUAL_SIZES)]
    return tuple(dict.fromkeys(found or rare))


def _within(size: float, sizes: tuple[float, float]) -> bool:
    return sizes[0] <= size <= sizes[1]


def _is_page(width: float, height: float) -> bool:
    """Whether this is the size of a sheet of paper in points, as programs for drawing write it."""
    sides = sorted((width, height))
    iso = any(abs(side - known) <= _SAME_SIDE for side in sides for known in _ISO_SIDES)
    us = any(all(abs(s - k) <= _SAME_SIDE for s, k in zip(sides, sheet, strict=True)) for sheet in _US_SHEETS)
    return iso or us


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


def parse_fine_angle(text: str) -> float:
    """The small angle in radians that ``text`` states: ``1arcmin``, ``20arcsec``, ``0.01deg``, ``1e-4rad``, ``16bit``.

    A bare number is degrees; ``16bit`` is the step of an encoder that divides a turn into 2^16.

    Raises:
        DeltacamError: not a finite number, an unknown unit, or a number of bits that is not 1 to 64 and whole.
    """
    value, unit = _split(text, "small angle", "1arcmin or 0.01deg")
    if unit == "bit":
        if not (1.0 <= value <= 64.0 and value.is_integer()):
            raise DeltacamError(f"an encoder of {value:g} bit is not possible", hint="write it like 16bit")
        return math.ldexp(math.tau, -int(value))
    unit = unit or "deg"
    if unit not in _FINE_ANGLES:
        raise DeltacamError(f"unknown unit of angle {unit!r}", hint=f"use {', '.join(_FINE_ANGLES)} or bit")
    return value * _FINE_ANGLES[unit]


def parse_jerk(text: str) -> float | None:
    """The jerk of a joint in rad/s^3 that ``text`` states: ``200000``, ``3500rad/s3``; None for ``none``.

    A bare number is deg/s3.

    Raises:
        DeltacamError: neither ``none`` nor a finite number, or an unknown unit.
    """
    if text.strip().lower() == "none":
        return None
    value, unit = _split(text, "jerk", "200000, 3500rad/s3 or none")
    if unit not in ("", "deg/s3", "rad/s3"):
        raise DeltacamError(f"unknown unit of jerk {unit!r}", hint="use deg/s3 or rad/s3")
    return value if unit == "rad/s3" else math.radians(value)


def parse_duration(text: str) -> float | None:
    """The time in seconds that ``text`` states; a bare number is seconds: ``90``, ``10min``, ``2h``; None for ``none``.

    Raises:
        DeltacamError: neither ``none`` nor a finite number, or an unknown unit.
    """
    if text.strip().lower() == "none":
        return None
    value, unit = _split(text, "duration", "90s, 10min or none")
    if (unit or "s") not in _LONGER_TIMES:
        raise DeltacamError(f"unknown unit of time {unit!r}", hint="use s, min or h")
    return value * _LONGER_TIMES[unit or "s"]


def parse_memory(text: str) -> int | None:
    """The bytes that ``text`` states; a bare number is GB: ``2``, ``1.5GB``, ``800MB``; None for ``none``.

    Raises:
        DeltacamError: neither ``none`` nor a finite number, or an unknown unit.
    """
    if text.strip().lower() == "none":
        return None
    value, unit = _split(text, "size of memory", "2GB, 800MB or none")
    if (unit or "GB").lower() not in _BYTES_PER:
        raise DeltacamError(f"unknown unit of memory {unit!r}", hint="use MB, GB, MiB or GiB")
    return round(value * _BYTES_PER[(unit or "GB").lower()])


def _split(text: str, kind: str, example: str) -> tuple[float, str]:
    match = _NUMBER.fullmatch(text)
    value = float(match.group(1)) if match else math.nan
    if match is None or not math.isfinite(value):
        raise DeltacamError(f"{text!r} is not a {kind}", hint=f"write it like {example}")
    return value, match.group(2)
