"""Checks of the way of the tool against the kerf path: on it, all of it, once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from deltacam.model import Array, BlockKind, BoolArray, Check, IntArray, Operation
from deltacam.verification.checks.measure import at_contour, at_most, at_tick
from deltacam.verification.comparison import Comparison, Target
from deltacam.verification.evidence import MOVING_KINDS, Evidence, to_sheet
from deltacam.verification.kerf_path import ACCURACY, all_corners, flattened, sharp_corners
from deltacam.verification.near import SPACING, Lines
from deltacam.verification.sharing import Beside
from deltacam.verification.way import motion

_LOOPS: Final = frozenset({BlockKind.LOOP})
_TABS: Final = frozenset({BlockKind.TAB})
_ALONG_KINDS: Final = frozenset({BlockKind.CUT, BlockKind.ENGRAVE}) | _TABS

LENGTH_TOLERANCE: Final = 0.02
"""How much longer or shorter than its kerf path a cut may be, beside what the tolerances allow."""


def deviation(comparison: Comparison) -> Check:
    """How far the tool is from the path of the contour that it cuts or engraves, at every tick with the laser on."""
    limit = comparison.evidence.program.process.tolerance
    evidence = comparison.evidence
    rows = [_joined([evidence.on_path(run) for run in target.runs]) for target in comparison.targets]
    return _worst_distance(comparison, "deviation at ticks", rows, evidence.sheet, limit)


def deviation_between(comparison: Comparison) -> Check:
    """The same half-way between the ticks, where the controller interpolates the joints."""
    evidence = comparison.evidence
    process = evidence.program.process
    limit = process.tolerance + process.chord_tolerance
    rows = [_joined([_between(evidence.on_path(run)) for run in target.runs]) for target in comparison.targets]
    places = to_sheet(evidence.program, evidence.between)
    return _worst_distance(comparison, "deviation between ticks", rows, places, limit)


def uncut(comparison: Comparison) -> Check:
    """How much of the path no cut or engraving comes near, in total; nothing may stay.

    Where outlines share an edge, one cut serves both.

    Near is the tolerance of the path and of its chords. A corner that is rounded within the tolerance stays further
    from its tip, by the inverse of the sine of half the angle between its sides.
    """
    process = comparison.evidence.program.process
    near = process.tolerance + process.chord_tolerance + ACCURACY
    found = [(*_uncut(comparison.evidence, target, near), target.contour) for target in comparison.due]
    total = 1e3 * sum(left for left, _, _ in found)
    if not total:
        return Check("uncut length", True, 0.0, 0.0, "mm")
    left, (x, y), contour = max(found, key=lambda one: one[0])
    words = f"{contour.where}: {1e3 * left:.3f} mm, from x {1e3 * x:.3f} y {1e3 * y:.3f} mm"
    return at_contour(Check("uncut length", False, total, 0.0, "mm", where=words, place=(x, y)), contour)


def cut_length(comparison: Comparison) -> Check:
    """No cut is longer or shorter than its path, beyond what a curve within the tolerances can be."""
    process = comparison.evidence.program.process
    name, limit = "cut length", LENGTH_TOLERANCE * 100.0
    worst = Check(name, True, 0.0, limit, "% off")
    for target in comparison.targets:
        slack = _length_slack(target) * (process.tolerance + process.chord_tolerance)
        closed = [ring if not target.contour.curve.closed else np.vstack([ring, ring[:1]]) for ring in target.rings]
        passes = process.passes if target.contour.operation is Operation.CUT else 1
        nominal = passes * sum(_length(line) for line in closed)
        length, unclear = _length_along(comparison.evidence, target)
        if target.open_runs:
            own, more = _own_length(comparison.evidence, target)
            nominal, unclear = passes * own, unclear + passes * more
        off = max(abs(length - nominal) - slack - unclear, 0.0) / nominal if nominal else float(length > 0.0)
        percent = 100.0 * off
        if target.runs and percent > (worst.worst or 0.0):
            words = f"{target.contour.where}: {1e3 * length:.3f} mm for {1e3 * nominal:.3f} mm"
            passed, tick = percent <= limit, target.runs[0].first
            worst = at_tick(comparison.evidence, name, passed, percent, limit, "% off", tick=tick, where=words)
    return worst


def _length_along(evidence: Evidence, target: Target) -> tuple[float, float]:
    """How long the cuts of a contour are, tabs included, and how far that is unclear, m.

    A cut begins and ends between two ticks where a lead, a loop or an overcut is beside it.
    """
    length, unclear = 0.0, 0.0
    for run in target.runs:
        for first, end in evidence.stretches(run, _ALONG_KINDS):
            length += _length(evidence.sheet[first : end + 1])
            beside = [first - 1] * (first > run.begin) + [end - 1]
            unclear += float(evidence.speed[beside].sum()) / evidence.rate
    return length, unclear


def _own_length(evidence: Evidence, target: Target) -> tuple[float, float]:
    """How much of its path the cuts of a contour come near, and how far that is unclear at their ends, m."""
    process = evidence.program.process
    near = process.tolerance + process.chord_tolerance + ACCURACY
    mine = own_part(evidence, target, near)
    own = 0.0 if target.path is None else float(target.path.share[mine].sum())
    return own, 2.0 * len(target.runs) * (near + SPACING)


def own_part(evidence: Evidence, target: Target, near: float) -> BoolArray:
    """Which samples of its path the cuts of a contour come ``near``, m."""
    samples = np.empty((0, 2)) if target.path is None else target.path.samples
    cuts = [span for run in target.runs for span in evidence.stretches(run, MOVING_KINDS)]
    return np.asarray(_lines(evidence, cuts, near).distance(samples, exact_above=near / 2.0) <= near)


def _length_slack(target: Target) -> float:
    """How much longer or shorter a curve at the distance d beside the path may be, in multiples of d.

    That is 2 pi for a closed curve that does not cross itself. The shortest way past a corner within d of its tip is
    straight; where the path turns by t, it is shorter by 2 d tan(t / 4).
    """
    corners = [sharp_corners(ring, closed=target.contour.curve.closed) for ring in target.rings]
    return float(2.0 * np.pi + 2.0 * sum(np.tan(turn / 4.0).sum() for _, turn in corners))


def _length(line: Array) -> float:
    return float(np.hypot(*np.diff(line, axis=0).T).sum())


def _joined(ticks: list[IntArray]) -> IntArray:
    return np.concatenate([np.empty(0, dtype=np.int64), *ticks])


def _between(ticks: IntArray) -> IntArray:
    """Those of the ticks that the next tick follows."""
    return np.asarray(ticks[:-1][np.diff(ticks) == 1])


def _worst_distance(comparison: Comparison, name: str, rows: list[IntArray], places: Array, limit: float) -> Check:
    """The check that the ``places`` (N, 2) at the ``rows`` of each target are within ``limit`` m of its path.

    What the reader lost of the drawing counts as distance, because the limit is from the exact kerf path.
    """
    found = [np.empty(0)]
    ticks = [np.empty(0, dtype=np.int64)]
    for target, cut in zip(comparison.targets, rows, strict=True):
        if target.path is not None and len(cut):
            found.append(target.path.distance(places[cut], exact_above=limit / 2.0))
            ticks.append(cut)
    values = (np.concatenate(found) + comparison.drawing.conversion_error) * 1e6
    at = np.concatenate(ticks)
    return at_most(comparison.evidence, name, values, (limit + ACCURACY) * 1e6, "um", ticks=at)


def _uncut(evidence: Evidence, target: Target, near: float) -> tuple[float, tuple[float, float]]:
    """The length of a target's path that no cut of it comes ``near``, m, and where it starts."""
    if target.path is None:
        return 0.0, (0.0, 0.0)  # `cut_once` reports it
    samples, share = target.path.samples, target.path.share
    cuts = [span for run in target.runs for span in evidence.stretches(run, MOVING_KINDS)]
    if not cuts:
        return float(share.sum()), (float(samples[0, 0]), float(samples[0, 1]))
    distance = _lines(evidence, cuts, near, target.beside).distance(samples, exact_above=near / 2.0)
    left = np.flatnonzero(distance > near)
    tabs = [span for run in target.runs for span in evidence.stretches(run, _TABS)]
    if tabs and len(left):
        left = left[_lines(evidence, tabs, near).distance(samples[left], exact_above=near / 2.0) > near]
    left = left[~_in_rounded_corner(target, samples[left], distance[left], near)]
    if target.open_runs or any(evidence.stretches(run, _LOOPS) for run in target.runs):
        left = left[~_burnt_at_corner(evidence, target, samples[left], distance[left], near)]
    if not len(left):
        return 0.0, (0.0, 0.0)
    return float(share[left].sum()), (float(samples[left[0], 0]), float(samples[left[0], 1]))


def _burnt_at_corner(evidence: Evidence, target: Target, points: Array, distance: Array, near: float) -> np.ndarray:
    """Which ``points`` (M, 2) of a round about a drawn corner are burnt by the beam, whose way passes at ``distance``.

    A loop goes straight on where the path turns about the corner, and back from the other side. Where both sides of a
    corner are shared, two cuts end where the round begins and ends: its middle is then further away, and `parts_free`
    looks at what is left there.
    """
    half = evidence.program.process.kerf / 2.0
    tips, turns = sharp_corners(flattened(target.contour), closed=target.contour.curve.closed)
    if not len(points) or not len(tips):
        return np.zeros(len(points), dtype=bool)
    away, tip = cKDTree(tips).query(points)
    reach = np.maximum(half, 2.0 * half * np.sin(turns[tip] / 4.0) + near) if target.open_runs else half
    return np.asarray((away <= half + near) & (distance <= reach))


def _lines(evidence: Evidence, spans: list[tuple[int, int]], near: float, others: Sequence[Beside] = ()) -> Lines:
    ways = [motion(evidence, first, end, near / 8.0) for first, end in spans]
    return Lines([*ways, *(way for cut in others for way in cut.ways)], closed=False)


def _in_rounded_corner(target: Target, points: Array, distance: Array, near: float) -> np.ndarray:
    """Which ``points`` (M, 2) lie so close to a sharp corner that rounding it may leave them at ``distance``, (M,)."""
    if not len(points):
        return np.zeros(0, dtype=bool)
    corners, turns = all_corners(target.rings, closed=target.contour.curve.closed)
    if not len(corners):
        return np.zeros(len(points), dtype=bool)
    half = turns / 2.0
    away, corner = cKDTree(corners).query(points)
    return np.asarray((away <= near * (1.0 + np.tan(half[corner]))) & (distance <= near / np.cos(half[corner])))
