"""The robot: what the planner and the checks know of the machine."""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import asdict, dataclass, field
from typing import Any, Literal, get_args

import numpy.typing as npt

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot import kinematics, measures
from deltacam.robot.bounds import BOUNDS
from deltacam.robot.dimensions import HANGING, DeltaGeometry, Triple
from deltacam.robot.workspace import Workspace

Interpolation = Literal["linear", "cubic"]


@dataclass(frozen=True, slots=True)
class JointLimits:
    """What the three joints can do; every limit holds one value per joint.

    Attributes:
        min: smallest angle, rad.
        max: largest angle, rad.
        max_speed: rad/s.
        max_acceleration: rad/s^2.
        max_jerk: rad/s^3; None where the drives set none.
        derived: the names of the limits that follow from the tool's rating; they do not make another robot.

    Raises:
        RobotError: a value out of its bounds, or min not below max.
    """

    min: Triple
    max: Triple
    max_speed: Triple
    max_acceleration: Triple
    max_jerk: Triple | None = None
    derived: tuple[str, ...] = field(default=(), compare=False)

    def __post_init__(self) -> None:
        for name in ("min", "max", "max_speed", "max_acceleration", "max_jerk"):
            BOUNDS[name].check(name, getattr(self, name) or (), "joints")
        for joint, (low, high) in enumerate(zip(self.min, self.max, strict=True), start=1):
            if low >= high:
                low_deg, high_deg = math.degrees(low), math.degrees(high)
                raise RobotError(
                    f"joint {joint}: min {low_deg:g} deg is not below max {high_deg:g} deg", where="joints"
                )


@dataclass(frozen=True, slots=True)
class ToolRating:
    """What the tool can do in any direction.

    Attributes:
        max_speed: m/s.
        max_acceleration: m/s^2.

    Raises:
        RobotError: a value out of its bounds.
    """

    max_speed: float
    max_acceleration: float

    def __post_init__(self) -> None:
        BOUNDS["tool_max_speed"].check("max_speed", (self.max_speed,), "tool")
        BOUNDS["tool_max_acceleration"].check("max_acceleration", (self.max_acceleration,), "tool")


@dataclass(frozen=True, slots=True)
class Controller:
    """How the controller takes the program.

    Attributes:
        rate_hz: setpoints per second.
        interpolation: how it moves the joints between setpoints: "linear", or "cubic" for Hermite curves whose slopes
            are central differences.

    Raises:
        RobotError: a value out of its bounds.
    """

    rate_hz: float = 400.0
    interpolation: Interpolation = "linear"

    def __post_init__(self) -> None:
        BOUNDS["rate_hz"].check("rate_hz", (self.rate_hz,), "controller")
        if self.interpolation not in get_args(Interpolation):
            raise RobotError(f"interpolation = {self.interpolation!r} is not linear or cubic", where="controller")


@dataclass(frozen=True, slots=True)
class Robot:
    """A rotary delta robot with a tool, its limits, and the place of the sheet.

    Two robots are equal when they move alike; a description, a source and which limits were derived do not count.

    Attributes:
        name: for people and for the program file.
        description: for people.
        source: where the numbers are from.
        geometry: the dimensions.
        joints: the joints' ranges and limits.
        tool: the rating at the tool.
        workspace: the sheet.
        controller: the receiver of the program.

    Raises:
        RobotError: the name is not one line of 1 to 200 characters.
    """

    name: str
    geometry: DeltaGeometry
    joints: JointLimits
    tool: ToolRating
    workspace: Workspace
    controller: Controller = Controller()
    description: str = field(default="", compare=False)
    source: str = field(default="", compare=False)

    def __post_init__(self) -> None:
        if not 0 < len(self.name) <= 200 or not self.name.isprintable():
            raise RobotError("name must be one line of 1 to 200 characters")

    def motion_values(self) -> dict[str, Any]:
        """What decides how the robot moves, in SI, as JSON has it: dicts, lists, numbers, strings and None.

        A base that hangs in the middle of the machine has no ``mount``: a robot has one description.
        """
        values = {
            "geometry": asdict(self.geometry),
            "joints": asdict(self.joints),
            "tool": asdict(self.tool),
            "workspace": asdict(self.workspace),
            "controller": asdict(self.controller),
        }
        del values["joints"]["derived"]
        if self.geometry.mount == HANGING:
            del values["geometry"]["mount"]
        return {section: {key: _plain(value) for key, value in part.items()} for section, part in values.items()}

    @property
    def fingerprint(self) -> str:
        """The SHA-256, hexadecimal, of the canonical JSON of `motion_values`."""
        text = json.dumps(self.motion_values(), sort_keys=True, separators=(",", ":"), allow_nan=False)
        return hashlib.sha256(text.encode("utf-8")).hexdigest()

    def inverse(self, points: npt.ArrayLike) -> Array:
        """The joint angles at ``points`` (N, 3) m: (N, 3) rad; see `kinematics.inverse`."""
        return kinematics.inverse(self.geometry, points)

    def forward(self, angles: npt.ArrayLike) -> Array:
        """The tool points at ``angles`` (N, 3) rad: (N, 3) m; see `kinematics.forward`."""
        return kinematics.forward(self.geometry, angles)

    def inverse_jacobian(self, points: npt.ArrayLike) -> Array:
        """Joint speed by tool velocity at ``points`` (N, 3) m: (N, 3, 3) rad/m; see `kinematics.inverse_jacobian`."""
        return kinematics.inverse_jacobian(self.geometry, points)

    def path_derivatives(self, p: npt.ArrayLike, dp: npt.ArrayLike, ddp: npt.ArrayLike) -> tuple[Array, Array, Array]:
        """Joint angles and their derivatives along a path, three times (N, 3); see `kinematics.path_derivatives`."""
        return kinematics.path_derivatives(self.geometry, p, dp, ddp)

    def third_derivative(self, p: npt.ArrayLike, dp: npt.ArrayLike, ddp: npt.ArrayLike, dddp: npt.ArrayLike) -> Array:
        """The third derivative of the joint angles along a path, (N, 3); see `kinematics.third_derivative`."""
        return kinematics.third_derivative(self.geometry, p, dp, ddp, dddp)

    def reach_margin(self, points: npt.ArrayLike) -> Array:
        """How far the arms are from the edge of their reach, (N, 3); see `kinematics.reach_margin`."""
        return kinematics.reach_margin(self.geometry, points)

    def pressure_angles(self, points: npt.ArrayLike) -> tuple[Array, Array]:
        """The pressure angles mu1 and mu2, each (N, 3) rad; see `measures.pressure_angles`."""
        return measures.pressure_angles(self.geometry, points)

    def forearm_swing(self, points: npt.ArrayLike) -> Array:
        """How far the forearms lean out of their arms' planes, (N, 3) rad; see `measures.forearm_swing`."""
        return measures.forearm_swing(self.geometry, points)

    def inverse_condition(self, points: npt.ArrayLike) -> Array:
        """The inverse condition number of the Jacobian, (N,); see `measures.inverse_condition`."""
        return measures.inverse_condition(self.geometry, points)


def _plain(value: object) -> object:
    """A value as JSON has it; -0.0 becomes 0.0, which is the same place."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return value + 0.0 if isinstance(value, float) else value
