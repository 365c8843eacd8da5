"""What a number of a process may be: in the file's unit, and in SI.

The same table bounds the process file, what the command line puts in its place, and a process that is built in code.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from deltacam.settings import Table


@dataclass(frozen=True, slots=True)
class Bound:
    """The range of a number of a process file.

    Attributes:
        minimum: smallest value allowed, in the file's unit.
        maximum: largest value allowed, in the file's unit.
        per_unit: how many SI units one unit of the file is; a divisor, where that is the exact number.
        divided: whether a value of the file is divided by ``per_unit`` to come to SI, and not multiplied.
        unit: of the file, for people; empty where there is none.
    """

    minimum: float
    maximum: float
    per_unit: float = 1.0
    divided: bool = True
    unit: str = ""

    def to_si(self, value: float) -> float:
        """A value of the file in SI."""
        return value / self.per_unit if self.divided else value * self.per_unit

    def from_si(self, value: float) -> float:
        """An SI value in the unit of the file."""
        return value * self.per_unit if self.divided else value / self.per_unit

    def allows(self, value: float) -> bool:
        """Whether an SI value is in the range; not a number is not."""
        return self.to_si(self.minimum) <= value <= self.to_si(self.maximum)

    @property
    def words(self) -> str:
        """The range: ``0 to 20 mm``."""
        return f"{self.minimum:g} to {self.maximum:g}" + (f" {self.unit}" if self.unit else "")


def _mm(minimum: float, maximum: float) -> Bound:
    return Bound(minimum, maximum, 1e3, unit="mm")


def _um(minimum: float, maximum: float) -> Bound:
    return Bound(minimum, maximum, 1e6, unit="um")


def _degrees(minimum: float, maximum: float) -> Bound:
    return Bound(minimum, maximum, math.pi / 180.0, divided=False, unit="deg")  # as math.radians has it


_FEED: Final = Bound(0.0006, 1000.0, 60.0, unit="m/min")
_SHARE: Final = Bound(0.001, 1.0)

BOUNDS: Final[dict[str, Bound]] = {
    "thickness_mm": _mm(0.0, 200.0),
    "laser_power_w": Bound(0.0, 200_000.0, unit="W"),
    "kerf_mm": _mm(0.0, 20.0),
    "feed_m_min": _FEED,
    "power": _SHARE,
    "pierce_time_s": Bound(0.0, 60.0, unit="s"),
    "overcut_mm": _mm(0.0, 50.0),
    "passes": Bound(1, 100),
    "tolerance_um": _um(2.0, 1000.0),
    "chord_tolerance_um": _um(2.0, 1000.0),
    "engrave.feed_m_min": _FEED,
    "engrave.power": _SHARE,
    "lead.length_mm": _mm(0.05, 100.0),
    "lead.radius_mm": _mm(0.05, 50.0),
    "lead.angle_deg": _degrees(0.0, 90.0),
    "pierce.power": _SHARE,
    "power_law.at_rest": Bound(0.0, 1.0),
    "power_law.exponent": Bound(0.1, 10.0),
    "power_law.lowest": Bound(0.0, 1.0),
    "slower.factor": Bound(0.01, 1.0),
    "slower.hole_diameter_mm": _mm(0.01, 1000.0),
    "slower.radius_mm": _mm(0.01, 1000.0),
    "loops.angle_deg": _degrees(10.0, 180.0),
    "loops.radius_mm": _mm(0.05, 50.0),
    "tabs.width_mm": _mm(0.01, 20.0),
    "tabs.count": Bound(0, 1000),
    "tabs.spacing_mm": _mm(1.0, 10_000.0),
    "tabs.corner_mm": _mm(0.0, 1000.0),
    "heat.distance_mm": _mm(0.0, 10_000.0),
    "heat.time_s": Bound(0.0, 3600.0, unit="s"),
    "gases.pressure_bar": Bound(0.0, 100.0, 1e5, divided=False, unit="bar"),
    "gases.feed_factor": Bound(0.01, 100.0),
}
"""The numbers by their place in the file: its section, where it is in one, and its key."""


def read(table: Table, name: str, default: float | None = None) -> float:
    """The number called ``name`` in `BOUNDS`, in SI; ``default``, in the file's unit, where the file has none.

    Raises:
        DeltacamError: it is missing without a default, not a number, or out of range.
    """
    bound, key = BOUNDS[name], name.rpartition(".")[2]
    if default is None:
        return bound.to_si(table.number(key, minimum=bound.minimum, maximum=bound.maximum))
    return bound.to_si(table.number(key, minimum=bound.minimum, maximum=bound.maximum, default=default))


def read_optional(table: Table, name: str) -> float | None:
    """As `read`; None where the file has none.

    Raises:
        DeltacamError: it is not a number, or out of range.
    """
    return read(table, name) if table.has(name.rpartition(".")[2]) else None


def read_whole(table: Table, name: str, default: int) -> int:
    """The whole number called ``name`` in `BOUNDS`.

    Raises:
        DeltacamError: it is not a whole number, or out of range.
    """
    bound = BOUNDS[name]
    key = name.rpartition(".")[2]
    return table.integer(key, minimum=int(bound.minimum), maximum=int(bound.maximum), default=default)
