"""Reading JSON objects that may come from anywhere: every key is known, every value has a type and a range."""

from __future__ import annotations

import json
import math
from collections.abc import Mapping, Sequence
from enum import StrEnum
from typing import Any, Final, TypeVar

from deltacam.errors import ProgramError

MAX_WHOLE: Final = 2**53
"""Largest whole number that is read; a spreadsheet and JavaScript hold it exactly too."""

_LONGEST_TEXT: Final = 10_000
_Choice = TypeVar("_Choice", bound=StrEnum)


class Fields:
    """The keys of one JSON object.

    Args:
        values: what JSON gave.
        where: the file, line and place, for messages.
        keys: exactly the keys that it must have.

    Raises:
        ProgramError: not an object, or a missing or unknown key.
    """

    def __init__(self, values: object, where: str, keys: Sequence[str]) -> None:
        self.where = where
        if not isinstance(values, Mapping):
            raise self.problem(f"expected an object, got {type(values).__name__}")
        self._values: Mapping[str, Any] = values
        missing = [key for key in keys if key not in values]
        unknown = sorted(key[:40] for key in values if key not in keys)[:5]
        if missing:
            hint = "the file may be from an older deltacam; plan the drawing again"
            raise self.problem(f"missing {', '.join(missing)}", hint=hint)
        if unknown:
            hint = "the file may be from a newer deltacam, which gives these keys a meaning"
            raise self.problem(f"unknown {', '.join(map(repr, unknown))}", hint=hint)

    def problem(self, what: str, *, hint: str = "") -> ProgramError:
        """An error that is located here."""
        return ProgramError(what, where=self.where, hint=hint)

    def section(self, key: str, keys: Sequence[str]) -> Fields:
        """The object ``key``, which has exactly ``keys``."""
        return Fields(self._values[key], f"{self.where}, {key}", keys)

    def raw(self, key: str) -> object:
        """The value of ``key``, unchecked."""
        return self._values[key]

    def items(self, key: str) -> list[object]:
        """The list ``key``, its items unchecked."""
        value = self._values[key]
        if not isinstance(value, list):
            raise self.problem(f"{key} is not a list")
        return value

    def text(self, key: str, *, empty: bool = False) -> str:
        """The text ``key``."""
        return self._text(key, self._values[key], empty)

    def texts(self, key: str) -> tuple[str, ...]:
        """The list of texts ``key``."""
        return tuple(self._text(key, value, False) for value in self.items(key))

    def number(self, key: str, low: float, high: float) -> float:
        """The number ``key``, from ``low`` to ``high``."""
        value = self._values[key]
        if isinstance(value, bool) or not isinstance(value, int | float):
            raise self.problem(f"{key} is not a number but {type(value).__name__}")
        if not low <= value <= high:  # true of nan; before float(), which may overflow
            raise self.problem(f"{key} is outside {low:g} to {high:g}")
        return float(value)

    def flag(self, key: str) -> bool:
        """Whether ``key`` is true."""
        value = self._values[key]
        if not isinstance(value, bool):
            raise self.problem(f"{key} is not true or false")
        return value

    def whole(self, key: str, low: int, high: int = MAX_WHOLE) -> int:
        """The whole number ``key``, from ``low`` to ``high``."""
        value = self._values[key]
        if isinstance(value, bool) or not isinstance(value, int):
            raise self.problem(f"{key} is not a whole number")
        if not low <= value <= high:
            raise self.problem(f"{key} is outside {low} to {high}")
        return value

    def choice(self, key: str, options: type[_Choice]) -> _Choice:
        """The text ``key``, one of ``options``."""
        text = self.text(key)
        if text not in [option.value for option in options]:
            names = ", ".join(option.value for option in options)
            raise self.problem(f"unknown {key} {text[:40]!r}", hint=f"this deltacam knows {names}")
        return options(text)

    def _text(self, key: str, value: object, empty: bool) -> str:
        if not isinstance(value, str):
            raise self.problem(f"{key} is not text")
        if len(value) > _LONGEST_TEXT or not (value or empty):
            shortest = 0 if empty else 1
            raise self.problem(f"{key} has {len(value)} characters, which is not {shortest} to {_LONGEST_TEXT}")
        return value


def parse_json(text: str, where: str) -> object:
    """The JSON value in ``text``, without duplicate keys, nan and infinities.

    Raises:
        ProgramError: not JSON, nested too deeply, a number that is not finite, or a key that is given twice.
    """
    try:
        return json.loads(text, object_pairs_hook=_unique, parse_constant=_refuse, parse_float=_finite)
    except (ValueError, RecursionError) as problem:  # ValueError also for a number of thousands of digits
        reason = str(problem).splitlines()[0] if isinstance(problem, ValueError) else "it is nested too deeply"
        hint = "the line was changed or cut off; plan the drawing again"
        raise ProgramError(f"the meta object is not JSON that can be read: {reason}", where=where, hint=hint) from None


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    found = dict(pairs)
    if len(found) != len(pairs):
        raise ValueError("a key is given twice")
    return found


def _refuse(constant: str) -> float:
    raise ValueError(f"{constant} is not a number")


def _finite(text: str) -> float:
    value = float(text)
    if not math.isfinite(value):
        raise ValueError("a number is too large")
    return value
