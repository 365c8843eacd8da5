"""Configuration files of other programs as entries, and the ledger of which of them were used.

The files may come from anywhere: their size is bounded, their bytes must be text, a value that is given twice must be
the same, and nothing that a file refers to is opened.
"""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Final

from deltacam.errors import RobotError

MAX_BYTES: Final = 1_000_000
"""Largest file that is read."""

_NUMBER: Final = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?", re.ASCII)
_SHOWN: Final = 60  # characters of a value in a message


@dataclass(frozen=True, slots=True)
class Source:
    """A file that was read: its name without the folder, and its text."""

    name: str
    text: str

    @property
    def lines(self) -> list[str]:
        """The lines, ended as editors end them and not as Unicode may."""
        return re.split(r"\r\n|\n|\r", self.text)


@dataclass(frozen=True, slots=True)
class Entry:
    """One value of a file.

    Attributes:
        section: the section or command that it stands in, empty for none.
        key: its name.
        value: its text.
        place: the file and the line, for messages.
        overrides: whether it holds instead of an entry of the same name without it.
    """

    section: str
    key: str
    value: str
    place: str
    overrides: bool = False

    @property
    def label(self) -> str:
        """The entry as a person finds it: ``[printer] shoulder_radius``."""
        return f"[{self.section}] {self.key}" if self.section else self.key

    @property
    def line(self) -> str:
        """The entry with its value and its place."""
        value = self.value if len(self.value) <= _SHOWN else f"{self.value[: _SHOWN - 3]}..."
        return f"{self.place}: {self.label} {value}".rstrip()


def read_source(path: Path) -> Source:
    """The file at ``path``: UTF-8 text of at most `MAX_BYTES`.

    Raises:
        RobotError: it cannot be read, is too large, or is not text.
    """
    try:
        with path.open("rb") as stream:
            content = stream.read(MAX_BYTES + 1)
    except (OSError, ValueError) as problem:  # ValueError: a null character in the name
        reason = problem.strerror if isinstance(problem, OSError) and problem.strerror else str(problem)
        raise RobotError(f"the file cannot be read: {reason.lower()}", where=str(path)) from problem
    return to_source(path.name.encode("utf-8", "replace").decode("utf-8"), content)


def to_source(name: str, content: bytes) -> Source:
    """The bytes of a file as text.

    Raises:
        RobotError: more than `MAX_BYTES`, not UTF-8, or with null characters.
    """
    if len(content) > MAX_BYTES:
        raise RobotError(f"the file is larger than {MAX_BYTES:,} bytes; it is no configuration", where=name)
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as problem:
        line = content.count(b"\n", 0, problem.start) + 1
        raise RobotError(f"the file is not UTF-8 text (at line {line})", where=name, hint="save it as UTF-8") from None
    if "\0" in text:
        raise RobotError("the file holds null characters; it is not text", where=name)
    return Source(name, text)


class Ledger:
    """The entries of the files, and which of them were used.

    Args:
        entries: in the order of the files.
    """

    def __init__(self, entries: Iterable[Entry]) -> None:
        self._entries = tuple(entries)
        self._used: set[Entry] = set()
        self._named: dict[tuple[str, str], list[Entry]] = {}
        for entry in self._entries:
            self._named.setdefault((entry.section, entry.key), []).append(entry)

    @property
    def sections(self) -> dict[str, None]:
        """The sections that hold an entry, in their order."""
        return dict.fromkeys(entry.section for entry in self._entries)

    def find(self, section: str, key: str) -> Entry | None:
        """The entry of that name, which counts as used; None where there is none.

        Raises:
            RobotError: it is given twice with different values.
        """
        found = self._named.get((section, key), [])
        holding = [entry for entry in found if entry.overrides] or found
        self._used.update(holding)
        for other in holding[1:]:
            if other.value != holding[0].value:
                what = f"{other.label} is given twice: {_short(holding[0].value)} and {_short(other.value)}"
                raise RobotError(what, where=other.place, hint="remove the one that does not hold")
        return holding[0] if holding else None

    def number(self, section: str, key: str) -> tuple[Entry, float] | None:
        """The entry of that name and its number; None where there is none.

        Raises:
            RobotError: it is not a finite number, or is given twice with different values.
        """
        entry = self.find(section, key)
        return None if entry is None else (entry, to_number(entry))

    def unused(self) -> tuple[str, ...]:
        """The entries that nothing asked for, each with its place."""
        return tuple(entry.line for entry in self._entries if entry not in self._used)


def to_number(entry: Entry) -> float:
    """The value as a number.

    Raises:
        RobotError: it is not one, or not finite.
    """
    return numbers(entry, entry.value.split())[0] if entry.value else numbers(entry, [""])[0]


def numbers(entry: Entry, words: Sequence[str]) -> tuple[float, ...]:
    """The words of an entry as numbers.

    Raises:
        RobotError: a word is not a finite number, or there is more than the entry's one value.
    """
    if not all(_NUMBER.fullmatch(word) and math.isfinite(float(word)) for word in words) or not words:
        raise RobotError(f"{entry.label} = {_short(entry.value)!r} is not a number", where=entry.place)
    return tuple(float(word) for word in words)


def one_of(entry: Entry, units: dict[str, float], what: str) -> float:
    """The factor that the value names.

    Raises:
        RobotError: it names none.
    """
    word = entry.value.strip().lower()
    if word not in units:
        known = ", ".join(units)
        raise RobotError(
            f"{entry.label} = {_short(entry.value)!r} is no {what}", where=entry.place, hint=f"use {known}"
        )
    return units[word]


def ini_entries(source: Source, *, fold: bool = False, marks: str = "#;") -> list[Entry]:
    """The entries of a file of sections and of lines ``key = value`` or ``key: value``.

    A line that starts with a space goes on with the value above. A comment starts with one of ``marks``, at the start
    of the line or after a space.

    Args:
        source: the file.
        fold: whether keys are the same in capital and in small letters.
        marks: the characters that start a comment.
    """
    found: list[tuple[str, str, list[str], str]] = []
    section = ""
    for number, raw in enumerate(source.lines, start=1):
        line = re.split(rf"(?:^|\s)[{re.escape(marks)}]", raw, maxsplit=1)[0].rstrip()
        head = re.fullmatch(r"\s*\[([^\]]*)\]", line)
        if not line.strip():
            continue
        if head:
            section = head[1].strip()
        elif line[0].isspace() and found and found[-1][0] == section:
            found[-1][2].append(line.strip())
        else:
            key, _, value = re.sub(r"[:=]", "\0", line, count=1).partition("\0")
            key = key.strip().lower() if fold else key.strip()
            found.append((section, key, [value.strip()], f"{source.name}:{number}"))
    return [Entry(section, key, " ".join(lines).strip(), place) for section, key, lines, place in found]


def _short(value: str) -> str:
    return value if len(value) <= _SHOWN else f"{value[: _SHOWN - 3]}..."
