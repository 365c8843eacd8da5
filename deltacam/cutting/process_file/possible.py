"""Values of a process that exclude each other."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from deltacam.model import Lead, Process, Tabs
from deltacam.units import to_mm


@dataclass(frozen=True, slots=True)
class Problem:
    """What is impossible about a process.

    Attributes:
        section: of the process file; empty for its top.
        what: with the values.
        hint: what to change.
    """

    section: str
    what: str
    hint: str


def first_problem(process: Process) -> Problem | None:
    """The first of the things about a process that cannot be; None where all of it can."""
    return next(_problems(process), None)


def _problems(process: Process) -> Iterator[Problem]:
    yield from _of_lead("lead_in", process.lead_in)
    yield from _of_lead("lead_out", process.lead_out)
    yield from _of_power(process)
    for number, slower in enumerate(process.slower, start=1):
        if slower.diameter is None and slower.radius is None:
            hint = "add hole_diameter_mm, radius_mm, or both"
            yield Problem(f"slower {number}", "it says neither for which holes nor for which bends", hint)
    if process.tabs is not None:
        yield from _of_tabs(process.tabs)
    yield from _of_feed(process)
    known = [gas.name for gas in process.gases]
    if known and process.gas not in known:
        names = " or ".join(f'"{name}"' for name in known)
        yield Problem("", f"gas = {process.gas!r} is none of those under [gases]", f"write gas = {names}")


def _of_lead(section: str, lead: Lead) -> Iterator[Problem]:
    if lead.shape == "none" and not (lead.length is None and lead.radius is None):
        yield Problem(section, 'a lead of shape = "none" has neither length nor radius', "leave them out")
    if lead.shape == "line" and lead.radius is not None:
        hint = 'leave radius_mm out, or write shape = "line+arc"'
        yield Problem(section, "a line has no radius", hint)
    if "arc" not in lead.shape:
        return
    if lead.angle <= 0.0:
        yield Problem(section, "an arc that turns by 0 degrees has no length", "write angle_deg = 90")
    elif lead.shape == "arc" and lead.radius is not None and lead.length is not None:
        hint = 'leave one of them out, or write shape = "line+arc"'
        yield Problem(section, "the length of an arc follows from its radius and angle", hint)
    elif lead.radius is not None and lead.length is not None and lead.length <= lead.radius * lead.angle:
        arc = f"{to_mm(lead.radius * lead.angle):.4g} mm"
        what = f"a length of {to_mm(lead.length):.4g} mm leaves nothing for the line, as the arc alone takes {arc}"
        yield Problem(section, what, "make length_mm longer or radius_mm smaller")


def _of_power(process: Process) -> Iterator[Problem]:
    law = process.power_law
    if law is not None and law.lowest > process.power:
        what = f"lowest = {law.lowest:.4g} is more than the power of the cut, {process.power:.4g}"
        yield Problem("power_law", what, "both are shares of the laser's rated power; make lowest smaller")


def _of_tabs(tabs: Tabs) -> Iterator[Problem]:
    if (tabs.count is None) == (tabs.spacing is None):
        said = "neither" if tabs.count is None else "both"
        yield Problem("tabs", f"{said} of count and spacing_mm is given", "give one of them")
    if tabs.spacing is not None and tabs.spacing <= tabs.width:
        what = f"tabs of {to_mm(tabs.width):.4g} mm every {to_mm(tabs.spacing):.4g} mm leave nothing to cut"
        yield Problem("tabs", what, "make spacing_mm larger or width_mm smaller")


def _of_feed(process: Process) -> Iterator[Problem]:
    if process.feeds is not None and not process.feeds[0] <= process.feeds[1]:
        low, high = (f"{value * 60.0:.6g}" for value in process.feeds)
        what = f"feed_range_m_min goes from {low} to {high}, which is less"
        yield Problem("", what, f"write feed_range_m_min = [{high}, {low}]")
