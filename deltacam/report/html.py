"""The report as one page that opens offline: nothing is fetched, and everything from files is escaped.

The script of the page is plotly.js and ours, both inside it; the policy of the page allows exactly these two.
"""

from __future__ import annotations

import base64
import hashlib
from collections.abc import Sequence
from functools import cache
from importlib import resources
from typing import Final

from deltacam.model import Check, Drawing, Report
from deltacam.program.program import Program
from deltacam.report import held_back, palette, sections
from deltacam.report.payload import payload, to_script
from deltacam.report.picture import draw, shown
from deltacam.report.pictures import pictures
from deltacam.report.tables import table
from deltacam.robot.robot import Robot
from deltacam.verification.evidence import Evidence, gather

_SCRIPTS: Final = ("series.js", "overlay.js", "pictures.js", "charts.js", "page.js")


def to_html(
    report: Report, program: Program, *, drawing: Drawing | None, title: str, robot: Robot | None = None
) -> str:
    """The report as one HTML page: the verdict, the figures that matter, pictures, charts and tables.

    Args:
        report: of ``program``.
        program: any, also one whose setpoints are out of reach.
        drawing: what it was compared with, if anything.
        title: of the page, a plain text.
        robot: the machine that it was checked against; None takes the one in the program.

    Returns:
        HTML without references to anything outside; the same input gives the same text.
    """
    evidence = gather(program, robot or program.robot)
    verdict = "Not checked" if not report.checks else "Passed" if report.passed else "Failed"
    data, inks = payload(evidence, drawing)
    scripts = (_library(), _script())
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_policy(scripts)}">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta name="color-scheme" content="light dark">\n'
        f"<title>{shown(title)}: {verdict.lower()}</title>\n"
        f"<style>{_resource('page.css')}{palette.dark_rules(inks)}</style>\n</head>\n<body>\n"
        f'<header class="{"passed" if verdict == "Passed" else "failed"}"><h1>{shown(title)}</h1>'
        f'<p class="verdict">{verdict}</p><p>{_reason(report.checks)}</p></header>\n'
        f"<main>\n{_body(report, evidence, drawing, pictures(data))}</main>\n"
        f'<script type="application/json" id="data">{to_script(data)}</script>\n'
        f"{''.join(f'<script>{script}</script>{chr(10)}' for script in scripts)}</body>\n</html>\n"
    )


def _body(report: Report, evidence: Evidence, drawing: Drawing | None, moving: str) -> str:
    held = table(held_back.HEADS, held_back.rows(report.held)) if report.held else ""
    parts = (
        ("Checks", sections.checks(report.checks, evidence)),
        ("Findings", sections.findings(report)),
        ("What limits the speed", held),
        ("Contours", sections.contours(evidence, drawing)),
        ("Entities of the drawing", sections.ledger(report.ledger)),
        ("All figures", table(("figure", "value"), sections.figures(report.summary))),
    )
    still = f'<figure class="still">{draw(evidence, drawing)}</figure>\n'
    tables = (f"<section><h2>{name}</h2>{content}</section>\n" for name, content in parts if content)
    return f"{sections.tiles(report.summary, evidence.program)}{still}{moving}{''.join(tables)}"


def _reason(checks: Sequence[Check]) -> str:
    """What the verdict rests on, in a sentence."""
    failed = [check.name for check in checks if not check.passed]
    if failed:
        return f"{len(failed)} of {len(checks)} checks failed: {shown(', '.join(failed))}."
    return f"{len(checks)} checks, each within its limit."


def _policy(scripts: Sequence[str]) -> str:
    """Nothing from outside, and no script but these."""
    hashes = (base64.b64encode(hashlib.sha256(script.encode()).digest()).decode() for script in scripts)
    allowed = " ".join(f"'sha256-{digest}'" for digest in hashes)
    return (
        f"default-src 'none'; script-src {allowed}; style-src 'unsafe-inline'; img-src data:; "
        f"base-uri 'none'; form-action 'none'"
    )


@cache
def _library() -> str:
    """plotly.js, as it comes with its Python package, which is not imported: that would take longer than the page."""
    return (resources.files("plotly") / "package_data" / "plotly.min.js").read_text("utf-8")


@cache
def _script() -> str:
    """Our script, in a scope of its own."""
    parts = "\n".join(map(_resource, _SCRIPTS))
    return f'"use strict";\n(() => {{\n{parts}}})();\n'


def _resource(name: str) -> str:
    return (resources.files("deltacam.report") / "page" / name).read_text("utf-8")
