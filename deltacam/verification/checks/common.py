"""Checks of edges that two outlines share: the parts come free, and the cut that serves both comes first."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import shapely
from shapely import Polygon

from deltacam.model import Array, Check, Size
from deltacam.verification.checks.measure import MICROMETRE, at_contour, at_tick
from deltacam.verification.comparison import Comparison, Target
from deltacam.verification.kerf_path import ACCURACY, flattened, quarter_sides
from deltacam.verification.near import Lines
from deltacam.verification.sharing import burnt


def parts_free(comparison: Comparison) -> Check:
    """The sheet without what the beam takes away has a piece that is the part, for every outline that shares edges.

    Others are cut around by a cut that comes back to where it started.
    """
    name, sizes = "parts come free", {size.contour: size for size in comparison.sizes}
    bound = [one for one in comparison.targets if one.open_runs and not _is_free(comparison, one, sizes)]
    check = Check(name, not bound, float(len(bound)), 0.0, "parts")
    if not bound:
        return check
    return at_contour(
        replace(check, where=f"{bound[0].contour.where} hangs together with what is beside it"), bound[0].contour
    )


def _is_free(comparison: Comparison, target: Target, sizes: dict[int, Size]) -> bool:
    """Whether the part inside an outline is a piece of its own, and no larger or smaller than it should be."""
    evidence, process = comparison.evidence, comparison.evidence.program.process
    drawn, half = Polygon(flattened(target.contour)), process.kerf / 2.0
    ways = [way for run in target.runs for way in burnt(evidence, run)]
    ways += [way for cut in target.beside for way in cut.ways]
    lines = [shapely.LineString(way) for way in ways if len(way) > 1]
    swept = shapely.union_all(shapely.buffer(lines, half, quad_segs=quarter_sides(half)))
    window = shapely.box(*drawn.bounds).buffer(2.0 * process.kerf, join_style="mitre")
    pieces = np.array(shapely.get_parts(window.difference(swept)))
    if not len(pieces):
        return False
    piece = pieces[int(np.argmax(shapely.area(shapely.intersection(pieces, drawn))))]
    limit = (process.tolerance + process.chord_tolerance + MICROMETRE) * drawn.length
    exact = sizes[target.contour.number].exact
    return not piece.intersects(window.boundary) and abs(piece.area - exact) <= limit


def shared_first(comparison: Comparison) -> Check:
    """What is left of an outline is cut after the edges that it shares: its last cut frees it, and none comes later."""
    evidence, name = comparison.evidence, "shared edges first"
    late = [target for target in comparison.targets if target.open_runs and _waits_for_nobody(comparison, target)]
    tick = late[0].runs[0].first if late else None
    words = f"{late[0].contour.where} before an edge that it shares" if late else ""
    return at_tick(evidence, name, not late, float(len(late)), 0.0, "contours", tick=tick, where=words)


def _waits_for_nobody(comparison: Comparison, target: Target) -> bool:
    """Whether a part of the path of a target is cut only for another one, and that after its own first cut."""
    evidence, process = comparison.evidence, comparison.evidence.program.process
    near = process.tolerance + process.chord_tolerance + ACCURACY
    if target.path is None:
        return False
    own = [way for run in target.runs for way in burnt(evidence, run)]
    first = target.runs[0].begin
    before = [way for cut in target.beside if cut.run is None or cut.run.end <= first for way in cut.ways]
    later = [way for cut in target.beside if cut.run is not None and cut.run.end > first for way in cut.ways]
    samples = target.path.samples
    for ways in (own, before):
        samples = samples[_away(ways, samples, near) > near]
    return bool((_away(later, samples, near) <= near).any())


def _away(ways: Sequence[Array], points: Array, near: float) -> Array:
    """How far points (N, 2) are from ways, (N,) m; infinite where there are none."""
    if not ways or not len(points):
        return np.full(len(points), np.inf)
    return Lines(ways, closed=False).distance(points, exact_above=near / 2.0)
