"""What is different for which parts of a batch: ``batch.toml``.

What the command line says wins over this file, and this file over the user's own defaults.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final

from deltacam.batch.choosing.patterns import check_pattern, matches
from deltacam.defaults import name_or_file, unit_name
from deltacam.errors import DeltacamError
from deltacam.settings import Table, read_table

FILE: Final = "batch.toml"

MOST: Final = 1_000_000
"""The largest quantity."""

_KEYS: Final = ("robot", "process", "units", "quantity")


@dataclass(frozen=True, slots=True)
class Wanted:
    """What the rules say of a part; None where none of them says anything.

    Attributes:
        robot: a built-in name, or the path of a robot file.
        process: a built-in name, or the path of a process file.
        units: what one unit of the drawing is, whatever its header says.
        quantity: how many are wanted.
    """

    robot: str | None = None
    process: str | None = None
    units: str | None = None
    quantity: int = 1


@dataclass(frozen=True, slots=True)
class Rule:
    """What is wanted of the parts whose names are like a pattern; None where it is not said.

    Attributes:
        pattern: as `patterns.matches` reads it.
        robot: as in `Wanted`.
        process: likewise.
        units: likewise.
        quantity: likewise.
    """

    pattern: str
    robot: str | None = None
    process: str | None = None
    units: str | None = None
    quantity: int | None = None


@dataclass(frozen=True, slots=True)
class Rules:
    """The rules of a batch, in their order.

    Attributes:
        file: the path that they were read from; empty where there is no such file.
        rules: of several that say something of a part, the last one counts.
    """

    file: str = ""
    rules: tuple[Rule, ...] = ()

    def settings_of(self, name: str) -> Wanted:
        """What is wanted of the part of that name."""
        wanted: dict[str, Any] = {}
        for rule in self.rules:
            if matches(name, rule.pattern):
                said = {key: getattr(rule, key) for key in _KEYS}
                wanted |= {key: value for key, value in said.items() if value is not None}
        return Wanted(**wanted)

    def unused(self, names: Sequence[str]) -> tuple[str, ...]:
        """The patterns that none of the names is like."""
        patterns = dict.fromkeys(rule.pattern for rule in self.rules)
        return tuple(pattern for pattern in patterns if not any(matches(name, pattern) for name in names))


def find_rules(folder: Path) -> Rules:
    """The rules in the ``batch.toml`` of a folder; none where it has no such file.

    Raises:
        DeltacamError: the file cannot be read, or a key or value in it is wrong; says which.
    """
    path = folder / FILE
    return read(path) if os.path.lexists(path) else Rules()  # a link to nowhere is a mistake to be told


def read(path: Path) -> Rules:
    """The rules in the file at ``path``.

    Names of files in it are relative to its folder.

    Raises:
        DeltacamError: the file cannot be read, or a key or value in it is wrong; says which.
    """
    try:
        table = read_table(path, error=DeltacamError)
        sections = table.tables("part")
        rules = tuple(_rule(section, path) for section in sections)
        table.finish()
        for section, rule in zip(sections, rules, strict=True):
            if all(getattr(rule, key) is None for key in _KEYS):
                raise section.problem("nothing is said of these parts", hint=f"give one of {', '.join(_KEYS)}")
    except DeltacamError as problem:  # there may be one in each folder: name this one in full
        place = problem.where.removeprefix(str(path)).removeprefix(path.name)
        raise DeltacamError(problem.what, where=f"{path}{place}", hint=problem.hint) from problem
    return Rules(str(path), rules)


def _rule(section: Table, path: Path) -> Rule:
    pattern = section.text("pattern")
    try:
        check_pattern(pattern)
    except DeltacamError as problem:
        raise section.problem(f"pattern: {problem.what}", hint=problem.hint) from problem
    return Rule(
        pattern=pattern,
        robot=name_or_file(section, "robot", path),
        process=name_or_file(section, "process", path),
        units=unit_name(section, "units"),
        quantity=section.integer("quantity", minimum=1, maximum=MOST) if section.has("quantity") else None,
    )
