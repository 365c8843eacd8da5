"""The dimensions of a rotary delta robot that decide where its tool is, and how its base stands in the machine."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot.bounds import BOUNDS

Triple = tuple[float, float, float]
PerArm = float | Triple
"""One length for the three arms, or one for each, m."""

STANDARD_AZIMUTHS: Final = (-np.pi / 2, np.pi / 6, 5 * np.pi / 6)
"""Azimuths of the three arms where the robot file gives none, rad."""

_LENGTHS: Final = ("base_radius", "effector_radius", "upper_arm", "forearm")


@dataclass(frozen=True, slots=True)
class Mount:
    """How the base stands in the machine, whose frame the sheet, the park place and the tool points are in.

    The base is turned over where it stands upside down, about its own x axis, then turned about z, then moved.

    Attributes:
        x: of the centre of the base, m.
        y: of the centre of the base, m.
        z: of the centre of the base, m.
        rotation: about z, counter-clockwise seen from above, rad.
        upside_down: whether the tool is above the base.

    Raises:
        RobotError: a value is not finite or out of its bounds.
    """

    x: float = 0.0
    y: float = 0.0
    z: float = 0.0
    rotation: float = 0.0
    upside_down: bool = False

    def __post_init__(self) -> None:
        for name in ("x", "y", "z", "rotation"):
            BOUNDS[f"mount_{name}"].check(name, (getattr(self, name),), "mount")


HANGING: Final = Mount()
"""The base above the sheet, its frame that of the machine."""


@dataclass(frozen=True, slots=True)
class DeltaGeometry:
    """The dimensions that decide where the tool is.

    Three equal lengths are held as one, so that a robot has one description.

    Attributes:
        base_radius: from the base's centre to the joint axes, m; one for all arms or one for each, as all lengths.
        effector_radius: from the effector's centre to the forearm joints, m.
        upper_arm: length, m.
        forearm: length, m.
        azimuths: direction of the three arms about the base's z, rad; no two within 10 degrees.
        mount: how the base stands in the machine.

    Raises:
        RobotError: a value is not finite or out of its bounds, or two arms stand in the same direction.
    """

    base_radius: PerArm
    effector_radius: PerArm
    upper_arm: PerArm
    forearm: PerArm
    azimuths: Triple = STANDARD_AZIMUTHS
    mount: Mount = HANGING

    def __post_init__(self) -> None:
        for name in _LENGTHS:
            values = _triple(getattr(self, name))
            BOUNDS[name].check(name, values, "geometry")
            object.__setattr__(self, name, values[0] if values.count(values[0]) == len(values) else values)
        BOUNDS["azimuths"].check("azimuths", self.azimuths, "geometry")
        turns = np.subtract(self.azimuths, np.roll(self.azimuths, 1))
        if np.cos(turns).max() > np.cos(np.radians(10.0)):
            raise RobotError("azimuths must be three directions at least 10 degrees apart", where="geometry")

    @property
    def base_radii(self) -> Array:
        """The base radius of each arm, (3,) m."""
        return _array(self.base_radius)

    @property
    def effector_radii(self) -> Array:
        """The effector radius of each arm, (3,) m."""
        return _array(self.effector_radius)

    @property
    def upper_arms(self) -> Array:
        """The length of each upper arm, (3,) m."""
        return _array(self.upper_arm)

    @property
    def forearms(self) -> Array:
        """The length of each forearm, (3,) m."""
        return _array(self.forearm)

    @property
    def offsets(self) -> Array:
        """Base radius less effector radius of each arm, (3,) m: all that the kinematics needs of the two."""
        return self.base_radii - self.effector_radii

    @property
    def up(self) -> float:
        """Where the base's own z points: 1 up, -1 down."""
        return -1.0 if self.mount.upside_down else 1.0

    @property
    def centre(self) -> Array:
        """The centre of the base in the machine, (3,) m."""
        return np.array([self.mount.x, self.mount.y, self.mount.z])

    @property
    def outwards(self) -> Array:
        """Unit vectors u_i from the base's axis to the arms, in the machine: (3, 2), level, one row per arm."""
        turn = self.mount.rotation + self.up * np.asarray(self.azimuths)
        return np.stack((np.cos(turn), np.sin(turn)), axis=1)

    @property
    def sideways(self) -> Array:
        """Unit vectors w_i across the planes of the arms, in the machine: (3, 2), level, one row per arm."""
        u = self.outwards
        return self.up * np.stack((-u[:, 1], u[:, 0]), axis=1)


def _triple(value: PerArm) -> Triple:
    return value if isinstance(value, tuple) else (value, value, value)


def _array(value: PerArm) -> Array:
    return np.array(_triple(value), dtype=np.float64)
