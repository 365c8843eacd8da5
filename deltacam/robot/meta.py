"""The robot in a program file: ``meta.robot``, every value in SI.

A program file may come from anywhere, so that reading trusts nothing: names, types, lengths and bounds are checked, the
robot must reach its sheet, and the fingerprint must be that of the values.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, cast

from deltacam.errors import RobotError
from deltacam.robot.checks import check_workspace
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.robot import Controller, Interpolation, JointLimits, Robot, ToolRating, Triple
from deltacam.robot.workspace import Workspace

_WHERE: Final = "meta.robot"


def to_meta(robot: Robot) -> dict[str, Any]:
    """The robot as the program file holds it; `from_meta` gives an equal robot, also by way of JSON text."""
    return {"name": robot.name, "fingerprint": robot.fingerprint, **robot.motion_values()}


def from_meta(meta: Mapping[str, Any]) -> Robot:
    """The robot of a program file, without its description, its source and which limits were derived.

    Raises:
        RobotError: a missing or unknown key, a value of another type or length, not finite or out of bounds, a sheet
            out of reach, or a fingerprint that is not that of the values.
    """
    sections = ("geometry", "joints", "tool", "workspace", "controller")
    top = _Section(meta, _WHERE, ("name", "fingerprint", *sections))
    robot = Robot(
        name=top.text("name"),
        geometry=_geometry(top.section("geometry", tuple(DeltaGeometry.__dataclass_fields__))),
        joints=_joints(top.section("joints", ("min", "max", "max_speed", "max_acceleration", "max_jerk"))),
        tool=_tool(top.section("tool", tuple(ToolRating.__dataclass_fields__))),
        workspace=_workspace(top.section("workspace", tuple(Workspace.__dataclass_fields__))),
        controller=_controller(top.section("controller", tuple(Controller.__dataclass_fields__))),
    )
    if top.text("fingerprint") != robot.fingerprint:
        hint = "the file was changed after it was written; plan it again"
        raise RobotError("the fingerprint is not that of the robot's values", where=_WHERE, hint=hint)
    check_workspace(robot)
    return robot


class _Section:
    """A JSON object whose keys are known, and whose values are taken by type."""

    def __init__(self, values: object, where: str, keys: tuple[str, ...]) -> None:
        if not isinstance(values, Mapping):
            raise RobotError(f"expected an object, got {type(values).__name__}", where=where)
        missing = [key for key in keys if key not in values]
        extra = sorted(str(key)[:40] for key in values if key not in keys)
        if missing or extra:
            words = [f"missing {', '.join(missing)}"] if missing else []
            words += [f"unknown {', '.join(extra[:5])}"] if extra else []
            raise RobotError("; ".join(words), where=where)
        self._values: Mapping[str, object] = values
        self._where = where

    def section(self, key: str, keys: tuple[str, ...]) -> _Section:
        return _Section(self._values[key], f"{self._where}.{key}", keys)

    def text(self, key: str) -> str:
        value = self._values[key]
        if not isinstance(value, str):
            raise RobotError(f"{key} is not text but {type(value).__name__}", where=self._where)
        return value

    def number(self, key: str) -> float:
        return self._number(key, self._values[key])

    def optional(self, key: str) -> float | None:
        return None if self._values[key] is None else self.number(key)

    def numbers(self, key: str, length: int) -> tuple[float, ...]:
        value = self._values[key]
        if not isinstance(value, Sequence) or isinstance(value, str) or len(value) != length:
            raise RobotError(f"{key} is not a list of {length} numbers", where=self._where)
        return tuple(self._number(key, item) for item in value)

    def triple(self, key: str) -> Triple:
        return cast("Triple", self.numbers(key, 3))

    def optional_triple(self, key: str) -> Triple | None:
        return None if self._values[key] is None else self.triple(key)

    def _number(self, key: str, value: object) -> float:
        """The number as a float; bounds, and with them nan, are checked by the class that takes it."""
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise RobotError(f"{key} is not a number but {type(value).__name__}", where=self._where)
        try:
            return float(value)
        except OverflowError:
            raise RobotError(f"{key} is too large", where=self._where) from None


def _geometry(section: _Section) -> DeltaGeometry:
    return DeltaGeometry(
        base_radius=section.number("base_radius"),
        effector_radius=section.number("effector_radius"),
        upper_arm=section.number("upper_arm"),
        forearm=section.number("forearm"),
        azimuths=section.triple("azimuths"),
    )


def _joints(section: _Section) -> JointLimits:
    return JointLimits(
        min=section.triple("min"),
        max=section.triple("max"),
        max_speed=section.triple("max_speed"),
        max_acceleration=section.triple("max_acceleration"),
        max_jerk=section.optional_triple("max_jerk"),
    )


def _tool(section: _Section) -> ToolRating:
    return ToolRating(max_speed=section.number("max_speed"), max_acceleration=section.number("max_acceleration"))


def _workspace(section: _Section) -> Workspace:
    return Workspace(
        sheet_z=section.number("sheet_z"),
        width=section.optional("width"),
        depth=section.optional("depth"),
        radius=section.optional("radius"),
        park=cast("tuple[float, float]", section.numbers("park", 2)),
        max_pressure_angle=section.number("max_pressure_angle"),
        max_forearm_swing=section.optional("max_forearm_swing"),
    )


def _controller(section: _Section) -> Controller:
    interpolation = cast("Interpolation", section.text("interpolation"))
    return Controller(rate_hz=section.number("rate_hz"), interpolation=interpolation)
