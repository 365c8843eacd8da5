"""Reads a process: how a material is cut."""

from __future__ import annotations

import difflib
from importlib import resources
from pathlib import Path
from typing import Final, cast

from deltacam.errors import ProcessError
from deltacam.model import DEFAULT_RULES, Corner, Operation, Process, Rule
from deltacam.settings import REQUIRED, Required, Table, read_table
from deltacam.units import to_mm, to_um

DEFAULT_PROCESS: Final = "steel-1mm-fibre"
"""The built-in process that is used where none is named."""

MAX_KERF: Final = 20e-3
MAX_FEED: Final = 1000.0 / 60.0
MIN_FEED: Final = 1e-5
TOLERANCES: Final = (2e-6, 1e-3)
"""Smallest and largest tolerance, m; below the smallest, reading and fitting a drawing leave no room for motion."""

COLORS: Final = {"red": 1, "yellow": 2, "green": 3, "cyan": 4, "blue": 5, "magenta": 6, "white": 7}
"""The names of AutoCAD's colours; white is shown black on white paper."""

_OPERATIONS: Final = tuple(Operation)
_FEEDS: Final = {"minimum": MIN_FEED * 60.0, "maximum": MAX_FEED * 60.0}  # m/min


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
            return _read(read_table(path, error=ProcessError))
    path = Path(text)
    if path.suffix == ".toml" or path.name != text or path.exists():
        return _read(read_table(path, error=ProcessError))
    near = difflib.get_close_matches(text, process_names(), n=1, cutoff=0.4)
    raise ProcessError(
        f"there is no process {text!r}" + (f"; did you mean {near[0]!r}?" if near else ""),
        hint=f"built in are {', '.join(process_names())}; a file of your own ends in .toml",
    )


def check_process(process: Process) -> Process:
    """The same process, its values checked.

    Raises:
        ProcessError: a value is out of range; where names it.
    """
    ranges = [
        ("kerf", process.kerf, 0.0, MAX_KERF, to_mm, "mm", "--kerf, or kerf_mm in the process file"),
        ("feed", process.feed, MIN_FEED, MAX_FEED, to_mm, "mm/s", "--feed, or feed_m_min in the process file"),
        ("tolerance", process.tolerance, *TOLERANCES, to_um, "um", "--tolerance, or tolerance_um in the process file"),
        (
            "chord tolerance",
            process.chord_tolerance,
            *TOLERANCES,
            to_um,
            "um",
            "chord_tolerance_um in the process file",
        ),
    ]
    if process.engrave_feed is not None:
        source = "feed_m_min under [engrave] in the process file"
        ranges.append(("feed for engraving", process.engrave_feed, MIN_FEED, MAX_FEED, to_mm, "mm/s", source))
    for key, value, low, high, convert, unit, source in ranges:
        if not low <= value <= high:
            raise ProcessError(
                f"a {key} of {convert(value):.6g} {unit} is out of range",
                where=f"process {process.name}",
                hint=f"it must be from {convert(low):.6g} to {convert(high):.6g} {unit}: {source}",
            )
    return process


def _read(table: Table) -> Process:
    micrometres = {"minimum": TOLERANCES[0] * 1e6, "maximum": TOLERANCES[1] * 1e6}
    feed, power = _engraving(table)
    open_lines = _operation(table, "open", Operation.IGNORE)
    process = Process(
        name=table.text("name"),
        source=table.text("source", default=""),
        material=table.text("material", default=""),
        thickness=table.number("thickness_mm", minimum=0.0, maximum=200.0, default=0.0) / 1e3,
        gas=table.text("gas", default=""),
        kerf=table.number("kerf_mm", minimum=0.0, maximum=MAX_KERF * 1e3) / 1e3,
        feed=table.number("feed_m_min", **_FEEDS) / 60.0,
        power=table.number("power", minimum=0.001, maximum=1.0, default=1.0),
        pierce_time=table.number("pierce_time_s", minimum=0.0, maximum=60.0, default=0.0),
        tolerance=table.number("tolerance_um", **micrometres, default=20.0) / 1e6,
        chord_tolerance=table.number("chord_tolerance_um", **micrometres, default=20.0) / 1e6,
        corner=cast("Corner", table.choice("corner", ("round", "stop"), default="round")),
        rules=_rules(table, open_lines),
        open=open_lines,
        engrave_feed=feed,
        engrave_power=power,
    )
    table.finish()
    return process


def _engraving(table: Table) -> tuple[float | None, float | None]:
    """Feed, m/s, and power while engraving; None and None where the file says nothing."""
    if not table.has("engrave"):
        return None, None
    engrave = table.table("engrave")
    feed = engrave.number("feed_m_min", **_FEEDS) / 60.0
    return feed, engrave.number("power", minimum=0.001, maximum=1.0)


def _rules(table: Table, open_lines: Operation) -> tuple[Rule, ...]:
    """The rules of the file, those of `DEFAULT_RULES` where it has none; ``open_lines`` is for lines that are cut."""
    if not table.has("operations"):
        return DEFAULT_RULES
    tables = table.tables("operations")
    rules = tuple(_rule(one, open_lines) for one in tables)
    for one, rule in zip(tables[:-1], rules[:-1], strict=True):
        if rule.layer is None and rule.color is None and rule.linetype is None:
            hint = "move it to the end, or give it a layer, color or linetype"
            raise one.problem("it matches everything, so that those after it are never used", hint=hint)
    return rules


def _rule(table: Table, open_lines: Operation) -> Rule:
    operation = _operation(table, "do")
    if operation is Operation.IGNORE and table.has("open"):
        raise table.problem('open says nothing where do = "ignore"', hint="leave one of them out")
    return Rule(
        operation=operation,
        layer=table.text("layer") if table.has("layer") else None,
        color=table.integer("color", minimum=1, maximum=255, names=COLORS) if table.has("color") else None,
        linetype=table.text("linetype") if table.has("linetype") else None,
        open=_operation(table, "open", open_lines if operation is Operation.CUT else operation),
    )


def _operation(table: Table, key: str, default: Operation | Required = REQUIRED) -> Operation:
    return Operation(table.choice(key, _OPERATIONS, default=default))
