"""Measures of all contours of a drawing at once."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from deltacam.geometry.pack import Pack
from deltacam.model import Array, Contour, Drawing, IntArray, Layer, LedgerEntry, Outcome


@dataclass(frozen=True, slots=True, eq=False)
class Measured:
    """All joined contours of a drawing, machined or not, in the order of their numbers.

    Attributes:
        contours: N of them.
        curves: of the contours.
        bounds: smallest x and y, largest x and y of each, (N, 4) m.
        lengths: of each, (N,) m.
        segments: how many lines and arcs each has, (N,).
        arcs: how many of these are arcs, (N,).
    """

    contours: tuple[Contour, ...]
    curves: Pack
    bounds: Array
    lengths: Array
    segments: IntArray
    arcs: IntArray

    @property
    def sizes(self) -> Array:
        """Width and height of each contour, (N, 2) m."""
        return self.bounds[:, 2:] - self.bounds[:, :2]


def measure(drawing: Drawing) -> Measured:
    """The contours of a drawing with their measures."""
    contours = tuple(sorted((*drawing.contours, *drawing.ignored), key=lambda contour: contour.number))
    curves = Pack.of(contour.curve for contour in contours)
    if not contours:
        none = np.zeros(0, dtype=np.int64)
        return Measured(contours, curves, np.zeros((0, 4)), np.zeros(0), none, none)
    arcs = np.add.reduceat((curves.bulges != 0.0).astype(np.int64), curves.first[:-1])
    segments = curves.counts - ~curves.closed
    return Measured(contours, curves, curves.bounds(), curves.lengths(), segments, arcs)


def kind(contour: Contour) -> str:
    """outer, inner or open."""
    if not contour.curve.closed:
        return "open"
    return "inner" if contour.is_hole else "outer"


def kind_in_words(contour: Contour) -> str:
    """How people say it: ``outer``, ``outer in 3``, ``hole in 1``, ``open``."""
    if not contour.curve.closed:
        return "open"
    around = "" if contour.parent is None else f" in {contour.parent}"
    return f"{'hole' if contour.is_hole else 'outer'}{around}"


@dataclass(frozen=True, slots=True)
class LayerUse:
    """A layer with what becomes of its lines.

    Attributes:
        layer: of the drawing.
        operations: of its contours, each once.
        closed: how many closed contours begin on it.
        open: how many open ones.
    """

    layer: Layer
    operations: tuple[str, ...]
    closed: int
    open: int


def layers(drawing: Drawing, measured: Measured) -> list[LayerUse]:
    """The layers of a drawing with the contours that begin on each."""
    on: dict[str, list[Contour]] = {}
    for contour in measured.contours:
        on.setdefault(contour.layer, []).append(contour)
    found = []
    for layer in drawing.layers:
        those = on.get(layer.name, [])
        closed = sum(contour.curve.closed for contour in those)
        operations = tuple(dict.fromkeys(contour.operation.value for contour in those))
        found.append(LayerUse(layer, operations, closed, len(those) - closed))
    return found


def totals(ledger: Iterable[LedgerEntry]) -> dict[str, int]:
    """How many entities there are, and how many had each outcome."""
    counts = Counter(entry.outcome for entry in ledger)
    return {"entities": counts.total(), **{outcome.value: counts[outcome] for outcome in Outcome}}
