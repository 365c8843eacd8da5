"""A drawing as a few lines through whole numbers: small enough to keep for thousands of parts."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve, Drawing
from deltacam.report.thin import thin_lines

SPAN: Final = 160
"""The longer side of the picture, in steps."""

MOST_NUMBERS: Final = 4_000
"""Numbers of one thumbnail; a drawing with more lines leaves the shortest out."""

Lines = tuple[tuple[int, ...], ...]


def thumbnail(drawing: Drawing) -> Lines:
    """The contours of a drawing as lines through x, y, x, y, ..., whole numbers from 0 to `SPAN`, y up."""
    drawn = [contour.curve for contour in drawing.contours]
    if not drawn:
        return ()
    boxes = np.array([curves.bounds(curve) for curve in drawn])
    origin = boxes[:, :2].min(axis=0)
    step = max(float((boxes[:, 2:].max(axis=0) - origin).max()), 1e-9) / SPAN
    flat = [_points(curve, step) for curve in drawn]
    places = [np.rint((line - origin) / step).astype(np.int64) for line in thin_lines(flat, 0.4 * step)]
    lines = dict.fromkeys(line for line in map(_written, places) if len(line) > 2)
    return _longest(lines)


def _points(curve: Curve, step: float) -> Array:
    points, _ = curves.flatten(curve, 0.25 * step)
    return np.vstack([points, points[:1]]) if curve.closed else points


def _written(places: Array) -> tuple[int, ...]:
    """The line without points that lie on the one before."""
    kept = np.any(np.diff(places, axis=0, prepend=places[:1] - 1) != 0, axis=1)
    return tuple(map(int, places[kept].ravel()))


def _longest(lines: Iterable[tuple[int, ...]]) -> Lines:
    """The longest lines that are within `MOST_NUMBERS`, in the order of the drawing."""
    lines = list(lines)
    numbers, kept = 0, set()
    for index in sorted(range(len(lines)), key=lambda index: -_extent(lines[index])):
        if numbers + len(lines[index]) <= MOST_NUMBERS:
            numbers += len(lines[index])
            kept.add(index)
    return tuple(line for index, line in enumerate(lines) if index in kept)


def _extent(line: tuple[int, ...]) -> int:
    return max(line[::2]) - min(line[::2]) + max(line[1::2]) - min(line[1::2])
