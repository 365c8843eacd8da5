"""Numbers and a few letters as single strokes, to be engraved."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.drawing.testcuts.line import ENGRAVED, Line

_STROKES: Final[dict[str, tuple[tuple[tuple[float, float], ...], ...]]] = {
    "0": (((0, 0), (4, 0), (4, 6), (0, 6), (0, 0)),),
    "1": (((1, 5), (2, 6), (2, 0)),),
    "2": (((0, 6), (4, 6), (4, 3), (0, 3), (0, 0), (4, 0)),),
    "3": (((0, 6), (4, 6), (4, 0), (0, 0)), ((1, 3), (3.5, 3))),
    "4": (((3, 0), (3, 6), (0, 2), (4, 2)),),
    "5": (((4, 6), (0, 6), (0, 3), (4, 3), (4, 0), (0, 0)),),
    "6": (((4, 6), (0, 6), (0, 0), (4, 0), (4, 3), (0.5, 3)),),
    "7": (((0, 6), (4, 6), (2, 0)),),
    "8": (((0, 0), (4, 0), (4, 6), (0, 6), (0, 0)), ((0.5, 3), (3.5, 3))),
    "9": (((3.5, 3), (0, 3), (0, 6), (4, 6), (4, 0), (0, 0)),),
    ".": (((1.5, 0), (2.5, 0)),),
    "F": (((0, 0), (0, 6), (4, 6)), ((0.5, 3), (3, 3))),
    "K": (((0, 0), (0, 6)), ((4, 6), (0.5, 3), (4, 0))),
    "P": (((0, 0), (0, 6), (4, 6), (4, 3), (0.5, 3)),),
    " ": (),
}
"""The strokes of a character that is 4 wide and 6 high."""

_HIGH: Final = 6.0
_ADVANCE: Final = 6.0


def engraved(text: str, *, at: tuple[float, float], height: float) -> tuple[Line, ...]:
    """The strokes of a text.

    Args:
        text: digits, points, blanks and the letters F, K and P.
        at: the lower left corner of the first character, m.
        height: of a character, m.
    """
    scale = height / _HIGH
    return tuple(
        Line(ENGRAVED, np.array(stroke) * scale + at + np.array([_ADVANCE * scale * number, 0.0]), closed=False)
        for number, letter in enumerate(text)
        for stroke in _STROKES[letter]
    )


def width(text: str, *, height: float) -> float:
    """How wide the text is, m, the gap after its last character included."""
    return len(text) * _ADVANCE * height / _HIGH
