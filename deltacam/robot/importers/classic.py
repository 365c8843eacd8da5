"""The four numbers of tutorials: f, e, rf and re.

After "Delta robot kinematics" by mzavatsky (Trossen Robotics forum), which LinuxCNC's and many programs' kinematics
come from: f is the side of the base's triangle, e that of the effector's, rf the upper arm, re the forearm. Joint 1 on
-y, then 2 and 3 counter-clockwise; angle 0 is level and outwards, positive is down, as ours. Where the joints are on
these triangles differs between texts, and so must be said: at the middles of the sides (radius = side / (2 sqrt 3)) or
at the vertices (side / sqrt 3).
"""

from __future__ import annotations

import json
import math
from collections.abc import Sequence
from typing import Final

from deltacam.errors import RobotError
from deltacam.robot.bounds import BOUNDS
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.importers.description import Choices, Description, Fact
from deltacam.robot.importers.ledger import Entry, Ledger, Source, ini_entries, numbers, one_of

NAME: Final = "classic"
TITLE: Final = "the description by f, e, rf and re"
USES: Final = ("units", "joints_at")
_KEYS: Final = ("f", "e", "rf", "re")
_UNITS: Final = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "inch": 25.4}
PLACES: Final = {"middles": 1.0 / (2.0 * math.sqrt(3.0)), "vertices": 1.0 / math.sqrt(3.0)}
"""The radius of the joints per side of the triangle."""


def is_like(source: Source) -> bool:
    """Whether the file has all four numbers."""
    try:
        return set(_KEYS) <= {entry.key for entry in _entries(source) if not entry.section}
    except RobotError:
        return False


def describe(sources: Sequence[Source], choices: Choices) -> Description:
    """The robot of four numbers.

    Raises:
        RobotError: one is missing or wrong, or it is not said in which unit they are or where the joints are.
    """
    file = sources[0].name
    ledger = Ledger(entry for source in sources for entry in _entries(source))
    facts: list[Fact] = []
    scale = _unit(ledger, choices, facts, file)
    base, effector = _places(ledger, choices, facts, file)
    geometry = DeltaGeometry(
        base_radius=_length(ledger, "f", "base_radius", PLACES[base] * scale, facts, file),
        effector_radius=_length(ledger, "e", "effector_radius", PLACES[effector] * scale, facts, file),
        upper_arm=_length(ledger, "rf", "upper_arm", scale, facts, file),
        forearm=_length(ledger, "re", "forearm", scale, facts, file),
    )
    notes = "the tool is the middle of the effector's joints; a longer tool lowers the sheet by its length"
    return Description(
        name=file.rpartition(".")[0] or file,
        program=TITLE,
        files=tuple(source.name for source in sources),
        geometry=geometry,
        facts=tuple(facts),
        unused=ledger.unused(),
        notes=(notes,),
    )


def _entries(source: Source) -> list[Entry]:
    """The values of a JSON object, or of lines ``key = value`` as TOML has them.

    Raises:
        RobotError: it starts like JSON and is none.
    """
    if not source.text.lstrip().startswith("{"):
        found = ini_entries(source, marks="#;")
        return [Entry(one.section, one.key, one.value.strip(" \"',"), one.place) for one in found]
    try:
        pairs = json.loads(source.text, object_pairs_hook=list)
    except (ValueError, RecursionError) as problem:
        raise RobotError(f"the file is not JSON: {str(problem)[:80]}", where=source.name) from None
    return [Entry("", key, value if isinstance(value, str) else _shown(value), source.name) for key, value in pairs]


def _shown(value: object) -> str:
    try:
        return repr(value)
    except ValueError:  # a whole number of thousands of digits
        return "a huge number"


def _length(ledger: Ledger, key: str, ours: str, scale: float, facts: list[Fact], file: str) -> float:
    entry = ledger.find("", key)
    if entry is None:
        raise RobotError(f"{key} is missing", where=file, hint=f"the file needs {', '.join(_KEYS)}")
    number = numbers(entry, [entry.value])[0] * scale
    facts.append(Fact(f"{entry.place} {key}", entry.value, f"{BOUNDS[ours].key} = {number:g}"))
    return BOUNDS[ours].to_si(number)


def _unit(ledger: Ledger, choices: Choices, facts: list[Fact], file: str) -> float:
    """Millimetres in a unit of the file."""
    entry, said = ledger.find("", "units"), choices.millimetres_per_unit
    if entry is None and said is None:
        raise RobotError("the file does not say its unit", where=file, hint="say --units mm, cm, m or in")
    if entry is None:
        return said or 1.0
    scale = one_of(entry, _UNITS, "unit of length")
    if said is not None and said != scale:
        raise RobotError(f"--units is not that of the file, {entry.value}", where=entry.place, hint="leave --units out")
    facts.append(Fact(f"{entry.place} units", entry.value, f"lengths times {scale:g} mm"))
    return scale


def _places(ledger: Ledger, choices: Choices, facts: list[Fact], file: str) -> tuple[str, str]:
    """Where the joints are on the triangles of the base and of the effector."""
    entry, said = ledger.find("", "joints_at"), choices.joints_at
    written = None if entry is None else to_places(entry.value)
    if said is None and written is None:
        hint = (
            "say --joints-at middles or --joints-at vertices, as its drawing shows; or middles,vertices where the base "
        )
        hint += "and the effector differ"
        raise RobotError("the file does not say where on the sides f and e the joints are", where=file, hint=hint)
    if said is not None and written is not None and said != written:
        raise RobotError("--joints-at is not what the file says", where=file, hint="leave --joints-at out")
    places = said or written or ("", "")
    source = "--joints-at" if entry is None else f"{entry.place} joints_at"
    facts.append(Fact(source, ",".join(places), "joints of the base and of the effector on their triangles"))
    return places


def to_places(text: str) -> tuple[str, str]:
    """The two places that ``middles``, ``vertices`` or ``middles,vertices`` names: base, effector.

    Raises:
        RobotError: it names no such places.
    """
    words = tuple(word.strip() for word in text.split(","))
    if len(words) > 2 or not set(words) <= set(PLACES):
        hint = "use middles or vertices, or two: middles,vertices for the base and the effector"
        raise RobotError(f"{text[:40]!r} is no place of joints on a triangle", hint=hint)
    return words[0], words[-1]
