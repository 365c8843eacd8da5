"""A picture of what was read from a drawing: one SVG without scripts, arcs as arcs, with a legend and a scale bar.

What is drawn to scale is in grains, usually micrometres, from the lower left corner of the drawing, y up; everything
else is in the picture's pixels.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Final

import numpy as np

from deltacam.geometry import curve as curve_measures
from deltacam.inspection import style
from deltacam.inspection.labels import Paper
from deltacam.inspection.measures import Measured, kind_in_words, measure
from deltacam.inspection.path_data import Grid, path_data
from deltacam.inspection.style import LineStyle
from deltacam.model import Array, Drawing, Finding, Outcome
from deltacam.plain import plain
from deltacam.units import to_mm

_WIDTH: Final = 900.0
_MARGIN: Final = 34.0
_TOP: Final = 64.0
_TALLEST: Final = 620.0  # of the drawing
_ROW: Final = 24.0  # of the legend
_LETTER: Final = 7.2  # width of a letter in the legend

GRAIN: Final = 1e-6
"""What ends are rounded to, m, unless there are very many."""

MOST_SEGMENTS: Final = 200_000
"""With more segments, what is smaller than a fraction of a pixel is left out."""

MOST_TITLES: Final = 400
"""With more contours, those of a kind are one path, without numbers and titles."""

MOST_MARKS: Final = 500
"""Places of one kind that are marked."""

_MARK_BOX: Final = 8.0 * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])


def to_svg(drawing: Drawing) -> str:
    """One picture of all contours of a drawing, with the places of its findings.

    Args:
        drawing: any; where it holds nothing, the picture says so.

    Returns:
        an SVG document for a file of its own or inside a page; the same drawing gives the same text. ``desc`` says how
        exact it is.
    """
    measured = measure(drawing)
    view = _View.around(drawing, measured)
    styles = [style.line_style(contour) for contour in measured.contours]
    parts = [_curves(drawing, measured, styles, view), _marks(drawing.findings, view)]
    if len(measured.contours) <= MOST_TITLES:
        parts.append(_numbers(drawing, measured, styles, view))
    footer, height = _footer(drawing, measured, styles, view)
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="di" viewBox="0 0 {_WIDTH:.0f} {height:.0f}" role="img">'
        f"<title>{_shown(drawing.file)}</title><desc>{view.accuracy}</desc>"
        f'<style>{style.sheet()}</style><rect width="100%" height="100%" rx="10" fill="var(--paper)"/>'
        f"{_header(drawing, measured, view)}{''.join(parts)}{footer}</svg>\n"
    )


@dataclass(frozen=True, slots=True)
class _View:
    """Where the drawing lies in the picture.

    Attributes:
        low: smallest x and y of the drawing, m.
        per_metre: pixels.
        corner: where ``low`` lies, pixels.
        bottom: below the drawing, pixels.
        grid: of the path data.
        accuracy: how exact the paths are, in words.
    """

    low: tuple[float, float]
    per_metre: float
    corner: tuple[float, float]
    bottom: float
    grid: Grid
    accuracy: str

    @classmethod
    def around(cls, drawing: Drawing, measured: Measured) -> _View:
        left, lower, right, upper = drawing.extents or (0.0, 0.0, 0.0, 0.0)
        width, depth = max(right - left, 1e-6), max(upper - lower, 1e-6)
        scale = min((_WIDTH - 2 * _MARGIN) / width, _TALLEST / depth)
        height = max(depth * scale, 120.0)
        x, y = 0.5 * (_WIDTH - (right - left) * scale), _TOP + 0.5 * (height + (upper - lower) * scale)
        grid, accuracy = Grid((left, lower), GRAIN), f"ends rounded to {GRAIN * 1e6:g} µm, arcs exact"
        if int(measured.segments.sum()) > MOST_SEGMENTS:
            grain = max(GRAIN, 0.25 / scale)
            grid = Grid((left, lower), grain, fine=False)
            accuracy = f"very many segments: what is smaller than {to_mm(grain):.2g} mm is left out"
        return cls((left, lower), scale, (x, y), _TOP + height + _MARGIN, grid, accuracy)

    def pixels(self, points: Array) -> Array:
        """Where points of the drawing (K, 2) m lie, pixels."""
        return np.asarray(self.corner + (points - self.low) * (self.per_metre, -self.per_metre))


def _curves(drawing: Drawing, measured: Measured, styles: Sequence[LineStyle], view: _View) -> str:
    """The contours: the material first, its holes on it, then the rest, and bands where something is drawn twice."""
    k = view.per_metre * view.grid.grain
    (x, y), of = view.corner, measured.contours
    order = sorted(range(len(of)), key=lambda i: (style.LINES.index(styles[i]) > 1, of[i].depth, i))
    repeated = _repeated(drawing)
    again = [i for i in order if of[i].number in repeated]
    data = path_data(measured.curves, view.grid) if view.grid.fine else []
    if view.grid.fine and len(of) <= MOST_TITLES:
        titles = _titles(measured)
        lines = [f'<path class="{styles[i].name}" d="{data[i]}"><title>{titles[i]}</title></path>' for i in order]
    else:
        groups: dict[tuple[str, int], list[int]] = {}
        for i in order:
            depth = of[i].depth if style.LINES.index(styles[i]) < 2 else 0
            groups.setdefault((styles[i].name, depth), []).append(i)
        lines = [_together(name, group, data, measured, view) for (name, _), group in groups.items()]
    lines += [_together(style.REPEATED.name, again, data, measured, view)] if again else []
    place = f'transform="translate({x:.3f} {y:.3f}) scale({k:.9g} {-k:.9g})"'
    return f'<g class="curves" {place}>{"".join(lines)}</g>'


def _together(name: str, which: Sequence[int], data: Sequence[str], measured: Measured, view: _View) -> str:
    """Some contours as one path."""
    if view.grid.fine:
        joined = "".join(data[i] for i in which)
    else:
        joined = "".join(path_data(measured.curves.take(np.array(which, dtype=np.int64)), view.grid))
    return f'<path class="{name}" d="{joined}"/>'


def _repeated(drawing: Drawing) -> set[int]:
    """The numbers of the contours that something was merged into."""
    merged = (entry.contour for entry in drawing.ledger if entry.outcome is Outcome.MERGED)
    return {number for number in merged if number is not None}


def _titles(measured: Measured) -> list[str]:
    """What is shown where the mouse rests on a contour."""
    return [
        _shown(
            f"contour {contour.number}: {kind_in_words(contour)}, layer {plain(contour.layer)}, "
            f"{contour.operation.value}, {to_mm(width):.2f} x {to_mm(height):.2f} mm"
        )
        for contour, (width, height) in zip(measured.contours, measured.sizes.tolist(), strict=True)
    ]


def _marks(findings: Iterable[Finding], view: _View) -> str:
    """A mark at the place of each finding that has one."""
    placed = [finding for finding in findings if finding.place is not None]
    if not placed:
        return ""
    where = view.pixels(np.array([finding.place for finding in placed])).tolist()
    shown: Counter[str] = Counter()
    parts = []
    for finding, (x, y) in zip(placed, where, strict=True):
        mark = style.mark_style(finding.kind)
        shown[mark.name] += 1
        if shown[mark.name] <= MOST_MARKS:
            parts.append(
                f'<path class="{mark.name}" transform="translate({x:.2f} {y:.2f})" d="{mark.shape}">'
                f"<title>{_shown(finding.what)}</title></path>"
            )
    return f'<g class="marks">{"".join(parts)}</g>'


def _numbers(drawing: Drawing, measured: Measured, styles: Sequence[LineStyle], view: _View) -> str:
    """The numbers of the contours, the largest contours first, where there is room for them."""
    paper, lines = Paper(_WIDTH, view.bottom, top=_TOP - 10.0), []
    for contour in measured.contours:
        points, _ = curve_measures.flatten(contour.curve, 0.5 / view.per_metre)
        lines.append(view.pixels(np.vstack([points, points[:1]]) if contour.curve.closed else points))
        paper.draw(lines[-1])
    places = [finding.place for finding in drawing.findings if finding.place is not None]
    for place in view.pixels(np.array(places).reshape(-1, 2)):
        paper.draw(place + _MARK_BOX)
    parts, parents = [], {contour.parent for contour in measured.contours}
    for i in np.argsort(-measured.sizes.max(axis=1, initial=0.0), kind="stable").tolist():
        number = str(measured.contours[i].number)
        bare = measured.contours[i].curve.closed and measured.contours[i].number not in parents
        middle = paper.place(lines[i], 6.6 * len(number), 11.0, inside=bare)
        if middle:
            x, y = middle
            parts.append(f'<text class="number on-{styles[i].name}" x="{x:.1f}" y="{y + 4:.1f}">{number}</text>')
    return f'<g class="numbers">{"".join(parts)}</g>'


def _header(drawing: Drawing, measured: Measured, view: _View) -> str:
    """The file, its unit and its size, and what the picture leaves out."""
    unit = f"unit {drawing.unit_in_words}" if drawing.unit else "no unit stated: sizes as if it were mm"
    size = "nothing is drawn"
    if drawing.extents:
        left, lower, right, upper = drawing.extents
        size = f"{to_mm(right - left):.2f} \u00d7 {to_mm(upper - lower):.2f} mm"
    many = len(measured.contours) > MOST_TITLES
    less = "" if view.grid.fine else f"; {view.accuracy}"
    less += f"; no numbers with more than {MOST_TITLES} contours" if many else ""
    return (
        f'<text class="name" x="{_MARGIN}" y="28">{_shown(drawing.file, longest=90)}</text>'
        f'<text x="{_MARGIN}" y="48">{_shown(unit)}, {size}{less}</text>'
    )


def _footer(drawing: Drawing, measured: Measured, styles: Sequence[LineStyle], view: _View) -> tuple[str, float]:
    """The scale bar and the legend, and how high the picture is with them."""
    top, left = view.bottom, _MARGIN
    parts = []
    if measured.contours:
        power = 10.0 ** math.floor(math.log10(150.0 / view.per_metre))
        bar = max(power * factor for factor in (1.0, 2.0, 5.0) if power * factor * view.per_metre <= 150.0)
        ends = f"M{left} {top}v8h{bar * view.per_metre:.2f}v-8"
        parts.append(f'<path d="{ends}" style="stroke:var(--soft)"/>')
        parts.append(f'<text x="{left}" y="{top + 28}">{to_mm(bar):g} mm</text>')
    x, y = left + 190.0, top + 6.0
    for key, label in _legend(drawing, styles):
        width = 46.0 + _LETTER * len(label)
        if x + width > _WIDTH - _MARGIN:
            x, y = left + 190.0, y + _ROW
        parts.append(f'<g transform="translate({x:.0f} {y:.0f})">{key}<text x="34" y="4">{label}</text></g>')
        x += width
    return f'<g class="legend">{"".join(parts)}</g>', y + 40.0


def _legend(drawing: Drawing, styles: Sequence[LineStyle]) -> list[tuple[str, str]]:
    """The key and the label of each kind of line and mark that the picture holds."""
    lines = Counter(each.name for each in styles)
    lines[style.REPEATED.name] = len(_repeated(drawing))
    marks = Counter(style.mark_style(finding.kind).name for finding in drawing.findings if finding.place is not None)
    found = [
        (f'<path class="{each.name}" d="M0 0h28"/>', f"{each.label} {lines[each.name]}")
        for each in (*style.LINES, style.REPEATED)
        if lines[each.name]
    ]
    for mark in style.MARKS:
        if marks[mark.name]:
            few = f" ({MOST_MARKS} shown)" if marks[mark.name] > MOST_MARKS else ""
            key = f'<path class="{mark.name}" transform="translate(14 0)" d="{mark.shape}"/>'
            found.append((key, f"{mark.label} {marks[mark.name]}{few}"))
    return found


def _shown(text: str, *, longest: int = 200) -> str:
    """Text from a file for XML: on one line, invisible characters spelled out, quotes and all escaped."""
    return escape(plain(text, longest=longest), quote=True)
