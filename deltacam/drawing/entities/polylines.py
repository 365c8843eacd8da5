"""Many polylines in planes of constant z, traced all at once."""

from __future__ import annotations

from array import array
from dataclasses import dataclass, field

import numpy as np

from deltacam.drawing.entities import shapes
from deltacam.drawing.entities.traces import Traces
from deltacam.model import Array, BoolArray, IntArray


@dataclass(slots=True)
class Polylines:
    """Polylines as the file gives them.

    Attributes:
        vertices: (N, 5) numbers for each: x, y, two widths, bulge.
        planes: three numbers for each: z, 1 or -1 for one that is seen from below, whether it is closed.
        owner: the index of the entity that each is of.
    """

    vertices: list[Array] = field(default_factory=list)
    planes: array[float] = field(default_factory=lambda: array("d"))
    owner: array[int] = field(default_factory=lambda: array("q"))

    def add(self, owner: int, vertices: Array, z: float, up: float, *, closed: bool) -> None:
        """Adds the polyline of one entity."""
        self.planes.extend((z, up, float(closed)))
        self.vertices.append(vertices)
        self.owner.append(owner)


@dataclass(frozen=True, slots=True, eq=False)
class _Clean:
    """M polylines without repeated vertices.

    Attributes:
        owner: (M,).
        points: (P, 3).
        bulges: (P,); 0 for the last vertex of an open one.
        counts: (M,) > 1.
        closed: (M,).
    """

    owner: IntArray
    points: Array
    bulges: Array
    counts: IntArray
    closed: BoolArray


def trace(raw: Polylines, matrix: Array) -> tuple[Traces | None, list[tuple[int, shapes.Lines]], list[int]]:
    """The curves of polylines, exact where the matrix keeps their arcs round.

    Args:
        raw: in their own coordinates.
        matrix: (3, 3) to the directions of the sheet, m.

    Returns:
        the curves; the polylines whose arcs become ellipses; the owners of those that are a single point.
    """
    clean, empty = _without_repeats(raw)
    if not len(clean.owner):
        return None, [], empty
    first = np.cumsum(clean.counts) - clean.counts
    reach = np.maximum.reduceat(_arc_lengths(clean, matrix), first)
    stretch = np.linalg.svd(matrix[:2, :2], compute_uv=False)
    squeezed = reach * (1.0 - stretch[1] / stretch[0] if stretch[0] > 0.0 else 1.0) > shapes.ROUND
    rest = [(int(clean.owner[i]), _lines(clean, i, first[i])) for i in np.flatnonzero(squeezed).tolist()]
    points = clean.points @ matrix
    # An arc that is not level reaches beyond the heights of its ends by less than its length.
    lift = reach * (float(np.hypot(*matrix[:2, 2])) / stretch[0] if stretch[0] > 0.0 else 0.0)
    heights = np.stack([np.minimum.reduceat(points[:, 2], first), np.maximum.reduceat(points[:, 2], first)], axis=1)
    curves = Traces(
        owner=clean.owner,
        points=points[:, :2],
        bulges=clean.bulges * np.sign(np.linalg.det(matrix[:2, :2])),
        counts=clean.counts,
        closed=clean.closed,
        heights=heights + lift[:, None] * np.array([-1.0, 1.0]),
        errors=np.zeros(len(clean.owner)),
    )
    if squeezed.any():
        curves = curves.take(np.flatnonzero(~squeezed))
    return _moderate(curves), rest, empty


def _without_repeats(raw: Polylines) -> tuple[_Clean, list[int]]:
    """The polylines without repeated vertices, and the owners of those that are a single point."""
    counts = np.array([len(each) for each in raw.vertices], dtype=np.int64)
    numbers = np.concatenate([np.empty((0, 5)), *raw.vertices])
    planes = np.frombuffer(raw.planes, dtype=np.float64).reshape(-1, 3)
    owner, closed = np.array(raw.owner, dtype=np.int64), planes[:, 2] > 0.0
    which = np.repeat(np.arange(len(counts)), counts)
    after = np.arange(1, len(numbers) + 1)
    held = counts > 0
    last = np.cumsum(counts)[held] - 1
    after[last] = np.where(closed[held], last - counts[held] + 1, last)
    keep = (numbers[after, :2] != numbers[:, :2]).any(axis=1)
    keep[last[~closed[held]]] = True
    counts = np.bincount(which[keep], minlength=len(counts))
    long = counts > 1
    keep &= long[which]
    empty = owner[~long].tolist()
    numbers, which, counts = numbers[keep], which[keep], counts[long]
    up = planes[which, 1]
    points = np.column_stack([numbers[:, 0] * up, numbers[:, 1], planes[which, 0] * up])
    bulges = numbers[:, 4] * up
    closed = closed[long]
    bulges[(np.cumsum(counts) - 1)[~closed]] = 0.0
    return _Clean(owner[long], points, bulges, counts, closed), empty


def _arc_lengths(clean: _Clean, matrix: Array) -> Array:
    """How long the arc that leaves each vertex may be in the sheet, (P,) m; 0 for a line."""
    arcs = np.flatnonzero(clean.bulges)
    reach = np.zeros(len(clean.points))
    if len(arcs):
        chord = np.hypot(*(clean.points[_next(clean.counts)[arcs], :2] - clean.points[arcs, :2]).T)
        half = 2.0 * np.arctan(np.abs(clean.bulges[arcs]))
        reach[arcs] = chord / np.sinc(half / np.pi) * np.linalg.norm(matrix[:2, :2], 2)
    return reach


def _next(counts: IntArray) -> IntArray:
    """The vertex after each one, the first after the last, (P,)."""
    after = np.arange(1, int(counts.sum()) + 1)
    after[np.cumsum(counts) - 1] -= counts
    return after


def _lines(clean: _Clean, i: int, first: int) -> shapes.Lines:
    """Polyline ``i`` for itself."""
    part = slice(first, first + int(clean.counts[i]))
    closed = bool(clean.closed[i])
    return shapes.Lines(clean.points[part], clean.bulges[part][: None if closed else -1], closed=closed)


def _moderate(curves: Traces) -> Traces:
    """The same curves with every arc of more than half a turn split in two."""
    wide = np.flatnonzero(np.abs(curves.bulges) > 1.0)
    if not len(wide):
        return curves
    chord = curves.points[_next(curves.counts)[wide]] - curves.points[wide]
    bulge = curves.bulges[wide]
    # An arc rises over its chord by half the chord times its bulge, to the right where it turns left.
    rise = 0.5 * bulge[:, None] * np.stack([chord[:, 1], -chord[:, 0]], axis=1)
    half = np.tan(0.5 * np.arctan(bulge))
    bulges = curves.bulges.copy()
    bulges[wide] = half
    which = np.repeat(np.arange(len(curves)), curves.counts)
    return Traces(
        curves.owner,
        np.insert(curves.points, wide + 1, curves.points[wide] + 0.5 * chord + rise, axis=0),
        np.insert(bulges, wide + 1, half),
        curves.counts + np.bincount(which[wide], minlength=len(curves)),
        curves.closed,
        curves.heights,
        curves.errors,
    )
