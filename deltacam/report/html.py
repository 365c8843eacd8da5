"""The report as one page that opens offline: nothing is fetched, and everything from files is escaped."""

from __future__ import annotations

from collections.abc import Sequence

from deltacam.model import Check, Drawing, Report
from deltacam.program.program import Program
from deltacam.report import held_back, kerf, palette, sections
from deltacam.report.escaping import shown
from deltacam.report.page import frame
from deltacam.report.payload import payload, to_script
from deltacam.report.picture import draw
from deltacam.report.slots import slots
from deltacam.report.tables import table
from deltacam.report.view import View
from deltacam.robot.robot import Robot
from deltacam.verification.evidence import Evidence, gather


def to_html(
    report: Report,
    program: Program,
    *,
    drawing: Drawing | None,
    title: str,
    robot: Robot | None = None,
    library: str | None = None,
) -> str:
    """The report as one HTML page: the verdict, the figures that matter, pictures, charts and tables.

    Args:
        report: of ``program``.
        program: any, also one whose setpoints are out of reach.
        drawing: what it was compared with, if anything.
        title: of the page, a plain text.
        robot: the machine that it was checked against; None takes the one in the program.
        library: where a copy of `page.plotly_js` lies, relative to the page; None puts it into the page, 4.8 MB.

    Returns:
        HTML that refers to nothing outside, but for the ``library``; the same input gives the same text.
    """
    evidence = gather(program, robot or program.robot)
    verdict = "Not checked" if not report.checks else "Passed" if report.passed else "Failed"
    view = View.around(evidence, drawing)
    data, inks = payload(evidence, drawing, view)
    figures = f'<figure class="still">{draw(evidence, drawing, view)}</figure>\n{slots(data)}'
    return frame(
        title=f"{shown(title)}: {verdict.lower()}",
        style=palette.dark_rules(inks),
        body=f'<header class="{"passed" if verdict == "Passed" else "failed"}"><h1>{shown(title)}</h1>'
        f'<p class="verdict">{verdict}</p><p>{_reason(report.checks)}</p></header>\n'
        f"<main>\n{_body(report, evidence, drawing, figures)}</main>\n",
        data=to_script(data),
        library=library,
    )


def _body(report: Report, evidence: Evidence, drawing: Drawing | None, figures: str) -> str:
    held = table(held_back.HEADS, held_back.rows(report.held)) if report.held else ""
    leaves = kerf.rows(report.kerf, report.sizes)
    left = table(kerf.HEADS, leaves, numbers=range(3, 7)) if leaves else ""
    parts = (
        ("Checks", sections.checks(report.checks, evidence)),
        ("Findings", sections.findings(report)),
        ("What limits the speed", held),
        ("Contours", sections.contours(evidence, drawing)),
        ("Sizes", sections.sizes(report.sizes)),
        ("What the kerf leaves", left),
        ("Entities of the drawing", sections.ledger(report.ledger)),
        ("All figures", table(("figure", "value"), sections.figures(report.summary))),
    )
    tables = (f"<section><h2>{name}</h2>{content}</section>\n" for name, content in parts if content)
    return f"{sections.tiles(report.summary, evidence.program)}{figures}{''.join(tables)}"


def _reason(checks: Sequence[Check]) -> str:
    """What the verdict rests on, in a sentence."""
    failed, warned = ([c.name for c in checks if not c.passed and c.warns is warns] for warns in (False, True))
    if failed:
        return f"{len(failed)} of {len(checks)} checks failed: {shown(', '.join(failed))}."
    if warned:
        return f"{len(checks)} checks, {len(warned)} with a warning: {shown(', '.join(warned))}."
    return f"{len(checks)} checks, each within its limit."
