"""The kerf comb: bars in a window, which are pushed together to measure the kerf as the sum of many.

Every bar and the window are drawn with gaps of a known width between them. Each gap is wider than drawn by what the
kerf is wider than planned: half of it from each of its two sides. All of them together, from the window's edge to the
bars pushed against the other edge, are wide enough for a caliper, which finds the kerf many times finer than one slot
would.
"""

from __future__ import annotations

from typing import Final

from deltacam.drawing.testcuts.line import CUT, Line, rectangle
from deltacam.drawing.testcuts.strokes import engraved
from deltacam.model import Process

BARS: Final = 10
SMALLEST: Final = 4e-3
"""The least width of a bar and of a gap, m; in thicker material both are as wide as it is thick."""

_LENGTH: Final = 7.0  # of a bar, in its widths
_MARGIN: Final = 2.0
_LETTERS: Final = 4e-3
_DIGITS: Final = 6


def kerf_comb(process: Process) -> tuple[Line, ...]:
    """The lines of the comb; the planned kerf is engraved into its frame where the process can engrave."""
    unit = bar_width(process)
    margin, length = _MARGIN * unit, _LENGTH * unit
    window = ((2 * BARS + 1) * unit, length + 2.0 * unit)
    lines = [
        rectangle(CUT, 0.0, 0.0, window[0] + 2.0 * margin, window[1] + 2.0 * margin),
        rectangle(CUT, margin, margin, *window),
    ]
    lines += [rectangle(CUT, margin + (2 * bar + 1) * unit, margin + unit, unit, length) for bar in range(BARS)]
    if process.engrave_feed is not None:
        label = f"K {process.kerf * 1e3:.3f}"
        lines += engraved(label, at=(margin, 0.5 * (margin - _LETTERS)), height=_LETTERS)
    return tuple(lines)


def bar_width(process: Process) -> float:
    """The width of a bar, and of a gap, m."""
    return max(SMALLEST, process.thickness)


def planned_gap(process: Process) -> float:
    """All gaps together where the kerf is that of the process, m."""
    return (BARS + 1) * bar_width(process)


def kerf_from_gap(gap: float, process: Process) -> float:
    """The kerf that was cut, m, to a micrometre; may be negative where the gap cannot be right.

    Args:
        gap: from the bars, pushed together against one edge of the window, to the other edge, m.
        process: that the comb was drawn and planned for.
    """
    return round(process.kerf + (gap - planned_gap(process)) / (BARS + 1), _DIGITS)
