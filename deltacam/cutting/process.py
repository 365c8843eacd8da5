"""Finds a process, how a material is cut, by its name or its file, and checks one."""

from __future__ import annotations

import difflib
from collections.abc import Iterator
from importlib import resources
from pathlib import Path
from typing import Final

from deltacam.cutting.process_file.bounds import BOUNDS
from deltacam.cutting.process_file.possible import first_problem
from deltacam.cutting.process_file.reading import read_process
from deltacam.errors import ProcessError
from deltacam.model import Lead, Process
from deltacam.settings import read_table

DEFAULT_PROCESS: Final = "steel-1mm-fibre"
"""The built-in process that is used where none is named."""

_NEAREST: Final = 6
"""How many built-in processes a message names."""


def process_names() -> tuple[str, ...]:
    """The names of the built-in processes, sorted."""
    folder = resources.files("deltacam.cutting") / "processes"
    return tuple(sorted(entry.name.removesuffix(".toml") for entry in folder.iterdir() if entry.name.endswith(".toml")))


def load_process(name: str | Path) -> Process:
    """The process of that name, or in that TOML file.

    Args:
        name: a built-in name, or the path of a file: what ends in ``.toml`` or holds a separator is a path.

    Raises:
        ProcessError: no such process, or a key or value in the file is wrong.
    """
    text = str(name)
    if text in process_names():
        with resources.as_file(resources.files("deltacam.cutting") / "processes" / f"{text}.toml") as path:
            return read_process(read_table(path, error=ProcessError))
    path = Path(text)
    if path.suffix == ".toml" or path.name != text or path.exists():
        return read_process(read_table(path, error=ProcessError))
    near = difflib.get_close_matches(text, process_names(), n=_NEAREST, cutoff=0.4)
    raise ProcessError(
        f"there is no process {text!r}" + (f"; did you mean {near[0]!r}?" if near else ""),
        hint=f"{', '.join(near or process_names()[:_NEAREST])}, and more: `deltacam process list`; "
        "a file of your own ends in .toml",
    )


def check_process(process: Process) -> Process:
    """The same process, its values checked.

    Raises:
        ProcessError: a value is out of range, or two exclude each other; says which.
    """
    where = f"process {process.name}"
    for words, key, value, source in _numbers(process):
        bound = BOUNDS[key]
        if not bound.allows(value):
            raise ProcessError(
                f"a {words} of {bound.from_si(value):.6g} {bound.unit} is out of range".replace("  ", " "),
                where=where,
                hint=f"it must be from {bound.words}: {source} in the process file",
            )
    problem = first_problem(process)
    if problem is not None:
        section = f" [{problem.section}]" if problem.section else ""
        raise ProcessError(problem.what, where=f"{where}{section}", hint=problem.hint)
    return process


def _numbers(process: Process) -> Iterator[tuple[str, str, float, str]]:
    """The numbers that the command line may change: in words, as `BOUNDS` names them, in SI, and where each is from."""
    yield "kerf", "kerf_mm", process.kerf, "--kerf, or kerf_mm"
    yield "feed", "feed_m_min", process.feed, "--feed, or feed_m_min"
    yield "power", "power", process.power, "--power, or power"
    yield "tolerance", "tolerance_um", process.tolerance, "--tolerance, or tolerance_um"
    yield "chord tolerance", "chord_tolerance_um", process.chord_tolerance, "chord_tolerance_um"
    if process.engrave_feed is not None:
        source = "feed_m_min under [engrave]"
        yield "feed for engraving", "engrave.feed_m_min", process.engrave_feed, source
    yield "overcut", "overcut_mm", process.overcut, "--overcut, or overcut_mm"
    yield "number of passes", "passes", process.passes, "--passes, or passes"
    for section, lead in (("lead_in", process.lead_in), ("lead_out", process.lead_out)):
        yield from _of_lead(section, lead)
    if process.tabs is not None:
        yield "width of tabs", "tabs.width_mm", process.tabs.width, "--tabs, or width_mm under [tabs]"
        if process.tabs.count is not None:
            yield "number of tabs", "tabs.count", process.tabs.count, "--tabs, or count under [tabs]"


def _of_lead(section: str, lead: Lead) -> Iterator[tuple[str, str, float, str]]:
    words, option = section.replace("_", "-"), f"--{section.replace('_', '-')}"
    if lead.length is not None:
        yield f"length of the {words}", "lead.length_mm", lead.length, f"{option}, or length_mm under [{section}]"
    if lead.radius is not None:
        yield f"radius of the {words}", "lead.radius_mm", lead.radius, f"radius_mm under [{section}]"
