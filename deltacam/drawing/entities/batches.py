"""The numbers of many simple shapes, traced all at once.

Lines, circles, arcs, ellipses and polylines are most of every drawing. Their numbers are gathered while the entities
are walked, and become curves as arrays. A matrix, (3, 3), takes them to the directions of the sheet: [x y z] @ matrix,
metres. Everything else, and whatever a matrix makes an ellipse of, is traced shape by shape.
"""

from __future__ import annotations

import math
from array import array
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from functools import partial
from typing import Final

import numpy as np

from deltacam.drawing.entities import polylines, shapes, traces
from deltacam.drawing.entities.polylines import Polylines
from deltacam.drawing.entities.traces import Trace, Traces
from deltacam.model import Array, IntArray

WHOLE: Final = 2.0 * math.pi
"""The span of a full circle or ellipse."""


@dataclass(slots=True)
class Gathered:
    """What the entities of one layout or block draw, in its own coordinates, by sort.

    Attributes:
        segments: six numbers for each line: start and end.
        segment_of: the index of the entity that each is of.
        conics: eleven numbers for each stretch of an ellipse centre + u cos t + v sin t: centre, u, v, the first t and
            how far t runs, rad.
        conic_of: the index of the entity that each is of.
        polylines: those in planes of constant z.
        singles: the others, with the index of their entity and the matrix (3, 3) from their coordinates.
        wide: the indices of entities with a width.
        guessed: the indices of splines of which the file gives only points to run through.
    """

    segments: array[float] = field(default_factory=lambda: array("d"))
    segment_of: array[int] = field(default_factory=lambda: array("q"))
    conics: array[float] = field(default_factory=lambda: array("d"))
    conic_of: array[int] = field(default_factory=lambda: array("q"))
    polylines: Polylines = field(default_factory=Polylines)
    singles: list[tuple[int, shapes.Shape, Array]] = field(default_factory=list)
    wide: list[int] = field(default_factory=list)
    guessed: list[int] = field(default_factory=list)


@dataclass(slots=True)
class Traced:
    """The curves of a layout or block, and why other entities have none.

    Attributes:
        parts: the curves, batch by batch.
        points: the indices of entities that are a single point.
        lost: what is wrong with entities that cannot be traced, by index.
    """

    parts: list[Traces] = field(default_factory=list)
    points: list[int] = field(default_factory=list)
    lost: dict[int, str] = field(default_factory=dict)

    def curves(self) -> Traces:
        """All curves in the order of their entities."""
        return traces.merge(self.parts)

    def single(self, shapes_of: Iterable[tuple[int, Callable[[], Trace | None]]]) -> None:
        """Traces shapes one by one."""
        owners: list[int] = []
        found: list[Trace] = []
        for i, draw in shapes_of:
            try:
                one = draw()
            except ValueError as error:
                self.lost[i] = str(error)
                continue
            if one is None:
                self.points.append(i)
            else:
                owners.append(i)
                found.append(one)
        self.parts.append(traces.of(owners, found))


def trace(gathered: Gathered, matrix: Array) -> Traced:
    """The curves of everything gathered; lines, circles and arcs stay exact.

    Args:
        gathered: in its own coordinates.
        matrix: (3, 3) to the directions of the sheet, m.
    """
    result = Traced()
    # Absurd numbers overflow without a word here; what comes out is checked once it is in its place.
    with np.errstate(all="ignore"):
        _segments(gathered, matrix, result)
        _polylines(gathered, matrix, result)
        _conics(gathered, matrix, result)
        result.single((i, partial(shapes.trace, shape, own @ matrix)) for i, shape, own in gathered.singles)
    return result


def _segments(gathered: Gathered, matrix: Array, result: Traced) -> None:
    """The lines."""
    points = np.frombuffer(gathered.segments, dtype=np.float64).reshape(-1, 3) @ matrix
    many = len(points) // 2
    height = points[:, 2].reshape(-1, 2)
    result.parts.append(
        Traces(
            owner=np.array(gathered.segment_of, dtype=np.int64),
            points=np.ascontiguousarray(points[:, :2]),
            bulges=np.zeros(2 * many),
            counts=np.full(many, 2),
            closed=np.zeros(many, dtype=np.bool_),
            heights=np.sort(height, axis=1),
            errors=np.zeros(many),
        )
    )


def _conics(gathered: Gathered, matrix: Array, result: Traced) -> None:
    """The circles and arcs, exact where the matrix keeps them round, and the ellipses."""
    numbers = np.frombuffer(gathered.conics, dtype=np.float64).reshape(-1, 11)
    owner = np.array(gathered.conic_of, dtype=np.int64)
    frames = numbers[:, :9].reshape(-1, 3, 3) @ matrix
    start, span = numbers[:, 9], numbers[:, 10]
    lift = np.hypot(frames[:, 1, 2], frames[:, 2, 2])
    heights = frames[:, 0, 2, None] + lift[:, None] * np.array([-1.0, 1.0])
    flat = frames[:, :, :2]
    a, b = np.hypot(*flat[:, 1].T), np.hypot(*flat[:, 2].T)
    skew = np.abs(np.sum(flat[:, 1] * flat[:, 2], axis=1))
    squeezed = (np.abs(a - b) > shapes.ROUND) | (skew > shapes.ROUND * np.maximum(a, b))
    rest = np.flatnonzero(squeezed)
    result.single(
        (int(owner[i]), partial(shapes.trace_ellipse, flat[i], float(start[i]), float(span[i]), tuple(heights[i])))
        for i in rest
    )
    kept = np.flatnonzero(~squeezed)
    if len(kept):
        result.parts.append(_arcs(owner[kept], flat[kept], start[kept], span[kept], heights[kept]))


def _arcs(owner: IntArray, frames: Array, start: Array, span: Array, heights: Array) -> Traces:
    """Circular arcs in halves where they turn by more than half a turn; whole circles are closed.

    Args:
        owner: (N,).
        frames: (N, 3, 2) m, centre and two equal radii at right angles.
        start: (N,) rad.
        span: (N,) rad.
        heights: (N, 2) m.
    """
    whole = span >= WHOLE
    pieces = np.where(span > math.pi, 2, 1)
    counts = np.where(whole, 2, pieces + 1)
    which = np.repeat(np.arange(len(span)), counts)
    step = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
    angle = start[which] + span[which] * step / pieces[which]
    centre, u, v = frames[which].transpose(1, 0, 2)
    turn = np.sign(frames[:, 1, 0] * frames[:, 2, 1] - frames[:, 1, 1] * frames[:, 2, 0])
    bulge = turn * np.where(whole, 1.0, np.tan(0.25 * span / pieces))
    return Traces(
        owner=owner,
        points=centre + np.cos(angle)[:, None] * u + np.sin(angle)[:, None] * v,
        bulges=np.where(step < pieces[which], bulge[which], 0.0),
        counts=counts,
        closed=whole,
        heights=heights,
        errors=np.zeros(len(owner)),
    )


def _polylines(gathered: Gathered, matrix: Array, result: Traced) -> None:
    """The polylines in planes of constant z."""
    curves, squeezed, empty = polylines.trace(gathered.polylines, matrix)
    if curves is not None:
        result.parts.append(curves)
    result.points += empty
    result.single((i, partial(shapes.trace, lines, matrix)) for i, lines in squeezed)
