"""The batch as a page that opens offline: a picture, the time and the verdict of every part, with its report.

What did not pass comes first. Without a script the page is complete; with one it can be sorted and searched.
"""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from importlib.metadata import version
from typing import Final

from deltacam.batch.parts import Batch, Row, Status
from deltacam.batch.results.columns import Column, columns, picture, urgency
from deltacam.batch.results.reasons import Reason, reasons
from deltacam.batch.results.totals import clock, counted, totals, verdict
from deltacam.report.escaping import shown
from deltacam.report.page import frame
from deltacam.report.tables import table

_LONGEST: Final = 600  # characters of a sentence
_MOST_NOTES: Final = 8  # that are shown at once


def to_html(batch: Batch) -> str:
    """The page; everything in it is escaped, and it refers to nothing but the files beside it."""
    rows = sorted(batch.rows, key=lambda row: urgency(row.outcome.status))
    shared, found = columns(batch), reasons(batch)
    reason_of = {part: number for number, reason in enumerate(found) for part in reason.parts}
    kind, word = ("passed", "Passed") if batch.passed else ("failed", "Failed")
    return frame(
        title=f"Batch: {word.lower()}",
        style=f".parts tr{{--columns:{' '.join(column.width for column in shared)}}}",
        body=f'<header class="{kind}"><h1>Batch of {counted(len(rows), "drawing")}</h1>'
        f'<p class="verdict">{word}</p><p>{verdict(batch)}.</p></header>\n'
        f"<main>\n{_tiles(batch)}{_notes(batch.notes)}{_why(found)}"
        f"<section><h2>Parts</h2>{_bar(batch)}{_table(rows, shared)}</section>\n</main>\n",
        data=_data(rows, shared, reason_of),
        library="",
        scripts=("index.js",),
        sheets=("page.css", "index.css"),
    )


def _tiles(batch: Batch) -> str:
    """What the parts come to, and what they are planned for where that is one thing."""
    sums = totals(batch)
    robots, processes = ({getattr(row.outcome, of) for row in batch.rows} for of in ("robot", "process"))
    tiles = {
        "parts passed": f"{batch.count(Status.PASSED)} of {len(batch.rows)}",
        "pieces to cut": str(sums.pieces),
        "machine time, h:mm:ss": clock(sums.time),
        "cut length": f"{sums.cut_length:.2f} m",
        "robot": robots.pop() if len(robots) == 1 else "",
        "process": processes.pop() if len(processes) == 1 else "",
        "planned by": f"deltacam {version('deltacam')}",
    }
    cells = (f"<div><dt>{shown(name)}</dt><dd>{shown(value)}</dd></div>" for name, value in tiles.items() if value)
    return (
        f"<dl>{''.join(cells)}</dl>\n"
        '<p class="note">Pieces, time and length are those of the parts that passed, each as often as it is wanted. '
        'For programs: <a href="batch.json">batch.json</a>; for a spreadsheet: <a href="batch.csv">batch.csv</a>.</p>\n'
    )


def _notes(notes: Sequence[str]) -> str:
    """What a person should know; many notes are folded."""
    items = f"<ul>{''.join(f'<li>{shown(note, longest=_LONGEST)}</li>' for note in notes)}</ul>"
    if len(notes) > _MOST_NOTES:
        items = f"<details><summary>{len(notes)} notes</summary>{items}</details>"
    return f'<section class="notes"><h2>Notes</h2>{items}</section>\n' if notes else ""


def _why(found: Sequence[Reason]) -> str:
    """The reasons of several parts each, which are what to see to first."""
    rows = []
    for number, reason in enumerate(found):
        if len(reason.parts) > 1:
            button = f'<button type="button" class="go" data-column="reason" data-value="{number}">Show</button>'
            sentence = f"{shown(reason.sentence, longest=_LONGEST)}{_hint(reason.hint)}"
            status = f'<span class="bad">{reason.status}</span>'
            which = f"{shown(reason.named, longest=_LONGEST)}{button}"
            rows.append((str(len(reason.parts)), status, sentence, which))
    if not rows:
        return ""
    heads = ("parts", "verdict", "reason", "which")
    return f'<section class="why"><h2>Reasons of several parts</h2>{table(heads, rows)}</section>\n'


def _bar(batch: Batch) -> str:
    """What the script finds parts with; without a script it is not there."""
    present = [status for status in Status if batch.count(status)]
    passed, every = batch.count(Status.PASSED), len(batch.rows)
    choices = [("all", "", 0, every), ("not passed", "passed", 0, every - passed)]
    choices += [(status.value, "status", urgency(status), batch.count(status)) for status in present]
    buttons = "".join(
        f'<button type="button" data-column="{column}" data-value="{value}">{word} {count}</button>'
        for word, column, value, count in choices
    )
    group = f'<div class="group" role="group" aria-label="Verdict">{buttons}</div>' if len(present) > 1 else ""
    return (
        f'<div class="bar find">{group}<input type="search" id="words" placeholder="Find by name, reason, ..." '
        'aria-label="Find parts"><span class="note" id="count" role="status"></span></div>'
    )


def _table(rows: Sequence[Row], shared: Sequence[Column]) -> str:
    """All parts, one row each; the reason is a line of its own below the others."""
    heads = "".join(f'<th scope="col" class="{column.name}" data-sort>{column.head}</th>' for column in shared)
    return (
        f'<div class="parts"><table><thead><tr><th scope="col" class="picture">picture</th>{heads}'
        '<th scope="col" class="reason">reason</th></tr></thead>\n'
        f'<tbody id="parts">\n{"".join(_row(row, shared) for row in rows)}</tbody></table>'
        '<p id="none" hidden>No part is like that.</p></div>'
    )


def _row(row: Row, shared: Sequence[Column]) -> str:
    first, *others = shared
    cells = "".join(f'<td class="{column.name}">{column.cell(row)}</td>' for column in others)
    outcome = row.outcome
    reason = f"{shown(outcome.reason, longest=_LONGEST)}{_hint(outcome.hint)}" if outcome.reason else ""
    return (
        f'<tr class="{outcome.status}"><td class="picture">{picture(row)}</td>'
        f'<th scope="row" class="{first.name}">{first.cell(row)}</th>{cells}'
        f'<td class="reason">{reason}</td></tr>\n'
    )


def _hint(hint: str) -> str:
    return f"<small>{shown(hint, longest=_LONGEST)}</small>" if hint else ""


def _data(rows: Sequence[Row], shared: Sequence[Column], reason_of: Mapping[str, int]) -> str:
    """What the script sorts and chooses by: a list for every row, numbers only."""
    values = [
        [
            *(column.value(row) for column in shared),
            int(row.outcome.status is Status.PASSED),
            reason_of.get(row.part),
        ]
        for row in rows
    ]
    names = [*(column.name for column in shared), "passed", "reason"]
    return json.dumps({"columns": names, "rows": values}, separators=(",", ":"), allow_nan=False)
