"""RepRapFirmware's ``config.g`` with ``M669 K10``.

After RepRapFirmware's ``src/Movement/Kinematics/RotaryDeltaKinematics.cpp`` and ``.h``. U: upper arms, L: rods,
H: heights of the bearings above the bed, R: radius, already less that of the effector's joints, A: least and largest
angle of an arm, positive *upwards*, X, Y and Z: corrections of the arms' azimuths -150, -30 and 90, B: radius of the
bed.
M203 and M201 limit the tool in the plane, to the lower of X and Y, not the joints.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from deltacam.errors import RobotError
from deltacam.robot.bounds import BOUNDS
from deltacam.robot.dimensions import DeltaGeometry, Mount, Triple
from deltacam.robot.importers.description import Choices, Description, Fact
from deltacam.robot.importers.ledger import Entry, Ledger, Source, numbers

NAME: Final = "reprapfirmware"
TITLE: Final = "RepRapFirmware"
USES: Final[tuple[str, ...]] = ()
_LONGEST: Final = 1000  # characters of a line; the firmware takes less
_ROTARY_DELTA: Final = 10.0
_AZIMUTHS: Final = (-150.0, -30.0, 90.0)
_DEFAULTS: Final = {
    "U": (100.0,) * 3,
    "L": (200.0,) * 3,
    "H": (250.0,) * 3,
    "R": (50.0,),
    "A": (-45.0, 45.0),
    "B": (80.0,),
    "X": (0.0,),
    "Y": (0.0,),
    "Z": (0.0,),
}
"""What the firmware takes where M669 does not say."""

_BECAME: Final = {
    "U": "upper_arm_mm",
    "L": "forearm_mm",
    "H": "[mount] z_mm",
    "R": "base_radius_mm, with effector_radius_mm = 0",
    "A": "max_deg and min_deg, with the other sign",
    "B": "radius of the sheet, unless --sheet says otherwise",
    "X": "azimuth of arm 1: -150 + X",
    "Y": "azimuth of arm 2: -30 + Y",
    "Z": "azimuth of arm 3: 90 + Z",
}
_DIFFERENCE: Final = (
    "the file gives only base radius - effector radius, which decides the motion; shown here as base radius"
)


def is_like(source: Source) -> bool:
    """Whether the file names this kind of machine."""
    return re.search(r"^[ \t]*M669\b[^;\n]*\bK10\b", source.text, flags=re.MULTILINE | re.IGNORECASE) is not None


def describe(sources: Sequence[Source], _choices: Choices) -> Description:
    """The robot of a ``config.g``.

    Raises:
        RobotError: another machine, a value that is wrong, bearings of different heights, or lengths in inches.
    """
    entries = [entry for source in sources for entry in _entries(source)]
    ledger = Ledger(entries)
    facts: list[Fact] = []
    _check_kind(ledger, entries, sources[0].name, facts)
    values = {letter: _values(ledger, letter, facts) for letter in _DEFAULTS}
    if len(set(values["H"])) > 1:
        what = f"the bearings are at different heights, H{':'.join(f'{h:g}' for h in values['H'])}"
        raise RobotError(what, where="M669", hint="deltacam needs the three joints in one plane; level the bearings")
    low, high = values["A"]
    bearing = {letter: values[letter][0] for letter in "RHB"}
    turned = [usual + values[letter][0] for usual, letter in zip(_AZIMUTHS, "XYZ", strict=True)]
    geometry = DeltaGeometry(
        base_radius=BOUNDS["base_radius"].to_si(bearing["R"]),
        effector_radius=0.0,
        upper_arm=_si("upper_arm", values["U"]),
        forearm=_si("forearm", values["L"]),
        azimuths=_si("azimuths", turned),
        mount=Mount(z=BOUNDS["mount_z"].to_si(bearing["H"])),
    )
    return Description(
        name=sources[0].name.rpartition(".")[0] or sources[0].name,
        program=TITLE,
        files=tuple(source.name for source in sources),
        geometry=geometry,
        joint_min=_si("min", (-high,) * 3),
        joint_max=_si("max", (-low,) * 3),
        tool_speed=_tool(ledger, "M203", 1e3 * 60.0, "[tool] max_speed_m_min", 1e-3, facts),
        tool_acceleration=_tool(ledger, "M201", 1e3, "[tool] max_acceleration_m_s2", 1e-3, facts),
        bed_z=0.0,
        bed_radius=BOUNDS["radius"].to_si(bearing["B"]),
        facts=tuple(facts),
        unused=ledger.unused(),
        notes=(*_macros(entries), _NOTE),
        remarks=(("geometry.effector_radius_mm", _DIFFERENCE),),
    )


_NOTE: Final = (
    "the firmware's tool is the nozzle: with another head, sheet_z_mm changes by the difference of the two heights "
    "above the bed. The firmware's joint angles have the other sign"
)


def _entries(source: Source) -> list[Entry]:
    """The commands of the file, an entry for every letter: section M669, key U, value 100:100:100."""
    found = []
    for number, raw in enumerate(source.lines, start=1):
        place = f"{source.name}:{number}"
        if len(raw) > _LONGEST:
            raise RobotError(f"a line of {len(raw)} characters is no command", where=place)
        quoted = re.sub(r'"[^"]*"', lambda text: text[0].replace(";", "\0").replace("(", "\1"), raw)
        line = re.sub(r"\([^)]*\)", " ", quoted.split(";")[0])
        command = re.match(r"\s*([GMT]\d+(?:\.\d+)?)", line, flags=re.IGNORECASE | re.ASCII)
        if command is None:
            found += [Entry("", line.strip(), "", place)] if line.strip() else []
            continue
        rest = line[command.end() :]
        words = re.findall(r'([A-Za-z])\s*("[^"]*"|\{[^}]*\}|[^\sA-Za-z"{]*(?:[eE][-+]?\d+)?)', rest)
        name = command[1].upper()
        values = [(letter.upper(), value.replace("\0", ";").replace("\1", "(")) for letter, value in words]
        found += [Entry(name, *pair, place) for pair in values] or [Entry(name, "", "", place)]
    return found


def _check_kind(ledger: Ledger, entries: Sequence[Entry], file: str, facts: list[Fact]) -> None:
    """Refuse another kinematics, and lengths in inches.

    Raises:
        RobotError: which.
    """
    kind = ledger.find("M669", "K")
    if kind is None or numbers(kind, [kind.value]) != (_ROTARY_DELTA,):
        shown = "missing" if kind is None else f"K{kind.value[:40]}"
        raise RobotError(f"the kinematics of M669 is {shown}, not K10 (rotary delta)", where=file)
    facts.append(Fact(f"{kind.place} M669 K", kind.value, "a rotary delta"))
    for entry in entries:
        if entry.section == "G20":
            raise RobotError(
                "the file switches to inches (G20)", where=entry.place, hint="import a file in millimetres"
            )


def _values(ledger: Ledger, letter: str, facts: list[Fact]) -> tuple[float, ...]:
    """The numbers of a letter of M669; one number stands for all three arms, as in the firmware.

    Raises:
        RobotError: not numbers, or not as many as the letter has.
    """
    usual = _DEFAULTS[letter]
    entry = ledger.find("M669", letter)
    if entry is None:
        shown = ":".join(f"{value:g}" for value in dict.fromkeys(usual))
        facts.append(Fact(f"default of RepRapFirmware for M669 {letter}", shown, _BECAME[letter]))
        return usual
    values = numbers(entry, entry.value.split(":"))
    if letter in "ULH" and len(values) == 1:
        values *= 3
    if len(values) != len(usual):
        raise RobotError(f"M669 {letter}{entry.value[:40]} must have {len(usual)} values", where=entry.place)
    facts.append(Fact(f"{entry.place} M669 {letter}", entry.value, _BECAME[letter]))
    return values


def _tool(ledger: Ledger, command: str, per_si: float, became: str, factor: float, facts: list[Fact]) -> float | None:
    """The lower of the X and Y limits in SI; None where one is not given."""
    found = [ledger.find(command, letter) for letter in "XY"]
    entries = [entry for entry in found if entry is not None]
    if len(entries) < 2:
        return None
    lowest = min(numbers(entry, [entry.value])[0] for entry in entries)
    shown = ", ".join(f"{entry.key}{entry.value}" for entry in entries)
    facts.append(Fact(f"{entries[0].place} {command}", shown, f"{became} = {lowest * factor:g}, the lower one"))
    return lowest / per_si


def _macros(entries: Sequence[Entry]) -> tuple[str, ...]:
    """What the file runs from other files."""
    return tuple(
        f"{entry.place} runs {entry.value[:60]}, which was not read"
        for entry in entries
        if entry.section == "M98" and entry.key == "P"
    )


def _si(name: str, values: Sequence[float]) -> Triple:
    one, two, three = map(BOUNDS[name].to_si, values)
    return one, two, three
