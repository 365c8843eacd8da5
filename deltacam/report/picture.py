"""A picture of what a program does to the sheet: one SVG without scripts, the cuts coloured by the tool's speed.

What is drawn to scale is in whole micrometres of the sheet frame, y up; everything else is in the picture's pixels.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Array, BlockKind, Drawing, IntArray, Operation
from deltacam.plain import plain
from deltacam.program.program import Program
from deltacam.report.palette import speeds
from deltacam.report.stretches import most_unusual, stretches
from deltacam.report.thin import thin_lines
from deltacam.robot.workspace import Workspace
from deltacam.units import to_mm, to_um
from deltacam.verification.evidence import LASER_KINDS, Evidence, gather, to_sheet

_WIDTH: Final = 900.0
_MARGIN: Final = 36.0
_TALLEST: Final = 620.0  # of the part
_FOOTER: Final = 92.0
_ERROR: Final = 1 / 6000  # of the part: how far a drawn path may leave the setpoints
_MAX_RUNS: Final = 12_000  # stretches of one colour
_MAX_NUMBERS: Final = 60  # cuts that are numbered
_SHEET_SHOWN: Final = 1.4  # how many times smaller the sheet may make the part
RAPID, ENGRAVED, SUBJECT = range(3)
"""What a step is in the picture: the subject is what is coloured."""
_STYLE: Final = """
.dc{--paper:#fff;--ink:#1f2328;--soft:#59636e;--line:#818b98;--part:#eaeef2;--edge:#d1d9e0;--mark:#bf3989;LIGHT}
@media screen and (prefers-color-scheme:dark){
.dc{--paper:#151b23;--ink:#f0f6fc;--soft:#9198a1;--line:#767f89;--part:#242d38;--edge:#3d444d;--mark:#f778ba;DARK}}
.dc text{font:13px system-ui,"Segoe UI",Roboto,"Liberation Sans",sans-serif;fill:var(--soft)}
.dc .number{font-size:12px;font-weight:600;fill:var(--ink);stroke:var(--paper);stroke-width:3px;paint-order:stroke}
@media (max-width:640px){.dc text{font-size:21px}.dc .number{font-size:18px}}
"""


def to_svg(program: Program, *, drawing: Drawing | None) -> str:
    """One picture of the part, the cuts coloured by tool speed, what is engraved, the rapids, and where cuts begin.

    Args:
        program: any; where its setpoints are out of the robot's reach, only the drawing is shown.
        drawing: its contours are drawn where it is given.

    Returns:
        an SVG document for a file of its own or inside a page; the same program gives the same text. ``desc`` says
        within how much the path is drawn.
    """
    evidence = gather(program, program.robot)
    return draw(evidence, drawing, View.around(evidence, drawing))


def draw(evidence: Evidence, drawing: Drawing | None, view: View) -> str:
    """As `to_svg`, of evidence that was gathered already."""
    step, colours, parts = 1.0, 1, [_drawn(drawing, view)]
    if len(evidence.sheet) > 1:
        band = bands(evidence)
        speed = tool_speeds(evidence)
        cut = speed[band == SUBJECT]
        step, colours = speed_colours(cut) if len(cut) else (1.0, 0)
        parts += [_paths(evidence.sheet, band, colours_of(speed, step, colours), view), _starts(evidence, view)]
    about = evidence.impossible[1] or f"path within {to_um(view.error) + 1.0:.0f} µm of the setpoints"
    height = view.height + _FOOTER
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="dc" viewBox="0 0 {_WIDTH:.0f} {height:.0f}" role="img">'
        f"<title>{shown(evidence.program.drawing.file)}</title>"
        f"<desc>{view.caption}; tool path coloured by speed; {shown(about)}</desc>"
        f'<style>{_style(colours)}</style><rect width="100%" height="100%" rx="10" fill="var(--paper)"/>'
        f"{''.join(parts)}{_footer(view, step, colours, engraved=_engraves(evidence))}</svg>\n"
    )


def shown(text: str, *, longest: int = 200) -> str:
    """Text from a file for HTML and XML: on one line, invisible characters spelled out, quotes and all escaped."""
    return escape(plain(text, longest=longest), quote=True)


def tool_speeds(evidence: Evidence) -> Array:
    """The tool's speed from every setpoint to the next, (N - 1,) mm/s."""
    return to_mm(1.0) * evidence.speed


def bands(evidence: Evidence) -> IntArray:
    """What each step is, (N - 1,): a rapid, engraved, or the subject: the cuts.

    Where nothing is cut and nothing engraved, as in a frame, the subject is the whole way.
    """
    steps = max(len(evidence.tool) - 1, 0)
    on = (evidence.is_kind(LASER_KINDS) | (evidence.program.power > 0.0))[:steps]
    engraved = evidence.is_kind(frozenset({BlockKind.ENGRAVE}))[:steps]
    return np.where(engraved, ENGRAVED, np.where(on | (not on.any()), SUBJECT, RAPID))


def _engraves(evidence: Evidence) -> bool:
    return any(run.operation is Operation.ENGRAVE for run in evidence.runs)


def speed_colours(speed: Array) -> tuple[float, int]:
    """The speed, mm/s, from one colour to the next, a round number, and the number of colours, at most 15."""
    top = max(float(speed.max(initial=0.0)), 1.0)
    power = 10.0 ** math.floor(math.log10(top / 14.0))
    step = next(power * factor for factor in (1.0, 2.0, 2.5, 5.0, 10.0) if power * factor * 14.0 >= top * (1.0 - 1e-9))
    return step, int(colours_of(np.array([top]), step, 15)[0]) + 1


def colours_of(speed: Array, step: float, count: int) -> IntArray:
    """The colour of each speed: a round speed, and also one that is half a step off, is well inside a colour."""
    return np.minimum(np.floor(speed / step + 0.53).astype(np.int64), count - 1)


def _style(colours: int) -> str:
    """The style sheet with the colours of the speeds."""
    inks = speeds(colours)
    light, dark = ("".join(f"--c{i}:{ink[shade]};" for i, ink in enumerate(inks)) for shade in range(2))
    return _STYLE.replace("LIGHT", light).replace("DARK", dark)


@dataclass(frozen=True, slots=True, eq=False)
class View:
    """What is shown of the sheet frame, and where.

    Attributes:
        caption: the size of the part in words.
        error: how far drawn paths may be off, m.
        per_metre: pixels.
        height: pixels.
        origin: where x = y = 0 lies, pixels.
        sheet: the sheet's edge, (K, 2) m; empty where it is not shown.
        box: the lower left and the upper right corner of all that is shown, (2, 2) m.
    """

    caption: str
    error: float
    per_metre: float
    height: float
    origin: tuple[float, float]
    sheet: Array
    box: Array

    @classmethod
    def around(cls, evidence: Evidence, drawing: Drawing | None) -> View:
        """Room for the part, everything that is worked, and the sheet where it is not much larger."""
        boxes = Pack.of(contour.curve for contour in drawing.contours).bounds() if drawing else np.zeros((0, 4))
        subject = bands(evidence) != RAPID
        places = (
            evidence.sheet[np.append(subject, False) | np.append(False, subject)] if len(subject) else evidence.sheet
        )
        places = _corners(places)
        part = _corners(boxes.reshape(-1, 2)) if len(boxes) else places if len(places) else np.zeros((1, 2))
        width, depth = np.ptp(part, axis=0)
        seen, sheet = np.vstack([part, places]), to_sheet(evidence.program, sheet_edge(evidence.robot.workspace))
        if _scale(seen) > _SHEET_SHOWN * _scale(np.vstack([seen, sheet])):
            sheet = np.zeros((0, 2))
        seen = np.vstack([seen, sheet])
        low, extent, scale = seen.min(axis=0), np.ptp(seen, axis=0), _scale(seen)
        height = max(float(extent[1]) * scale, 120.0) + 2 * _MARGIN
        x, y = ((_WIDTH, height) + np.array((-1.0, 1.0)) * (2.0 * low + extent) * scale) / 2.0
        caption = f"{'part' if len(boxes) else 'path'} {to_mm(width):.2f} \u00d7 {to_mm(depth):.2f} mm"
        error, box = _ERROR * max(width, depth, 1e-3), np.stack([low, low + extent])
        return cls(caption, error, scale, height, (float(x), float(y)), sheet, box)

    def path(self, lines: Sequence[Array], *, width: float, style: str) -> str:
        """A path of polylines (K, 2) m as relative moves, without the points that it can spare."""
        if not lines:
            return ""
        thinned = thin_lines(lines, self.error)
        grains = np.rint(to_um(1.0) * np.vstack(thinned)).astype(np.int64)
        way, last = np.diff(grains, axis=0, prepend=[[0, 0]]), np.cumsum([len(line) for line in thinned])
        moves = "".join("m" + " ".join(map(str, line.ravel())) for line in np.split(way, last[:-1]))
        (x, y), k = self.origin, self.per_metre * 1e-6
        place = f'transform="translate({x:.3f} {y:.3f}) scale({k:.9g} {-k:.9g})"'
        return f'<path {place} {style} stroke-width="{width / k:.4g}" d="{moves.replace(" -", "-")}"/>'


def _corners(points: Array) -> Array:
    """The lower left and the upper right corner of ``points``, (2, 2) m; nothing of nothing."""
    if not len(points):
        return points
    x, y = np.ascontiguousarray(points.T)  # a column after the other is several times as fast
    return np.array([[x.min(), y.min()], [x.max(), y.max()]])


def _scale(points: Array) -> float:
    """The pixels per metre at which the points fill the picture."""
    width, height = np.maximum(np.ptp(points, axis=0), 1e-3)
    return float(min((_WIDTH - 2 * _MARGIN) / width, _TALLEST / height))


def sheet_edge(sheet: Workspace) -> Array:
    """The edge of the sheet in the machine frame, (K, 2) m."""
    if sheet.radius is not None:
        turn = np.linspace(0.0, 2.0 * np.pi, 180, endpoint=False)
        return sheet.radius * np.column_stack((np.cos(turn), np.sin(turn)))
    return np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * (sheet.width or 0.0, sheet.depth or 0.0) / 2.0


def _drawn(drawing: Drawing | None, view: View) -> str:
    """The sheet's edge and the contours, the material between them filled."""
    sheet = [np.vstack([view.sheet, view.sheet[:1]])] if len(view.sheet) else []
    edges: list[Array] = []
    lines: list[Array] = []
    for contour in drawing.contours if drawing else ():
        line = curves.flatten(contour.curve, view.error / 4.0)[0]
        line = np.vstack([line, line[:1]]) if contour.curve.closed else line
        (edges if contour.has_kerf else lines).append(line)
    stroke = 'stroke="var(--line)" stroke-linejoin="round"'
    return (
        view.path(sheet, width=1.0, style='class="sheet" fill="none" stroke="var(--edge)"')
        + view.path(edges, width=0.7, style=f'class="contours" fill="var(--part)" fill-rule="evenodd" {stroke}')
        + view.path(lines, width=0.7, style=f'class="lines" fill="none" {stroke}')
    )


def _paths(xy: Array, band: IntArray, colour: IntArray, view: View) -> str:
    """The rapids as one dashed path, one of what is engraved, then a path per colour, the short slow ones on top."""
    subject = band == SUBJECT
    usual = float(np.median(colour[subject])) if subject.any() else 0.0
    colour = np.where(subject, colour, band - SUBJECT)
    first, (kind,) = stretches(xy, band, [most_unusual(colour, usual)], reach=view.error * 3.0, most=_MAX_RUNS)
    lines = [xy[start : end + 1] for start, end in zip(first, np.append(first[1:], len(band)), strict=True)]

    def drawn(of_kind: int, width: float, style: str) -> str:
        chosen = [line for line, of in zip(lines, kind.tolist(), strict=True) if of == of_kind]
        return view.path(chosen, width=width, style=f'{style} fill="none"')

    dash = f'stroke="var(--line)" stroke-dasharray="{5e6 / view.per_metre:.4g}"'
    parts = [drawn(RAPID - SUBJECT, 0.8, f'class="rapid" {dash}')]
    parts.append(drawn(ENGRAVED - SUBJECT, 1.6, 'class="engraved" stroke="var(--mark)" stroke-linecap="round"'))
    values = range(int(kind.max(initial=-1)), -1, -1)
    parts += [drawn(one, 2.0, f'class="speed" stroke="var(--c{one})" stroke-linecap="round"') for one in values]
    return "".join(parts)


def _starts(evidence: Evidence, view: View) -> str:
    """A dot where each cut begins, with its place in the order while there is room for numbers."""
    parts, cuts = [], [run for run in evidence.runs if run.operation is Operation.CUT]
    for number, run in enumerate(cuts, start=1):
        x, y = (evidence.sheet[run.first] * (1.0, -1.0) * view.per_metre + view.origin).tolist()
        name = f"<title>cut {number}: {shown(evidence.place(run.first))}</title>"
        parts.append(f'<circle class="start" cx="{x:.2f}" cy="{y:.2f}" r="3" fill="var(--ink)">{name}</circle>')
        if len(cuts) < _MAX_NUMBERS:
            parts.append(f'<text class="number" x="{x + 5:.2f}" y="{y - 5:.2f}">{number}</text>')
    return "".join(parts)


def _footer(view: View, step: float, colours: int, *, engraved: bool) -> str:
    """The size, a scale bar, and what the colours and lines stand for."""
    power = 10.0 ** math.floor(math.log10(150.0 / view.per_metre))
    bar = max(power * factor for factor in (1.0, 2.0, 5.0) if power * factor * view.per_metre <= 150.0)
    top, left, right = view.height + 14.0, _MARGIN, _WIDTH - _MARGIN - 30.0 * colours
    parts = [
        f'<rect y="{view.height:.2f}" width="100%" height="{_FOOTER:.0f}" rx="10" fill="var(--paper)"/>',
        f'<text x="{left}" y="{top + 16}">{view.caption}</text>',
        f'<path d="M{left} {top + 32}v8h{bar * view.per_metre:.2f}v-8" fill="none" stroke="var(--soft)"/>',
        f'<text x="{left}" y="{top + 61}">{to_mm(bar):g} mm</text>',
        f'<path d="M{left + 200} {top + 40}h60" stroke="var(--line)" stroke-dasharray="5"/>',
        f'<text x="{left + 200}" y="{top + 61}">rapid</text>',
    ]
    if colours:
        parts.append(f'<text x="{right}" y="{top + 16}">tool speed, mm/s</text>')
    if engraved:
        line = f'<path class="engraved-key" d="M{left + 280} {top + 40}h40" stroke="var(--mark)" stroke-width="1.6"/>'
        parts.append(f'{line}<text x="{left + 280}" y="{top + 61}">engraved</text>')
    every = 1 if colours < 8 else 2
    for i in range(colours):
        x = right + 30.0 * i
        parts.append(f'<rect class="key" x="{x}" y="{top + 28}" width="30" height="12" fill="var(--c{i})"/>')
        if i % every == 0:
            parts.append(f'<text x="{x + 15}" y="{top + 61}" text-anchor="middle">{i * step:g}</text>')
    return "".join(parts)
