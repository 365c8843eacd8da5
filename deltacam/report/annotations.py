"""What is written and marked over and under the still picture: tabs, arrows, dots, numbers, and what it all means."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Final

import numpy as np

from deltacam.report.bands import BESIDE, DARK, ENGRAVED, RAPID, STROKES, SUBJECT, TWICE
from deltacam.report.escaping import shown
from deltacam.report.marks import MANY, SIDES, Marks, headings
from deltacam.report.view import MARGIN, WIDTH, View
from deltacam.units import to_mm
from deltacam.verification.evidence import Evidence

_WORDS: Final = 92.0  # the height of the words under the picture without those about lines and marks, pixels
_ROW: Final = 24.0  # the height of a row of these
_LETTER: Final = 8.7  # the width of a letter in the smallest window, pixels of the picture
_LINES: Final = {
    SUBJECT: '<path d="M0 0h30" stroke="var(--ink)" stroke-width="{:.2g}"/>',
    BESIDE: '<path d="M0 0h30" stroke="var(--ink)" stroke-width="{:.2g}"/>',
    TWICE: '<path d="M0 0h30" stroke="var(--ink)" stroke-width="{:.2g}"/>',
    DARK: '<path d="M0 0h30" stroke="var(--soft)" stroke-dasharray="1.5 2" stroke-width="{:.2g}"/>',
    ENGRAVED: '<path class="engraved-key" d="M0 0h30" stroke="var(--mark)" stroke-width="1.6"/>',
    RAPID: '<path d="M0 0h30" stroke="var(--line)" stroke-dasharray="5"/>',
}
_TAB: Final = '<path d="M12-6v12M19-6v12" stroke="var(--tab)" stroke-width="2"/>'
_ARROW: Final = '<path d="M21 0L10 4V-4z" fill="var(--ink)"/>'


def marked(evidence: Evidence, marks: Marks, view: View) -> str:
    """The ends of tabs, the arrows, a dot where each cut begins, and its place in the order where there is room."""
    pixel, parts = 1.0 / view.per_metre, []
    half, radius = (4.5, 2.4) if len(marks.starts) >= MANY else (6.0, 3.0)
    for tick, turn in zip(marks.tabs.tolist(), np.degrees(headings(evidence.sheet, marks.tabs)), strict=True):
        place = view.place(evidence.sheet[tick], -turn)
        parts.append(f'<path class="tab" d="M0-{half:g}v{2 * half:g}" stroke="var(--tab)" stroke-width="2" {place}/>')
    arrows = marks.arrows
    for at in np.flatnonzero(arrows.scale >= pixel).tolist():
        place = view.place(arrows.points[at], -float(np.degrees(arrows.heading[at])))
        parts.append(f'<path class="arrow" d="M6 0L-5 4V-4z" fill="var(--ink)" stroke="var(--paper)" {place}/>')
    for number, tick in enumerate(marks.starts.tolist(), start=1):
        x, y = view.pixel(evidence.sheet[tick])
        name = f"<title>cut {number}: {shown(evidence.place(tick))}</title>"
        parts.append(
            f'<circle class="start" cx="{x:.2f}" cy="{y:.2f}" r="{radius:g}" fill="var(--ink)">{name}</circle>'
        )
    numbers = marks.numbers
    for at in np.flatnonzero(numbers.scale >= pixel).tolist():
        (x, y), (right, up) = view.pixel(numbers.points[at]), SIDES[numbers.side[at]]
        anchor = "" if right > 0 else ' text-anchor="end"'
        place = f'x="{x + 4.0 * right:.2f}" y="{y - 4.0 * up + (0 if up > 0 else 9):.2f}"{anchor}'
        parts.append(f'<text class="number" {place}>{numbers.text[at]}</text>')
    return "".join(parts)


@dataclass(frozen=True, slots=True)
class Looks:
    """How lines and marks look, as a row of the legend.

    Attributes:
        names: of the bands that are there.
        tabs: whether there are any.
        arrows: likewise.
    """

    names: Mapping[int, str] = field(default_factory=dict)
    tabs: bool = False
    arrows: bool = False

    @property
    def height(self) -> float:
        """Of all that is under the picture, pixels."""
        return _WORDS + _ROW * max((row for row, *_ in self._placed()), default=0.0)

    def drawn(self, top: float) -> str:
        """The rows, each look with its name."""
        return "".join(
            f'<g class="looks" transform="translate({left:.0f} {top + _ROW * (row - 1):.0f})">{look}'
            f'<text class="look" x="36" y="4.5">{name}</text></g>'
            for row, left, look, name in self._placed()
        )

    def _placed(self) -> Iterator[tuple[int, float, str, str]]:
        """In which row, counted from 1, and how far from the left, what with which name."""
        found = [(_LINES[band].format(0.8 * STROKES[band].width), name) for band, name in self.names.items()]
        found += [(_TAB, "tab")] if self.tabs else []
        found += [(_ARROW, "direction")] if self.arrows else []
        row, left = 1, MARGIN
        for look, name in found:
            width = 36.0 + _LETTER * len(name)
            if left + width > WIDTH - MARGIN:
                row, left = row + 1, MARGIN
            yield row, left, look, name
            left += width + 14.0


def footer(view: View, step: float, colours: int, looks: Looks) -> str:
    """The size, a scale bar, and what the colours and lines stand for."""
    power = 10.0 ** math.floor(math.log10(150.0 / view.per_metre))
    bar = max(power * factor for factor in (1.0, 2.0, 5.0) if power * factor * view.per_metre <= 150.0)
    top, left, right = view.height + 14.0, MARGIN, WIDTH - MARGIN - 30.0 * colours
    parts = [
        f'<rect y="{view.height:.2f}" width="100%" height="{looks.height:.0f}" rx="10" fill="var(--paper)"/>',
        f'<text x="{left}" y="{top + 16}">{view.caption}</text>',
        f'<path d="M{left} {top + 32}v8h{bar * view.per_metre:.2f}v-8" fill="none" stroke="var(--soft)"/>',
        f'<text x="{left}" y="{top + 61}">{to_mm(bar):g} mm</text>',
    ]
    if colours:
        parts.append(f'<text x="{right}" y="{top + 16}">tool speed, mm/s</text>')
    every = 1 if colours < 8 else 2
    for i in range(colours):
        x = right + 30.0 * i
        parts.append(f'<rect class="key" x="{x}" y="{top + 28}" width="30" height="12" fill="var(--c{i})"/>')
        if i % every == 0:
            parts.append(f'<text x="{x + 15}" y="{top + 61}" text-anchor="middle">{i * step:g}</text>')
    return "".join(parts) + looks.drawn(view.height + _WORDS)
