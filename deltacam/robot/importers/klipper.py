"""Klipper's ``printer.cfg`` with ``kinematics: rotary_delta``.

After Klipper's ``klippy/kinematics/rotary_delta.py``, ``klippy/chelper/kin_rotary_delta.c`` and
``docs/Config_Reference.md``: ``shoulder_radius`` is already the base radius less the effector radius;
``shoulder_height`` is the height of the shoulders above the bed less the height of the effector's joints above the
nozzle; stepper a, b and c stand at 30, 150 and 270 degrees; an arm's angle is 0 where it is level and outwards, and
positive *upwards*.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.robot import kinematics
from deltacam.robot.bounds import BOUNDS
from deltacam.robot.dimensions import DeltaGeometry, Mount, Triple
from deltacam.robot.importers.description import Choices, Description, Fact
from deltacam.robot.importers.ledger import Entry, Ledger, Source, ini_entries, to_number

NAME: Final = "klipper"
TITLE: Final = "Klipper"
USES: Final[tuple[str, ...]] = ()
_STEPPERS: Final = ("stepper_a", "stepper_b", "stepper_c")
_ANGLES: Final = (30.0, 150.0, 270.0)
_DIFFERENCE: Final = (
    "the file gives only base radius - effector radius, which decides the motion; shown here as base radius"
)


def is_like(source: Source) -> bool:
    """Whether the file names this kind of machine."""
    return (
        re.search(r"^kinematics\s*[:=]\s*rotary_delta\b", source.text, flags=re.MULTILINE | re.IGNORECASE) is not None
    )


def describe(sources: Sequence[Source], _choices: Choices) -> Description:
    """The robot of a ``printer.cfg``.

    Raises:
        RobotError: another machine, a value that is missing or wrong, or one that no robot file can hold.
    """
    ledger = Ledger(entry for source in sources for entry in _entries(source))
    kind = ledger.find("printer", "kinematics")
    if kind is None or kind.value != "rotary_delta":
        shown = "missing" if kind is None else kind.value[:40]
        raise RobotError(f"[printer] kinematics is {shown}, not rotary_delta", where=sources[0].name)
    facts = [_fact(kind, "a rotary delta")]
    radius, height = (_required(ledger, "printer", key, sources) for key in ("shoulder_radius", "shoulder_height"))
    upper = _per_stepper(ledger, "upper_arm_length", "upper_arm_mm", sources, facts)
    lower = _per_stepper(ledger, "lower_arm_length", "forearm_mm", sources, facts)
    geometry = DeltaGeometry(
        base_radius=BOUNDS["base_radius"].to_si(to_number(radius)),
        effector_radius=0.0,
        upper_arm=_si("upper_arm", upper),
        forearm=_si("forearm", lower),
        azimuths=_si("azimuths", _angles(ledger, facts)),
        mount=Mount(z=BOUNDS["mount_z"].to_si(to_number(height))),
    )
    facts[1:1] = [
        _fact(radius, f"base_radius_mm = {radius.value}, effector_radius_mm = 0"),
        _fact(height, f"[mount] z_mm = {height.value}"),
    ]
    highest = _highest(ledger, geometry, sources, facts)
    speed, acceleration = _rating(ledger, facts)
    return Description(
        name=sources[0].name.rpartition(".")[0] or sources[0].name,
        program=TITLE,
        files=tuple(source.name for source in sources),
        geometry=geometry,
        joint_min=highest,
        tool_speed=speed,
        tool_acceleration=acceleration,
        bed_z=0.0,
        facts=tuple(facts),
        unused=ledger.unused(),
        notes=(*_included(sources), _NOTE),
        remarks=(("geometry.effector_radius_mm", _DIFFERENCE),),
    )


_NOTE: Final = (
    "Klipper's tool is the nozzle: with another head, sheet_z_mm changes by the difference of the two heights above "
    "the bed. Klipper's joint angles have the other sign"
)


def _entries(source: Source) -> list[Entry]:
    """The entries of the file; those that SAVE_CONFIG wrote at its end hold instead of those above."""
    lines = source.lines
    saved = [line[4:] if line.startswith("#*# ") else "" for line in lines]
    shown = ["" if line.startswith("#*#") else line for line in lines]
    above = ini_entries(Source(source.name, "\n".join(shown)), fold=True)
    below = ini_entries(Source(source.name, "\n".join(saved)), fold=True)
    return above + [Entry(e.section, e.key, e.value, e.place, overrides=True) for e in below if e.section]


def _required(ledger: Ledger, section: str, key: str, sources: Sequence[Source]) -> Entry:
    found = ledger.find(section, key)
    if found is None:
        raise RobotError(f"[{section}] {key} is missing", where=sources[0].name, hint="Klipper has no default for it")
    return found


def _per_stepper(
    ledger: Ledger, key: str, ours: str, sources: Sequence[Source], facts: list[Fact]
) -> tuple[float, ...]:
    """The value of every stepper; b and c have that of a where they give none."""
    first = _required(ledger, "stepper_a", key, sources)
    entries = [ledger.find(stepper, key) or first for stepper in _STEPPERS]
    facts += [_fact(entry, f"{ours}, arm {arm}") for arm, entry in enumerate(entries, start=1)]
    return tuple(to_number(entry) for entry in entries)


def _angles(ledger: Ledger, facts: list[Fact]) -> tuple[float, ...]:
    found = []
    for stepper, usual in zip(_STEPPERS, _ANGLES, strict=True):
        entry = ledger.find(stepper, "angle")
        found.append(usual if entry is None else to_number(entry))
        default = Fact(f"default of Klipper for [{stepper}] angle", f"{usual:g}", f"azimuth of arm {len(found)}")
        facts.append(default if entry is None else _fact(entry, f"azimuth of arm {len(found)}"))
    return tuple(found)


def _highest(ledger: Ledger, geometry: DeltaGeometry, sources: Sequence[Source], facts: list[Fact]) -> Triple:
    """The joint angles at the endstops, rad: where the tool on the axis is at ``position_endstop`` above the bed."""
    first = _required(ledger, "stepper_a", "position_endstop", sources)
    entries = [ledger.find(stepper, "position_endstop") or first for stepper in _STEPPERS]
    heights = [to_number(entry) for entry in entries]
    points = np.column_stack((np.zeros((3, 2)), np.array(heights) / 1e3))
    try:
        angles = np.diagonal(kinematics.inverse(geometry, points))
    except RobotError as problem:
        what = f"position_endstop is no place of this robot: {problem.what}"
        raise RobotError(
            what, where=sources[0].name, hint="check the lengths of the arms and position_endstop"
        ) from None
    for entry, angle in zip(entries, np.degrees(angles), strict=True):
        facts.append(_fact(entry, f"min_deg = {angle:.4f}, the endstop"))
    one, two, three = (float(angle) for angle in angles)
    return one, two, three


def _rating(ledger: Ledger, facts: list[Fact]) -> tuple[float | None, float | None]:
    """The rating at the tool, m/s and m/s^2; Klipper has mm/s and mm/s^2."""
    found: list[float | None] = []
    for key, ours, factor in (
        ("max_velocity", "[tool] max_speed_m_min", 0.06),
        ("max_accel", "[tool] max_acceleration_m_s2", 1e-3),
    ):
        entry = ledger.find("printer", key)
        found.append(None if entry is None else to_number(entry) / 1e3)
        if entry is not None:
            facts.append(_fact(entry, f"{ours} = {to_number(entry) * factor:g}"))
    return found[0], found[1]


def _included(sources: Sequence[Source]) -> tuple[str, ...]:
    """What the files refer to."""
    return tuple(
        f"{source.name} includes {name.strip()[:60]}, which was not read; name it beside the file if it matters"
        for source in sources
        for name in re.findall(r"^\[include ([^\]\n]*)\]", source.text, flags=re.MULTILINE)
    )


def _fact(entry: Entry, became: str) -> Fact:
    return Fact(f"{entry.place} {entry.label}", entry.value, became)


def _si(name: str, values: Sequence[float]) -> Triple:
    one, two, three = map(BOUNDS[name].to_si, values)
    return one, two, three
