"""The unit of a drawing: stated by the user, or by the file; never guessed."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

from deltacam.errors import DrawingError
from deltacam.model import Finding
from deltacam.units import METRES_PER, metres_per

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
}
"""$INSUNITS to the unit's name and metres (Autodesk DXF reference, header variables)."""


@dataclass(frozen=True, slots=True)
class Scale:
    """How long one unit of the drawing is.

    Attributes:
        metres: in one unit.
        name: of the unit.
        source: who states it: header, --units or given.
        findings: where what was stated does not agree.
    """

    metres: float
    name: str
    source: str
    findings: tuple[Finding, ...] = ()


def choose(header: int | None, *, unit: str | None, metres_per_unit: float | None) -> Scale | None:
    """The scale to apply, or None where nobody states one.

    Args:
        header: $INSUNITS as the file itself gives it; None where it does not.
        unit: what the user states; wins over the header, with a finding where they differ.
        metres_per_unit: an exact factor; wins over both.

    Raises:
        DrawingError: a factor that is not a positive number, or a header code that stands for no usable unit.
        DeltacamError: a ``unit`` that is not known.
    """
    if metres_per_unit is not None:
        if not (math.isfinite(metres_per_unit) and metres_per_unit > 0.0):
            raise DrawingError(f"{metres_per_unit} metres per unit is not a positive number")
        return Scale(metres_per_unit, _name(metres_per_unit), "given")
    name, metres = _HEADER_UNITS.get(header or 0, ("", 0.0))
    if unit is not None:
        stated = metres_per(unit)
        findings: tuple[Finding, ...] = ()
        if metres and not math.isclose(metres, stated, rel_tol=1e-9):
            what = f"the file says its unit is {name}, but it is read in {_name(stated)} as --units says"
            findings = (Finding(what, hint="leave --units away if the file is right"),)
        return Scale(stated, _name(stated), "--units", findings)
    if metres:
        return Scale(metres, name, "header")
    if header:
        what = f"the header's unit, $INSUNITS = {header}, is not one that a part is drawn in"
        raise DrawingError(what, hint="state the unit: --units mm")
    return None


def missing(size: tuple[float, float]) -> DrawingError:
    """The error for a drawing without a unit that is ``size`` units wide and high."""
    width, height = size
    in_mm = f"{width:.6g} x {height:.6g} mm if its unit is mm"
    in_inch = f"{25.4 * width:.6g} x {25.4 * height:.6g} mm if it is inch"
    return DrawingError(f"the drawing states no unit: it is {in_mm}, {in_inch}", hint="state the unit: --units mm")


def _name(metres: float) -> str:
    """The short name of a unit, or its length in metres."""
    for name, length in METRES_PER.items():
        if math.isclose(length, metres, rel_tol=1e-12):
            return name
    return f"{metres:.9g} m"
