"""A picture of what a program does to the sheet: one SVG without scripts, the cuts coloured by the tool's speed.

What is drawn to scale is in whole micrometres of the sheet frame, y up; everything else is in the picture's pixels.
"""

from __future__ import annotations

import math
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Drawing, IntArray
from deltacam.program.program import Program
from deltacam.report.annotations import Looks, footer, marked
from deltacam.report.bands import BESIDE, DARK, ENGRAVED, RAPID, STROKES, SUBJECT, TWICE, bands, names
from deltacam.report.escaping import shown
from deltacam.report.marks import marks_of
from deltacam.report.palette import speeds
from deltacam.report.stretches import most_unusual, stretches
from deltacam.report.view import WIDTH, View
from deltacam.units import to_mm, to_um
from deltacam.verification.evidence import Evidence, gather

_MAX_RUNS: Final = 12_000  # stretches of one colour
_STYLE: Final = """
.dc{--paper:#fff;--ink:#1f2328;--soft:#59636e;--line:#818b98;--part:#eaeef2;--edge:#d1d9e0;
--mark:#bf3989;--tab:#bc4c00;LIGHT}
@media screen and (prefers-color-scheme:dark){
.dc{--paper:#151b23;--ink:#f0f6fc;--soft:#9198a1;--line:#767f89;--part:#242d38;--edge:#3d444d;
--mark:#f778ba;--tab:#f0883e;DARK}}
.dc text{font:13px system-ui,"Segoe UI",Roboto,"Liberation Sans",sans-serif;fill:var(--soft)}
.dc .number{font-size:12px;font-weight:600;fill:var(--ink);stroke:var(--paper);stroke-width:3px;paint-order:stroke}
@media (max-width:640px){.dc text{font-size:21px}.dc .number{font-size:18px}.dc .look{font-size:16px}}
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
    step, colours, parts, looks = 1.0, 1, [_drawn(drawing, view)], Looks()
    if len(evidence.sheet) > 1:
        band = bands(evidence)
        speed = tool_speeds(evidence)
        cut = speed[np.isin(band, (SUBJECT, BESIDE, TWICE))]
        step, colours = speed_colours(cut) if len(cut) else (1.0, 0)
        marks = marks_of(evidence, view.box)
        parts += [_paths(evidence.sheet, band, colours_of(speed, step, colours), view), marked(evidence, marks, view)]
        looks = Looks(names(evidence, band), tabs=bool(len(marks.tabs)), arrows=bool(len(marks.arrows.points)))
    about = evidence.impossible[1] or f"path within {to_um(view.error) + 1.0:.0f} µm of the setpoints"
    height = view.height + looks.height
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="dc" viewBox="0 0 {WIDTH:.0f} {height:.0f}" role="img">'
        f"<title>{shown(evidence.program.drawing.file)}</title>"
        f"<desc>{view.caption}; tool path coloured by speed; {shown(about)}</desc>"
        f'<style>{_style(colours)}</style><rect width="100%" height="100%" rx="10" fill="var(--paper)"/>'
        f"{''.join(parts)}{footer(view, step, colours, looks)}</svg>\n"
    )


def tool_speeds(evidence: Evidence) -> Array:
    """The tool's speed from every setpoint to the next, (N - 1,) mm/s."""
    return to_mm(1.0) * evidence.speed


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
    """The rapids as one dashed path, one of what is engraved, then a path per colour, the short slow ones on top.

    Lead-ins and loops are thin, the overcut is thick; dotted is where the laser is off on the way of a cut.
    """
    subject = np.isin(band, (SUBJECT, BESIDE, TWICE))
    usual = float(np.median(colour[subject])) if subject.any() else 0.0
    colour = np.where(subject, colour, 0)
    first, (kind,) = stretches(xy, band, [most_unusual(colour, usual)], reach=view.error * 3.0, most=_MAX_RUNS)
    lines = [xy[start : end + 1] for start, end in zip(first, np.append(first[1:], len(band)), strict=True)]
    of_line = list(zip(lines, band[first].tolist(), kind.tolist(), strict=True))

    def drawn(of_band: int, style: str, of_kind: int | None = None, *, scale: float = 1.0) -> str:
        chosen = [line for line, one, value in of_line if one == of_band and of_kind in (None, value)]
        return view.path(chosen, width=scale * STROKES[of_band].width, style=f'{style} fill="none"')

    dash = f'stroke="var(--line)" stroke-dasharray="{5e6 / view.per_metre:.4g}"'
    dots = f'stroke="var(--soft)" stroke-dasharray="{1.5e6 / view.per_metre:.4g} {2e6 / view.per_metre:.4g}"'
    parts = [drawn(RAPID, f'class="rapid" {dash}', scale=0.8), drawn(DARK, f'class="dark" {dots}', scale=0.8)]
    parts.append(drawn(ENGRAVED, 'class="engraved" stroke="var(--mark)" stroke-linecap="round"'))
    for name, of_band, cap in (("beside", BESIDE, "round"), ("speed", SUBJECT, "round"), ("twice", TWICE, "butt")):
        style = f'stroke-linecap="{cap}"'
        values = range(int(kind.max(initial=-1)), -1, -1)
        parts += [drawn(of_band, f'class="{name}" stroke="var(--c{one})" {style}', one, scale=0.8) for one in values]
    return "".join(parts)
