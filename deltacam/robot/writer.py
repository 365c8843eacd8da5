"""A robot as a robot file that reads back as the same robot."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from typing import Final

from deltacam.errors import RobotError
from deltacam.robot.bounds import BOUNDS, Bound
from deltacam.robot.dimensions import HANGING, STANDARD_AZIMUTHS
from deltacam.robot.robot import Robot

_DIGITS: Final = 17  # of a decimal number that is any float
_NEIGHBOURS: Final = 4  # floats to either side that are tried
_WIDTH: Final = 100  # of a comment line
_LIMITS: Final = ("min", "max", "max_speed", "max_acceleration", "max_jerk")
_REQUIRED_LIMITS: Final = ("min", "max")
_SHEET: Final = ("sheet_z", "width", "depth", "radius")

_SECTIONS: Final[dict[str, str]] = {
    "geometry": "lengths are between the centres of the joints; only base radius - effector radius decides the motion",
    "mount": "how the base stands in the machine: turned over about x, then turned about z, then moved",
    "joints": "0 is the upper arm horizontal and outwards, positive is down",
    "tool": "what the tool may do in any direction",
    "workspace": "the sheet, in the machine: z is up; the axes of the joints are at 0 unless [mount] moves them",
    "controller": "how the program is played",
}
_DERIVED: Final = "not given, so derived from [tool] when the file is read: "


def to_toml(robot: Robot, *, header: Sequence[str] = (), remarks: Mapping[str, str] | None = None) -> str:
    """The robot file of a robot, which `load_robot` reads back as an equal robot with the same fingerprint.

    Limits named in ``robot.joints.derived`` are left out: they are derived again. Every number is the shortest decimal
    in the file's unit that is the same float in SI. Some floats that do not come from a file are not reached by
    any decimal, since a unit's factor may skip them: these are written as their nearest neighbour, one part in 10^15
    away at most, and the file is read as that neighbour, with its own fingerprint.

    Args:
        robot: any robot.
        header: lines of comment above everything, without the mark.
        remarks: comments above single keys, by ``section.key``: ``{"workspace.sheet_z_mm": "an estimate"}``.

    Raises:
        RobotError: a text that TOML cannot hold.
        ValueError: a remark for a key that is not written.
    """
    left = dict(remarks or {})
    lines = [*_comment("\n".join(header)), ""] if header else []
    texts = {"name": robot.name, "description": robot.description, "source": robot.source}
    lines += [f"{key} = {_text(key, text)}" for key, text in texts.items() if text]
    for section, values in _sections(robot).items():
        lines += ["", f"[{section}]", f"# {_SECTIONS[section]}"]
        for key, value in values.items():
            lines += [*_comment(left.pop(f"{section}.{key}", "")), f"{key} = {value}"]
        if section == "joints" and robot.joints.derived:
            keys = ", ".join(BOUNDS[name].key for name in robot.joints.derived)
            lines += _comment(_DERIVED + keys)
    if left:
        raise ValueError(f"remarks for keys that are not written: {', '.join(left)}")
    return "\n".join(lines) + "\n"


def decimal(bound: Bound, value: float) -> str:
    """The shortest decimal in the file's unit that ``bound.to_si`` turns into ``value``; the nearest if none does."""
    near = list(_candidates(bound, value))
    exact = [text for text in near if bound.to_si(float(text)) == value]
    return min(exact, key=len) if exact else min(near, key=lambda text: abs(bound.to_si(float(text)) - value))


def _candidates(bound: Bound, value: float) -> Iterator[str]:
    """Decimals about the value in the file's unit, within the bounds."""
    guess = value / bound.to_si(1.0)  # every unit is a factor
    below = above = min(max(guess, bound.minimum), bound.maximum)
    floats = [below]
    for _ in range(_NEIGHBOURS):
        below, above = math.nextafter(below, -math.inf), math.nextafter(above, math.inf)
        floats += [below, above]
    for number in floats:
        for digits in range(1, _DIGITS + 1):
            text = _plain(float(f"{number:.{digits}g}"))
            if bound.minimum <= float(text) <= bound.maximum:
                yield text


def _plain(number: float) -> str:
    """The shortest text of a float: a whole number without a point, and no minus before zero."""
    if number.is_integer() and abs(number) < 1e15:
        return str(int(number))
    return repr(number)


def _sections(robot: Robot) -> dict[str, dict[str, str]]:
    """The keys of every section with their values as TOML has them."""
    return {
        "geometry": _geometry(robot),
        **({} if robot.geometry.mount == HANGING else {"mount": _mount(robot)}),
        "joints": _joints(robot),
        "tool": {
            BOUNDS[f"tool_{name}"].key: decimal(BOUNDS[f"tool_{name}"], getattr(robot.tool, name))
            for name in ("max_speed", "max_acceleration")
        },
        "workspace": _workspace(robot),
        "controller": {
            "rate_hz": decimal(BOUNDS["rate_hz"], robot.controller.rate_hz),
            "interpolation": f'"{robot.controller.interpolation}"',
        },
    }


def _geometry(robot: Robot) -> dict[str, str]:
    geometry = robot.geometry
    found = {}
    for part in ("base", "effector"):
        key, text = _radius(part, getattr(geometry, f"{part}_radius"))
        found[key] = text
    for name in ("upper_arm", "forearm"):
        found[BOUNDS[name].key] = _numbers(BOUNDS[name], getattr(geometry, name))
    azimuths = BOUNDS["azimuths"]
    text = _list(azimuths, geometry.azimuths)
    if geometry.azimuths != STANDARD_AZIMUTHS or _is_exact(azimuths, geometry.azimuths):
        found[azimuths.key] = text
    return found


def _radius(part: str, value: float | Sequence[float]) -> tuple[str, str]:
    """The key and the text of a radius: by the side of its triangle only where that alone gives the same float."""
    radius, side = BOUNDS[f"{part}_radius"], BOUNDS[f"{part}_side"]
    bound = side if isinstance(value, float) and not _is_exact(radius, value) and _is_exact(side, value) else radius
    return bound.key, _numbers(bound, value)


def _mount(robot: Robot) -> dict[str, str]:
    mount = robot.geometry.mount
    found = {
        BOUNDS[f"mount_{name}"].key: decimal(BOUNDS[f"mount_{name}"], getattr(mount, name))
        for name in ("x", "y", "z", "rotation")
    }
    return {**found, "upside_down": "true" if mount.upside_down else "false"}


def _joints(robot: Robot) -> dict[str, str]:
    found = {}
    for name in _LIMITS:
        value = getattr(robot.joints, name)
        if name in _REQUIRED_LIMITS or (value is not None and name not in robot.joints.derived):
            found[BOUNDS[name].key] = _numbers(BOUNDS[name], value)
    return found


def _workspace(robot: Robot) -> dict[str, str]:
    workspace = robot.workspace
    found = {}
    for name in (*_SHEET, "park", "max_pressure_angle", "max_forearm_swing"):
        value = getattr(workspace, name)
        if name == "park":
            found[BOUNDS[name].key] = _list(BOUNDS[name], value)
        elif value is not None:
            found[BOUNDS[name].key] = decimal(BOUNDS[name], value)
    return found


def _numbers(bound: Bound, value: float | Sequence[float]) -> str:
    """One number for all three joints or arms where they are equal, a list where they are not."""
    if isinstance(value, Sequence):
        return decimal(bound, value[0]) if len(set(value)) == 1 else _list(bound, value)
    return decimal(bound, value)


def _list(bound: Bound, values: Sequence[float]) -> str:
    return f"[{', '.join(decimal(bound, value) for value in values)}]"


def _is_exact(bound: Bound, value: float | Sequence[float]) -> bool:
    values = value if isinstance(value, Sequence) else (value,)
    return all(bound.to_si(float(decimal(bound, one))) == one for one in values)


def _text(key: str, text: str) -> str:
    """A TOML basic string; what is not printable is escaped."""
    if any(0xD800 <= ord(letter) <= 0xDFFF for letter in text):
        raise RobotError(f"{key} holds half of a surrogate pair, which no file can hold", hint=f"write {key} anew")
    return '"' + "".join(_escape(letter) for letter in text) + '"'


def _escape(letter: str) -> str:
    if letter in '"\\':
        return f"\\{letter}"
    if letter.isprintable():
        return letter
    code = ord(letter)
    return f"\\u{code:04X}" if code < 0x10000 else f"\\U{code:08X}"


def _comment(text: str) -> list[str]:
    """The lines of a comment; whatever would end a comment or move a cursor becomes a space."""
    found = []
    for line in text.split("\n"):
        safe = "".join(letter if letter.isprintable() else " " for letter in line)
        found += [f"# {part}" for part in textwrap.wrap(safe, _WIDTH, break_on_hyphens=False)]
    return found
