"""Generated sheets for the benchmarks of the order: grids, random rings, nested rings, and parts with holes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from deltacam.cutting.beginnings import Beginnings, Place
from deltacam.geometry import curve as curves
from deltacam.model import Curve, Cut

SIZES = (10, 14, 20, 30, 40, 60, 80, 120, 170, 250, 350, 500, 800, 1300, 2000)
KINDS = ("grid", "random", "nested", "mixed")
HALF = 0.14  # m, of the sheet's side
PLACES = 8


class Sheet(NamedTuple):
    """Cuts, the contour around each contour, and the places where each cut may begin."""

    name: str
    cuts: tuple[Cut, ...]
    parents: dict[int, int | None]
    places: tuple[tuple[Place, ...], ...]


def sheets(sizes: tuple[int, ...] = SIZES) -> Iterator[Sheet]:
    """Sheets of all kinds, of every size."""
    for size in sizes:
        for kind in KINDS:
            yield sheet(kind, size)


def sheet(kind: str, size: int) -> Sheet:
    """The sheet of a kind with so many contours, always the same."""
    rng = np.random.default_rng([KINDS.index(kind), size])
    drawn, around = {"grid": _grid, "random": _random, "nested": _nested, "mixed": _mixed}[kind](rng, size)
    cuts = tuple(Cut(contour=n, layer="0", handles=("1",), curve=one) for n, one in enumerate(drawn, start=1))
    parents = {n: None if inside is None else inside + 1 for n, inside in enumerate(around, start=1)}
    return Sheet(f"{kind}-{size}", cuts, parents, tuple(_places(cut) for cut in cuts))


def _places(cut: Cut) -> tuple[Place, ...]:
    """Eight places, evenly spread along a closed cut; both ends of an open one."""
    if not cut.curve.closed:
        first, last = (tuple(point) for point in cut.curve.points[[0, -1]].tolist())
        return Place(first, last), Place(last, first)
    along = np.arange(PLACES) / PLACES * curves.length(cut.curve)
    points = Beginnings([cut]).at(np.zeros(PLACES, dtype=np.int64), along)
    return tuple(Place(point, point) for point in map(tuple, points.tolist()))


def _grid(_: np.random.Generator, size: int) -> tuple[list[Curve], list[int | None]]:
    columns = int(np.ceil(np.sqrt(size)))
    pitch = 2.0 * HALF / columns
    corners = [-HALF + pitch * (np.array(divmod(n, columns))[::-1] + 0.5) for n in range(size)]
    return [_square(corner, 0.35 * pitch, 0.0) for corner in corners], [None] * size


def _random(rng: np.random.Generator, size: int) -> tuple[list[Curve], list[int | None]]:
    radius = HALF / np.sqrt(size) * rng.uniform(0.1, 0.8, size)
    return [curves.circle(rng.uniform(-HALF, HALF, 2), one) for one in radius], [None] * size


def _nested(rng: np.random.Generator, size: int) -> tuple[list[Curve], list[int | None]]:
    """Stacks of up to five rings in each other."""
    drawn: list[Curve] = []
    around: list[int | None] = []
    stacks = max(2, size // 4)
    centres = _spread(rng, stacks)
    room = 0.9 * HALF / np.sqrt(stacks)
    for n in range(size):
        stack, depth = n % stacks, n // stacks
        drawn.append(curves.circle(centres[stack], room * 0.75**depth))
        around.append(n - stacks if depth else None)
    return drawn, around


def _mixed(rng: np.random.Generator, size: int) -> tuple[list[Curve], list[int | None]]:
    """Plates with holes and open slits, holes with nothing around them, turned anyhow."""
    drawn: list[Curve] = []
    around: list[int | None] = []
    plates = max(1, size // 8)
    centres, room = _spread(rng, plates), 0.8 * HALF / np.sqrt(plates)
    for centre in centres:
        drawn.append(_square(centre, room * rng.uniform(0.6, 1.0), rng.uniform(0.0, np.pi)))
        around.append(None)
    while len(drawn) < size:
        plate = int(rng.integers(plates))
        centre = centres[plate] + rng.uniform(-0.4, 0.4, 2) * room
        if rng.random() < 0.15:
            step = rng.normal(0.0, 0.1 * room, 2)
            drawn.append(Curve(points=np.array([centre - step, centre + step]), bulges=np.zeros(1), closed=False))
        else:
            drawn.append(curves.circle(centre, room * rng.uniform(0.02, 0.1)))
        around.append(plate)
    return drawn, around


def _spread(rng: np.random.Generator, count: int) -> np.ndarray:
    """Places on a grid, a little off."""
    columns = int(np.ceil(np.sqrt(count)))
    pitch = 2.0 * HALF / columns
    cells = rng.permutation(columns * columns)[:count]
    return -HALF + pitch * (np.stack(np.divmod(cells, columns), axis=1) + 0.5 + rng.uniform(-0.1, 0.1, (count, 2)))


def _square(centre: np.ndarray, half: float, turn: float) -> Curve:
    corners = half * np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return curves.transform(curves.polygon(corners), rotation=turn, shift=tuple(centre.tolist()))
