"""The sections of a process file that say how a cut begins, ends, turns and holds."""

from __future__ import annotations

import difflib
from typing import Final, cast, get_args

from deltacam.cutting.process_file.bounds import BOUNDS, read, read_optional, read_whole
from deltacam.model import Gas, Grade, Heat, Lead, LeadShape, Loops, PowerLaw, Provenance, Slower, Tabs
from deltacam.settings import Table

AUTO: Final = "auto"
"""The length of a lead that is as long as it takes to reach the feed."""


def read_lead(top: Table, section: str) -> Lead:
    """The lead in that section; none where it is missing."""
    if not top.has(section):
        return Lead()
    table = top.table(section)
    bound = BOUNDS["lead.length_mm"]
    length = table.number_or("length_mm", AUTO, minimum=bound.minimum, maximum=bound.maximum)
    shape = cast("LeadShape", table.choice("shape", get_args(LeadShape)))
    angle = read(table, "lead.angle_deg", 90.0)
    return Lead(
        shape=shape,
        length=None if length is None else bound.to_si(length),
        radius=read_optional(table, "lead.radius_mm"),
        angle=Lead().angle if shape == "none" else angle,
    )


def read_engraving(top: Table) -> tuple[float | None, float | None]:
    """Feed, m/s, and power while engraving; None and None where the file says nothing."""
    if not top.has("engrave"):
        return None, None
    table = top.table("engrave")
    return read(table, "engrave.feed_m_min"), read(table, "engrave.power")


def read_pierce(top: Table) -> tuple[float | None, bool]:
    """The power of the pierce, None where it is that of the cut, and whether all pierces come first."""
    table = top.table("pierce", required=False)
    return read_optional(table, "pierce.power"), table.flag("first", default=False)


def read_power_law(top: Table) -> PowerLaw | None:
    """How the power follows the speed; None where the file says nothing."""
    if not top.has("power_law"):
        return None
    table = top.table("power_law")
    return PowerLaw(
        at_rest=read(table, "power_law.at_rest"),
        exponent=read(table, "power_law.exponent", 1.0),
        lowest=read(table, "power_law.lowest", 0.0),
    )


def read_slower(top: Table) -> tuple[Slower, ...]:
    """Where the feed is reduced."""
    return tuple(
        Slower(
            factor=read(table, "slower.factor"),
            diameter=read_optional(table, "slower.hole_diameter_mm"),
            radius=read_optional(table, "slower.radius_mm"),
        )
        for table in top.tables("slower")
    )


def read_loops(top: Table) -> Loops:
    """How corners are passed by a loop."""
    table = top.table("loops", required=False)
    return Loops(angle=read(table, "loops.angle_deg", 60.0), radius=read_optional(table, "loops.radius_mm"))


def read_tabs(top: Table) -> Tabs | None:
    """The tabs; None where the file says nothing, or ``count = 0``."""
    if not top.has("tabs"):
        return None
    table = top.table("tabs")
    tabs = Tabs(
        width=read(table, "tabs.width_mm"),
        count=read_whole(table, "tabs.count", 1) if table.has("count") else None,
        spacing=read_optional(table, "tabs.spacing_mm"),
        corner=read(table, "tabs.corner_mm", 2.0),
        holes=table.flag("holes", default=False),
    )
    return None if tabs.count == 0 and tabs.spacing is None else tabs


def read_heat(top: Table) -> Heat | None:
    """How long heat is given to spread; None where the file says nothing, or a distance of 0."""
    if not top.has("heat"):
        return None
    table = top.table("heat")
    heat = Heat(distance=read(table, "heat.distance_mm"), time=read(table, "heat.time_s"))
    return heat if heat.distance > 0.0 else None


def read_gases(top: Table) -> tuple[Gas, ...]:
    """What the file knows of gases, in its order."""
    table = top.table("gases", required=False)
    return tuple(_gas(name, table.table(name)) for name in table.keys)


def _gas(name: str, table: Table) -> Gas:
    return Gas(
        name=name,
        pressure=read_optional(table, "gases.pressure_bar"),
        feed_factor=read(table, "gases.feed_factor", 1.0),
    )


def read_provenance(top: Table, known: tuple[str, ...]) -> tuple[Provenance, ...]:
    """Where the values are from, in the order of the file.

    A value in a section is named with it: ``engrave.power``.

    Args:
        top: of the file.
        known: the keys and sections that a process file may have.

    Raises:
        DeltacamError: a key that no process file has, or no grade.
    """
    return _provenance(top.table("provenance", required=False), known, "")


def _provenance(table: Table, known: tuple[str, ...], section: str) -> tuple[Provenance, ...]:
    found: tuple[Provenance, ...] = ()
    for key in table.keys:
        name = f"{section}{key}"
        one = table.table(key)
        _refuse_unknown(table, name, known)
        if name in SECTIONS and one.keys and not one.has("grade"):
            found += _provenance(one, known, f"{name}.")
            continue
        grade = cast("Grade", one.choice("grade", get_args(Grade)))
        found += (Provenance(key=name, grade=grade, source=one.text("source", default="")),)
    return found


def _refuse_unknown(table: Table, name: str, known: tuple[str, ...]) -> None:
    """Refuse the name of a value that is none."""
    section, dot, key = name.rpartition(".")
    if name in known or (dot and key in SECTIONS.get(section, ())) or section in _NAMED:
        return
    options = [one.rpartition(".")[2] for one in (SECTIONS.get(section, ()) if dot else known)]
    near = difflib.get_close_matches(key, options, n=1)
    question = f"; did you mean {near[0]!r}?" if near else ""
    raise table.problem(f"no process has a value {name!r}{question}", hint=f"known: {', '.join(options)}")


_LEAD: Final = ("shape", "length_mm", "radius_mm", "angle_deg")

SECTIONS: Final[dict[str, tuple[str, ...]]] = {
    "engrave": ("feed_m_min", "power"),
    "lead_in": _LEAD,
    "lead_out": _LEAD,
    "pierce": ("power", "first"),
    "power_law": ("at_rest", "exponent", "lowest"),
    "slower": ("factor", "hole_diameter_mm", "radius_mm"),
    "loops": ("angle_deg", "radius_mm"),
    "tabs": ("width_mm", "count", "spacing_mm", "corner_mm", "holes"),
    "heat": ("distance_mm", "time_s"),
    "gases": (),
}
"""The keys of the sections."""

_NAMED: Final = ("gases",)
"""Sections whose keys are names that the file chooses."""
