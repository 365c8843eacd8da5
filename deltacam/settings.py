"""Settings files: TOML that is read strictly.

Every key that a file holds must be asked for, every number has bounds, and every message names the file, the section
and the key. What is wrong is never skipped, clipped or guessed.
"""

from __future__ import annotations

import difflib
import tomllib
from collections.abc import Mapping, Sequence
from enum import Enum
from pathlib import Path
from typing import Any, Final

from deltacam.errors import DeltacamError

MAX_BYTES: Final = 1_000_000
"""Largest settings file that is read."""


class Required(Enum):
    """The default of a key that has none."""

    KEY = "required"


REQUIRED: Final = Required.KEY


class Table:
    """A table of a settings file.

    Every method that takes a ``key`` marks it as known; `finish` refuses the others. A value that is missing or wrong
    raises ``error`` with the value, the key and what is allowed.

    Args:
        values: the table as TOML gives it.
        file: the file's name, for messages.
        section: the table's name in the file; empty for the top level.
        error: what to raise.
    """

    def __init__(self, values: Mapping[str, Any], *, file: str, section: str = "", error: type[DeltacamError]) -> None:
        self._values = values
        self._file = file
        self._section = section
        self._error = error
        self._known: dict[str, None] = {}
        self._tables: list[Table] = []

    @property
    def where(self) -> str:
        """The file and the section, for messages: ``robot.toml [joints]``."""
        return f"{self._file} [{self._section}]" if self._section else self._file

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys that the file gives here, in its order; asking marks none of them as known."""
        return tuple(self._values)

    def problem(self, what: str, *, hint: str = "") -> DeltacamError:
        """An error of the file's kind that is located in this table."""
        return self._error(what, where=self.where, hint=hint)

    def has(self, key: str) -> bool:
        """Whether the file gives ``key``."""
        self._known[key] = None
        return key in self._values

    def table(self, key: str, *, required: bool = True) -> Table:
        """The table ``key``; an empty one where it is missing and not required."""
        name = f"{self._section}.{key}" if self._section else key
        values = self._values[key] if self.has(key) else {}
        if required and key not in self._values:
            raise self.problem(f"the section [{name}] is missing", hint=self._suggestion(key))
        if not isinstance(values, dict):
            raise self.problem(f"{key} = {_show(values)} must be a section", hint=f"write [{name}] above its keys")
        table = Table(values, file=self._file, section=name, error=self._error)
        self._tables.append(table)
        return table

    def tables(self, key: str) -> tuple[Table, ...]:
        """The tables that are written one by one under ``[[key]]``; none where it is missing."""
        values = self._values[key] if self.has(key) else []
        if not isinstance(values, list) or not all(isinstance(value, dict) for value in values):
            raise self.problem(f"{key} = {_show(values)} must be sections", hint=f"write [[{key}]] above each of them")
        name = f"{self._section}.{key}" if self._section else key
        tables = [
            Table(value, file=self._file, section=f"{name} {number}", error=self._error)
            for number, value in enumerate(values, start=1)
        ]
        self._tables += tables
        return tuple(tables)

    def number(self, key: str, *, minimum: float, maximum: float, default: float | Required = REQUIRED) -> float:
        """The number ``key``, from ``minimum`` to ``maximum`` in the file's own unit."""
        value = self._get(key, default, f"a number from {minimum:g} to {maximum:g}")
        return self._bounded(key, value, minimum, maximum)

    def number_or(self, key: str, word: str, *, minimum: float, maximum: float) -> float | None:
        """The number ``key`` as `number`; None where the file gives the ``word`` in its place, or nothing."""
        if not self.has(key) or self._values[key] == word:
            return None
        if isinstance(self._values[key], str):
            self.choice(key, (word,))
        return self.number(key, minimum=minimum, maximum=maximum)

    def numbers(
        self,
        key: str,
        *,
        length: int,
        minimum: float,
        maximum: float,
        default: Sequence[float] | Required = REQUIRED,
        repeat: bool = False,
    ) -> tuple[float, ...]:
        """The list ``key`` of ``length`` numbers, each in the bounds; with ``repeat``, one number stands for all."""
        value = self._get(key, default, f"{length} numbers from {minimum:g} to {maximum:g}")
        if repeat and not isinstance(value, (list, tuple)):
            value = [value] * length
        if not isinstance(value, (list, tuple)) or len(value) != length:
            raise self.problem(f"{key} = {_show(value)} must be a list of {length} numbers")
        return tuple(self._bounded(key, item, minimum, maximum) for item in value)

    def integer(
        self,
        key: str,
        *,
        minimum: int,
        maximum: int,
        default: int | Required = REQUIRED,
        names: Mapping[str, int] | None = None,
    ) -> int:
        """The whole number ``key``, from ``minimum`` to ``maximum``, or one of the ``names`` that stand for one."""
        value = self._get(key, default, f"a whole number from {minimum} to {maximum}")
        if names and isinstance(value, str):
            return names[self.choice(key, tuple(names))]
        if not isinstance(value, int) or isinstance(value, bool):
            raise self.problem(f"{key} = {_show(value)} is not a whole number", hint=f"allowed: {minimum} to {maximum}")
        if not minimum <= value <= maximum:
            raise self.problem(f"{key} = {_show(value)} is outside {minimum} to {maximum}")
        return value

    def text(self, key: str, *, default: str | Required = REQUIRED) -> str:
        """The text ``key``; required text must not be empty."""
        value = self._get(key, default, "text in quotes")
        if not isinstance(value, str):
            raise self.problem(f"{key} = {_show(value)} is not text", hint=f'write it in quotes: {key} = "..."')
        if default is REQUIRED and not value.strip():
            raise self.problem(f"{key} is empty")
        return value

    def flag(self, key: str, *, default: bool | Required = REQUIRED) -> bool:
        """Whether ``key`` is true."""
        value = self._get(key, default, "true or false")
        if not isinstance(value, bool):
            raise self.problem(f"{key} = {_show(value)} is not true or false", hint=f"write {key} = true, or false")
        return value

    def choice(self, key: str, options: Sequence[str], *, default: str | Required = REQUIRED) -> str:
        """The text ``key``, one of ``options``."""
        allowed = " or ".join(f'"{option}"' for option in options)
        value = self._get(key, default, allowed)
        if value not in options:
            near = _nearest(value, options) if isinstance(value, str) else None
            hint = f"did you mean {near!r}?" if near else ""
            raise self.problem(f"{key} = {_show(value)} is not {allowed}", hint=hint)
        return str(value)

    def finish(self) -> None:
        """Refuse keys that nothing asked for, here and in every table that was taken from this one."""
        for key in self._values:
            if key not in self._known:
                kind = "section" if isinstance(self._values[key], dict) else "key"
                place = f" in [{self._section}]" if self._section else ""
                near = _nearest(key, list(self._known))
                question = f"; did you mean {near!r}?" if near else ""
                raise self.problem(f"unknown {kind} {key!r}{place}{question}", hint=f"known: {', '.join(self._known)}")
        for table in self._tables:
            table.finish()

    def _get(self, key: str, default: object, allowed: str) -> Any:
        if self.has(key):
            return self._values[key]
        if default is REQUIRED:
            raise self.problem(f"{key} is missing", hint=self._suggestion(key) or f"add {key} = {allowed}")
        return default

    def _suggestion(self, key: str) -> str:
        """The key that was probably meant to be the missing ``key``; far stricter than for unknown keys."""
        others = [other for other in self._values if other not in self._known]
        without_unit = [other for other in others if key.startswith(f"{other}_")]
        near = without_unit[0] if without_unit else _nearest(key, others, cutoff=0.85)
        return f"the file has {near!r}; did you mean {key!r}?" if near else ""

    def _bounded(self, key: str, value: object, minimum: float, maximum: float) -> float:
        allowed = f"{minimum:g} to {maximum:g}"
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self.problem(f"{key} = {_show(value)} is not a number", hint=f"allowed: {allowed}")
        if not minimum <= value <= maximum:  # true of nan; before float(), which may overflow
            raise self.problem(f"{key} = {_show(value)} is outside {allowed}")
        return float(value)


def read_table(path: Path, *, error: type[DeltacamError]) -> Table:
    """The top level of the TOML file at ``path``.

    Args:
        path: UTF-8, with or without a byte order mark, at most `MAX_BYTES`.
        error: what to raise, here and from the table.

    Raises:
        DeltacamError: of kind ``error``: the file cannot be read, is too large, is not UTF-8 or is not TOML.
    """
    try:
        with path.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as problem:  # ValueError: a null character in the name
        reason = problem.strerror if isinstance(problem, OSError) and problem.strerror else str(problem)
        raise error(f"the file cannot be read: {reason.lower()}", where=str(path)) from problem
    if len(content) > MAX_BYTES:
        raise error(f"the file is larger than {MAX_BYTES:,} bytes; it is not a settings file", where=path.name)
    try:
        values = tomllib.loads(content.decode("utf-8-sig"))
    except UnicodeDecodeError as problem:
        line = content.count(b"\n", 0, problem.start) + 1
        raise error(
            f"the file is not UTF-8 text (at line {line})", where=path.name, hint="save it as UTF-8"
        ) from problem
    except (ValueError, RecursionError) as problem:  # TOMLDecodeError, and a number of thousands of digits
        raise error(f"the file is not TOML: {_lower_first(str(problem))}", where=path.name) from problem
    return Table(values, file=path.name, error=error)


def _nearest(word: str, options: Sequence[str], *, cutoff: float = 0.6) -> str | None:
    matches = difflib.get_close_matches(word, options, n=1, cutoff=cutoff)
    return matches[0] if matches else None


def _show(value: object) -> str:
    """A value about as the file writes it, in at most 40 characters."""
    try:
        text: str = str(value).lower() if isinstance(value, bool) else repr(value)
    except ValueError:  # a whole number of thousands of digits
        text = "a huge number"
    return text if len(text) <= 40 else f"{text[:37]}..."


def _lower_first(text: str) -> str:
    return text[:1].lower() + text[1:]
