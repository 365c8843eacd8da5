"""A process file becomes a process."""

from __future__ import annotations

from typing import Final, cast, get_args

from deltacam.cutting.gas import at_feed_of_its_gas
from deltacam.cutting.process_file.bounds import BOUNDS, read, read_whole
from deltacam.cutting.process_file.possible import first_problem
from deltacam.cutting.process_file.rules import read_rules
from deltacam.cutting.process_file.sections import (
    read_engraving,
    read_gases,
    read_heat,
    read_lead,
    read_loops,
    read_pierce,
    read_power_law,
    read_provenance,
    read_slower,
    read_tabs,
)
from deltacam.model import Corner, Process, StartRule
from deltacam.settings import Table

LASERS: Final = ("fibre", "co2")

KEYS: Final = (
    "name",
    "source",
    "material",
    "thickness_mm",
    "laser",
    "laser_power_w",
    "gas",
    "kerf_mm",
    "feed_m_min",
    "feed_range_m_min",
    "power",
    "pierce_time_s",
    "overcut_mm",
    "start",
    "corner",
    "passes",
    "common_edges",
    "tolerance_um",
    "chord_tolerance_um",
    "open",
    "operations",
    "engrave",
    "lead_in",
    "lead_out",
    "pierce",
    "power_law",
    "slower",
    "loops",
    "tabs",
    "heat",
    "gases",
    "provenance",
)
"""Every key and section at the top of a process file."""


def read_process(table: Table) -> Process:
    """The process in a file, its feed being that with the gas in use.

    Raises:
        DeltacamError: a key is missing or unknown, or a value is wrong, or two exclude each other.
    """
    rules, open_lines = read_rules(table)
    engrave_feed, engrave_power = read_engraving(table)
    pierce_power, pre_pierce = read_pierce(table)
    stated = Process(
        name=table.text("name"),
        source=table.text("source", default=""),
        material=table.text("material", default=""),
        thickness=read(table, "thickness_mm", 0.0),
        laser=table.choice("laser", LASERS) if table.has("laser") else "",
        laser_power=read(table, "laser_power_w", 0.0),
        gas=table.text("gas", default=""),
        gases=read_gases(table),
        kerf=read(table, "kerf_mm"),
        feed=read(table, "feed_m_min"),
        feeds=_feeds(table),
        power=read(table, "power", 1.0),
        pierce_time=read(table, "pierce_time_s", 0.0),
        pierce_power=pierce_power,
        pre_pierce=pre_pierce,
        tolerance=read(table, "tolerance_um", 20.0),
        chord_tolerance=read(table, "chord_tolerance_um", 20.0),
        corner=cast("Corner", table.choice("corner", get_args(Corner), default="round")),
        loops=read_loops(table),
        rules=rules,
        open=open_lines,
        engrave_feed=engrave_feed,
        engrave_power=engrave_power,
        lead_in=read_lead(table, "lead_in"),
        lead_out=read_lead(table, "lead_out"),
        start=cast("StartRule", table.choice("start", get_args(StartRule), default="best")),
        overcut=read(table, "overcut_mm", 0.0),
        passes=read_whole(table, "passes", 1),
        common_edges=table.flag("common_edges", default=False),
        power_law=read_power_law(table),
        slower=read_slower(table),
        tabs=read_tabs(table),
        heat=read_heat(table),
        provenance=read_provenance(table, KEYS),
    )
    table.finish()
    _refuse_impossible(table, stated)
    return at_feed_of_its_gas(stated)


def _feeds(table: Table) -> tuple[float, float] | None:
    if not table.has("feed_range_m_min"):
        return None
    bound = BOUNDS["feed_m_min"]
    slowest, fastest = table.numbers("feed_range_m_min", length=2, minimum=bound.minimum, maximum=bound.maximum)
    return bound.to_si(slowest), bound.to_si(fastest)


def _refuse_impossible(table: Table, stated: Process) -> None:
    problem = first_problem(stated)
    if problem is None:
        return
    place = table.problem(problem.what, hint=problem.hint)
    where = f"{place.where} [{problem.section}]" if problem.section else place.where
    raise type(place)(problem.what, where=where, hint=problem.hint)
