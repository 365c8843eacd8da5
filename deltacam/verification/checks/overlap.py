"""The check that no stretch is cut again."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from deltacam.model import Array, BlockKind, Check, IntArray
from deltacam.verification.checks.measure import at_tick
from deltacam.verification.comparison import Comparison, Target
from deltacam.verification.evidence import KINDS, WORKING_KINDS, Evidence
from deltacam.verification.kerf_path import ACCURACY
from deltacam.verification.near import Lines
from deltacam.verification.runs import Run
from deltacam.verification.sharing import burnt

LONGEST: Final = 1.0e-3
"""Length that may be cut again, m: less cannot be told from the ends of cuts."""

_SPACING: Final = 0.1e-3  # m, of samples along a way
_RADIUS: Final = 0.5e-3  # m, of the circle in which the lengths of way and drawing are compared
_BEYOND: Final = (KINDS.index(BlockKind.OVERCUT), KINDS.index(BlockKind.LEAD_OUT))
_AGAIN: Final = 0.6  # of the circle's width: so much more way than drawn is a second pass


def cut_again(comparison: Comparison) -> Check:
    """How much of the way with the laser on runs where it has been before, and the drawing has nothing for it.

    Around every 0.1 mm of way the length of all ways is compared with that of all kerf paths: two sides of a narrow web
    or of a sharp corner are near each other in both. Of an outline that shares edges its own cuts are drawn, so that an
    edge which serves two counts once. The last step before an overcut or a lead-out is left out: within it the cut
    comes back to its start.
    """
    evidence, name, limit = comparison.evidence, "material cut twice", LONGEST * 1e3
    spans = [span for run in evidence.runs for span in _spans(evidence, run)]
    if not spans:
        return Check(name, True, 0.0, limit, "mm")
    found = [_evenly(evidence.sheet[first : end + 1]) for first, end in spans]
    samples = np.concatenate([points for points, _ in found])
    ticks = np.concatenate([first + steps for (first, _), (_, steps) in zip(spans, found, strict=True)])
    near = evidence.program.process.tolerance + evidence.program.process.chord_tolerance + ACCURACY
    drawn = np.concatenate([np.empty((0, 2)), *(_drawn(evidence, target, near) for target in comparison.targets)])
    once, passes = 2.0 * _RADIUS / _SPACING, evidence.program.process.passes
    passed = _near(samples, samples) - _AGAIN * once
    again = np.flatnonzero(passed > passes * once)
    again = again[passed[again] > passes * _near(samples[again], drawn)]
    # Both passes are counted where they lie on each other, so that half of it is what was cut again.
    length, tick = len(again) * _SPACING * 1e3 / 2.0, int(ticks[again[-1]]) if len(again) else None
    return at_tick(evidence, name, length <= limit, length, limit, "mm", tick=tick)


def _spans(evidence: Evidence, run: Run) -> list[tuple[int, int]]:
    """Where a run cuts or engraves: the tick at which each stretch begins, and the one until which it counts."""
    return [
        (first, end - 1 if evidence.kind[end] in _BEYOND else end)
        for first, end in evidence.stretches(run, frozenset(WORKING_KINDS))
        if end - first > 1
    ]


def _drawn(evidence: Evidence, target: Target, near: float) -> Array:
    """Points along the path of a contour, (N, 2) m; of one that shares edges where its own cuts come ``near``."""
    closed = target.contour.curve.closed
    rings = [_evenly(np.vstack([ring, ring[:1]]) if closed else ring)[0] for ring in target.rings]
    points = np.concatenate([np.empty((0, 2)), *rings])
    if not target.open_runs:
        return points
    own = Lines([way for run in target.runs for way in burnt(evidence, run)], closed=False)
    return points[own.distance(points, exact_above=near / 2.0) <= near]


def _near(places: Array, samples: Array) -> Array:
    """How many of the ``samples`` (M, 2) are within `_RADIUS` of each of the ``places`` (N, 2): (N,)."""
    if not len(samples):
        return np.zeros(len(places))
    return np.asarray(
        cKDTree(samples).query_ball_point(places, _RADIUS, return_length=True, workers=-1), dtype=np.float64
    )


def _evenly(line: Array) -> tuple[Array, IntArray]:
    """Points along a polyline (K, 2) m, about `_SPACING` apart, and the step of the line that each is on."""
    steps = np.hypot(*np.diff(line, axis=0).T)
    ends = np.concatenate([[0.0], np.cumsum(steps)])
    count = max(round(ends[-1] / _SPACING), 1)
    at = (np.arange(count) + 0.5) * ends[-1] / count
    points = np.stack([np.interp(at, ends, line[:, 0]), np.interp(at, ends, line[:, 1])], axis=1)
    return points, np.searchsorted(ends, at, side="right") - 1
