"""Robot files and the built-in robots."""

from __future__ import annotations

import difflib
from collections.abc import Mapping
from importlib import resources
from pathlib import Path
from typing import Final, cast, get_args

from deltacam.errors import RobotError
from deltacam.robot.bounds import BOUNDS, Bound
from deltacam.robot.checks import check_reach, check_workspace
from deltacam.robot.dimensions import STANDARD_AZIMUTHS, DeltaGeometry, Mount, Triple
from deltacam.robot.limits import derive_max_acceleration, derive_max_speed
from deltacam.robot.robot import Controller, Interpolation, JointLimits, Robot, ToolRating
from deltacam.robot.workspace import DEFAULT_PRESSURE_ANGLE_DEG, Workspace
from deltacam.settings import REQUIRED, Required, Table, read_table

DEFAULT_ROBOT: Final = "delta-300"

_PROFILES: Final = resources.files("deltacam.robot") / "profiles"
_LIMITS: Final = ("max_speed", "max_acceleration", "max_jerk")


def profile_names() -> tuple[str, ...]:
    """The names of the built-in robots, sorted."""
    return tuple(
        sorted(entry.name.removesuffix(".toml") for entry in _PROFILES.iterdir() if entry.name.endswith(".toml"))
    )


def load_robot(name_or_path: str | Path) -> Robot:
    """The built-in robot of that name, or the robot that the TOML file describes.

    A name of a built-in robot wins over a file or folder that happens to be called the same; ``./name`` is the file.
    Limits of the joints that the file does not give are derived from the tool's rating, see `deltacam.robot.limits`.

    Args:
        name_or_path: a name from `profile_names`, or a path that ends in ``.toml`` or exists.

    Raises:
        RobotError: no such robot or file, a key or value that is wrong, or a sheet that the robot cannot reach.
    """
    text = str(name_or_path)
    if text in profile_names():
        with resources.as_file(_PROFILES / f"{text}.toml") as path:
            return _read(path)
    path = Path(name_or_path)
    if path.suffix.lower() == ".toml" or path.is_file():
        return _read(path)
    names = profile_names()
    near = difflib.get_close_matches(text, names, n=1)
    hint = f"did you mean {near[0]!r}? " if near else ""
    raise RobotError(f"unknown robot {text!r}", hint=f"{hint}built-in: {', '.join(names)}; or give a .toml file")


def _read(path: Path) -> Robot:
    top = read_table(path, error=RobotError)
    try:
        robot = _robot(top)
        check_workspace(robot)
    except RobotError as problem:
        if problem.where.startswith(top.where):
            raise
        where = f"{top.where} [{problem.where}]" if problem.where else top.where
        raise RobotError(problem.what, where=where, hint=problem.hint) from problem
    return robot


def _robot(top: Table) -> Robot:
    name = top.text("name")
    description, source = top.text("description", default=""), top.text("source", default="")
    geometry = _geometry(top.table("geometry"), _mount(top.table("mount", required=False)))
    tool = _tool(top.table("tool"))
    workspace = _workspace(top.table("workspace"))
    controller = _controller(top.table("controller", required=False))
    joints = top.table("joints")
    low, high = _triple(joints, BOUNDS["min"]), _triple(joints, BOUNDS["max"])
    given = {name: _triple(joints, BOUNDS[name]) for name in _LIMITS if joints.has(BOUNDS[name].key)}
    top.finish()  # before limits are derived: a misspelled limit is not a missing one
    check_reach(geometry, workspace)
    derived = _derived(geometry, tool, workspace, given)
    limits = given | {name: (value, value, value) for name, value in derived.items()}
    return Robot(
        name=name,
        description=description,
        source=source,
        geometry=geometry,
        joints=JointLimits(
            min=low,
            max=high,
            max_speed=limits["max_speed"],
            max_acceleration=limits["max_acceleration"],
            max_jerk=limits.get("max_jerk"),
            derived=tuple(derived),
        ),
        tool=tool,
        workspace=workspace,
        controller=controller,
    )


def _derived(
    geometry: DeltaGeometry, tool: ToolRating, workspace: Workspace, given: Mapping[str, Triple]
) -> dict[str, float]:
    """The limits of speed, rad/s, and acceleration, rad/s^2, that the file does not give."""
    found = {}
    if "max_speed" not in given:
        found["max_speed"] = derive_max_speed(geometry, workspace, speed=tool.max_speed)
    if "max_acceleration" not in given:
        found["max_acceleration"] = derive_max_acceleration(
            geometry, workspace, speed=tool.max_speed, acceleration=tool.max_acceleration
        )
    return found


def _geometry(table: Table, mount: Mount) -> DeltaGeometry:
    azimuths = BOUNDS["azimuths"]
    standard = not table.has(azimuths.key)
    return DeltaGeometry(
        base_radius=_radius(table, "base"),
        effector_radius=_radius(table, "effector"),
        upper_arm=_triple(table, BOUNDS["upper_arm"]),
        forearm=_triple(table, BOUNDS["forearm"]),
        azimuths=STANDARD_AZIMUTHS if standard else _triple(table, azimuths, repeat=False),
        mount=mount,
    )


def _radius(table: Table, part: str) -> Triple:
    """The radii of the base or the effector, given as they are or by the side of the triangle about it."""
    radius, side = BOUNDS[f"{part}_radius"], BOUNDS[f"{part}_side"]
    if table.has(radius.key) and table.has(side.key):
        raise table.problem(f"{radius.key} and {side.key} are both given", hint="keep one of them")
    if not table.has(side.key):
        return _triple(table, radius)
    value = _number(table, side)
    return value, value, value


def _mount(table: Table) -> Mount:
    return Mount(
        x=_number(table, BOUNDS["mount_x"], default=0.0),
        y=_number(table, BOUNDS["mount_y"], default=0.0),
        z=_number(table, BOUNDS["mount_z"], default=0.0),
        rotation=_number(table, BOUNDS["mount_rotation"], default=0.0),
        upside_down=table.flag("upside_down", default=False),
    )


def _tool(table: Table) -> ToolRating:
    return ToolRating(
        max_speed=_number(table, BOUNDS["tool_max_speed"]),
        max_acceleration=_number(table, BOUNDS["tool_max_acceleration"]),
    )


def _workspace(table: Table) -> Workspace:
    disc = table.has(BOUNDS["radius"].key)
    if disc and (table.has(BOUNDS["width"].key) or table.has(BOUNDS["depth"].key)):
        raise table.problem("radius_mm is given beside width_mm or depth_mm", hint="keep radius_mm for a round sheet")
    park = BOUNDS["park"]
    x, y = table.numbers(park.key, length=2, minimum=park.minimum, maximum=park.maximum, default=(0.0, 0.0))
    swing = BOUNDS["max_forearm_swing"]
    return Workspace(
        sheet_z=_number(table, BOUNDS["sheet_z"]),
        width=None if disc else _number(table, BOUNDS["width"]),
        depth=None if disc else _number(table, BOUNDS["depth"]),
        radius=_number(table, BOUNDS["radius"]) if disc else None,
        park=(park.to_si(x), park.to_si(y)),
        max_pressure_angle=_number(table, BOUNDS["max_pressure_angle"], default=DEFAULT_PRESSURE_ANGLE_DEG),
        max_forearm_swing=_number(table, swing) if table.has(swing.key) else None,
    )


def _controller(table: Table) -> Controller:
    interpolation = table.choice("interpolation", get_args(Interpolation), default="linear")
    return Controller(
        rate_hz=_number(table, BOUNDS["rate_hz"], default=400.0), interpolation=cast("Interpolation", interpolation)
    )


def _number(table: Table, bound: Bound, *, default: float | Required = REQUIRED) -> float:
    """The number of that key in SI; the default is in the file's unit."""
    return bound.to_si(table.number(bound.key, minimum=bound.minimum, maximum=bound.maximum, default=default))


def _triple(table: Table, bound: Bound, *, repeat: bool = True) -> Triple:
    """The three numbers of that key in SI; with ``repeat``, one number stands for all."""
    values = table.numbers(bound.key, length=3, minimum=bound.minimum, maximum=bound.maximum, repeat=repeat)
    one, two, three = map(bound.to_si, values)
    return one, two, three
