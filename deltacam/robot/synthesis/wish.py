"""What is asked of a robot that is yet to be dimensioned."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from deltacam.errors import RobotError
from deltacam.robot.synthesis.shape import BoxShape, CylinderShape

LARGEST_SIZE: Final = 5.0
"""How large a robot may become where nothing else is asked, in diagonals of its workspace.

Any dexterity can be bought with size: seen from far enough away, the workspace is one pose. A cube of 200 mm takes
3.7 diagonals for 1/cond of 0.9 all over, and 5.3 for 0.95.
"""

CLEARANCE: Final = 0.001
"""Least distance from the base to the top of the workspace where nothing else is asked, m."""


@dataclass(frozen=True, slots=True)
class Wish:
    """The prescribed workspace and the demands that hold everywhere in it; None asks nothing.

    Attributes:
        shape: the workspace, about the robot's axis; its height above or below the base is found by the synthesis.
        joint_min: smallest joint angle, rad.
        joint_max: largest joint angle, rad.
        min_inverse_condition: smallest 1/cond of the Jacobian, 0 to 1.
        max_transmission_angle: largest pressure angle mu2, rad.
        max_drive_angle: largest pressure angle mu1, rad.
        max_forearm_swing: largest lean of a forearm out of its arm's plane, rad.
        base_radius_min: smallest base radius, the room for the motors, m.
        head_radius: the radius of the effector, the room for the head, m.
        clearance: least distance from the base down to the workspace, m.
        max_size: largest (R - r) + La + Lb, m; None for `LARGEST_SIZE` diagonals.
        speed: of the tool in any direction of the plane, m/s; asked with `max_joint_speed` or acceleration.
        acceleration: of the tool in any direction of the plane, m/s^2.
        max_joint_speed: what a joint may need for that speed, rad/s.
        max_joint_acceleration: what a joint may need for that speed and acceleration together, rad/s^2.
        max_error: largest distance the tool moves when the three joints err by up to `encoder_step`, m.
        encoder_step: the error of one joint, rad.

    Raises:
        RobotError: a value is out of range, or one of a pair is missing.
    """

    shape: BoxShape | CylinderShape
    joint_min: float = math.radians(-50.0)
    joint_max: float = math.radians(90.0)
    min_inverse_condition: float = 0.33
    max_transmission_angle: float = math.radians(60.0)
    max_drive_angle: float | None = None
    max_forearm_swing: float | None = None
    base_radius_min: float | None = None
    head_radius: float | None = None
    clearance: float = CLEARANCE
    max_size: float | None = None
    speed: float | None = None
    acceleration: float | None = None
    max_joint_speed: float | None = None
    max_joint_acceleration: float | None = None
    max_error: float | None = None
    encoder_step: float | None = None

    def __post_init__(self) -> None:
        for name, (low, high, unit, scale) in _RANGES.items():
            value = getattr(self, name)
            if value is not None and not low <= value * scale <= high:  # also true of nan
                what = f"{name} = {value * scale:.6g}{unit} is outside {low:g} to {high:g}{unit}"
                raise RobotError(what, where="demands")
        if self.joint_min >= self.joint_max:
            low_deg, high_deg = math.degrees(self.joint_min), math.degrees(self.joint_max)
            raise RobotError(f"joint_min {low_deg:g} deg is not below joint_max {high_deg:g} deg", where="demands")
        for name, needed in _NEEDS:
            if getattr(self, name) is not None and getattr(self, needed) is None:
                raise RobotError(f"{name} is given without {needed}", where="demands", hint=f"give both, or no {name}")

    @property
    def size_limit(self) -> float:
        """The largest size that is looked at, m."""
        return LARGEST_SIZE * self.shape.diagonal if self.max_size is None else self.max_size

    @property
    def lowest_offset(self) -> float | None:
        """The smallest R - r that leaves room for motors and head, m; None where the effector may grow."""
        return None if self.head_radius is None else (self.base_radius_min or 0.0) - self.head_radius


_DEGREES: Final = math.degrees(1.0)
_RANGES: Final = {
    "joint_min": (-180.0, 180.0, " deg", _DEGREES),
    "joint_max": (-180.0, 180.0, " deg", _DEGREES),
    "min_inverse_condition": (0.001, 0.999, "", 1.0),
    "max_transmission_angle": (1.0, 89.0, " deg", _DEGREES),
    "max_drive_angle": (1.0, 89.0, " deg", _DEGREES),
    "max_forearm_swing": (1.0, 89.0, " deg", _DEGREES),
    "base_radius_min": (0.0, 10_000.0, " mm", 1e3),
    "head_radius": (0.0, 10_000.0, " mm", 1e3),
    "clearance": (1.0, 10_000.0, " mm", 1e3),
    "max_size": (1.0, 30_000.0, " mm", 1e3),
    "speed": (1e-6, 100.0, " m/s", 1.0),
    "acceleration": (1e-6, 10_000.0, " m/s^2", 1.0),
    "max_joint_speed": (1e-3, 1e6, " deg/s", _DEGREES),
    "max_joint_acceleration": (1e-3, 1e9, " deg/s^2", _DEGREES),
    "max_error": (1e-3, 1e6, " um", 1e6),
    "encoder_step": (1e-9, 90.0, " deg", _DEGREES),
}
"""Smallest and largest value in the unit of people, that unit, and how many of it are one SI unit."""

_NEEDS: Final = (
    ("max_joint_speed", "speed"),
    ("max_joint_acceleration", "acceleration"),
    ("max_joint_acceleration", "speed"),
    ("max_error", "encoder_step"),
)
