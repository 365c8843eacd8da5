"""The dimensions of a rotary delta robot that decide where its tool is."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.robot.bounds import BOUNDS

STANDARD_AZIMUTHS: Final = (-np.pi / 2, np.pi / 6, 5 * np.pi / 6)
"""Azimuths of the three arms where the robot file gives none, rad."""


@dataclass(frozen=True, slots=True)
class DeltaGeometry:
    """The dimensions that decide where the tool is.

    Attributes:
        base_radius: from the base's centre to the joint axes, m.
        effector_radius: from the effector's centre to the forearm joints, m.
        upper_arm: length, m.
        forearm: length, m.
        azimuths: direction of the three arms about z, rad; no two within 10 degrees.

    Raises:
        RobotError: a value is not finite or out of its bounds, or two arms stand in the same direction.
    """

    base_radius: float
    effector_radius: float
    upper_arm: float
    forearm: float
    azimuths: tuple[float, float, float] = STANDARD_AZIMUTHS

    def __post_init__(self) -> None:
        for name in ("base_radius", "effector_radius", "upper_arm", "forearm"):
            BOUNDS[name].check(name, (getattr(self, name),), "geometry")
        BOUNDS["azimuths"].check("azimuths", self.azimuths, "geometry")
        turns = np.subtract(self.azimuths, np.roll(self.azimuths, 1))
        if np.cos(turns).max() > np.cos(np.radians(10.0)):
            raise RobotError("azimuths must be three directions at least 10 degrees apart", where="geometry")

    @property
    def offset(self) -> float:
        """R - r, the only combination of the radii that enters the kinematics, m."""
        return self.base_radius - self.effector_radius
