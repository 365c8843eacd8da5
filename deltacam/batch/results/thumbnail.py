"""A drawing as a few lines through whole numbers: small enough to keep for thousands of parts."""

from __future__ import annotations

from itertools import pairwise
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve, Drawing
from deltacam.report.thin import thin_lines

SPAN: Final = 160
"""The longer side of the picture, in steps."""

MOST_NUMBERS: Final = 2_000
"""Numbers of one thumbnail; a drawing with more is drawn more coarsely, and in the end without its shortest lines."""

_TOLERANCES: Final = (0.4, 0.8, 1.6)  # steps
_MARGIN: Final = 2  # steps around the picture, so that also a straight line has an area

Lines = tuple[tuple[int, ...], ...]


def thumbnail(drawing: Drawing) -> Lines:
    """The contours of a drawing as lines through x, y, x, y, ..., whole numbers from 0 to `SPAN`, y up.

    Where all of them are ignored, for instance because they do not close, it is these.
    """
    drawn = [contour.curve for contour in drawing.contours or drawing.ignored]
    if not drawn:
        return ()
    boxes = np.array([curves.bounds(curve) for curve in drawn])
    origin = boxes[:, :2].min(axis=0)
    step = max(float((boxes[:, 2:].max(axis=0) - origin).max()), 1e-9) / SPAN
    flat = [_points(curve, step) for curve in drawn]
    lines: Lines = ()
    for tolerance in _TOLERANCES:
        places = [np.rint((line - origin) / step).astype(np.int64) for line in thin_lines(flat, tolerance * step)]
        lines = tuple(dict.fromkeys(map(_written, places)))
        if sum(map(len, lines)) <= MOST_NUMBERS:
            return lines
    return _longest(lines)


def to_svg(lines: Lines) -> str:
    """The picture in SVG: what the closed lines enclose is an area; without lines it is empty.

    Its style sheet says how wide the lines are; they are numbers only, so nothing needs to be escaped.
    """
    width, height = (max((max(line[axis::2]) for line in lines), default=SPAN) for axis in (0, 1))
    box = f"{-_MARGIN} {-_MARGIN} {width + 2 * _MARGIN} {height + 2 * _MARGIN}"
    rings = [len(line) > 4 and line[:2] == line[-2:] for line in lines]
    closed = "".join(_path(line[:-2], height) + "z" for line, ring in zip(lines, rings, strict=True) if ring)
    others = "".join(_path(line, height) for line, ring in zip(lines, rings, strict=True) if not ring)
    area = f'<path class="area" d="{closed}"/>' if closed else ""
    open_ones = f'<path d="{others}"/>' if others else ""
    return f'<svg viewBox="{box}" aria-hidden="true">{area}{open_ones}</svg>'


def _path(line: tuple[int, ...], height: int) -> str:
    """The line in SVG, y down, every point after the first relative to the one before: that is shortest."""
    x, y = line[::2], [height - value for value in line[1::2]]
    steps = [value - before for pair in zip(pairwise(x), pairwise(y), strict=True) for before, value in pair]
    return f"M{x[0]} {y[0]}l" + " ".join(map(str, steps)).replace(" -", "-")


def _points(curve: Curve, step: float) -> Array:
    points, _ = curves.flatten(curve, 0.25 * step)
    return np.vstack([points, points[:1]]) if curve.closed else points


def _written(places: Array) -> tuple[int, ...]:
    """The line without points that lie on the one before; a point, which a tiny hole becomes, is there twice."""
    kept = np.any(np.diff(places, axis=0, prepend=places[:1] - 1) != 0, axis=1)
    numbers = tuple(map(int, places[kept].ravel()))
    return numbers if len(numbers) > 2 else numbers * 2


def _longest(lines: Lines) -> Lines:
    """The longest lines that are within `MOST_NUMBERS`, in the order of the drawing."""
    numbers, kept = 0, set()
    for index in sorted(range(len(lines)), key=lambda index: -_extent(lines[index])):
        if numbers + len(lines[index]) <= MOST_NUMBERS:
            numbers += len(lines[index])
            kept.add(index)
    return tuple(line for index, line in enumerate(lines) if index in kept)


def _extent(line: tuple[int, ...]) -> int:
    return max(line[::2]) - min(line[::2]) + max(line[1::2]) - min(line[1::2])
