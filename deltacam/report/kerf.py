"""What the kerf leaves of every contour: the rows of the table, and one line for a terminal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

from deltacam.model import KerfEffect, Size
from deltacam.units import to_mm, to_um

HEADS: Final = (
    "contour",
    "paths",
    "slot meets that of",
    "inner corners",
    "deepest tip, \u00b5m",
    "at x, y, mm",
    "unreached, mm\u00b2",
)
"""The heads of the columns."""

_NAMED: Final = 6  # contours in a cell, or in the line


def rows(effects: Sequence[KerfEffect], sizes: Sequence[Size]) -> list[list[str]]:
    """A row for every contour to which the kerf does something; the others are cut as they are drawn."""
    unreached = {one.contour: abs(one.exact - one.drawn) for one in sizes}
    return [
        [
            str(one.contour),
            {0: "swallowed", 1: "1"}.get(one.paths, f"split into {one.paths}"),
            _numbers(one.meets),
            str(one.corners),
            f"{to_um(one.depth):.1f}" if one.corners else "",
            "" if one.place is None else ", ".join(f"{to_mm(value):.3f}" for value in one.place),
            f"{unreached[one.contour] * 1e6:.4f}" if one.contour in unreached else "",
        ]
        for one in effects
        if one.paths != 1 or one.meets or one.corners
    ]


def in_words(effects: Sequence[KerfEffect]) -> str:
    """The worst of it in one line; empty where all contours are cut as they are drawn."""
    swallowed = [one.contour for one in effects if one.paths == 0]
    split = [one.contour for one in effects if one.paths > 1]
    corners = sum(one.corners for one in effects)
    parts = [f"swallows contours {_numbers(swallowed)}"] if swallowed else []
    parts += [f"splits contours {_numbers(split)}"] if split else []
    if corners:
        worst = max(effects, key=lambda one: one.depth)
        x, y = (to_mm(value) for value in worst.place or (0.0, 0.0))
        what = "1 inner corner" if corners == 1 else f"{corners} inner corners"
        parts.append(
            f"leaves up to {to_um(worst.depth):.1f} um in {what}, most in contour {worst.contour} at ({x:.3f}, {y:.3f})"
        )
    return ", ".join(parts)


def _numbers(contours: Sequence[int]) -> str:
    more = f" and {len(contours) - _NAMED} more" if len(contours) > _NAMED else ""
    return ", ".join(map(str, contours[:_NAMED])) + more
