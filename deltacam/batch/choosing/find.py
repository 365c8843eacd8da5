"""Which drawings a batch plans: those of a folder and its subfolders, or those of a list."""

from __future__ import annotations

import codecs
import os
import unicodedata
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath
from typing import Final

from deltacam.batch.choosing.patterns import check_pattern, matches, suggestion, written
from deltacam.batch.choosing.search import ENDING, Kind, look_up, search
from deltacam.errors import DeltacamError

_UNKNOWN_INSIDE: Final = (Kind.HIDDEN_FOLDER, Kind.LINKED_FOLDER, Kind.RULES)
"""Drawings that are wanted may be in there, whatever they are called themselves."""


@dataclass(frozen=True, slots=True)
class Found:
    """The drawings of a batch.

    Attributes:
        drawings: name, relative to the folder and with ``/``, and path of each; in the order of the names.
        notes: what was left out, and why; safe to show.
    """

    drawings: tuple[tuple[str, Path], ...]
    notes: tuple[str, ...] = ()


def find(
    folder: Path, *, include: Sequence[str] = (), exclude: Sequence[str] = (), listed: Sequence[str] | None = None
) -> Found:
    """The drawings in a folder and in its subfolders.

    Hidden files and folders are left out. Links to files are followed, links to folders are not.

    Args:
        folder: to look in.
        include: patterns as `patterns.matches` reads them: only drawings that are like one of them; none for all.
        exclude: patterns: no drawings that are like one of them.
        listed: only these drawings: paths as seen from the current folder. The folder is not searched then, and a
            pattern that fits none of them is a note, not an error: the list may be another one every day.

    Raises:
        DeltacamError: the folder or one below it cannot be read, a pattern fits nothing, what is listed is not a
            drawing in the folder, two drawings would share the files of their results, or there is no drawing.
    """
    for option, pattern in _options(include, exclude):
        _check(option, pattern)
    seen = dict(sorted(search(folder) if listed is None else look_up(folder, listed), key=lambda one: one[0]))
    drawings = _drawings(seen)
    if not drawings:
        raise _nothing(folder, seen, of_a_list=listed is not None)
    useless = _options(_useless(include, drawings), _useless(exclude, list(seen)))
    if useless and listed is None:
        option, pattern = useless[0]
        raise DeltacamError(f"no drawing is like {pattern!r}", where=option, hint=suggestion(pattern, drawings))
    chosen = {name: kind for name, kind in seen.items() if _is_chosen(name, kind, include, exclude)}
    kept = _drawings(chosen)
    if not kept:
        hint = f"without them, there is {written(drawings)}"
        raise DeltacamError("--include and --exclude leave no drawing", where=str(folder), hint=hint)
    refuse_clashes(kept)
    unused = (f"{option}: nothing in the list is like {pattern!r}" for option, pattern in useless)
    return Found(tuple((name, folder / name) for name in kept), (*_notes(chosen), *unused))


def names_in(data: bytes) -> tuple[str, ...]:
    """The names in a list: between NULs where it holds one, as ``find -print0`` writes them, else one a line.

    Bytes that are not UTF-8 are kept as `os.fsdecode` does.

    Raises:
        DeltacamError: it begins like UTF-16 and is none.
    """
    if data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):  # by > in PowerShell
        try:
            text = data.decode("utf-16")
        except UnicodeDecodeError as problem:
            raise DeltacamError("the list is damaged UTF-16", where="--list", hint="save it as UTF-8") from problem
    else:
        text = os.fsdecode(data.removeprefix(codecs.BOM_UTF8))
    names = text.split("\0") if "\0" in text else [line.removesuffix("\r") for line in text.split("\n")]
    return tuple(name for name in names if name.strip())


def refuse_clashes(names: Sequence[str]) -> None:
    """Refuse two drawings whose results would have one name, also on a disk that does not tell capitals apart.

    Raises:
        DeltacamError: names both.
    """
    owners: dict[str, str] = {}
    for name in names:
        stem = unicodedata.normalize("NFD", str(PurePosixPath(name).with_suffix("")))
        other = owners.setdefault(unicodedata.normalize("NFD", stem.casefold()), name)
        if other != name:
            looks_the_same = unicodedata.normalize("NFC", other) == unicodedata.normalize("NFC", name)
            one, two = map(ascii if looks_the_same else repr, (other, name))
            what = f"the results of {one} and {two} would have the same names"
            only = f"leave one out: --exclude {two}" if not matches(other, name) else "plan a list of drawings: --list"
            raise DeltacamError(what, hint=f"rename one of them, or {only}")


def _options(include: Sequence[str], exclude: Sequence[str]) -> list[tuple[str, str]]:
    """The patterns, each with its option."""
    return [*(("--include", pattern) for pattern in include), *(("--exclude", pattern) for pattern in exclude)]


def _check(option: str, pattern: str) -> None:
    try:
        check_pattern(pattern)
    except DeltacamError as problem:
        raise DeltacamError(problem.what, where=option, hint=problem.hint) from problem


def _nothing(folder: Path, seen: Mapping[str, Kind], *, of_a_list: bool) -> DeltacamError:
    """What is said where there is no drawing at all."""
    if of_a_list and not seen:
        return DeltacamError("the list names no drawing", where="--list", hint="write a name on each line")
    place = "the list" if of_a_list else "this folder and below"
    hint = "; ".join(_notes(seen)) or "name the folder that holds the drawings"
    return DeltacamError(f"no drawing ({ENDING}) in {place}", where=str(folder), hint=hint)


def _drawings(seen: Mapping[str, Kind]) -> list[str]:
    return [name for name, kind in seen.items() if kind is Kind.DRAWING]


def _useless(patterns: Sequence[str], names: Sequence[str]) -> list[str]:
    """The patterns that none of the names is like."""
    return [pattern for pattern in patterns if not any(matches(name, pattern) for name in names)]


def _is_chosen(name: str, kind: Kind, include: Sequence[str], exclude: Sequence[str]) -> bool:
    is_wanted = not include or kind in _UNKNOWN_INSIDE or any(matches(name, pattern) for pattern in include)
    return is_wanted and not any(matches(name, pattern) for pattern in exclude)


def _notes(seen: Mapping[str, Kind]) -> tuple[str, ...]:
    """What is said of that which is left out: a line for each reason."""
    left_out: dict[Kind, list[str]] = {kind: [] for kind in Kind if kind is not Kind.DRAWING}
    for name, kind in seen.items():
        if kind is not Kind.DRAWING:
            left_out[kind].append(name)
    return tuple(f"{kind.value}: {written(names)}" for kind, names in left_out.items() if names)
