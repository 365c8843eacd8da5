"""Places for the numbers of contours: on free paper, near their lines, without overlap."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from deltacam.model import Array, BoolArray

_CELL: Final = 3.0
"""Grid of the paper, pixels."""

_GAP: Final = 4.0
"""Between a contour's box and a number beside it, pixels."""


class Paper:
    """Which parts of a picture are taken.

    Args:
        width: pixels.
        height: pixels.
        top: pixels that are taken from the start.
    """

    def __init__(self, width: float, height: float, *, top: float) -> None:
        self._taken: BoolArray = np.zeros((int(height / _CELL) + 1, int(width / _CELL) + 1), dtype=np.bool_)
        self._taken[: int(top / _CELL)] = True

    def draw(self, points: Array) -> None:
        """Take the cells along a polyline (K, 2), pixels."""
        step = np.hypot(*np.diff(points, axis=0).T)
        pieces = np.maximum(np.ceil(step / _CELL), 1).astype(np.int64)
        index = np.repeat(np.arange(len(step)), pieces)
        share = (np.arange(len(index)) - np.repeat(np.cumsum(pieces) - pieces, pieces)) / pieces[index]
        between = points[index] + share[:, None] * (points[index + 1] - points[index])
        column, row = np.vstack([between, points[-1:]]).T // _CELL
        inside = (row >= 0) & (row < self._taken.shape[0]) & (column >= 0) & (column < self._taken.shape[1])
        self._taken[row[inside].astype(np.int64), column[inside].astype(np.int64)] = True

    def place(self, line: Array, width: float, height: float, *, inside: bool) -> tuple[float, float] | None:
        """The middle of a free place for a number; taken from now on. None where there is none.

        Args:
            line: of the contour, (K, 2) pixels, y down; a closed one ends where it starts.
            width: of the number, pixels.
            height: of the number, pixels.
            inside: whether the inside of the contour is a better place than its outside.
        """
        for x, y in _candidates(line, width, height, inside=inside):
            rows = slice(int((y - height / 2.0) // _CELL), int((y + height / 2.0) // _CELL) + 1)
            columns = slice(int((x - width / 2.0) // _CELL), int((x + width / 2.0) // _CELL) + 1)
            shown = rows.start >= 0 and columns.start >= 0
            shown = shown and rows.stop <= self._taken.shape[0] and columns.stop <= self._taken.shape[1]
            if shown and not self._taken[rows, columns].any():
                self._taken[rows, columns] = True
                return x, y
        return None


def _candidates(line: Array, width: float, height: float, *, inside: bool) -> Iterator[tuple[float, float]]:
    """The middle of the contour's box and other places in it, and those beside its outermost points."""
    (left, top), (right, bottom) = line.min(axis=0).tolist(), line.max(axis=0).tolist()
    fits = right - left > width and bottom - top > height
    grid = np.array([left, top]) + _INSIDE * (right - left, bottom - top)
    within = [(x, y) for x, y in grid[_is_inside(grid, line)].tolist()] if fits else []
    across, along = 0.5 * width + _GAP, 0.5 * height + _GAP
    beside = [
        (float(line[line[:, 1].argmin(), 0]), top - along),
        (right + across, float(line[line[:, 0].argmax(), 1])),
        (float(line[line[:, 1].argmax(), 0]), bottom + along),
        (left - across, float(line[line[:, 0].argmin(), 1])),
    ]
    yield from (*within, *beside) if inside else (*beside, *within)


def _is_inside(points: Array, line: Array) -> BoolArray:
    """Whether points (K, 2) lie in the polygon of a line that ends where it starts: a ray to the right leaves it."""
    (x, y), (u, v) = line[:-1].T, line[1:].T
    above = (y > points[:, 1:]) != (v > points[:, 1:])
    share = np.divide(points[:, 1:] - y, v - y, out=np.zeros(above.shape), where=above)
    crossed = above & (points[:, :1] < x + share * (u - x))
    return np.asarray(np.count_nonzero(crossed, axis=1) % 2 == 1)


_SHARES: Final = (0.5, 0.3, 0.7, 0.15, 0.85)
_INSIDE: Final = np.array([(across, down) for down in _SHARES for across in _SHARES])
"""Places in a box, as shares of its width and height, the middle first."""
