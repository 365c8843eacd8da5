"""Checks of what is left when the beam has passed: the size and the edge of every part, and where it was pierced."""

from __future__ import annotations

from typing import Final

import numpy as np
import shapely

from deltacam.model import BlockKind, Check, IntArray, Size
from deltacam.verification.checks.measure import MICROMETRE, at_contour, at_most
from deltacam.verification.comparison import Comparison
from deltacam.verification.evidence import KINDS
from deltacam.verification.kerf_path import ACCURACY

_BESIDE: Final = frozenset({BlockKind.LEAD_IN, BlockKind.LEAD_OUT, BlockKind.LOOP})


def part_size(comparison: Comparison) -> Check:
    """The area of every part and hole, as an even shift of its edge."""
    return _worst(comparison, "part size", [size.offset for size in comparison.sizes])


def part_edge(comparison: Comparison) -> Check:
    """The edge that the beam leaves of every part and hole, at its worst point."""
    return _worst(comparison, "part edge", [size.edge for size in comparison.sizes])


def pierce_outside(comparison: Comparison) -> Check:
    """No pierce burns into a finished part: it is half a kerf away from all of them, to the tolerance.

    The pierces of open lines are not meant: they lie in the part that they cut into.
    """
    return _outside(comparison, "pierce outside the part", _pierces(comparison))


def leads_outside(comparison: Comparison) -> Check:
    """The same all along every lead and every loop, whatever contour it is said to belong to."""
    evidence = comparison.evidence
    rows = np.flatnonzero(evidence.is_kind(_BESIDE))
    rows = rows[rows < len(evidence.sheet) - 1]
    return _outside(comparison, "leads outside the part", rows, ways=True)


def _outside(comparison: Comparison, name: str, ticks: IntArray, *, ways: bool = False) -> Check:
    """The check that the tool is half a kerf away from all finished parts at some ticks, to the tolerance.

    With ``ways`` that is so all along the way to the next tick.
    """
    evidence = comparison.evidence
    process, parts, places = evidence.program.process, comparison.parts, evidence.sheet[ticks]
    steps = np.stack([places, evidence.sheet[ticks + ways]], axis=1)
    shapes = np.asarray(shapely.linestrings(steps) if ways else shapely.points(places))
    which, part = shapely.STRtree(parts).query(shapes, predicate="dwithin", distance=process.kerf)
    near = np.array(parts, dtype=object)[part]
    away = shapely.distance(shapes[which], near)
    # A way that crosses an edge is as deep in the part as the deeper of its ends.
    ends = [shapely.points(steps[which, end]) for end in range(2)]
    depths = [np.where(shapely.intersects(end, near), shapely.distance(end, shapely.boundary(near)), 0) for end in ends]
    depth = process.kerf / 2.0 - np.where(away > 0.0, away, -np.max(depths, axis=0))
    limit = (process.tolerance + process.chord_tolerance * ways + ACCURACY) * 1e6
    return at_most(evidence, name, depth * 1e6, limit, "um too near", ticks=ticks[which])


def _pierces(comparison: Comparison) -> IntArray:
    """The first tick of every pierce, but those of lines that are cut without a kerf beside them."""
    evidence = comparison.evidence
    lines = {contour.number for contour in comparison.drawing.contours if not contour.has_kerf}
    piercing = evidence.kind == KINDS.index(BlockKind.PIERCE)
    starts = np.flatnonzero(piercing & (np.diff(evidence.program.block, prepend=-1) != 0))
    return np.array([row for row in starts.tolist() if evidence.block_of(row).contour not in lines], dtype=np.int64)


def _worst(comparison: Comparison, name: str, values: list[float]) -> Check:
    """The check that none of the ``values`` of all sizes, m, is beyond the tolerances.

    What the reader lost of the drawing counts as well.
    """
    process, lost = comparison.evidence.program.process, comparison.drawing.conversion_error
    limit = (process.tolerance + process.chord_tolerance + MICROMETRE) * 1e6
    if not values:
        return Check(name, True, limit=limit, unit="um")
    row = int(np.argmax(values))
    worst, size = (values[row] + lost) * 1e6, comparison.sizes[row]
    contour = next(one for one in comparison.drawing.contours if one.number == size.contour)
    check = Check(name, worst <= limit, worst, limit, "um", where=_in_words(contour.where, size), place=size.place)
    return at_contour(check, contour)


def _in_words(where: str, size: Size) -> str:
    x, y = (f"{1e3 * value:.3f}" for value in size.place)
    return f"{where}: {1e6 * size.area:.3f} of {1e6 * size.drawn:.3f} mm2, worst at x {x} y {y} mm"
