"""Charts as SVG text: axes, lines, areas and bands, the same bytes for the same numbers, for light and dark pages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import Final

import numpy as np
import numpy.typing as npt

Numbers = npt.NDArray[np.float64]

WIDTH: Final = 900

_STYLE: Final = """
.dm{--paper:#fff;--ink:#1f2328;--soft:#59636e;--line:#818b98;--part:#eaeef2;--edge:#d1d9e0;--blue:#0969da;--red:#cf222e;\
--green:#1a7f37;--purple:#8250df;--orange:#bc4c00;--teal:#1b7c83;--pink:#bf3989}
@media screen and (prefers-color-scheme:dark){
.dm{--paper:#151b23;--ink:#f0f6fc;--soft:#9198a1;--line:#767f89;--part:#242d38;--edge:#3d444d;--blue:#4493f8;--red:#ff7b72;\
--green:#3fb950;--purple:#ab7df8;--orange:#f0883e;--teal:#39c5cf;--pink:#f778ba}}
.dm text{font:13px system-ui,"Segoe UI",Roboto,"Liberation Sans",sans-serif;fill:var(--soft)}
.dm .head{font-weight:600;fill:var(--ink)}
@media (max-width:640px){.dm text{font-size:17px}}
"""


def picture(title: str, about: str, height: int, parts: Sequence[str]) -> str:
    """A whole SVG document of parts, `WIDTH` by ``height`` pixels."""
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="dm" viewBox="0 0 {WIDTH} {height}" role="img">'
        f"<title>{escape(title)}</title><desc>{escape(about)}</desc><style>{_STYLE}</style>"
        f'<rect width="100%" height="100%" rx="10" fill="var(--paper)"/>{"".join(parts)}</svg>\n'
    )


def label(x: float, y: float, text: str, *, anchor: str = "start", kind: str = "") -> str:
    """A line of text with its baseline at pixels x and y."""
    return f'<text x="{x:g}" y="{y:g}" text-anchor="{anchor}" class="{kind}">{escape(text)}</text>'


def legend(x: float, y: float, entries: Sequence[tuple[str, str, str]], *, apart: float = 150.0) -> str:
    """Names with a sample each, side by side: (name, colour, kind), where the kind is line, dashed or band."""
    parts = []
    for number, (name, colour, kind) in enumerate(entries):
        left = x + apart * number
        if kind == "band":
            parts.append(f'<rect x="{left:g}" y="{y - 10:g}" width="24" height="12" {_paint(colour)}/>')
        else:
            dash = ' stroke-dasharray="6 4"' if kind == "dashed" else ""
            parts.append(
                f'<path d="M{left:g} {y - 4:g}h24" fill="none" stroke="var(--{colour})" stroke-width="2"{dash}/>'
            )
        parts.append(label(left + 30, y, name))
    return "".join(parts)


def _paint(colour: str, opacity: float = 0.3) -> str:
    return f'fill="var(--{colour})" fill-opacity="{opacity:g}"'


@dataclass(frozen=True, slots=True)
class Axes:
    """A rectangle of the picture in which numbers are drawn to scale.

    Attributes:
        left, top, width, height: of the rectangle, pixels.
        x: the least and the largest number across it.
        y: the least and the largest number up it.
    """

    left: float
    top: float
    width: float
    height: float
    x: tuple[float, float]
    y: tuple[float, float]

    def pixels(self, x: Numbers, y: Numbers) -> Numbers:
        """Where numbers (N,) and (N,) are, (N, 2)."""
        across = self.left + (np.asarray(x) - self.x[0]) / (self.x[1] - self.x[0]) * self.width
        down = self.top + (self.y[1] - np.asarray(y)) / (self.y[1] - self.y[0]) * self.height
        return np.stack([across, down], axis=-1)

    def frame(self, x_ticks: Sequence[float], y_ticks: Sequence[float], *, x_name: str = "", y_name: str = "") -> str:
        """The edge, a grid line and a number at every tick, and the names; the one of y is above the rectangle."""
        bottom, right = self.top + self.height, self.left + self.width
        parts = []
        for number in x_ticks:
            across = float(self.pixels(np.array(number), np.array(self.y[0]))[0])
            parts.append(f'<path d="M{across:.1f} {self.top:g}V{bottom:g}" stroke="var(--edge)" stroke-width="0.6"/>')
            parts.append(label(round(across, 1), bottom + 17, f"{number:g}".replace("-", "\u2212"), anchor="middle"))
        for number in y_ticks:
            down = float(self.pixels(np.array(self.x[0]), np.array(number))[1])
            parts.append(f'<path d="M{self.left:g} {down:.1f}H{right:g}" stroke="var(--edge)" stroke-width="0.6"/>')
            parts.append(label(self.left - 6, round(down + 4.5, 1), f"{number:g}".replace("-", "\u2212"), anchor="end"))
        parts.append(
            f'<rect x="{self.left:g}" y="{self.top:g}" width="{self.width:g}" height="{self.height:g}" fill="none" '
            'stroke="var(--line)" stroke-width="0.8"/>'
        )
        if x_name:
            parts.append(label(right, bottom + 35, x_name, anchor="end"))
        if y_name:
            parts.append(label(self.left, self.top - 8, y_name, kind="head"))
        return "".join(parts)

    def line(self, x: Numbers, y: Numbers, colour: str, *, width: float = 1.6, dashed: bool = False) -> str:
        """A line through numbers (N,) and (N,); above and below the rectangle it runs along the edge."""
        dash = ' stroke-dasharray="6 4"' if dashed else ""
        return (
            f'<path class="line" d="{self._way(x, y)}" fill="none" stroke="var(--{colour})" stroke-width="{width:g}" '
            f'stroke-linejoin="round"{dash}/>'
        )

    def area(self, x: Numbers, y: Numbers, base: float, colour: str) -> str:
        """What lies between a line and a number."""
        around = np.concatenate([x[:1], x, x[-1:]]), np.concatenate([[base], y, [base]])
        return f'<path class="area" d="{self._way(*around)}Z" {_paint(colour)}/>'

    def band(self, first: float, last: float, colour: str, *, opacity: float = 0.3) -> str:
        """A stretch of the rectangle from one number to another across it."""
        (start, _), (end, _) = self.pixels(np.array([first, last]), np.zeros(2))
        return (
            f'<rect class="band" x="{start:.1f}" y="{self.top:g}" width="{end - start:.1f}" height="{self.height:g}" '
            f"{_paint(colour, opacity)}/>"
        )

    def marks(self, x: Numbers) -> str:
        """Dashed lines up the rectangle."""
        at = self.pixels(x, np.zeros(len(x)))[:, 0]
        way = "".join(f"M{across:.1f} {self.top:g}v{self.height:g}" for across in at)
        return f'<path class="marks" d="{way}" stroke="var(--line)" stroke-width="0.6" stroke-dasharray="2 3"/>'

    def _way(self, x: Numbers, y: Numbers) -> str:
        low, high = self.y
        points = self.pixels(x, np.clip(y, low, high))
        return "M" + "L".join(f"{across:.1f} {down:.1f}" for across, down in points)
