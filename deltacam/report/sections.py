"""The tables and figures of the page; everything from files is escaped."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Mapping, Sequence
from typing import Any, Final

import numpy as np

from deltacam.model import BlockKind, Check, Drawing, LedgerEntry, Mode, Operation, Report, Size
from deltacam.program.program import Program
from deltacam.report.escaping import shown
from deltacam.report.picture import tool_speeds
from deltacam.report.tables import table
from deltacam.units import to_mm, to_um
from deltacam.verification.checks.measure import DIFFERENCES
from deltacam.verification.evidence import Evidence

_DONE: Final = {Operation.CUT: "cut", Operation.ENGRAVE: "engraved"}
_PASSED: Final = '<span class="ok">\u2713 passed</span>'
_WARNED: Final = '<span class="warned">! warning</span>'
_FAILED: Final = '<span class="bad">\u2717 failed</span>'
_LENGTHS: Final = {"lead-in, mm": BlockKind.LEAD_IN, "overcut, mm": BlockKind.OVERCUT}
_COUNTS: Final = {"loops": BlockKind.LOOP, "tabs": BlockKind.TAB}
_HANDLES: Final = 3  # of a contour that are named


def tiles(summary: Mapping[str, Any], program: Program) -> str:
    """The figures that matter; those that the summary does not have are left out."""
    minutes, seconds = divmod(program.duration, 60.0)
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
        "most energy per mm": _energy(summary.get("line_energy", {})),
        "feed": f"{_number(to_mm(program.process.feed))} mm/s",
        "process": program.process.name,
        "robot": program.robot.name,
        "mode": "" if program.mode is Mode.CUT else program.mode.value.replace("_", " "),
    }
    cells = (f"<div><dt>{shown(name)}</dt><dd>{shown(value)}</dd></div>" for name, value in tiles.items() if value)
    return f"<dl>{''.join(cells)}</dl>\n{_shares(summary.get('share_of_limit', {}))}"


def _energy(found: Mapping[str, float]) -> str:
    """The most that a millimetre gets, in J where the power of the laser is known."""
    if "most" not in found:
        return ""
    joules = f"{_number(found['most'] * found['at_feed_j_mm'])} J, " if "at_feed_j_mm" in found else ""
    return f"{joules}{found['most']:.3g} \u00d7 usual"


def _shares(shares: Mapping[str, float]) -> str:
    """How much of each limit is used at most, as bars."""
    cells = []
    for name, share in shares.items():
        percent, over = 100.0 * share, ' class="over"' if share > DIFFERENCES else ""
        bar = f'<i><b{over} style="width:{min(max(percent, 0.0), 100.0):.0f}%"></b></i>'
        cells.append(f"<div><dt>{shown(name)}</dt><dd>{percent:.0f} % {bar}</dd></div>")
    return f'<dl class="shares" aria-label="Largest share of each limit">{"".join(cells)}</dl>\n' if cells else ""


def checks(found: Sequence[Check], evidence: Evidence) -> str:
    """The failed checks first, then the warnings, else in their order; a button goes to the place where it is known."""
    rows = []
    for check in sorted(found, key=lambda check: (check.passed, not check.passed and check.warns)):
        verdict = _PASSED if check.passed else _WARNED if check.warns else _FAILED
        time = "" if check.tick is None else f"{check.tick / evidence.rate:.4f}"
        limit = "no limit" if check.limit is None and check.worst is not None else _number(check.limit)
        numbers = (_number(check.worst), limit, shown(check.unit), time)
        rows.append((shown(check.name), verdict, *numbers, shown(check.where) + _button(check, evidence)))
    heads = ("check", "verdict", "worst", "limit", "unit", "time, s", "where")
    return table(heads, rows, numbers=(2, 3, 5), fold=False)


def _button(check: Check, evidence: Evidence) -> str:
    """Goes to the place of a check in the picture of the part."""
    place, known = check.place, len(evidence.sheet)
    if place is None and check.tick is not None and check.tick < known:
        place = (float(evidence.sheet[check.tick, 0]), float(evidence.sheet[check.tick, 1]))
    if place is None or not known:
        return ""
    tick = "" if check.tick is None else f' data-tick="{check.tick}"'
    x, y = (f"{to_mm(value):.4f}" for value in place)
    return f'<button type="button" class="go" data-x="{x}" data-y="{y}"{tick}>Show</button>'


def findings(report: Report) -> str:
    """What a person should know; nothing where there is nothing."""
    rows = [(shown(finding.what), shown(finding.where), shown(finding.hint)) for finding in report.findings]
    return table(("finding", "where", "hint"), rows, fold=False) if rows else ""


def contours(evidence: Evidence, drawing: Drawing | None) -> str:
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
    more = _beside(evidence, [int(row[0]) if row[0] != "?" else 0 for row in rows])
    rows = [[*row, *(column[at] for column in more.values())] for at, row in enumerate(rows)]
    return table((*heads, *more), rows, numbers=range(4, len(heads) + len(more))) if rows else ""


def _beside(evidence: Evidence, contours: Sequence[int]) -> dict[str, list[str]]:
    """What the ``contours`` have besides their cut: a column for each thing that there is."""
    speed, found = tool_speeds(evidence), {}
    for head, kind in _LENGTHS.items():
        mm: defaultdict[int, float] = defaultdict(float)
        for run in evidence.runs if len(speed) else ():
            for first, end in evidence.stretches(run, frozenset({kind})):
                mm[run.contour or 0] += float(speed[first:end].sum()) / evidence.rate
        found[head] = [f"{mm[contour]:.2f}" if contour in mm else "" for contour in contours]
    for head, kind in _COUNTS.items():
        counts: Counter[int] = Counter()
        for run in evidence.runs:
            counts[run.contour or 0] += len(evidence.stretches(run, frozenset({kind})))
        found[head] = [str(counts[contour] or "") for contour in contours]
    return {head: cells for head, cells in found.items() if any(cells)}


def sizes(found: Sequence[Size]) -> str:
    """What the swept kerf leaves of every closed contour that is cut."""
    rows = [
        [
            str(one.contour),
            f"{one.drawn * 1e6:.3f}",
            f"{one.area * 1e6:.3f}",
            _box(one.drawn_box),
            _box(one.box),
            f"{to_um(one.offset):.2f}",
            f"{to_um(one.edge):.2f}",
            ", ".join(f"{to_mm(value):.3f}" for value in one.place),
        ]
        for one in found
    ]
    heads = (
        "contour",
        "drawn, mm\u00b2",
        "left, mm\u00b2",
        "box drawn, mm",
        "box left, mm",
        "size off, \u00b5m",
        "edge off, \u00b5m",
        "at x, y, mm",
    )
    return table(heads, rows, numbers=range(1, 8)) if rows else ""


def _box(sides: tuple[float, float]) -> str:
    return " \u00d7 ".join(f"{to_mm(side):.3f}" for side in sides)


def _handles(handles: Sequence[str]) -> str:
    """The first handles, and how many more there are."""
    more = f" and {len(handles) - _HANDLES} more" if len(handles) > _HANDLES else ""
    return ", ".join(f"#{shown(handle, longest=20)}" for handle in handles[:_HANDLES]) + more


def ledger(entries: Sequence[LedgerEntry]) -> str:
    """What became of every entity of the drawing."""
    rows = []
    for entry in entries:
        texts = (f"#{entry.handle}", entry.kind, entry.layer, entry.block, entry.outcome.value)
        contour = "" if entry.contour is None else str(entry.contour)
        rows.append([*map(shown, texts), contour, shown(entry.reason)])
    heads = ("handle", "entity", "layer", "block", "outcome", "contour", "reason")
    return table(heads, rows, numbers=(5,)) if rows else ""


def figures(summary: Mapping[str, Any], prefix: str = "") -> list[tuple[str, str]]:
    """Every figure of the summary with its name, those of its parts too."""
    rows: list[tuple[str, str]] = []
    for name, value in summary.items():
        if isinstance(value, Mapping):
            rows += figures(value, f"{prefix}{name}: ")
        else:
            values = value if isinstance(value, (list, tuple)) else [value]
            text = ", ".join(
                _number(item) if isinstance(item, float) else str("" if item is None else item) for item in values
            )
            rows.append((shown(f"{prefix}{name}"), shown(text)))
    return rows


def _number(value: float | None) -> str:
    """Four significant digits, without an exponent where people would not write one; nothing for None."""
    if value is None or value == 0.0:
        return "" if value is None else "0"
    digits = f"{value:.4g}" if abs(value) >= 1e-3 else f"{value:.1e}"
    return f"{value:.0f}" if "e+" in digits else digits
