"""The unit of a drawing: stated by the user, or by the file; never guessed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Final

from deltacam.errors import DrawingError
from deltacam.model import Finding
from deltacam.units import METRES_PER, POSSIBLE_SIZES, USUAL_SIZES, likely_units, metres_per

MISSING: Final = "missing"

_SURVEY_FOOT: Final = 1200.0 / 3937.0

_HEADER_UNITS: Final[dict[int, tuple[str, float]]] = {
    1: ("in", METRES_PER["in"]),
    2: ("ft", METRES_PER["ft"]),
    4: ("mm", METRES_PER["mm"]),
    5: ("cm", METRES_PER["cm"]),
    6: ("m", METRES_PER["m"]),
    8: ("microinch", 25.4e-9),
    9: ("mil", METRES_PER["mil"]),
    10: ("yd", 0.9144),
    13: ("um", METRES_PER["um"]),
    14: ("dm", 0.1),
    21: ("US survey foot", _SURVEY_FOOT),
    22: ("US survey inch", _SURVEY_FOOT / 12.0),
    23: ("US survey yard", _SURVEY_FOOT * 3.0),
}
"""$INSUNITS to the unit's name and metres (Autodesk DXF reference, header variables)."""

_NOT_FOR_PARTS: Final[dict[int, str]] = {
    3: "mile",
    7: "kilometre",
    11: "angstrom",
    12: "nanometre",
    15: "decametre",
    16: "hectometre",
    17: "gigametre",
    18: "astronomical unit",
    19: "light year",
    20: "parsec",
    24: "US survey mile",
}
"""$INSUNITS of units in which nobody draws a part, by the same reference."""

_SYSTEMS: Final = {0: "inch", 1: "metric"}
_IN_FEET: Final = (3, 4)  # engineering and architectural

_LARGE: Final = 40.0 * METRES_PER["in"]
"""Of real files whose unit is larger than a millimetre, most with larger parts were drawn in millimetres."""


@dataclass(frozen=True, slots=True)
class Header:
    """What a file's header says about lengths; None where it says nothing.

    Attributes:
        insunits: $INSUNITS, the unit of the drawing; 0 says that there is none.
        measurement: $MEASUREMENT, inch (0) or metric (1) line types and patterns. Often wrong: only a hint.
        lunits: $LUNITS, how a CAD program shows lengths; 3 and 4 are feet and inches. Only a hint.
    """

    insunits: int | None = None
    measurement: int | None = None
    lunits: int | None = None


@dataclass(frozen=True, slots=True)
class Scale:
    """How long one unit of the drawing is.

    Attributes:
        metres: in one unit; as if it were mm where nobody says.
        name: of the unit; empty where nobody says.
        source: who states it: header, --units, deltacam.toml, given or missing.
    """

    metres: float
    name: str
    source: str


def read_header(document: Any, data: bytes) -> Header:
    """What the file itself says; a document that was read also has values that the reader filled in.

    Args:
        document: of ezdxf.
        data: the bytes of the file.
    """

    def value(name: str) -> int | None:
        found = document.header.get(name) if name.encode() in data else None
        return found if isinstance(found, int) else None

    return Header(value("$INSUNITS"), value("$MEASUREMENT"), value("$LUNITS"))


def choose(
    header: Header, *, unit: str | None = None, metres_per_unit: float | None = None, default: str | None = None
) -> Scale:
    """The scale to apply; its source is ``missing`` where nobody states a unit that can be used.

    Args:
        header: what the file says.
        unit: what the user states; wins over the header.
        metres_per_unit: an exact factor; wins over all others.
        default: what the user states for files that state nothing.

    Raises:
        DrawingError: a factor that is not a positive number.
        DeltacamError: a ``unit`` or ``default`` that is not known.
    """
    if metres_per_unit is not None:
        if not (math.isfinite(metres_per_unit) and metres_per_unit > 0.0):
            raise DrawingError(f"{metres_per_unit} metres per unit is not a positive number")
        return Scale(metres_per_unit, _name(metres_per_unit), "given")
    if unit is not None:
        return Scale(metres_per(unit), _name(metres_per(unit)), "--units")
    if header.insunits in _HEADER_UNITS:
        name, metres = _HEADER_UNITS[header.insunits]
        return Scale(metres, name, "header")
    if default is not None and not header.insunits:
        return Scale(metres_per(default), _name(metres_per(default)), "deltacam.toml")
    return Scale(METRES_PER["mm"], "", MISSING)


def findings(scale: Scale, size: tuple[float, float] | None, header: Header) -> tuple[Finding, ...]:
    """What a person should know about the unit and the size; blocking where the unit must be stated first.

    Args:
        scale: as `choose` gave it.
        size: width and height of all curves, read with that scale, m; None where there are none.
        header: what the file says.
    """
    drawn = None if size is None or not max(size) > 0.0 else (size[0] / scale.metres, size[1] / scale.metres)
    if scale.source == MISSING:
        return (_missing(drawn, header),)
    if scale.source == "given":
        return ()
    return (*_stated_elsewhere(scale, header), *(_surprising(scale, drawn) if drawn else ()))


def _missing(drawn: tuple[float, float] | None, header: Header) -> Finding:
    """Nobody states a unit that can be used."""
    what = "the drawing states no unit"
    if header.insunits in _NOT_FOR_PARTS:
        name = f"{_NOT_FOR_PARTS[header.insunits]} ($INSUNITS = {header.insunits})"
        what = f"the header's unit, {name}, is not one that a part is drawn in"
    elif header.insunits:
        what = f"the header's unit, $INSUNITS = {header.insunits}, does not exist"
    best = "mm"
    if drawn:
        likely = likely_units(*drawn)
        best = next(iter(likely), best)
        others = [unit for unit in dict.fromkeys(("in", best)) if unit != "mm"]
        sizes = [f"{_in_mm(drawn, METRES_PER[unit])} if it is {_word(unit)}" for unit in others]
        what += ", ".join([f": it is {_in_mm(drawn, METRES_PER['mm'])} if its unit is mm", *sizes])
    return Finding(what, hint=f"state the unit: --units {best}{_clue(header)}", kind="units", blocks=True)


def _clue(header: Header) -> str:
    """What the header gives away about the unit without stating it."""
    if header.lunits in _IN_FEET:
        return f" (the header shows lengths in feet and inches: $LUNITS = {header.lunits})"
    if header.measurement in _SYSTEMS:
        system = f"{_SYSTEMS[header.measurement]}, $MEASUREMENT = {header.measurement}"
        return f" (the header says {system}, which is often wrong)"
    return ""


def _stated_elsewhere(scale: Scale, header: Header) -> tuple[Finding, ...]:
    """The user states the unit and not, or not the same as, the file."""
    if scale.source == "deltacam.toml":
        what = f"the file states no unit: it is read in {scale.name} as deltacam.toml says"
        return (Finding(what, hint="state the unit if that is wrong: --units", kind="units"),)
    code = header.insunits or 0
    name, metres = _HEADER_UNITS.get(code, (_NOT_FOR_PARTS.get(code, ""), 0.0))
    if not name or math.isclose(metres, scale.metres, rel_tol=1e-9):
        return ()
    what = f"the file says its unit is {name}, but it is read in {scale.name} as --units says"
    return (Finding(what, hint="leave --units away if the file is right" if metres else "", kind="units"),)


def _surprising(scale: Scale, drawn: tuple[float, float]) -> tuple[Finding, ...]:
    """A size that a part seldom or never has, so that the unit is to be doubted."""
    larger = max(drawn) * scale.metres
    by_user = scale.source == "--units"
    if not POSSIBLE_SIZES[0] <= larger <= POSSIBLE_SIZES[1]:
        limit = f"{'more' if larger > 1.0 else 'less'} than any part"
        return (_doubt(scale, drawn, f", {limit}", "size", blocks=not by_user),)
    if larger < USUAL_SIZES[0] and not by_user:
        return (_doubt(scale, drawn, "", "size", blocks=False),)
    if larger > _LARGE and scale.metres > METRES_PER["mm"] and not by_user:
        return (_doubt(scale, drawn, "", "units", blocks=False),)
    return ()


def _doubt(scale: Scale, drawn: tuple[float, float], limit: str, kind: str, *, blocks: bool) -> Finding:
    """The size, and what it would be in the units that would make it a usual one."""
    what = f"the drawing is {_in_mm(drawn, scale.metres)} as its unit is {scale.name} ({scale.source}){limit}"
    likely = [unit for unit in likely_units(*drawn) if unit != scale.name]
    sizes = ", ".join(f"{_in_mm(drawn, METRES_PER[unit])} if it were {_word(unit)}" for unit in likely)
    what += f"; it would be {sizes}" if likely else ""
    keep = f"--units {scale.name} if the size is right" if blocks and scale.name in METRES_PER else ""
    change = f"--units {likely[0]} if the unit is wrong" if likely else ""
    hint = "state the unit: " + ", ".join(filter(None, (change, keep)))
    return Finding(what, hint=hint if change or keep else "draw it again in mm", kind=kind, blocks=blocks)


def _in_mm(drawn: tuple[float, float], metres: float) -> str:
    """The size in mm, if one unit is so many metres."""
    return " x ".join(f"{1e3 * metres * side:.6g}" for side in drawn) + " mm"


def _word(unit: str) -> str:
    """The unit as messages write it in a sentence."""
    return {"in": "inch", "pt": "pt (1/72 inch)"}.get(unit, unit)


def _name(metres: float) -> str:
    """The short name of a unit, or its length in metres."""
    for name, length in METRES_PER.items():
        if math.isclose(length, metres, rel_tol=1e-12):
            return name
    return f"{metres:.9g} m"
