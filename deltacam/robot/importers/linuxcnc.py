"""LinuxCNC's INI and HAL files of a machine with ``rotarydeltakins``.

After LinuxCNC's ``src/emc/kinematics/rotarydeltakins-common.h``: ``platformradius`` and ``footradius`` are the two
radii, ``thighlength`` the upper arm, ``shinlength`` the forearm, in the machine's units. The frame, the azimuths (-90,
30, 150), the zero and the sign of the joints, which are in degrees, are ours.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Final

from deltacam.errors import RobotError
from deltacam.robot.bounds import BOUNDS
from deltacam.robot.dimensions import DeltaGeometry, Triple
from deltacam.robot.importers.description import Choices, Description, Fact
from deltacam.robot.importers.ledger import Entry, Ledger, Source, ini_entries, one_of, to_number

NAME: Final = "linuxcnc"
TITLE: Final = "LinuxCNC"
USES: Final = ("units",)
_PREFIX: Final = "rotarydeltakins."
_LENGTHS: Final = {
    "platformradius": ("base_radius", 10.0),
    "footradius": ("effector_radius", 6.0),
    "thighlength": ("upper_arm", 10.0),
    "shinlength": ("forearm", 14.0),
}
"""The pin, our dimension, and what LinuxCNC takes where no file sets it."""

_UNITS: Final = {"mm": 1.0, "metric": 1.0, "inch": 25.4, "in": 25.4, "imperial": 25.4}
_DEGREES: Final = {"degree": 1.0, "deg": 1.0}
_LIMITS: Final = {
    "MIN_LIMIT": "min",
    "MAX_LIMIT": "max",
    "MAX_VELOCITY": "max_speed",
    "MAX_ACCELERATION": "max_acceleration",
}
_RATING: Final = {
    "MAX_LINEAR_VELOCITY": "tool_max_speed",
    "MAX_LINEAR_ACCELERATION": "tool_max_acceleration",
}


def is_like(source: Source) -> bool:
    """Whether the file names this kind of machine."""
    return re.search(r"^[^#\n]*\brotarydeltakins\b", source.text, flags=re.MULTILINE) is not None


def describe(sources: Sequence[Source], choices: Choices) -> Description:
    """The robot of an INI file, of HAL files, or of both.

    Raises:
        RobotError: no rotary delta, no unit, or a value that is wrong or not in the files.
    """
    if not any(map(is_like, sources)):
        raise RobotError("no file names rotarydeltakins", where=sources[0].name, hint="name the HAL file beside it")
    inis = [source for source in sources if _is_ini(source)]
    ini = Ledger(entry for source in inis for entry in ini_entries(source))
    hal = Ledger(entry for source in sources if source not in inis for entry in _hal_entries(source))
    facts: list[Fact] = []
    elsewhere = _elsewhere(sources)
    scale = _unit(ini, choices, facts, sources[0].name)
    base, effector, upper, fore = (_length(hal, ini, pin, scale, facts, unread=elsewhere) for pin in _LENGTHS)
    limits = {ours: _per_joint(ini, key, ours, facts) for key, ours in _LIMITS.items()}
    _check_angles(ini, facts)
    rating = {ours: _rating(ini, key, ours, scale, facts) for key, ours in _RATING.items()}
    return Description(
        name=sources[0].name.rpartition(".")[0] or sources[0].name,
        program=TITLE,
        files=tuple(source.name for source in sources),
        geometry=DeltaGeometry(base, effector, upper, fore),
        joint_min=limits["min"],
        joint_max=limits["max"],
        max_joint_speed=limits["max_speed"],
        max_joint_acceleration=limits["max_acceleration"],
        tool_speed=rating["tool_max_speed"],
        tool_acceleration=rating["tool_max_acceleration"],
        facts=tuple(facts),
        unused=ini.unused() + hal.unused(),
        notes=tuple(f"{name}, which was not read; name it beside the file if it matters" for name in elsewhere),
    )


def _is_ini(source: Source) -> bool:
    return re.search(r"^[ \t]*\[[^\]\n]*\][ \t]*$", source.text, flags=re.MULTILINE) is not None


def _hal_entries(source: Source) -> list[Entry]:
    """The commands of a HAL file; ``setp PIN VALUE`` and its other form ``PIN = VALUE`` as section setp, key PIN."""
    found = []
    for number, raw in enumerate(source.lines, start=1):
        words = raw.split("#")[0].split()
        place = f"{source.name}:{number}"
        if len(words) >= 3 and words[0] == "setp":
            found.append(Entry("setp", words[1], " ".join(words[2:]), place))
        elif len(words) >= 3 and words[1] == "=":
            found.append(Entry("setp", words[0], " ".join(words[2:]), place))
        elif words and words[0] == "net":
            found += [Entry("net", word, " ".join(words[1:2]), place) for word in words[2:] if word.isprintable()]
        elif words:
            found.append(Entry("", words[0], " ".join(words[1:]), place))
    return found


def _unit(ini: Ledger, choices: Choices, facts: list[Fact], file: str) -> float:
    """Millimetres in a unit of the machine.

    Raises:
        RobotError: neither the files nor the user say, or they say different things.
    """
    entry = ini.find("TRAJ", "LINEAR_UNITS")
    said = choices.millimetres_per_unit
    if entry is None and said is None:
        hint = "name the INI file too, which has [TRAJ] LINEAR_UNITS; or say --units mm or --units in"
        raise RobotError("the files do not say the unit of the lengths", where=file, hint=hint)
    if entry is None:
        return said or 1.0
    scale = one_of(entry, _UNITS, "unit of length")
    if said is not None and said != scale:
        what = f"--units is not that of the file, {entry.label} = {entry.value}"
        raise RobotError(what, where=entry.place, hint="leave --units out")
    facts.append(Fact(f"{entry.place} {entry.label}", entry.value, f"lengths times {scale:g} mm"))
    return scale


def _length(hal: Ledger, ini: Ledger, pin: str, scale: float, facts: list[Fact], *, unread: Sequence[str]) -> float:
    """A dimension in SI.

    Raises:
        RobotError: the pin is driven by a signal, its value is not known, or a file that was not read may set it.
    """
    ours, default = _LENGTHS[pin]
    signal = hal.find("net", _PREFIX + pin)
    if signal is not None:
        what = f"{_PREFIX}{pin} is driven by the signal {signal.value[:40]}, whose value no file says"
        raise RobotError(what, where=signal.place, hint=f"write `setp {_PREFIX}{pin} VALUE` in a copy of the file")
    key = BOUNDS[ours].key
    entry = hal.find("setp", _PREFIX + pin)
    if entry is None and unread:
        what = f"no file that was read sets {_PREFIX}{pin}, but {unread[0]}, which was not read"
        raise RobotError(what, hint="name the HAL files beside the INI file: deltacam robot import a.ini a.hal")
    if entry is None:
        facts.append(Fact(f"default of LinuxCNC for {_PREFIX}{pin}", f"{default:g}", f"{key} = {default * scale:g}"))
        return BOUNDS[ours].to_si(default * scale)
    value = _substituted(entry, ini)
    number = to_number(value) * scale
    facts.append(Fact(f"{entry.place} {_PREFIX}{pin}", entry.value, f"{key} = {number:g}"))
    if value is not entry:
        facts.append(Fact(f"{value.place} {entry.value}", value.value, key))
    return BOUNDS[ours].to_si(number)


def _substituted(entry: Entry, ini: Ledger) -> Entry:
    """The entry with the value of the INI file that it refers to: ``[KINS]THIGH`` or ``[KINS](THIGH)``.

    Raises:
        RobotError: there is no such value.
    """
    name = re.fullmatch(r"\[([^\]]+)\]\s*\(?([^()]+)\)?", entry.value)
    if name is None:
        return entry
    found = ini.find(name[1], name[2])
    if found is None:
        what = f"{entry.key} = {entry.value[:60]}, which no INI file says"
        raise RobotError(what, where=entry.place, hint="name the INI file beside the HAL file")
    return Entry(entry.section, entry.key, found.value, found.place)


def _per_joint(ini: Ledger, key: str, ours: str, facts: list[Fact]) -> Triple | None:
    """A limit of the three joints in SI; None where no joint has it.

    Raises:
        RobotError: some have it and some do not.
    """
    found = [ini.number(f"JOINT_{joint}", key) for joint in range(3)]
    given = [pair for pair in found if pair is not None]
    if not given:
        return None
    if len(given) < 3:
        missing = next(joint for joint, pair in enumerate(found) if pair is None)
        raise RobotError(f"[JOINT_{missing}] {key} is missing, which other joints have", where=given[0][0].place)
    one, two, three = (BOUNDS[ours].to_si(number) for _, number in given)
    facts += [
        Fact(f"{entry.place} {entry.label}", entry.value, f"{BOUNDS[ours].key}, joint {joint}")
        for joint, (entry, _) in enumerate(given, start=1)
    ]
    return one, two, three


def _check_angles(ini: Ledger, facts: list[Fact]) -> None:
    """Refuse joints that are not in degrees.

    Raises:
        RobotError: which unit the file has.
    """
    entry = ini.find("TRAJ", "ANGULAR_UNITS")
    if entry is not None:
        one_of(entry, _DEGREES, "unit of angle that rotarydeltakins has")
        facts.append(Fact(f"{entry.place} {entry.label}", entry.value, "angles are in degrees"))


def _rating(ini: Ledger, key: str, ours: str, scale: float, facts: list[Fact]) -> float | None:
    """A limit at the tool in SI; the file has units/s and units/s^2."""
    found = ini.number("TRAJ", key)
    if found is None:
        return None
    entry, number = found
    bound = BOUNDS[ours]
    si = number * scale / 1e3
    facts.append(Fact(f"{entry.place} {entry.label}", entry.value, f"[tool] {bound.key} = {si / bound.to_si(1.0):g}"))
    return si


def _elsewhere(sources: Sequence[Source]) -> tuple[str, ...]:
    """The files that the files name and that were not read."""
    pattern = r"^[ \t]*(?:#INCLUDE|source|HALFILE[ \t]*=|POSTGUI_HALFILE[ \t]*=)(.*)"
    return tuple(
        f"{source.name} names {name.strip()[:60]}"
        for source in sources
        for name in re.findall(pattern, source.text, flags=re.MULTILINE)
        if not any(name.strip().endswith(other.name) for other in sources)
    )
