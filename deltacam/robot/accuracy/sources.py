"""What can be wrong with a delta robot, and by how much."""

from __future__ import annotations

import math
from dataclasses import dataclass
from enum import Enum
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array


class Source(Enum):
    """Where an error comes from; the value is its name in `Errors` and in JSON."""

    ENCODER = "encoder"
    BACKLASH = "backlash"
    UPPER_ARM = "upper_arm"
    FOREARM = "forearm"
    BASE_RADIUS = "base_radius"
    EFFECTOR_RADIUS = "effector_radius"
    AZIMUTH = "azimuth"
    SHEET = "sheet"


PER_ARM: Final = tuple(source for source in Source if source is not Source.SHEET)
"""The sources of which every arm has an error of its own."""

JOINTS: Final = (Source.ENCODER, Source.BACKLASH)
"""The sources that turn a joint. They come and go; all others stay as they are, so that a calibration can find them."""

ANGLES: Final = (*JOINTS, Source.AZIMUTH)
"""The sources that are angles, rad; the others are lengths, m."""

WIDTHS: Final = JOINTS
"""The sources that are given as a whole width; the others are given as +- a limit."""

COUNT: Final = 3 * len(PER_ARM) + 1
"""How many independent errors there are: three for each source, one per arm, and the height of the sheet."""

_LARGEST_ANGLE: Final = math.radians(5.0)
_LARGEST_LENGTH: Final = 50e-3


@dataclass(frozen=True, slots=True)
class Errors:
    """How large the errors may be. Each is taken as uniform within its limits and independent of all others.

    The values that stand here are assumptions about a machine built with care, and none about a certain one.

    Attributes:
        encoder: step of the joints' encoders, rad; a joint is up to half a step beside what is asked.
        backlash: width of the play of a joint, rad; the joint is anywhere within it.
        upper_arm: +- of the length of each upper arm, m.
        forearm: +- of the length of each forearm, m.
        base_radius: +- of the distance of each joint from the centre of the base, m.
        effector_radius: +- of the distance of each forearm's joint from the centre of the effector, m.
        azimuth: +- of the direction in which each arm stands, rad; the effector's joints are not turned with it.
        sheet: +- of the height of the sheet, m.

    Raises:
        RobotError: a value is not finite, negative, or larger than 5 degrees or 50 mm.
    """

    encoder: float = math.tau / 2**16
    backlash: float = math.radians(1.0 / 60.0)
    upper_arm: float = 0.05e-3
    forearm: float = 0.05e-3
    base_radius: float = 0.05e-3
    effector_radius: float = 0.05e-3
    azimuth: float = math.radians(1.0 / 60.0)
    sheet: float = 0.2e-3

    def __post_init__(self) -> None:
        for source in Source:
            value, angle = self.given(source), source in ANGLES
            largest, scale, unit = (_LARGEST_ANGLE, 180.0 / math.pi, "deg") if angle else (_LARGEST_LENGTH, 1e3, "mm")
            if not 0.0 <= value <= largest:  # false for nan
                what = f"an error of {value * scale:.6g} {unit} is out of range"
                hint = f"it must be from 0 to {largest * scale:g} {unit}"
                raise RobotError(what, where=source.value, hint=hint)

    def given(self, source: Source) -> float:
        """The error as it is given: a width or a +- limit, rad or m."""
        return float(getattr(self, source.value))

    def limit(self, source: Source) -> float:
        """How far the error may be from none, rad or m: half of a width."""
        return self.given(source) * limit_per_given(source)

    def limits(self) -> Array:
        """The limit of every independent error, (COUNT,) rad or m, in the order of `columns_of`."""
        return np.array([*(self.limit(source) for source in PER_ARM for _ in range(3)), self.limit(Source.SHEET)])


def limit_per_given(source: Source) -> float:
    """What part of the given error its limit is: half of a width, all of a +-."""
    return 0.5 if source in WIDTHS else 1.0


def columns_of(source: Source) -> slice:
    """Which of the independent errors are of this source: three in the order of the arms, or one for the sheet."""
    if source is Source.SHEET:
        return slice(COUNT - 1, COUNT)
    first = 3 * PER_ARM.index(source)
    return slice(first, first + 3)
