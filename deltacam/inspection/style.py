"""How the kinds of lines and places look in the picture of a drawing.

The colours are those of Okabe and Ito (2008), which people with any colour vision tell apart, darker or lighter where
the paper asks for it; the dashes and shapes say the same without colour.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

from deltacam.model import Contour, Operation


@dataclass(frozen=True, slots=True)
class LineStyle:
    """How a kind of line is drawn and what the legend calls it."""

    name: str
    label: str
    light: str
    dark: str
    dash: str = ""
    width: float = 1.6


@dataclass(frozen=True, slots=True)
class MarkStyle:
    """How a kind of place is marked, which findings it stands for, and what the legend calls it."""

    name: str
    label: str
    light: str
    dark: str
    shape: str
    kinds: tuple[str, ...] = ()


LINES: Final = (
    LineStyle("outer", "outer", "#1f2328", "#f0f6fc", width=1.8),
    LineStyle("hole", "hole", "#0072b2", "#56b4e9", dash="6 2"),
    LineStyle("line", "open, cut on the line", "#d55e00", "#ff9d5c", dash="8 3 2 3", width=2.0),
    LineStyle("engraved", "engraved", "#00795a", "#2fc79b", dash="2 2.5", width=2.0),
    LineStyle("open", "open, not cut", "#d55e00", "#ff9d5c", dash="5 3", width=2.0),
    LineStyle("ignored", "ignored", "#818b98", "#767f89", dash="2 4", width=1.4),
)
"""From the legend's left to its right; the first ones are drawn first."""

REPEATED: Final = LineStyle("repeated", "some of it drawn twice", "#cc79a7", "#cc79a7", width=7.0)
"""A band along the contours that duplicates were merged into."""

MARKS: Final = (
    MarkStyle("gap", "gap", "#d55e00", "#ff9d5c", "M-8 0a8 8 0 1 0 16 0a8 8 0 1 0-16 0z", ("gap",)),
    MarkStyle("branch", "branch", "#0072b2", "#56b4e9", "M0-9l9 9-9 9-9-9z", ("branch",)),
    MarkStyle("crossing", "crossing", "#b8003c", "#ff7a9c", "M-8-8l16 16M8-8l-16 16", ("crossing", "self_crossing")),
    MarkStyle("twice", "duplicate", "#a34b85", "#e59ccb", "M-8-7h16l-8 14z", ("duplicate", "common_edge")),
    MarkStyle("note", "other warning", "#7a5a00", "#e6b800", "M-7-7h14v14h-14z"),
)
"""The last one is for all findings that have a place but no mark of their own."""


def line_style(contour: Contour) -> LineStyle:
    """How a contour is drawn."""
    return _LINE[_line_name(contour)]


def mark_style(kind: str) -> MarkStyle:
    """How a finding of this kind is marked."""
    return next((mark for mark in MARKS if kind in mark.kinds), MARKS[-1])


def _line_name(contour: Contour) -> str:
    if contour.operation is Operation.ENGRAVE:
        return "engraved"
    if contour.operation is Operation.IGNORE:
        return "ignored" if contour.curve.closed else "open"
    if not contour.curve.closed:
        return "line"
    return "hole" if contour.is_hole else "outer"


_LINE: Final = {style.name: style for style in LINES}


def sheet() -> str:
    """The style sheet."""
    light = "".join(f"--{style.name}:{style.light};" for style in (*LINES, REPEATED, *MARKS))
    dark = "".join(f"--{style.name}:{style.dark};" for style in (*LINES, REPEATED, *MARKS))
    rules = [
        f".{style.name}{{stroke:var(--{style.name});stroke-width:{style.width}px"
        + (f";stroke-dasharray:{style.dash}" if style.dash else "")
        + "}"
        for style in (*LINES, REPEATED)
    ]
    rules += [f".di .on-{style.name}{{fill:var(--{style.name})}}" for style in LINES]
    rules += [f".{mark.name}{{stroke:var(--{mark.name});stroke-width:2px}}" for mark in MARKS]
    return _SHEET.replace("LIGHT", light).replace("DARK", dark) + "\n".join(rules) + "\n"


_SHEET: Final = """
.di{--paper:#fff;--ink:#1f2328;--soft:#59636e;--part:#eaeef2;LIGHT}
@media screen and (prefers-color-scheme:dark){.di{--paper:#151b23;--ink:#f0f6fc;--soft:#9198a1;--part:#242d38;DARK}}
.di path{fill:none;stroke-linecap:butt;stroke-linejoin:round;vector-effect:non-scaling-stroke}
.di .repeated{stroke-opacity:.45}
.di .marks path{pointer-events:all}
.di .curves .outer{fill:var(--part)}.di .curves .hole{fill:var(--paper)}
.di text{font:13px system-ui,"Segoe UI",Roboto,"Liberation Sans",sans-serif;fill:var(--soft)}
.di .name{font-size:16px;font-weight:600;fill:var(--ink)}
.di .number{font-size:11px;text-anchor:middle}
"""
