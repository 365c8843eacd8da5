"""Curves as the data of SVG paths: arcs stay arcs."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.geometry.pack import Pack
from deltacam.model import Array, BoolArray, IntArray

_WIDEST: Final = 0.5
"""Largest bulge that is written as one arc, a little over a quarter turn: with ends rounded to a grain, the middle of a
half circle could be anywhere."""


@dataclass(frozen=True, slots=True)
class Grid:
    """The whole numbers that the data is written in.

    Attributes:
        origin: (x, y) m, which is written 0, 0.
        grain: m; ends lie on whole grains.
        fine: whether every segment is written; else those that stay within a grain are left out.
    """

    origin: tuple[float, float]
    grain: float
    fine: bool = True


def path_data(curves: Pack, grid: Grid) -> list[str]:
    """The data of each curve, in grains, y up; with ``grid.fine`` not set, curves that look the same are left out."""
    if not len(curves):
        return []
    points, bulges, curve = _split(curves)
    places = np.rint((points - grid.origin) / grid.grain).astype(np.int64)
    if not grid.fine:
        places, bulges, curve = _coarse(places, bulges, curve)
    data = _written(places, bulges, curve, curves.closed)
    return data if grid.fine else list(dict.fromkeys(data))


def _split(curves: Pack) -> tuple[Array, Array, IntArray]:
    """The vertices with their bulges and their curves; wide arcs are halved."""
    points, bulges = np.asarray(curves.points), curves.bulges.copy()
    curve = np.repeat(np.arange(len(curves)), curves.counts)
    while np.any(wide := np.abs(bulges) > _WIDEST):
        after = points[_next(curve)]
        step = after[wide] - points[wide]
        # The middle of an arc rises over the middle of its chord by bulge x half the chord, to the right.
        right = np.column_stack([step[:, 1], -step[:, 0]])
        middle = points[wide] + 0.5 * (step + bulges[wide, None] * right)
        bulges[wide] = np.tan(0.5 * np.arctan(bulges[wide]))
        place = np.flatnonzero(wide) + 1
        points = np.insert(points, place, middle, axis=0)
        curve = np.insert(curve, place, curve[wide])
        bulges = np.insert(bulges, place, bulges[wide])
    return points, bulges, curve


def _next(curve: IntArray) -> IntArray:
    """For each vertex the next one of its curve, around to the first."""
    after = np.arange(1, len(curve) + 1)
    last = np.flatnonzero(np.diff(curve, append=-1))
    after[last] = np.concatenate([[0], last[:-1] + 1])
    return after


def _coarse(places: IntArray, bulges: Array, curve: IntArray) -> tuple[IntArray, Array, IntArray]:
    """Without the vertices that lie in the same grain as the one before, and with flat arcs as lines."""
    first = np.diff(curve, prepend=-1) != 0
    kept = first | np.any(np.diff(places, axis=0, prepend=0) != 0, axis=1)
    places, bulges, curve = places[kept], bulges[kept], curve[kept]
    chord = np.hypot(*(places[_next(curve)] - places).T)
    return places, np.where(0.5 * np.abs(bulges) * chord < 0.5, 0.0, bulges), curve


def _written(places: IntArray, bulges: Array, curve: IntArray, closed: BoolArray) -> list[str]:
    """One text per curve."""
    steps = places[_next(curve)] - places
    chord = np.hypot(*steps.T)
    rise = 4.0 * np.abs(bulges)
    radius = np.divide(chord * (1.0 + bulges**2), rise, out=np.zeros_like(chord), where=rise > 0.0)
    first = np.flatnonzero(np.diff(curve, prepend=-1))
    last = np.append(first[1:], len(curve)) - 1
    rows = list(zip(steps.tolist(), bulges.tolist(), radius.tolist(), strict=True))
    starts = places[first].tolist()
    data = []
    for (x, y), low, high, around in zip(starts, first.tolist(), last.tolist(), closed.tolist(), strict=True):
        # An open curve ends at its last vertex. The way back to the start is drawn by z, unless it is an arc.
        stop = high + 1 if around and rows[high][1] != 0.0 else high
        data.append(f"M{x} {y}{_segments(rows[low:stop])}{'z' if around else ''}")
    return data


def _segments(rows: list[tuple[list[int], float, float]]) -> str:
    """Relative lines and arcs; a letter is only written where it changes."""
    parts, letter = [], ""
    for (x, y), bulge, radius in rows:
        if bulge == 0.0:
            sign, own = f"{x} {y}", "l"
        else:
            sign, own = f"{radius:.6g} {radius:.6g} 0 0 {int(bulge > 0.0)} {x} {y}", "a"
        parts.append(f"{own if own != letter else ' '}{sign}")
        letter = own
    return "".join(parts).replace(" -", "-")
