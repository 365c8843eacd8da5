"""What a number of the robot file may be, in the file's unit and in SI.

The same table bounds the robot file, the robot in a program file, and a robot that is built in code, so that a value
that one of them takes is taken by all of them.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Final

from deltacam.errors import RobotError


@dataclass(frozen=True, slots=True)
class Bound:
    """The unit of a quantity and the range of its values.

    Attributes:
        key: its name in the robot file, which ends in the unit.
        minimum: smallest value allowed, in the file's unit.
        maximum: largest value allowed, in the file's unit.
        to_si: a value of the file in SI; strictly increasing, so that the range is the same in both units.
        unit: the SI unit, for messages.
    """

    key: str
    minimum: float
    maximum: float
    to_si: Callable[[float], float]
    unit: str

    def check(self, name: str, values: Sequence[float], where: str) -> None:
        """Refuse SI ``values`` that are not finite or out of range.

        Raises:
            RobotError: the first value outside the range, and the range in SI.
        """
        low, high = self.to_si(self.minimum), self.to_si(self.maximum)
        for value in values:
            if not low <= value <= high:  # also true of nan
                raise RobotError(f"{name} = {value:.6g} {self.unit} is outside {low:.6g} to {high:.6g}", where=where)


def _from_mm(value: float) -> float:
    return value / 1e3


def _radius_from_side_mm(value: float) -> float:
    """The radius of the circle that touches the sides of an equilateral triangle at their middles."""
    return value / 1e3 / (2.0 * math.sqrt(3.0))


def _from_per_minute(value: float) -> float:
    return value / 60.0


BOUNDS: Final[dict[str, Bound]] = {
    "base_radius": Bound("base_radius_mm", 0.0, 10_000.0, _from_mm, "m"),
    "effector_radius": Bound("effector_radius_mm", 0.0, 10_000.0, _from_mm, "m"),
    "upper_arm": Bound("upper_arm_mm", 1.0, 10_000.0, _from_mm, "m"),
    "forearm": Bound("forearm_mm", 1.0, 10_000.0, _from_mm, "m"),
    "base_side": Bound("base_side_mm", 0.0, 34_641.0, _radius_from_side_mm, "m"),
    "effector_side": Bound("effector_side_mm", 0.0, 34_641.0, _radius_from_side_mm, "m"),
    "azimuths": Bound("azimuths_deg", -360.0, 360.0, math.radians, "rad"),
    "mount_x": Bound("x_mm", -20_000.0, 20_000.0, _from_mm, "m"),
    "mount_y": Bound("y_mm", -20_000.0, 20_000.0, _from_mm, "m"),
    "mount_z": Bound("z_mm", -20_000.0, 20_000.0, _from_mm, "m"),
    "mount_rotation": Bound("rotation_deg", -360.0, 360.0, math.radians, "rad"),
    "min": Bound("min_deg", -180.0, 180.0, math.radians, "rad"),
    "max": Bound("max_deg", -180.0, 180.0, math.radians, "rad"),
    "max_speed": Bound("max_speed_deg_s", 1e-3, 1e6, math.radians, "rad/s"),
    "max_acceleration": Bound("max_acceleration_deg_s2", 1e-3, 1e9, math.radians, "rad/s^2"),
    "max_jerk": Bound("max_jerk_deg_s3", 1e-3, 1e12, math.radians, "rad/s^3"),
    "tool_max_speed": Bound("max_speed_m_min", 1e-3, 1_000.0, _from_per_minute, "m/s"),
    "tool_max_acceleration": Bound("max_acceleration_m_s2", 1e-3, 10_000.0, float, "m/s^2"),
    "sheet_z": Bound("sheet_z_mm", -40_000.0, 40_000.0, _from_mm, "m"),
    "width": Bound("width_mm", 1.0, 20_000.0, _from_mm, "m"),
    "depth": Bound("depth_mm", 1.0, 20_000.0, _from_mm, "m"),
    "radius": Bound("radius_mm", 1.0, 10_000.0, _from_mm, "m"),
    "park": Bound("park_mm", -10_000.0, 10_000.0, _from_mm, "m"),
    "max_pressure_angle": Bound("max_pressure_angle_deg", 1.0, 89.0, math.radians, "rad"),
    "max_forearm_swing": Bound("max_forearm_swing_deg", 1.0, 90.0, math.radians, "rad"),
    "rate_hz": Bound("rate_hz", 1.0, 100_000.0, float, "Hz"),
}
"""The range of every number of a robot, by the name of its field; ``tool_`` and ``mount_`` start those of these two."""
