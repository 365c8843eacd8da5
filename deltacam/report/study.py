"""A study of a robot as it is shown: facts, tables and charts; as text, as a page, and as JSON."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Final

from deltacam.plain import plain
from deltacam.report import palette
from deltacam.report.escaping import shown
from deltacam.report.figures import Json
from deltacam.report.page import frame
from deltacam.report.tables import table

_LONGEST: Final = 400  # characters of a cell or a name on a terminal; a file may hold a name of any length
_STYLE: Final = (
    ".chart{height:34rem}figure.study{margin:0 0 2rem}figure.study h2{margin-top:0}"
    "figure.study figcaption{max-width:60rem}"
)


@dataclass(frozen=True, slots=True)
class Table:
    """Rows of plain text.

    Attributes:
        heading: what it holds.
        heads: the names of the columns.
        rows: as many cells each as there are heads; the first is the row's name.
    """

    heading: str
    heads: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, slots=True, eq=False)
class Chart:
    """A picture as plotly.js draws it.

    Attributes:
        heading: what it shows.
        caption: how to read it.
        traces: of plotly.js.
        layout: of plotly.js.
    """

    heading: str
    caption: str
    traces: tuple[Json, ...]
    layout: Json


@dataclass(frozen=True, slots=True, eq=False)
class Study:
    """What was found out, for people and for programs.

    Attributes:
        title: one line of plain text.
        facts: names and values with their units.
        tables: below the facts.
        charts: on the page only.
        notes: sentences that a person should know.
        data: the JSON object; keys carry their units, numbers are finite.
    """

    title: str
    facts: tuple[tuple[str, str], ...]
    tables: tuple[Table, ...] = ()
    charts: tuple[Chart, ...] = ()
    notes: tuple[str, ...] = ()
    data: Json = field(default_factory=dict)


def to_text(study: Study) -> str:
    """The study for a terminal, without its charts; names from files cannot command the terminal."""
    width = max((len(name) for name, _ in study.facts), default=0)
    lines = [_plain(study.title), *(f"  {_plain(name):<{width}}  {_plain(value)}" for name, value in study.facts)]
    for one in study.tables:
        lines += ["", _plain(one.heading), *_columns((one.heads, *one.rows))]
    if study.notes:
        lines += ["", *(f"note: {_plain(note)}" for note in study.notes)]
    return "\n".join(lines)


def to_html(study: Study, *, library: str | None = None) -> str:
    """The study as one page that opens offline.

    Args:
        study: everything in it is escaped.
        library: where a copy of `page.plotly_js` lies, relative to the page; None puts it into the page, 4.8 MB.
    """
    rows = [(shown(name), shown(value)) for name, value in study.facts]
    facts = table(("fact", "value"), rows) if rows else ""
    tables = "".join(f"<section><h2>{shown(one.heading)}</h2>{_html_table(one)}</section>\n" for one in study.tables)
    charts = "".join(
        f'<figure class="study inked"><h2>{shown(chart.heading)}</h2><div class="chart" id="chart{number}"></div>'
        f"<figcaption>{shown(chart.caption)}</figcaption></figure>\n"
        for number, chart in enumerate(study.charts)
    )
    notes = "".join(f"<p>{shown(note)}</p>" for note in study.notes)
    drawn = [{"traces": chart.traces, "layout": chart.layout} for chart in study.charts]
    return frame(
        title=shown(study.title),
        style=_STYLE + palette.dark_rules(()),
        body=f"<header><h1>{shown(study.title)}</h1></header>\n<main>\n{facts}\n{charts}{tables}{notes}</main>\n",
        data=json.dumps(drawn, allow_nan=False).replace("<", "\\u003c"),
        library=library,
        scripts=("study.js",),
    )


def _html_table(one: Table) -> str:
    rows = [tuple(map(shown, row)) for row in one.rows]
    return table(tuple(map(shown, one.heads)), rows, numbers=range(1, len(one.heads)))


def _columns(rows: Sequence[Sequence[str]]) -> list[str]:
    """The rows in columns: the first to the left, the others to the right."""
    cells = [[_plain(cell) for cell in row] for row in rows]
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return [
        ("  " + "  ".join([row[0].ljust(widths[0]), *map(str.rjust, row[1:], widths[1:])])).rstrip() for row in cells
    ]


def _plain(text: str) -> str:
    return plain(text, longest=_LONGEST)
