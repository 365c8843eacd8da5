"""Every value of a process as its file states it, with its unit and where it is from."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

from deltacam.cutting.gas import stated_feed, stated_feeds
from deltacam.cutting.process_file.bounds import BOUNDS, Bound
from deltacam.cutting.process_file.rules import COLORS
from deltacam.cutting.process_file.sections import AUTO
from deltacam.model import DEFAULT_RULES, Grade, Lead, Operation, Process, Provenance, Rule

GRADES: Final[tuple[Grade, ...]] = ("measured", "vendor", "community", "estimate")
"""The grades of values, the most trustworthy first."""

NOT_SAID: Final = "not said"
"""What stands in place of a grade where the process says nothing about where a value is from."""

_WEIGHTY: Final = ("kerf_mm", "feed_m_min", "power", "pierce_time_s")
"""The values by which a process is judged."""

_MOST_DIGITS: Final = 17
_SAME: Final = 1e-12


@dataclass(frozen=True, slots=True)
class Value:
    """A value of a process file.

    Attributes:
        key: in its section.
        text: as the file writes it: 0.15, "oxygen", [6.0, 12.0].
        unit: of it; empty where it has none.
    """

    key: str
    text: str
    unit: str = ""


@dataclass(frozen=True, slots=True)
class Section:
    """A section of a process file.

    Attributes:
        name: of the section; empty for the top of the file.
        values: in the order of the file.
        repeated: whether there may be several of that name.
    """

    name: str
    values: tuple[Value, ...]
    repeated: bool = False


def sections(process: Process) -> tuple[Section, ...]:
    """What a file of that process states, without its provenance; values at their defaults are left out."""
    found = [Section("", tuple(_top(process)))]
    if process.engrave_feed is not None and process.engrave_power is not None:
        feed, power = _of("engrave.feed_m_min", process.engrave_feed), _of("engrave.power", process.engrave_power)
        found.append(Section("engrave", (feed, power)))
    found += [
        Section(name, tuple(_lead(lead)))
        for name, lead in (("lead_in", process.lead_in), ("lead_out", process.lead_out))
        if lead != Lead()
    ]
    found += _how(process)
    for gas in process.gases:
        pressure = () if gas.pressure is None else (_of("gases.pressure_bar", gas.pressure),)
        found.append(Section(f"gases.{gas.name}", (*pressure, _of("gases.feed_factor", gas.feed_factor))))
    if process.rules != DEFAULT_RULES:
        found += [Section("operations", tuple(_rule(rule)), repeated=True) for rule in process.rules]
    return tuple(found)


def provenance_of(process: Process, section: str, key: str) -> Provenance | None:
    """Where a value is from: what is said of it, else what is said of its section; None where nothing is said."""
    said = {one.key: one for one in process.provenance}
    names = [f"{section}.{key}" if section else key, section]
    while section:
        section = section.rpartition(".")[0]
        names.append(section)
    return next((said[name] for name in names if name in said), None)


def worst_grade(process: Process) -> str:
    """The worst grade of kerf, feed, power and pierce time; `NOT_SAID` where one of them has none."""
    found = [provenance_of(process, "", key) for key in _WEIGHTY]
    if any(one is None for one in found):
        return NOT_SAID
    return max((one.grade for one in found if one is not None), key=GRADES.index)


def _top(process: Process) -> Iterator[Value]:
    yield Value("name", quoted(process.name))
    for key, text in (("source", process.source), ("material", process.material)):
        if text:
            yield Value(key, quoted(text))
    yield _of("thickness_mm", process.thickness)
    if process.laser:
        yield Value("laser", quoted(process.laser))
    if process.laser_power:
        yield _of("laser_power_w", process.laser_power)
    if process.gas:
        yield Value("gas", quoted(process.gas))
    yield _of("kerf_mm", process.kerf)
    yield _of("feed_m_min", stated_feed(process))
    if process.feeds is not None:
        low, high = (_of("feed_m_min", feed).text for feed in stated_feeds(process))
        yield Value("feed_range_m_min", f"[{low}, {high}]", BOUNDS["feed_m_min"].unit)
    yield _of("power", process.power)
    yield _of("pierce_time_s", process.pierce_time)
    yield from _course(process)
    yield _of("tolerance_um", process.tolerance)
    yield _of("chord_tolerance_um", process.chord_tolerance)
    if process.open is not Operation.IGNORE:
        yield Value("open", quoted(process.open))
    if not process.rules:
        yield Value("operations", "[]")


def _course(process: Process) -> Iterator[Value]:
    """What the top of the file says of the way of a cut."""
    if process.overcut:
        yield _of("overcut_mm", process.overcut)
    if process.start != "best":
        yield Value("start", quoted(process.start))
    if process.corner != "round":
        yield Value("corner", quoted(process.corner))
    if process.passes != 1:
        yield Value("passes", str(process.passes))
    if process.common_edges:
        yield Value("common_edges", "true")


def _how(process: Process) -> Iterator[Section]:
    """The sections about power, feed, corners, tabs and heat."""
    if process.pierce_power is not None or process.pre_pierce:
        power = () if process.pierce_power is None else (_of("pierce.power", process.pierce_power),)
        first = (Value("first", "true"),) if process.pre_pierce else ()
        yield Section("pierce", (*power, *first))
    if (law := process.power_law) is not None:
        names = ("at_rest", "exponent", "lowest")
        yield Section("power_law", tuple(_of(f"power_law.{name}", getattr(law, name)) for name in names))
    for slower in process.slower:
        diameter, radius = ("slower.hole_diameter_mm", slower.diameter), ("slower.radius_mm", slower.radius)
        given = tuple(_of(name, value) for name, value in (diameter, radius) if value is not None)
        yield Section("slower", (_of("slower.factor", slower.factor), *given), repeated=True)
    if process.loops != type(process.loops)():
        radius_of = () if process.loops.radius is None else (_of("loops.radius_mm", process.loops.radius),)
        yield Section("loops", (_of("loops.angle_deg", process.loops.angle), *radius_of))
    if process.tabs is not None:
        yield Section("tabs", tuple(_tabs(process)))
    if process.heat is not None:
        distance, time = _of("heat.distance_mm", process.heat.distance), _of("heat.time_s", process.heat.time)
        yield Section("heat", (distance, time))


def _lead(lead: Lead) -> Iterator[Value]:
    yield Value("shape", quoted(lead.shape))
    if lead.shape == "none":
        return
    yield Value("length_mm", quoted(AUTO)) if lead.length is None else _of("lead.length_mm", lead.length)
    if lead.radius is not None:
        yield _of("lead.radius_mm", lead.radius)
    yield _of("lead.angle_deg", lead.angle)


def _tabs(process: Process) -> Iterator[Value]:
    tabs = process.tabs
    if tabs is None:
        return
    yield _of("tabs.width_mm", tabs.width)
    if tabs.count is not None:
        yield Value("count", str(tabs.count))
    if tabs.spacing is not None:
        yield _of("tabs.spacing_mm", tabs.spacing)
    yield _of("tabs.corner_mm", tabs.corner)
    yield Value("holes", "true" if tabs.holes else "false")


def _rule(rule: Rule) -> Iterator[Value]:
    if rule.layer is not None:
        yield Value("layer", quoted(rule.layer))
    if rule.color is not None:
        names = {number: name for name, number in COLORS.items()}
        yield Value("color", quoted(names[rule.color]) if rule.color in names else str(rule.color))
    if rule.linetype is not None:
        yield Value("linetype", quoted(rule.linetype))
    yield Value("do", quoted(rule.operation))
    if rule.operation is not Operation.IGNORE:
        yield Value("open", quoted(rule.open))


def _of(name: str, value: float) -> Value:
    """The number called ``name`` in `BOUNDS`, in SI, as its file writes it."""
    bound = BOUNDS[name]
    return Value(name.rpartition(".")[2], _shortest(bound, value), bound.unit)


def _shortest(bound: Bound, value: float) -> str:
    """The shortest number of a file that is read as ``value``, or, where there is none, as nearly as can be."""
    candidates = [repr(float(f"{bound.from_si(value):.{digits}g}")) for digits in range(1, _MOST_DIGITS + 1)]
    exact = [text for text in candidates if bound.to_si(float(text)) == value]
    near = [text for text in candidates if math.isclose(bound.to_si(float(text)), value, rel_tol=_SAME)]
    return next(iter([*exact, *near]), candidates[-1])


def quoted(text: str) -> str:
    """The text as a TOML string; JSON's escapes are a part of TOML's, but for the delete character."""
    return json.dumps(str(text), ensure_ascii=False).replace("\x7f", "\\u007F")
