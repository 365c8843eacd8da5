"""The colours of the page: each has one value on light paper and one on a dark screen.

plotly.js writes colours into the style of every element that it draws. The style sheet of `dark_rules` finds them there
and replaces them, so that the pictures follow the system, and the printer, without a script.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Final, NamedTuple

import numpy as np

_VIRIDIS: Final = ("440154", "472d7b", "3b528b", "2c728e", "21918c", "28ae80", "5ec962", "addc30", "fde725")
_CALM_LIGHT: Final = ("a9bfdd", "7d8fd0", "7b4fb5", "5c1067")
_CALM_DARK: Final = ("44577a", "7078cc", "bd74dd", "ffc4f2")
_COLD_LIGHT: Final = ("0b4a9e", "2f7fd0", "79b4e6")
_COLD_DARK: Final = ("7cc0ff", "4a90dd", "34689f")
_HOT_LIGHT: Final = ("f0b44c", "e0761c", "c22f1d", "6e0d25")
_HOT_DARK: Final = ("8a6420", "d07a2a", "ff6a4d", "ffc2c2")


class Ink(NamedTuple):
    """One colour, as ``#rrggbb``: on light paper and on a dark screen."""

    light: str
    dark: str


TEXT: Final = Ink("#59636e", "#9198a1")
STRONG: Final = Ink("#1f2328", "#f0f6fc")
GRID: Final = Ink("#e3e7eb", "#2a313a")
ZERO: Final = Ink("#c2cad2", "#4b535d")
LINE: Final = Ink("#818b98", "#767f89")
RAPID: Final = Ink("#939eab", "#666f79")
PART: Final = Ink("#eaeef2", "#242d38")
SHEET: Final = Ink("#d1d9e0", "#3d444d")
LIMIT: Final = Ink("#cf222e", "#f85149")
TOOL: Final = Ink("#8250df", "#ab7df8")
ANGLE: Final = Ink("#b3bcc6", "#4f5862")
JOINTS: Final = (Ink("#0969da", "#4493f8"), Ink("#bc4c00", "#f0883e"), Ink("#1a7f37", "#3fb950"))
BINDING: Final = (
    Ink("#009e73", "#2fc99c"),
    Ink("#3d9fe0", "#6cc0f5"),
    Ink("#00548a", "#3b8fd1"),
    Ink("#d39200", "#f0b429"),
    Ink("#d25400", "#f47a2c"),
    Ink("#b8528f", "#e28bbd"),
    Ink("#a7b0ba", "#5d6670"),
)
"""One for each of `binding.LIMITS`, and the last for none of them."""
_MIDDLE: Final = Ink("#9aa88f", "#5d6b56")
OVER: Final = Ink("#e5202e", "#ff4d4d")
"""Of what is beyond its limit."""
PAPER: Final = Ink("#ffffff", "#151b23")
"""Around marks that lie on lines."""
TAB: Final = JOINTS[1]
KINDS: Final = {
    "cut": Ink("#0969da", "#4493f8"),
    "lead-in": Ink("#1a7f37", "#3fb950"),
    "loop": Ink("#bf3989", "#f778ba"),
    "overcut": Ink("#8250df", "#ab7df8"),
    "engraved": Ink("#9a6700", "#d4a72c"),
}
"""Of what is done with the laser on."""

_FIXED: Final = (
    TEXT,
    STRONG,
    GRID,
    ZERO,
    LINE,
    RAPID,
    PART,
    SHEET,
    LIMIT,
    TOOL,
    ANGLE,
    *JOINTS,
    *BINDING,
    OVER,
    PAPER,
    TAB,
)


def css(ink: Ink) -> str:
    """A light colour in the one spelling that `dark_rules` finds."""
    red, green, blue = (int(ink.light[i : i + 2], 16) for i in (1, 3, 5))
    return f"rgb({red}, {green}, {blue})"


def speeds(count: int) -> list[Ink]:
    """Viridis in ``count`` colours: the part that is dark enough on light paper, light enough on a dark screen."""
    return list(map(Ink, _ramp(_VIRIDIS, 0.0, 0.8, count), _ramp(_VIRIDIS, 0.28, 1.0, count)))


def deviations(count: int) -> list[Ink]:
    """From pale to strong in ``count`` colours."""
    return list(map(Ink, _ramp(_CALM_LIGHT, 0.0, 1.0, count), _ramp(_CALM_DARK, 0.0, 1.0, count)))


def energies(below: int, above: int) -> list[Ink]:
    """From blue over a calm middle to red: ``below`` colours, that of the middle, and ``above`` colours."""
    light = [*_ramp(_COLD_LIGHT, 0.0, 1.0, below), _MIDDLE.light, *_ramp(_HOT_LIGHT, 0.0, 1.0, above)]
    dark = [*_ramp(_COLD_DARK, 0.0, 1.0, below), _MIDDLE.dark, *_ramp(_HOT_DARK, 0.0, 1.0, above)]
    return list(map(Ink, light, dark))


def dark_rules(further: Iterable[Ink]) -> str:
    """The style sheet that turns every colour, those of ``further`` too, into its dark one inside ``.inked``."""
    rules = []
    for ink in dict.fromkeys((*_FIXED, *further)):
        rules += [
            f'.inked [style*="{what}: {css(ink)}"]{{{what}:{ink.dark}!important}}'
            for what in ("stroke", "fill", "background-color")
        ]
    lines = "\n".join(rules)
    return f"@media screen and (prefers-color-scheme:dark){{\n{lines}\n}}\n"


def _ramp(anchors: Sequence[str], first: float, last: float, count: int) -> list[str]:
    values = np.array([[int(colour[i : i + 2], 16) for i in (0, 2, 4)] for colour in anchors])
    at = np.linspace(first, last, count) * (len(anchors) - 1)
    rgb = np.column_stack([np.interp(at, np.arange(len(anchors)), values[:, i]) for i in range(3)])
    return ["#{:02x}{:02x}{:02x}".format(*row) for row in rgb.round().astype(int)]
