"""From what a file describes, and what the user adds, to a whole robot that can do its sheet.

What neither says is not made up: the sheet and the rating of the tool must be given. Only a joint's range may be left
open; then it is the part that the sheet needs, which no real range of the machine can be smaller than, marked as an
estimate.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.robot import kinematics
from deltacam.robot.checks import check_reach, check_workspace
from deltacam.robot.dimensions import DeltaGeometry, Triple
from deltacam.robot.importers.description import Description, Fact
from deltacam.robot.limits import derive_max_acceleration, derive_max_speed
from deltacam.robot.robot import JointLimits, Robot, ToolRating
from deltacam.robot.workspace import Workspace
from deltacam.robot.writer import to_toml

_NEEDED: Final = "the file gives no such limit; this is what the sheet needs, rounded outwards"
_SLACK: Final = math.radians(1e-3)  # before the needed range is rounded outwards to whole degrees

_ESTIMATE: Final = "an estimate, to be replaced: "


@dataclass(frozen=True, slots=True)
class Sheet:
    """The sheet that the user asks for.

    Attributes:
        width: along x, m; None for a disc.
        depth: along y, m.
        radius: of a disc, m; None for a rectangle.
        z: its height in the machine, m; None for that of the file's bed.
    """

    width: float | None = None
    depth: float | None = None
    radius: float | None = None
    z: float | None = None


@dataclass(frozen=True, slots=True)
class Wishes:
    """What the user adds; None leaves it to the file. What is given here holds, and the file's value is then replaced.

    Attributes:
        name: of the robot.
        sheet: where it lies.
        speed: of the tool, m/s.
        acceleration: of the tool, m/s^2.
        joints: smallest and largest angle of all joints, rad, in our sign.
    """

    name: str | None = None
    sheet: Sheet | None = None
    speed: float | None = None
    acceleration: float | None = None
    joints: tuple[float, float] | None = None


@dataclass(frozen=True, slots=True)
class Imported:
    """A robot that was imported.

    Attributes:
        robot: the robot.
        toml: its robot file.
        program: whose file it was.
        facts: what was read and given, and what it became.
        unused: the entries of the file that were not used.
        estimates: the keys of the robot file that hold an estimate, and what it is.
        notes: what a person should know.
    """

    robot: Robot
    toml: str
    program: str
    facts: tuple[Fact, ...]
    unused: tuple[str, ...]
    estimates: tuple[tuple[str, str], ...] = ()
    notes: tuple[str, ...] = ()


def complete(description: Description, wishes: Wishes) -> Imported:
    """The robot of a description and of what the user adds.

    Raises:
        RobotError: something that neither says, with the option for it; a value out of bounds; or a robot that cannot
            do its sheet.
    """
    speed = description.tool_speed if wishes.speed is None else wishes.speed
    acceleration = description.tool_acceleration if wishes.acceleration is None else wishes.acceleration
    workspace = _workspace(description, wishes.sheet)
    if workspace is None or speed is None or acceleration is None:
        raise _missing(description, workspace, speed, acceleration)
    tool = ToolRating(speed, acceleration)
    check_reach(description.geometry, workspace)
    low, high, estimates = _range(description, workspace, wishes)
    robot = Robot(
        name=wishes.name or _printable(description.name),
        geometry=description.geometry,
        joints=_joints(description, workspace, tool, low, high),
        tool=tool,
        workspace=workspace,
        source=f"imported from {', '.join(description.files)} ({description.program})",
    )
    check_workspace(robot)
    marked = {key: _ESTIMATE + remark for key, remark in estimates.items()}
    return Imported(
        robot=robot,
        toml=to_toml(robot, header=_header(estimates), remarks=dict(description.remarks) | marked),
        program=description.program,
        facts=description.facts + _given(wishes),
        unused=description.unused,
        estimates=tuple(estimates.items()),
        notes=description.notes + _replaced(description, wishes),
    )


def _workspace(description: Description, sheet: Sheet | None) -> Workspace | None:
    """The sheet that the user asks for, or the file's own bed; None where its size or its height is not known."""
    asked = sheet or Sheet(radius=description.bed_radius)
    z = description.bed_z if asked.z is None else asked.z
    if z is None or (asked.radius is None and asked.width is None):
        return None
    return Workspace(sheet_z=z, width=asked.width, depth=asked.depth, radius=asked.radius)


def _missing(
    description: Description, workspace: Workspace | None, speed: float | None, acceleration: float | None
) -> RobotError:
    """The error that lists everything that neither the file nor the user says, with the options for it."""
    wanted = [
        ("the sheet", "--sheet 300x300" + ("@-650" if description.bed_z is None else ""), workspace),
        ("the speed of the tool", "--speed 60m/min", speed),
        ("the acceleration of the tool", "--acceleration 23", acceleration),
    ]
    lacking = [(what, option) for what, option, value in wanted if value is None]
    what = f"the file of {description.program} does not say {', '.join(what for what, _ in lacking)}"
    return RobotError(
        what, hint=f"say it: {' '.join(option for _, option in lacking)}, with the numbers of your machine"
    )


def _range(description: Description, workspace: Workspace, wishes: Wishes) -> tuple[Triple, Triple, dict[str, str]]:
    """The ranges of the joints, and the remarks on those that are estimates."""
    if wishes.joints is not None:
        low, high = wishes.joints
        return (low,) * 3, (high,) * 3, {}
    geometry = description.geometry
    found: list[Triple] = []
    estimates: dict[str, str] = {}
    for key, given, sign in (("min_deg", description.joint_min, -1.0), ("max_deg", description.joint_max, 1.0)):
        if given is not None:
            found.append(given)
            continue
        needed = _needed(geometry, workspace, sign)
        bound = math.radians(sign * math.ceil(math.degrees(needed + _SLACK)))
        found.append((bound, bound, bound))
        estimates[f"joints.{key}"] = _NEEDED
    return found[0], found[1], estimates


def _needed(geometry: DeltaGeometry, workspace: Workspace, sign: float) -> float:
    """The largest of ``sign`` times any joint's angle over the sheet, rad."""
    value, _ = workspace.worst(lambda points: (sign * kinematics.inverse(geometry, points)).max(axis=1))
    return value


def _joints(description: Description, workspace: Workspace, tool: ToolRating, low: Triple, high: Triple) -> JointLimits:
    """The limits of the joints: those of the file, or derived from the tool's rating as the reader derives them."""
    geometry = description.geometry
    speed, acceleration = description.max_joint_speed, description.max_joint_acceleration
    derived = []
    if speed is None:
        derived.append("max_speed")
        speed = (derive_max_speed(geometry, workspace, speed=tool.max_speed),) * 3
    if acceleration is None:
        derived.append("max_acceleration")
        acceleration = (
            derive_max_acceleration(geometry, workspace, speed=tool.max_speed, acceleration=tool.max_acceleration),
        ) * 3
    return JointLimits(min=low, max=high, max_speed=speed, max_acceleration=acceleration, derived=tuple(derived))


def _given(wishes: Wishes) -> tuple[Fact, ...]:
    """What the user added, as facts."""
    found = []
    if wishes.sheet is not None:
        sheet = wishes.sheet
        size = (
            f"radius {sheet.radius * 1e3:g}"
            if sheet.radius is not None
            else (f"{(sheet.width or 0.0) * 1e3:g} x {(sheet.depth or 0.0) * 1e3:g}")
        )
        height = "the bed's height" if sheet.z is None else f"z = {sheet.z * 1e3:g} mm"
        found.append(Fact("--sheet", f"{size} mm", f"[workspace], {height}"))
    if wishes.speed is not None:
        found.append(Fact("--speed", f"{wishes.speed:g} m/s", f"[tool] max_speed_m_min = {wishes.speed * 60.0:g}"))
    if wishes.acceleration is not None:
        acceleration = f"{wishes.acceleration:g}"
        found.append(Fact("--acceleration", f"{acceleration} m/s2", f"[tool] max_acceleration_m_s2 = {acceleration}"))
    if wishes.joints is not None:
        low, high = np.degrees(wishes.joints)
        found.append(Fact("--joints", f"{low:g} to {high:g} deg", f"min_deg = {low:g}, max_deg = {high:g}"))
    return tuple(found)


def _replaced(description: Description, wishes: Wishes) -> tuple[str, ...]:
    """Which values of the file an option holds instead of."""
    both = (
        ("--sheet", wishes.sheet, description.bed_radius),
        ("--speed", wishes.speed, description.tool_speed),
        ("--acceleration", wishes.acceleration, description.tool_acceleration),
        ("--joints", wishes.joints, description.joint_min or description.joint_max),
    )
    return tuple(
        f"{option} holds instead of what the file says" for option, *two in both if all(one is not None for one in two)
    )


def _printable(name: str) -> str:
    """A file's name as a robot's: one line of at most 200 characters."""
    return "".join(letter for letter in name if letter.isprintable())[:200].strip() or "imported"


def _header(estimates: Mapping[str, str]) -> tuple[str, ...]:
    keys = ", ".join("[{}] {}".format(*key.split(".")) for key in estimates)
    return (f"Estimates, to be replaced by the numbers of the machine: {keys}",) if estimates else ()
