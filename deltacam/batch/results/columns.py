"""The columns of the page of a batch: what they show, and what they are sorted by."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Final, NamedTuple
from urllib.parse import quote

from deltacam.batch.parts import Batch, Row, Status
from deltacam.batch.results.thumbnail import to_svg
from deltacam.batch.results.totals import clock, counted
from deltacam.report.escaping import shown
from deltacam.units import to_mm

_SIGNS: Final = {Status.PASSED: ("ok", "\u2713"), Status.LEFT: ("quiet", "\u2013")}
_LINKS: Final = ((".program.csv", "program"), (".report.json", "JSON"))
_LONGEST: Final = 400  # characters of the warnings of a part
_URGENCY: Final = (*(status for status in Status if status is not Status.PASSED), Status.PASSED)

Value = float | None


class Column(NamedTuple):
    """One column.

    Attributes:
        name: of its class in the style sheet, and in the script.
        head: its heading; numbers have their unit there.
        width: of the grid, in the style sheet's words.
        cell: what it shows, HTML; empty where nothing is known.
        value: what it is sorted by; None comes last.
    """

    name: str
    head: str
    width: str
    cell: Callable[[Row], str]
    value: Callable[[Row], Value]


def columns(batch: Batch) -> tuple[Column, ...]:
    """The columns that this batch needs: the quantities are not among them where each is 1."""
    rank = {row.part: number for number, row in enumerate(batch.rows)}
    settings = len({(row.outcome.robot, row.outcome.process) for row in batch.rows}) > 1
    several = any(row.quantity != 1 for row in batch.rows)
    return (
        Column("part", "part", "minmax(0,1fr)", lambda row: _part(row, settings=settings), lambda row: rank[row.part]),
        Column("status", "verdict", "7rem", _verdict, lambda row: urgency(row.outcome.status)),
        Column("time", "time, s", "4.5rem", lambda row: _number(_time(row), 2), _time),
        *(_QUANTITIES if several else ()),
        Column("cut", "cut, mm", "5.25rem", lambda row: _number(_cut(row), 1), _cut),
        Column("size", "size, mm", "8.5rem", _size, _area),
        Column("contours", "contours", "4.75rem", lambda row: _number(_contours(row), 0), _contours),
    )


def urgency(status: Status) -> int:
    """The place of the status where what needs a person comes first."""
    return _URGENCY.index(status)


def picture(row: Row) -> str:
    """The thumbnail, which leads to the report as well; those who cannot see it have the name for that."""
    drawn = to_svg(row.outcome.thumbnail)
    report = row.file(".report.html")
    return f'<a href="{_address(report)}" tabindex="-1" aria-hidden="true">{drawn}</a>' if report else drawn


def _time(row: Row) -> Value:
    """Of one piece, s."""
    return row.outcome.facts.time if row.outcome.facts else None


def _total(row: Row) -> Value:
    """Of all pieces, s."""
    return row.quantity * row.outcome.facts.time if row.outcome.facts else None


def _cut(row: Row) -> Value:
    return to_mm(row.outcome.facts.cut_length) if row.outcome.facts else None


def _contours(row: Row) -> Value:
    return row.outcome.facts.contours if row.outcome.facts else None


def _area(row: Row) -> Value:
    size = row.outcome.facts.size if row.outcome.facts else None
    return to_mm(size[0]) * to_mm(size[1]) if size else None


def _size(row: Row) -> str:
    size = row.outcome.facts.size if row.outcome.facts else None
    return " \u00d7 ".join(f"{to_mm(side):.2f}" for side in size) if size else ""


def _part(row: Row, *, settings: bool) -> str:
    """The name with its links, and where that differs between parts with what it is planned for."""
    folder, slash, file = row.part.rpartition("/")
    report, name = row.file(".report.html"), shown(file)
    linked = f'<a href="{_address(report)}">{name}</a>' if report else name
    found = ((row.file(ending), word) for ending, word in _LINKS)
    links = " ".join(f'<a href="{_address(file)}">{word}</a>' for file, word in found if file)
    used = ", ".join(shown(name) for name in (row.outcome.robot, row.outcome.process) if name) if settings else ""
    lines = "".join(f"<small>{line}</small>" for line in (used, links) if line)
    return f'<span class="quiet">{shown(folder + slash)}</span>{linked}{lines}'


def _verdict(row: Row) -> str:
    outcome = row.outcome
    kind, sign = _SIGNS.get(outcome.status, ("bad", "\u2717"))
    lines = f"<small>{counted(outcome.facts.checks, 'check')}</small>" if outcome.facts else ""
    if outcome.warnings:
        texts = shown("; ".join(outcome.warnings), longest=_LONGEST)
        lines += f'<small class="warned" title="{texts}">! {counted(len(outcome.warnings), "warning")}</small>'
    return f'<span class="{kind}">{sign} {outcome.status}</span>{lines}'


def _number(value: Value, digits: int) -> str:
    return "" if value is None else f"{value:.{digits}f}"


def _address(name: str) -> str:
    """A file of the folder of results as the address in a link; bytes that are not UTF-8 stay what they are."""
    try:
        return quote(os.fsencode(name))
    except UnicodeEncodeError:  # no file can be called so here
        return quote(name, errors="surrogatepass")


_QUANTITIES: Final = (
    Column("quantity", "pieces", "4rem", lambda row: str(row.quantity), lambda row: row.quantity),
    Column("total", "total, h:mm:ss", "4.5rem", lambda row: "" if (of := _total(row)) is None else clock(of), _total),
)
