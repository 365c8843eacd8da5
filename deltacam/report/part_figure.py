"""The picture of the part: what is drawn, and the path of the tool in stretches that the script colours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Drawing
from deltacam.report import palette
from deltacam.report.bands import (
    BESIDE,
    BURNT,
    DARK,
    ENGRAVED,
    RAPID,
    STROKES,
    SUBJECT,
    TWICE,
    Stroke,
    bands,
    names,
)
from deltacam.report.colouring import Colouring
from deltacam.report.figures import Json, dots, lines, map_layout, packed
from deltacam.report.marks import MANY, Marks, headings, marks_of
from deltacam.report.stretches import stretches
from deltacam.report.thin import thin_lines, thin_way
from deltacam.report.view import View
from deltacam.units import to_mm
from deltacam.verification.evidence import Evidence

EXACT: Final = 1e-6
"""How far the path of a program that is shown tick by tick may be drawn from its setpoints, m."""

_MOST_STRETCHES: Final = 12_000


def part_figure(evidence: Evidence, drawing: Drawing | None, view: View) -> Json:
    """The contours, the sheet's edge where it is near, where cuts begin, in which order, which way they run, and tabs.

    Returns:
        ``below`` and ``above``: the traces under and over the path; ``marks``: traces of which a mark is shown where a
        pixel is at most so many mm as ``scale`` says; ``strokes``: how every band of the path is drawn; ``legend``:
        what lines and marks there are; ``dots``: a colour; ``layout``.
    """
    below = []
    if len(view.sheet):
        below.append(lines([_closed(to_mm(1.0) * view.sheet)], palette.SHEET, width=1.0))
    below += _drawn(drawing, view)
    marks = marks_of(evidence, view.box)
    return {
        "below": below,
        "above": _above(evidence, marks),
        "marks": _marks(marks),
        "strokes": [_stroke(STROKES[band]) for band in sorted(STROKES)],
        "legend": _legend(evidence, marks),
        "dots": palette.STRONG.light,
        "layout": map_layout(to_mm(1.0) * view.box),
    }


def _above(evidence: Evidence, marks: Marks) -> list[Json]:
    """The ends of tabs as bars across the path, and the places at which the laser pierces as dots."""
    sheet, found, small = to_mm(1.0) * evidence.sheet, [], len(marks.starts) >= MANY
    if len(marks.tabs):
        bars = dots(sheet[marks.tabs], palette.TAB, size=9.0 if small else 12.0, symbol="line-ns")
        bars["marker"] |= {"angle": _degrees(-headings(evidence.sheet, marks.tabs))}
        found.append(bars | {"marker": bars["marker"] | {"line": {"color": palette.TAB.light, "width": 2.2}}})
    edge = {"line": {"color": palette.PAPER.light, "width": 1.0}}
    for ticks, size in ((marks.pierces, 3.5 if small else 5.0), (marks.starts, 5.5 if small else 7.0)):
        if len(ticks):
            trace = dots(sheet[ticks], palette.STRONG, size=size)
            found.append(trace | {"marker": trace["marker"] | edge})
    return found


def _marks(marks: Marks) -> list[Json]:
    """The heads of arrows, and the numbers."""
    found, arrows, numbers = [], marks.arrows, marks.numbers
    if len(arrows.points):
        heads = dots(to_mm(1.0) * arrows.points, palette.STRONG, size=13.0, symbol="arrow")
        # The head of an arrow points up, and its angle is clockwise.
        edge = {"angle": _degrees(0.5 * np.pi - arrows.heading), "line": {"color": palette.PAPER.light, "width": 0.8}}
        found.append({"trace": heads | {"marker": heads["marker"] | edge}, "scale": packed(to_mm(1.0) * arrows.scale)})
    if len(numbers.points):
        font = {"size": 12, "color": palette.STRONG.light, "weight": 600}
        text = {
            "mode": "markers+text",
            "text": list(numbers.text),
            "textposition": list(numbers.side),
            "textfont": font,
        }
        trace = dots(to_mm(1.0) * numbers.points, palette.STRONG, size=7.0) | text
        trace["marker"] |= {"opacity": 0.0}  # the dots are there already; these keep their distance
        found.append({"trace": trace, "scale": packed(to_mm(1.0) * numbers.scale)})
    return found


def _degrees(angles: Array) -> list[int]:
    return [round(angle) for angle in np.degrees(angles).tolist()]


def _stroke(stroke: Stroke) -> Json:
    dash = ",".join(f"{length:g}px" for length in stroke.dash if length)
    line: Json = {"width": stroke.width, "dash": dash or "solid"}
    return line if stroke.ink is None else line | {"color": stroke.ink.light}


def _legend(evidence: Evidence, marks: Marks) -> list[list[str]]:
    """The looks and the names of the lines and marks that there are."""
    found = [[_LOOKS[band], name] for band, name in names(evidence, bands(evidence)).items()]
    found += [["tab", "tab"]] if len(marks.tabs) else []
    found += [["dot", "pierce, in order"]] if len(marks.starts) else []
    found += [["arrow", "direction"]] if len(marks.arrows.points) else []
    return found


_LOOKS: Final = {
    SUBJECT: "line",
    BESIDE: "thin line",
    TWICE: "thick line",
    DARK: "dotted line",
    ENGRAVED: "fine line",
    RAPID: "dashed line",
}


def route(evidence: Evidence, colourings: Sequence[Colouring], view: View, *, exact: bool) -> Json:
    """The path of the tool without the points that it can spare, cut into stretches of one colour.

    Args:
        evidence: with the places of at least two ticks.
        colourings: the ways of colouring it.
        view: says how far the path may be off where it is not ``exact``.
        exact: whether every step may have colours of its own, and the path is within `EXACT`.

    Returns:
        ``x`` and ``y`` in mm; ``first``: the point at which every stretch starts; ``band`` of every stretch;
        ``colours``: for every way of colouring the colour of every stretch; ``within``: mm.
    """
    within = EXACT if exact else view.error
    band = bands(evidence)
    reach = 0.0 if exact else 3.0 * within
    choices = [colouring.choice for colouring in colourings]
    first, colours = stretches(evidence.sheet, band, choices, reach=reach, most=_MOST_STRETCHES)
    fixed = np.zeros(len(evidence.sheet), dtype=bool)
    fixed[first] = fixed[-1] = True
    kept = np.flatnonzero(thin_way(evidence.sheet, fixed, within))
    points = to_mm(1.0) * evidence.sheet[kept]
    return {
        "x": packed(points[:, 0]),
        "y": packed(points[:, 1]),
        "first": packed(np.searchsorted(kept, first), "u4"),
        "band": packed(band[first], "u1"),
        "colours": [packed(np.where(np.isin(band[first], BURNT), colour, 0), "u1") for colour in colours],
        "within": to_mm(within),
    }


def _drawn(drawing: Drawing | None, view: View) -> list[Json]:
    """The material filled, holes left out, and the lines that enclose none."""
    edges: list[Array] = []
    others: list[Array] = []
    for contour in drawing.contours if drawing else ():
        points = curves.flatten(contour.curve, view.error / 8.0)[0]
        line = _closed(points) if contour.curve.closed else points
        # Fills count turns: what runs clockwise takes away from what it lies in.
        (edges if contour.has_kerf else others).append(line[::-1] if contour.is_hole else line)
    found = []
    if edges:
        thinned = [to_mm(1.0) * line for line in thin_lines(edges, view.error / 8.0)]
        found.append(lines(thinned, palette.LINE, width=0.8, fill=palette.PART))
    if others:
        thinned = [to_mm(1.0) * line for line in thin_lines(others, view.error / 8.0)]
        found.append(lines(thinned, palette.LINE, width=0.8))
    return found


def _closed(points: Array) -> Array:
    return np.concatenate([points, points[:1]])
