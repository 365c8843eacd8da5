"""The process in a program file, in SI."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, fields
from typing import Any, Final, TypeVar, cast, get_args

from deltacam.model import (
    Corner,
    Gas,
    Grade,
    Heat,
    Lead,
    LeadShape,
    Loops,
    Operation,
    PowerLaw,
    Process,
    Provenance,
    Rule,
    Slower,
    StartRule,
    Tabs,
)
from deltacam.program.fields import Fields

_LARGEST: Final = 1e4  # m, s or m/s: far beyond any machine, and far from where a product could overflow
_TURN: Final = 7.0  # rad, more than a full turn
_PRESSURE: Final = 1e9  # Pa
_MOST: Final = 1_000_000

_Part = TypeVar("_Part")
_Word = TypeVar("_Word", bound=str)


def to_meta(process: Process) -> dict[str, Any]:
    """The process as JSON has it."""
    return asdict(process)


def from_meta(top: Fields) -> Process:
    """The process that the meta object ``top`` holds.

    Raises:
        ProgramError: a missing or unknown key, or a value of another type or out of its range.
    """
    found = top.section("process", _keys(Process))
    return Process(
        name=found.text("name"),
        source=found.text("source", empty=True),
        material=found.text("material", empty=True),
        thickness=found.number("thickness", 0.0, _LARGEST),
        kerf=found.number("kerf", 0.0, 1.0),
        feed=found.number("feed", 1e-9, _LARGEST),
        power=found.number("power", 0.0, 1.0),
        pierce_time=found.number("pierce_time", 0.0, _LARGEST),
        tolerance=found.number("tolerance", 1e-9, 1.0),
        chord_tolerance=found.number("chord_tolerance", 1e-9, 1.0),
        corner=_word(found, "corner", cast("tuple[Corner, ...]", get_args(Corner))),
        gas=found.text("gas", empty=True),
        rules=_each(found, "rules", Rule, _rule),
        open=found.choice("open", Operation),
        engrave_feed=_optional(found, "engrave_feed", 1e-9, _LARGEST),
        engrave_power=_optional(found, "engrave_power", 0.0, 1.0),
        lead_in=_lead(found.section("lead_in", _keys(Lead))),
        lead_out=_lead(found.section("lead_out", _keys(Lead))),
        start=_word(found, "start", cast("tuple[StartRule, ...]", get_args(StartRule))),
        overcut=found.number("overcut", 0.0, 1.0),
        pierce_power=_optional(found, "pierce_power", 0.0, 1.0),
        pre_pierce=found.flag("pre_pierce"),
        power_law=_maybe(found, "power_law", PowerLaw, _power_law),
        slower=_each(found, "slower", Slower, _slower),
        loops=_loops(found.section("loops", _keys(Loops))),
        tabs=_maybe(found, "tabs", Tabs, _tabs),
        heat=_maybe(found, "heat", Heat, _heat),
        passes=found.whole("passes", 1, _MOST),
        common_edges=found.flag("common_edges"),
        gases=_each(found, "gases", Gas, _gas),
        laser=found.text("laser", empty=True),
        laser_power=found.number("laser_power", 0.0, 1e9),
        feeds=_feeds(found),
        provenance=_each(found, "provenance", Provenance, _provenance),
    )


def _rule(rule: Fields) -> Rule:
    return Rule(
        operation=rule.choice("operation", Operation),
        layer=None if rule.raw("layer") is None else rule.text("layer"),
        color=None if rule.raw("color") is None else rule.whole("color", 1, 255),
        linetype=None if rule.raw("linetype") is None else rule.text("linetype"),
        open=rule.choice("open", Operation),
    )


def _lead(lead: Fields) -> Lead:
    return Lead(
        shape=_word(lead, "shape", cast("tuple[LeadShape, ...]", get_args(LeadShape))),
        length=_optional(lead, "length", 1e-9, 1.0),
        radius=_optional(lead, "radius", 1e-9, 1.0),
        angle=lead.number("angle", 0.0, _TURN),
    )


def _power_law(law: Fields) -> PowerLaw:
    return PowerLaw(
        at_rest=law.number("at_rest", 0.0, 1.0),
        exponent=law.number("exponent", 1e-3, 1e3),
        lowest=law.number("lowest", 0.0, 1.0),
    )


def _slower(slower: Fields) -> Slower:
    return Slower(
        factor=slower.number("factor", 1e-3, 1.0),
        diameter=_optional(slower, "diameter", 0.0, _LARGEST),
        radius=_optional(slower, "radius", 0.0, _LARGEST),
    )


def _loops(loops: Fields) -> Loops:
    return Loops(angle=loops.number("angle", 0.0, _TURN), radius=_optional(loops, "radius", 1e-9, 1.0))


def _tabs(tabs: Fields) -> Tabs:
    return Tabs(
        width=tabs.number("width", 1e-9, 1.0),
        count=None if tabs.raw("count") is None else tabs.whole("count", 1, _MOST),
        spacing=_optional(tabs, "spacing", 1e-9, _LARGEST),
        corner=tabs.number("corner", 0.0, 1.0),
        holes=tabs.flag("holes"),
    )


def _heat(heat: Fields) -> Heat:
    return Heat(distance=heat.number("distance", 0.0, _LARGEST), time=heat.number("time", 0.0, _LARGEST))


def _gas(gas: Fields) -> Gas:
    return Gas(
        name=gas.text("name"),
        pressure=_optional(gas, "pressure", 0.0, _PRESSURE),
        feed_factor=gas.number("feed_factor", 1e-3, 1e3),
    )


def _provenance(value: Fields) -> Provenance:
    return Provenance(
        key=value.text("key"),
        grade=_word(value, "grade", cast("tuple[Grade, ...]", get_args(Grade))),
        source=value.text("source", empty=True),
    )


def _feeds(process: Fields) -> tuple[float, float] | None:
    if process.raw("feeds") is None:
        return None
    values = process.items("feeds")
    if len(values) != 2:
        raise process.problem("feeds are not two numbers")
    both = Fields(dict(zip(("slowest", "fastest"), values, strict=True)), f"{process.where}, feeds", _RANGE)
    slowest, fastest = (both.number(key, 1e-9, _LARGEST) for key in _RANGE)
    return slowest, fastest


_RANGE: Final = ("slowest", "fastest")


def _keys(kind: type) -> tuple[str, ...]:
    return tuple(field.name for field in fields(kind))


def _optional(found: Fields, key: str, low: float, high: float) -> float | None:
    return None if found.raw(key) is None else found.number(key, low, high)


def _maybe(found: Fields, key: str, kind: type[_Part], read: Callable[[Fields], _Part]) -> _Part | None:
    return None if found.raw(key) is None else read(found.section(key, _keys(kind)))


def _each(found: Fields, key: str, kind: type[_Part], read: Callable[[Fields], _Part]) -> tuple[_Part, ...]:
    where = f"{found.where}, {key}"
    items = enumerate(found.items(key))
    return tuple(read(Fields(values, f"{where} {index}", _keys(kind))) for index, values in items)


def _word(found: Fields, key: str, words: tuple[_Word, ...]) -> _Word:
    text = found.text(key)
    for word in words:
        if text == word:
            return word
    raise found.problem(f"unknown {key} {text[:40]!r}", hint=f"use {' or '.join(words)}")
