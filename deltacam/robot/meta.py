"""The robot in a program file: ``meta.robot``, every value in SI.

A program file may come from anywhere, so that reading trusts nothing: names, types, lengths and bounds are checked, the
robot must reach its sheet, and the fingerprint must be that of the values.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Final, cast

from deltacam.errors import RobotError
from deltacam.robot.checks import check_workspace
from deltacam.robot.dimensions import HANGING, DeltaGeometry, Mount, PerArm, Triple
from deltacam.robot.robot import Controller, Interpolation, JointLimits, Robot, ToolRating
from deltacam.robot.workspace import Workspace

_WHERE: Final = "meta.robot"
_GEOMETRY: Final = tuple(DeltaGeometry.__dataclass_fields__)


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
        geometry=_geometry(top.section("geometry", _GEOMETRY, may_lack=("mount",))),
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

    def __init__(self, values: object, where: str, keys: tuple[str, ...], *, may_lack: tuple[str, ...] = ()) -> None:
        if not isinstance(values, Mapping):
            raise RobotError(f"expected an object, got {type(values).__name__}", where=where)
        missing = [key for key in keys if key not in values and key not in may_lack]
        extra = sorted(str(key)[:40] for key in values if key not in keys)
        if missing or extra:
            words = [f"missing {', '.join(missing)}"] if missing else []
            words += [f"unknown {', '.join(extra[:5])}"] if extra else []
            raise RobotError("; ".join(words), where=where)
        self._values: Mapping[str, object] = values
        self._where = where

    def has(self, key: str) -> bool:
        return key in self._values

    def section(self, key: str, keys: tuple[str, ...], *, may_lack: tuple[str, ...] = ()) -> _Section:
        return _Section(self._values[key], f"{self._where}.{key}", keys, may_lack=may_lack)

    def flag(self, key: str) -> bool:
        value = self._values[key]
        if not isinstance(value, bool):
            raise RobotError(f"{key} is not true or false but {type(value).__name__}", where=self._where)
        return value

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

    def per_arm(self, key: str) -> PerArm:
        return self.triple(key) if isinstance(self._values[key], list) else self.number(key)

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
        base_radius=section.per_arm("base_radius"),
        effector_radius=section.per_arm("effector_radius"),
        upper_arm=section.per_arm("upper_arm"),
        forearm=section.per_arm("forearm"),
        azimuths=section.triple("azimuths"),
        mount=_mount(section.section("mount", tuple(Mount.__dataclass_fields__))) if section.has("mount") else HANGING,
    )


def _mount(section: _Section) -> Mount:
    return Mount(
        x=section.number("x"),
        y=section.number("y"),
        z=section.number("z"),
        rotation=section.number("rotation"),
        upside_down=section.flag("upside_down"),
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
