"""The report as one page that opens offline: no script, nothing fetched, everything from files escaped."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from deltacam.model import Array, Check, Drawing, LedgerEntry, Mode, Operation, Report
from deltacam.program.program import Program
from deltacam.report import held_back
from deltacam.report.picture import draw, shown, tool_speeds
from deltacam.report.tables import table
from deltacam.units import to_mm
from deltacam.verification.evidence import Evidence, gather

_POLICY: Final = "default-src 'none'; style-src 'unsafe-inline'; img-src data:; base-uri 'none'; form-action 'none'"
_COLUMNS: Final = 1000  # of a chart: more setpoints are shown by their smallest and largest values
_DONE: Final = {Operation.CUT: "cut", Operation.ENGRAVE: "engraved"}
_HANDLES: Final = 3  # of a contour that are named
_LEFT, _RIGHT = 62.0, 880.0  # of a chart, pixels
_CROWDED: Final = 18.0  # pixels from one line of a chart to the next, so that both are labelled
_STYLE: Final = """
:root{--page:#f6f8fa;--card:#fff;--text:#1f2328;--quiet:#59636e;--rule:#d1d9e0;--good:#1a7f37;--bad:#cf222e;--mark:#0969da}
@media screen and (prefers-color-scheme:dark){
:root{--page:#0d1117;--card:#151b23;--text:#f0f6fc;--quiet:#9198a1;--rule:#3d444d;--good:#3fb950;--bad:#f85149;--mark:#4493f8}}
*{box-sizing:border-box}
body{margin:0 auto;padding:2rem 1rem 4rem;max-width:62rem;background:var(--page);color:var(--text);
font:1rem/1.5 system-ui,"Segoe UI",Roboto,"Liberation Sans",sans-serif;font-variant-numeric:tabular-nums}
h1{margin:0;font-size:1rem;font-weight:600;color:var(--quiet);overflow-wrap:anywhere}
h2{margin:2.5rem 0 .75rem;font-size:1.25rem}
p{margin:.25rem 0}
.verdict{margin:0;font-size:clamp(2.75rem,9vw,4.25rem);font-weight:700;line-height:1.15;letter-spacing:-.02em}
.passed .verdict,.ok{color:var(--good)}.failed .verdict,.bad{color:var(--bad)}
.ok,.bad{font-weight:600;white-space:nowrap}
dl{display:flex;flex-wrap:wrap;gap:1px;margin:1.75rem 0;padding:0;
background:var(--rule);border:1px solid var(--rule);border-radius:10px;overflow:hidden}
dl div{flex:1 1 auto;min-width:9.5rem;padding:.75rem 1rem;background:var(--card)}
dt{font-size:.8125rem;color:var(--quiet)}
dd{margin:0;font-size:1.25rem;font-weight:600;overflow-wrap:anywhere}
figure,.table{margin:1rem 0;background:var(--card);border:1px solid var(--rule);border-radius:10px;overflow:auto}
svg{display:block;width:100%;height:auto}
.chart text{font:13px system-ui,"Segoe UI",Roboto,"Liberation Sans",sans-serif;fill:var(--quiet)}
.chart .grid{stroke:var(--rule);fill:none}.chart .limit{stroke:var(--bad);stroke-dasharray:6 4;fill:none}
.chart .values{stroke:var(--mark);fill:var(--mark);stroke-width:1.1;stroke-linejoin:round}.chart .line{fill:none}
table{border-collapse:collapse;width:100%;font-size:.875rem}
th,td{padding:.45rem .85rem;text-align:left;vertical-align:top;border-top:1px solid var(--rule)}
thead th{border-top:0;font-weight:600;color:var(--quiet);white-space:nowrap}
tbody th{font-weight:600;min-width:7.5rem}
td:last-child:not(.n){min-width:11rem;overflow-wrap:anywhere}
.n{text-align:right;white-space:nowrap}
summary{cursor:pointer;color:var(--mark)}
:focus-visible{outline:2px solid var(--mark);outline-offset:2px}
@media (max-width:640px){dl div{flex-basis:45%;min-width:8rem}.chart text{font-size:21px}th,td{padding:.4rem .6rem}}
@media print{:root{--page:#fff}body{padding:0;max-width:none;font-size:.85rem}figure,tr,dl{break-inside:avoid}
h2{break-after:avoid}.dc{max-height:14.5cm}.table{overflow:visible}details::details-content{content-visibility:visible;block-size:auto}}
"""


def to_html(report: Report, program: Program, *, drawing: Drawing | None, title: str) -> str:
    """The report as one HTML page: the verdict, the figures that matter, the picture, charts and tables.

    Args:
        report: of ``program``.
        program: any, also one whose setpoints are out of reach.
        drawing: what it was compared with, if anything.
        title: of the page, a plain text.

    Returns:
        HTML without scripts or references to anything outside; the same input gives the same text.
    """
    evidence = gather(program, program.robot)
    verdict = "Not checked" if not report.checks else "Passed" if report.passed else "Failed"
    sections = (
        _tiles(report.summary, program),
        f"<figure>{draw(evidence, drawing)}</figure>",
        _section("Motion", _charts(evidence)),
        _section("Checks", _checks(report.checks, evidence.rate)),
        _section("Findings", _findings(report)),
        _section("What limits the speed", table(held_back.HEADS, held_back.rows(report.held)) if report.held else ""),
        _section("Contours", _contours(evidence, drawing)),
        _section("Entities of the drawing", _ledger(report.ledger)),
        _section("All figures", table(("figure", "value"), _figures(report.summary))),
    )
    return (
        f'<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f'<meta http-equiv="Content-Security-Policy" content="{_POLICY}">\n'
        f'<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        f'<meta name="color-scheme" content="light dark">\n'
        f"<title>{shown(title)}: {verdict.lower()}</title>\n<style>{_STYLE}</style>\n</head>\n<body>\n"
        f'<header class="{"passed" if verdict == "Passed" else "failed"}"><h1>{shown(title)}</h1>'
        f'<p class="verdict">{verdict}</p><p>{_reason(report.checks)}</p></header>\n'
        f"<main>\n{''.join(sections)}</main>\n</body>\n</html>\n"
    )


def _section(heading: str, content: str) -> str:
    return f"<section><h2>{heading}</h2>{content}</section>\n" if content else ""


def _reason(checks: Sequence[Check]) -> str:
    """What the verdict rests on, in a sentence."""
    failed = [check.name for check in checks if not check.passed]
    if failed:
        return f"{len(failed)} of {len(checks)} checks failed: {shown(', '.join(failed))}."
    return f"{len(checks)} checks, each within its limit."


def _tiles(summary: Mapping[str, Any], program: Program) -> str:
    """The figures that matter; those that the summary does not have are left out."""
    minutes, seconds = divmod(program.duration, 60.0)
    shares = {f"{name}, of limit": f"{100 * share:.0f} %" for name, share in summary.get("share_of_limit", {}).items()}
    engraved = summary.get("contours_engraved", 0)
    size = " \u00d7 ".join(f"{side:.2f}" for side in summary.get("part_size_mm", ()))
    tiles = {
        "time": (f"{minutes:.0f} min " if minutes else "") + f"{seconds:.2f} s",
        "cut length": f"{summary['cut_length_mm']:.1f} mm" if "cut_length_mm" in summary else "",
        "contours cut": str(summary.get("contours_cut", "")),
        "engraved length": f"{summary.get('engraved_length_mm', 0.0):.1f} mm" if engraved else "",
        "contours engraved": str(engraved) if engraved else "",
        "part": f"{size} mm" if size else "",
        "unit of the drawing": str(summary.get("unit", "")),
        **shares,
        "feed": f"{_number(to_mm(program.process.feed))} mm/s",
        "process": program.process.name,
        "robot": program.robot.name,
        "mode": "" if program.mode is Mode.CUT else program.mode.value.replace("_", " "),
    }
    cells = (f"<div><dt>{shown(name)}</dt><dd>{shown(value)}</dd></div>" for name, value in tiles.items() if value)
    return f"<dl>{''.join(cells)}</dl>\n"


def _checks(checks: Sequence[Check], rate: float) -> str:
    """The failed checks first, otherwise in their order."""
    rows = []
    for check in sorted(checks, key=lambda check: check.passed):
        verdict = '<span class="ok">\u2713 passed</span>' if check.passed else '<span class="bad">\u2717 failed</span>'
        time = "" if check.tick is None else f"{check.tick / rate:.4f}"
        limit = "no limit" if check.limit is None and check.worst is not None else _number(check.limit)
        numbers = (_number(check.worst), limit, shown(check.unit), time)
        rows.append((shown(check.name), verdict, *numbers, shown(check.where)))
    heads = ("check", "verdict", "worst", "limit", "unit", "time, s", "where")
    return table(heads, rows, numbers=(2, 3, 5), fold=False)


def _findings(report: Report) -> str:
    rows = [(shown(finding.what), shown(finding.where), shown(finding.hint)) for finding in report.findings]
    return table(("finding", "where", "hint"), rows, fold=False) if rows else ""


def _contours(evidence: Evidence, drawing: Drawing | None) -> str:
    """Every contour that is drawn, cut or engraved; several runs of one are added up."""
    names = {block.contour or 0: (block.layer, block.handles) for block in evidence.program.blocks}
    names |= {contour.number: (contour.layer, contour.handles) for contour in (drawing.contours if drawing else ())}
    spans, operations = defaultdict(list), {}
    for run in evidence.runs:
        spans[run.contour or 0].append(np.arange(run.first, run.end))
        operations[run.contour or 0] = run.operation
    speed, rows = tool_speeds(evidence), []
    for number in sorted((names.keys() - {0}) | spans.keys()):
        layer, handles = names[number]
        done = _DONE[operations[number]] if number in operations else "not done"
        cells = [str(number or "?"), shown(layer, longest=60), _handles(handles), done]
        ticks = np.concatenate(spans[number]) if number in spans else np.zeros(0, dtype=np.int64)
        if len(ticks) and len(speed):
            length, time = float(speed[ticks].sum()) / evidence.rate, len(ticks) / evidence.rate
            cells += [f"{length:.2f}", f"{time:.3f}", f"{length / time:.1f}", f"{speed[ticks].max():.1f}"]
        else:
            cells += ["unknown" if len(ticks) else "", "", "", ""]
        rows.append(cells)
    heads = ("contour", "layer", "handles", "done", "length, mm", "time, s", "mean, mm/s", "largest, mm/s")
    return table(heads, rows, numbers=(4, 5, 6, 7)) if rows else ""


def _handles(handles: Sequence[str]) -> str:
    """The first handles, and how many more there are."""
    more = f" and {len(handles) - _HANDLES} more" if len(handles) > _HANDLES else ""
    return ", ".join(f"#{shown(handle, longest=20)}" for handle in handles[:_HANDLES]) + more


def _ledger(ledger: Sequence[LedgerEntry]) -> str:
    rows = []
    for entry in ledger:
        texts = (f"#{entry.handle}", entry.kind, entry.layer, entry.block, entry.outcome.value)
        contour = "" if entry.contour is None else str(entry.contour)
        rows.append([*map(shown, texts), contour, shown(entry.reason)])
    heads = ("handle", "entity", "layer", "block", "outcome", "contour", "reason")
    return table(heads, rows, numbers=(5,)) if rows else ""


def _figures(summary: Mapping[str, Any], prefix: str = "") -> list[tuple[str, str]]:
    """Every figure of the summary with its name, those of its parts too."""
    rows: list[tuple[str, str]] = []
    for name, value in summary.items():
        if isinstance(value, Mapping):
            rows += _figures(value, f"{prefix}{name}: ")
        else:
            values = value if isinstance(value, (list, tuple)) else [value]
            text = ", ".join(
                _number(item) if isinstance(item, float) else str("" if item is None else item) for item in values
            )
            rows.append((shown(f"{prefix}{name}"), shown(text)))
    return rows


def _charts(evidence: Evidence) -> str:
    """Joint speed, joint acceleration and tool speed over time, each with its limits."""
    q, joints, rate, seconds = evidence.program.q, evidence.robot.joints, evidence.rate, evidence.program.duration
    charts = []
    for name, order, limits in (
        ("Joint speed", 1, joints.max_speed),
        ("Joint acceleration", 2, joints.max_acceleration),
    ):
        shares = [100.0 * np.diff(q[:, i], n=order) * rate**order / limits[i] for i in range(3)]
        strips = [(f"joint {i + 1}", share, (100.0, 0.0, -100.0)) for i, share in enumerate(shares)]
        charts.append(_chart(name, "% of limit", strips, seconds))
    if len(evidence.tool):
        limit, feed = to_mm(evidence.robot.tool.max_speed), to_mm(evidence.program.process.feed)
        tool = (f"feed {_number(feed)}", tool_speeds(evidence), (limit, 0.0, feed))
        charts.append(_chart("Tool speed", "mm/s", [tool], seconds))
    return "".join(charts)


def _chart(name: str, unit: str, strips: Sequence[tuple[str, Array, Sequence[float]]], seconds: float) -> str:
    """Strips above each other: a name, values at even times, and the lines to draw, the first of them a limit."""
    room = max(92.0, 160.0 / len(strips))
    parts, height = [], 34.0 + room * len(strips) + 34.0
    worst = max((float(np.abs(values).max(initial=0.0)) for _, values, _ in strips), default=0.0)
    for row, (label, values, lines) in enumerate(strips):
        parts.append(_strip(label, values, lines, unit, (34.0 + room * row, room)))
    step = _round_up(seconds / 8.0) if seconds > 0.0 else 1.0
    for tick in range(int(seconds / step + 1e-9) + 1):
        x = _LEFT + (_RIGHT - _LEFT) * (tick * step / seconds if seconds > 0.0 else 0.0)
        parts.append(f'<text x="{x:.1f}" y="{height - 12}" text-anchor="middle">{tick * step:g}</text>')
    return (
        f'<figure><svg class="chart" viewBox="0 0 900 {height:.0f}" role="img">'
        f"<title>{name}, {unit}, over time in s</title>"
        f"<desc>Largest {_number(worst)} {unit}.</desc>"
        f'<text x="12" y="22" font-weight="600">{name}, {unit}, over time, s</text>{"".join(parts)}</svg></figure>\n'
    )


def _strip(label: str, values: Array, lines: Sequence[float], unit: str, place: tuple[float, float]) -> str:
    """The envelope of the values with the lines; what is over twice the limit is cut off, its size is told."""
    top, room = place
    worst = float(np.abs(values).max(initial=0.0))
    high = 1.08 * max(*lines, min(worst, 2.0 * lines[0]))
    low = -high if min(lines) < 0.0 else 0.0
    base, scale = top + room - 8.0, (room - 30.0) / (high - low)
    parts = [f'<text x="{_RIGHT}" y="{top + 14}" text-anchor="end">{label}, largest {_number(worst)} {unit}</text>']
    for index, line in enumerate(lines):
        y, style = base - scale * (line - low), "limit" if abs(line) == lines[0] else "grid"
        parts.append(f'<path class="{style}" d="M{_LEFT} {y:.1f}H{_RIGHT}"/>')
        if all(scale * abs(other - line) > _CROWDED for other in lines[:index]):
            parts.append(f'<text x="{_LEFT - 6}" y="{y + 4:.1f}" text-anchor="end">{_number(line)}</text>')
    first = np.unique(np.linspace(0, len(values), _COLUMNS, endpoint=False).astype(np.int64))
    if len(values):
        x = _LEFT + (_RIGHT - _LEFT) * first / max(len(values) - 1, 1)
        shape = np.column_stack((x, np.maximum.reduceat(values, first)))
        if len(values) > len(first):
            shape = np.vstack([shape, np.column_stack((x, np.minimum.reduceat(values, first)))[::-1]])
        shape[:, 1] = base - scale * (np.clip(shape[:, 1], -high, high) - low)
        points = " ".join(f"{x:.1f},{y:.1f}" for x, y in shape.tolist())
        kind = ("polygon", "values") if len(values) > len(first) else ("polyline", "values line")
        parts.append(f'<{kind[0]} class="{kind[1]}" points="{points}"/>')
    return "".join(parts)


def _round_up(value: float) -> float:
    """The smallest of 1, 2 or 5 times a power of ten that is not smaller."""
    power = 10.0 ** np.floor(np.log10(value))
    return float(next(power * factor for factor in (1.0, 2.0, 5.0, 10.0) if power * factor >= value * (1.0 - 1e-9)))


def _number(value: float | None) -> str:
    """Four significant digits, without an exponent where people would not write one; nothing for None."""
    if value is None or value == 0.0:
        return "" if value is None else "0"
    digits = f"{value:.4g}" if abs(value) >= 1e-3 else f"{value:.1e}"
    return f"{value:.0f}" if "e+" in digits else digits
