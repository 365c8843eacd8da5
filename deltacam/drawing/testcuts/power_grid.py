"""The power-speed grid: squares that are each cut with a power and a feed of their own.

A program has one process. So every square lies on a layer of its own, and is planned by itself, at its place in the
grid.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.drawing.testcuts.line import ENGRAVED, Line, rectangle
from deltacam.drawing.testcuts.strokes import engraved, width
from deltacam.model import Process

STEPS: Final = 5
"""How many powers and how many feeds, at most."""

_LEAST_POWER: Final = 0.6  # of the largest
_MORE_POWER: Final = 1.2  # the largest power, of that of the process
_FEEDS: Final = (0.6, 1.4)  # of that of the process, where it has no range
_SQUARE: Final = 10e-3
_GAP: Final = 0.6  # of a square
_LETTERS: Final = 3e-3


@dataclass(frozen=True, slots=True)
class Cell:
    """A square of the grid, or its labels.

    Attributes:
        layer: that it lies on, and nothing else does.
        place: of its middle, with the middle of all squares at (0, 0), m.
        power: of the laser's rated power; None for the labels.
        feed: m/s; None for the labels.
    """

    layer: str
    place: tuple[float, float]
    power: float | None = None
    feed: float | None = None


@dataclass(frozen=True, slots=True)
class Grid:
    """The lines of a grid, and what is to be planned one after the other."""

    lines: tuple[Line, ...]
    cells: tuple[Cell, ...]


def power_grid(process: Process) -> Grid:
    """Squares of different powers, upwards, and feeds, to the right, around those of the process.

    The order of the cells is that in which to cut: what is engraved first, then from little power and much speed to
    much power and little speed, which sets fire to things.
    """
    size = max(_SQUARE, 3.0 * process.thickness)
    pitch = (1.0 + _GAP) * size
    squares = [
        (rectangle(_layer(power, feed), column * pitch, row * pitch, size, size), power, feed)
        for row, power in enumerate(powers(process))
        for column, feed in reversed(list(enumerate(feeds(process))))
    ]
    labels = tuple(_labels(process, pitch)) if process.engrave_feed is not None else ()
    middle = 0.5 * ((np.array([len(feeds(process)), len(powers(process))]) - 1) * pitch + size)
    cells = [Cell(line.layer, _middle([line], middle), power, feed) for line, power, feed in squares]
    if labels:
        cells.insert(0, Cell(ENGRAVED, _middle(labels, middle)))
    return Grid((*(line for line, _, _ in squares), *labels), tuple(cells))


def powers(process: Process) -> tuple[float, ...]:
    """The powers of the grid, to a tenth of a percent of the laser's rated power, upwards.

    None is less than the power law allows; where that leaves no room there are fewer than `STEPS`.
    """
    most = min(1.0, _MORE_POWER * process.power)
    least = max(_LEAST_POWER * most, process.power_law.lowest if process.power_law else 0.0, 1e-3)
    return tuple(dict.fromkeys(max(float(f"{value:.3f}"), least) for value in np.linspace(least, most, STEPS)))


def feeds(process: Process) -> tuple[float, ...]:
    """The feeds of the grid, m/s, upwards; in m/min they have three digits. Fewer than `STEPS` where they are alike."""
    low, high = process.feeds or (_FEEDS[0] * process.feed, _FEEDS[1] * process.feed)
    return tuple(dict.fromkeys(float(f"{value * 60.0:.3g}") / 60.0 for value in np.linspace(low, high, STEPS)))


def percent(power: float) -> str:
    """The power in percent, as short as it is exact."""
    return f"{power * 100.0:.4g}"


def metres_per_minute(feed: float) -> str:
    """The feed in m/min, as short as it is exact."""
    return f"{feed * 60.0:.3g}"


def _layer(power: float, feed: float) -> str:
    return f"GRID-P{percent(power)}-F{metres_per_minute(feed)}"


def _labels(process: Process, pitch: float) -> Iterator[Line]:
    """The feed below every column, the power left of every row."""
    for column, feed in enumerate(feeds(process)):
        yield from engraved(metres_per_minute(feed), at=(column * pitch, -2.0 * _LETTERS), height=_LETTERS)
    for row, power in enumerate(powers(process)):
        text = percent(power)
        yield from engraved(text, at=(-width(text, height=_LETTERS) - _LETTERS, row * pitch), height=_LETTERS)


def _middle(lines: list[Line] | tuple[Line, ...], origin: np.ndarray) -> tuple[float, float]:
    points = np.concatenate([line.points for line in lines])
    x, y = 0.5 * (points.min(axis=0) + points.max(axis=0)) - origin
    return round(float(x), 9) + 0.0, round(float(y), 9) + 0.0
