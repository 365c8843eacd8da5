"""The check that small holes and small bends are cut as slowly as the process wants them, computed from the drawing."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final, NamedTuple

import numpy as np
import shapely

from deltacam.model import Array, BoolArray, Check, Contour, IntArray, Operation, Process
from deltacam.verification.checks.measure import DIFFERENCES, at_most
from deltacam.verification.comparison import Comparison, Target
from deltacam.verification.evidence import ON_PATH_KINDS, Evidence
from deltacam.verification.kerf_path import flattened

NAME: Final = "reduced feed"

_CORNER: Final = np.radians(20.0)  # a line that turns by more at a point has a corner there, and no bend
_SURE: Final = 0.98  # of the radius of a rule: so much are radii of three points of a line known


class _Found(NamedTuple):
    """Ticks (M,), the speed from each to the next (M,) m/s, and what it may be (M,) m/s."""

    ticks: IntArray
    speed: Array
    limit: Array


def reduced_feed(comparison: Comparison) -> Check:
    """The speed in holes and bends for which the process has a rule, where it is nearest to what the rule allows.

    The steps at the ends of a bend do not count: there the tool may be beside it by both tolerances.
    """
    evidence, process = comparison.evidence, comparison.evidence.program.process
    found = [one for target in comparison.targets for one in _of_target(evidence, target, process)]
    if not sum(len(one.ticks) for one in found):
        return at_most(evidence, NAME, np.empty(0), None, "mm/s")
    ticks, speed, limit = (np.concatenate(part) for part in zip(*found, strict=True))
    worst = int(np.argmax(speed / limit))
    allowed = float(limit[worst]) * DIFFERENCES * 1e3
    return at_most(evidence, NAME, speed[[worst]] * 1e3, allowed, "mm/s", ticks=ticks[[worst]])


def _of_target(evidence: Evidence, target: Target, process: Process) -> Iterator[_Found]:
    """What is cut of a contour under the rules that match it."""
    contour = target.contour
    if contour.operation is not Operation.CUT or not process.slower or not target.runs:
        return
    spans = [span for run in target.runs for span in evidence.stretches(run, ON_PATH_KINDS)]
    ticks = np.concatenate([np.empty(0, dtype=np.int64), *(np.arange(first, end) for first, end in spans)])
    line = flattened(contour)
    if contour.has_kerf and contour.is_hole and len(line) > 2:
        size = 2.0 * np.sqrt(shapely.Polygon(line).area / np.pi)
        for rule in process.slower:
            if rule.diameter is not None and size <= rule.diameter:
                yield _under(evidence, ticks, rule.factor * process.feed)
    for rule in process.slower:
        if rule.radius is not None:
            inside = _in_bends(evidence, contour, line, ticks, rule.radius, process)
            yield _under(evidence, ticks[inside], rule.factor * process.feed)


def _under(evidence: Evidence, ticks: IntArray, limit: float) -> _Found:
    return _Found(ticks, evidence.speed[ticks], np.full(len(ticks), limit))


def _in_bends(
    evidence: Evidence, contour: Contour, line: Array, ticks: IntArray, radius: float, process: Process
) -> BoolArray:
    """Whether the tool is beside a bend of up to that radius at ticks (M,) and at the next ones, (M,)."""
    points = np.concatenate([line, line[:2]]) if contour.curve.closed else line
    bends = _bends(points, _SURE * radius)
    if not len(bends) or not len(ticks):
        return np.zeros(len(ticks), dtype=np.bool_)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    margin = 2.0 * (process.tolerance + process.chord_tolerance)
    pieces = shapely.STRtree(shapely.linestrings(np.stack([points[:-1], points[1:]], axis=1)))
    places = [_along(pieces, points, way, evidence.sheet[ticks + after]) for after in (0, 1)]
    # A bend at the seam of a closed line is taken for two.
    inside = np.zeros(len(ticks), dtype=np.bool_)
    for low, high in zip(way[bends[:, 0]] + margin, way[bends[:, 1]] - margin, strict=True):
        inside |= (places[0] > low) & (places[0] < high) & (places[1] > low) & (places[1] < high)
    return inside


def _bends(points: Array, radius: float) -> IntArray:
    """The first and the last of the points (N, 2) m of every bend of a line, (K, 2).

    A bend is of points at which the circle through them and the points beside them is no larger than the radius.
    """
    before, behind = points[1:-1] - points[:-2], points[2:] - points[1:-1]
    cross = before[:, 0] * behind[:, 1] - before[:, 1] * behind[:, 0]
    turn = np.abs(np.arctan2(cross, np.sum(before * behind, axis=1)))
    chord = np.hypot(*(before + behind).T)
    bent = (chord <= 2.0 * radius * np.sin(turn)) & (turn <= _CORNER)
    edges = np.flatnonzero(np.diff(np.concatenate([[False, False], bent, [False]]).astype(np.int64)))
    return np.stack([edges[::2], edges[1::2] - 1], axis=1)


def _along(pieces: shapely.STRtree, points: Array, way: Array, places: Array) -> Array:
    """How far along a line, m from its start, the point of it is that is nearest to each of the ``places`` (N, 2) m."""
    piece = pieces.query_nearest(shapely.points(places), all_matches=False)[1]
    step = points[piece + 1] - points[piece]
    square = np.maximum(np.sum(step**2, axis=1), 1e-30)
    share = np.clip(np.sum((places - points[piece]) * step, axis=1) / square, 0.0, 1.0)
    return np.asarray(way[piece] + share * (way[piece + 1] - way[piece]))
