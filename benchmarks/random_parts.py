"""Sheets of random parts with holes, each line of a kind, for the benchmark of leads."""

from __future__ import annotations

import io
from collections.abc import Iterator
from typing import Any, Final, NamedTuple

import ezdxf
import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve

PER_SHEET: Final = 10
KINDS: Final = ("rectangle", "star", "blob", "gear", "slot", "circle", "tiny hole")
_WEB: Final = 0.8  # mm of material between lines, at least


class Drawn(NamedTuple):
    """A closed line of a sheet, mm, with bulges, (N, 3), and what kind it is."""

    vertices: Array
    kind: str


def shape(kind: str, size: float, chance: np.random.Generator) -> Array:
    """The vertices of a line of a kind about the origin that fits into a circle of ``size`` mm diameter."""
    half = 0.5 * size
    if kind == "rectangle":
        ratio = chance.uniform(0.4, 1.0)
        x = half / np.hypot(1.0, ratio)
        return np.array([[-x, -x * ratio, 0], [x, -x * ratio, 0], [x, x * ratio, 0], [-x, x * ratio, 0]])
    if kind == "slot":
        width = chance.uniform(0.2, 0.6) * size
        x, y = 0.5 * (size - width), 0.5 * width
        return np.array([[-x, -y, 0], [x, -y, 1], [x, y, 0], [-x, y, 1]])
    if kind in ("circle", "tiny hole"):
        return np.array([[half, 0, 1], [-half, 0, 1]])
    if kind == "gear":
        count = int(chance.integers(8, 25))
        angle = 2.0 * np.pi * (np.arange(4 * count) + np.tile([0.0, 0.1, 0.0, 0.1], count)) / (4 * count)
        radius = half * np.tile([0.84, 1.0, 1.0, 0.84], count)
        bulge = np.tile([0.0, np.tan(np.pi / (8 * count)), 0.0, np.tan(np.pi / (8 * count))], count)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle), bulge], axis=1)
    count = int(chance.integers(3, 13))
    angle = 2.0 * np.pi * (np.arange(count) + chance.uniform(-0.2, 0.2, count)) / count
    radius = half * chance.uniform(0.6, 0.95, count)
    bulge = np.zeros(count) if kind == "star" else chance.uniform(-0.06, 0.12, count)
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), bulge], axis=1)


def sheet(chance: np.random.Generator, room: float) -> list[Drawn]:
    """The lines of a sheet that is at most ``room`` mm wide and deep: parts in rows, with holes in the larger ones."""
    gap, found = float(chance.uniform(1.0, 10.0)), list[Drawn]()
    x = y = depth = 0.0
    while len(found) < PER_SHEET:
        kind = str(chance.choice(KINDS[:-1]))
        size = float(np.exp(chance.uniform(np.log(4.0), np.log(0.45 * room))))
        if x + size > room:
            x, y, depth = 0.0, y + depth + gap, 0.0
        if y + size > room:
            size, kind = min(8.0, size), "circle"
        found.append(placed(kind, size, (x + 0.5 * size, y + 0.5 * size), chance))
        if size > 12.0:
            free = _area(found[-1]).buffer(-_WEB)
            for hole in _holes((x + 0.5 * size, y + 0.5 * size), size, gap, PER_SHEET - len(found), chance):
                if free.contains(_area(hole)):
                    free = free.difference(_area(hole).buffer(_WEB))
                    found.append(hole)
        x, depth = x + size + gap, max(depth, size)
    return found


def placed(kind: str, size: float, centre: tuple[float, float], chance: np.random.Generator) -> Drawn:
    """A line of a kind, turned at random, about a place, mm."""
    turn = chance.uniform(0.0, 2.0 * np.pi)
    own = shape(kind, size, chance)
    cos, sin = np.cos(turn), np.sin(turn)
    own[:, :2] = own[:, :2] @ np.array([[cos, sin], [-sin, cos]]) + centre
    return Drawn(own, kind)


def _area(line: Drawn) -> Any:
    """The polygon that a line surrounds, mm."""
    curve = Curve(points=line.vertices[:, :2], bulges=line.vertices[:, 2])
    return shapely.Polygon(curves.flatten(curve, 1e-3)[0])


def _holes(
    centre: tuple[float, float], size: float, gap: float, most: int, chance: np.random.Generator
) -> Iterator[Drawn]:
    """Holes on a circle in a part, which has no vertex nearer to its centre than 0.2 of its size."""
    inner = 0.17 * size
    for index in range(min(most, int(chance.integers(0, 6)))):
        kind = str(chance.choice(KINDS[1:]))
        largest = 0.9 * inner if kind != "tiny hole" else 1.5
        own = float(np.exp(chance.uniform(np.log(0.8), np.log(max(largest, 0.9)))))
        if index == 0 and chance.random() < 0.4:
            yield placed(kind, min(1.6 * inner, 60.0), centre, chance)
            return
        angle = 2.0 * np.pi * index / 6.0
        arm = 0.55 * inner if own < 0.5 * inner - 0.5 * min(gap, 1.0) else None
        if arm is not None:
            yield placed(kind, own, (centre[0] + arm * np.cos(angle), centre[1] + arm * np.sin(angle)), chance)


def content(lines: list[Drawn]) -> bytes:
    """The bytes of a DXF file of closed lines."""
    document = ezdxf.new("R2000")
    document.header["$INSUNITS"] = 4
    for line in lines:
        document.modelspace().add_lwpolyline(line.vertices.tolist(), format="xyb", close=True)
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()
