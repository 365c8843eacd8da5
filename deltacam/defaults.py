"""The user's own defaults: ``deltacam.toml``.

What the command line says wins over this file, and this file over what is built in.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Final

from deltacam.errors import DeltacamError
from deltacam.settings import Table, read_table
from deltacam.units import metres_per

FILE: Final = "deltacam.toml"

JOINING: Final = (1e-6, 5e-3)
"""Smallest and largest distance between ends that a person may have joined, m."""


@dataclass(frozen=True, slots=True)
class Defaults:
    """What a user wants where the command line does not say; None where the file does not say either.

    Attributes:
        file: the path that it was read from; empty where there is no such file.
        robot: a built-in name, or the path of a robot file.
        process: a built-in name, or the path of a process file.
        units: what one unit is in drawings that do not state it.
        joining: largest distance between ends that are joined, m.
    """

    file: str = ""
    robot: str | None = None
    process: str | None = None
    units: str | None = None
    joining: float | None = None


def find(folders: Sequence[Path]) -> Defaults:
    """The defaults of the first folder that has a ``deltacam.toml``; empty ones where none has.

    Raises:
        DeltacamError: the file cannot be read, or a key or value in it is wrong; says which.
    """
    for folder in folders:
        if os.path.lexists(folder / FILE):  # a link to nowhere is a mistake to be told, not a missing file
            return read(folder / FILE)
    return Defaults()


def read(path: Path) -> Defaults:
    """The defaults in the file at ``path``.

    Names of files in it are relative to its folder.

    Raises:
        DeltacamError: the file cannot be read, or a key or value in it is wrong; says which.
    """
    try:
        table = read_table(path, error=DeltacamError)
        found = Defaults(
            robot=name_or_file(table, "robot", path),
            process=name_or_file(table, "process", path),
            units=unit_name(table, "units"),
            joining=_joining(table),
        )
        table.finish()
    except DeltacamError as problem:  # there may be one in each folder: name this one in full
        raise DeltacamError(problem.what, where=str(path), hint=problem.hint) from problem
    return replace(found, file=str(path))


def name_or_file(table: Table, key: str, path: Path) -> str | None:
    """The robot or process that ``key`` names, as the readers of robots and processes take it.

    A built-in name is left as it is; what ends in ``.toml`` or holds a separator is a file, as seen from the folder of
    the settings.

    Args:
        table: of the settings file at ``path``.
        key: where it is missing, the answer is None.
        path: of the settings file.

    Raises:
        DeltacamError: it is not text, is empty, or is a file that is not there.
    """
    if not table.has(key):
        return None
    name = table.text(key)
    if not name.lower().endswith(".toml") and Path(name).name == name:
        return name
    file = path.parent / name
    try:
        is_file = file.is_file()
    except OSError as problem:
        reason = (problem.strerror or str(problem)).lower()
        raise table.problem(f"{key} = {name!r}: the file cannot be looked at: {reason}") from problem
    if not is_file:
        raise table.problem(f"{key} = {name!r}: there is no such file", hint=f"name it as seen from {path.name}")
    # Without its folder, "./delta-300" would be the robot of that name.
    return f"{os.curdir}{os.sep}{file}" if str(file) == file.stem else str(file)


def unit_name(table: Table, key: str) -> str | None:
    """The name of the unit of length that ``key`` gives; None where it is missing.

    Raises:
        DeltacamError: it is not text, or there is no such unit.
    """
    if not table.has(key):
        return None
    unit = table.text(key)
    try:
        metres_per(unit)
    except DeltacamError as problem:
        raise table.problem(f"{key}: {problem.what}", hint=problem.hint) from problem
    return unit


def _joining(table: Table) -> float | None:
    if not table.has("joining_mm"):
        return None
    low, high = JOINING
    return table.number("joining_mm", minimum=low * 1e3, maximum=high * 1e3) / 1e3
