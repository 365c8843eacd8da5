"""Checks of the cuts against the contours of the drawing: all of them, once, and in an order that drops no part."""

from __future__ import annotations

import numpy as np
import shapely

from deltacam.model import Check, Drawing, Operation
from deltacam.program.program import Program
from deltacam.verification.checks.measure import at_contour, at_most, at_tick
from deltacam.verification.comparison import Comparison, Target
from deltacam.verification.evidence import Evidence
from deltacam.verification.runs import Run
from deltacam.verification.sharing import burnt


def same_drawing(program: Program, drawing: Drawing) -> Check:
    """The drawing is the one that was planned, read at the same scale and with the same layers and rules."""
    planned, given = program.drawing, drawing
    problems = []
    if planned.sha256 != given.sha256:
        problems.append(f"planned from {planned.file}, checked against {given.file}, whose bytes differ")
    if planned.metres_per_unit != given.metres_per_unit:
        problems.append(f"planned at {planned.metres_per_unit:g} m per unit, read at {given.metres_per_unit:g}")
    if program.selection != given.selection:
        problems.append("it was read with other layers, rules or joining than it was planned with")
    return Check("drawing", not problems, where="; ".join(problems))


def known_contours(comparison: Comparison) -> Check:
    """Every cut is of a contour that the drawing has for cutting, and what is engraved is there for engraving."""
    known: set[tuple[int | None, Operation]] = {(one.number, one.operation) for one in comparison.drawing.contours}
    strange = [run for run in comparison.evidence.runs if (run.contour, run.operation) not in known]
    tick = strange[0].first if strange else None
    count = float(len(strange))
    return at_tick(comparison.evidence, "cuts of drawn contours only", not strange, count, 0.0, "cuts", tick=tick)


def cut_once(comparison: Comparison) -> Check:
    """Every contour is cut or engraved exactly once: as many times as its path has rings, and it has at least one.

    Of an outline that shares edges there are any number of cuts that do not go around instead of at least one that
    does. In a program that goes on after a stop there may be contours that are not cut again.
    """
    wrong = [target for target in comparison.due if not _is_cut_once(target)]
    name, unit = "every contour cut once", "contours"
    if not wrong:
        return Check(name, True, 0.0, 0.0, unit)
    first, count = wrong[0], float(len(wrong))
    words = f"{first.contour.where}: {len(first.runs)} cuts of {len(first.rings)} rings"
    tick = first.runs[-1].first if first.runs else None
    found = at_tick(comparison.evidence, name, False, count, 0.0, unit, tick=tick, where=words)
    return at_contour(found, first.contour)


def _is_cut_once(target: Target) -> bool:
    around = len(target.runs) - len(target.open_runs)
    return around < len(target.rings) if target.open_runs else around == len(target.rings) > 0


def resumed(comparison: Comparison) -> Check:
    """A program that goes on after a stop begins with the contour that it says."""
    evidence, name = comparison.evidence, "begins at its contour"
    contour, runs = evidence.program.from_contour, evidence.runs
    if contour is None or (runs and runs[0].contour == contour):
        return Check(name, True)
    tick = runs[0].first if runs else None
    return at_tick(evidence, name, False, tick=tick, where=f"said to go on from contour {contour}")


def closed(comparison: Comparison) -> Check:
    """The cut of a closed contour, with its overcut, comes back to where it started.

    What is left of one that shares edges begins and ends on another cut.
    """
    evidence = comparison.evidence
    closed_ones = [target for target in comparison.targets if target.contour.curve.closed]
    runs = [run for target in closed_ones for run in target.runs]
    gaps = [
        _away(evidence, target, run) if run in target.open_runs else _gap(evidence, run)
        for target in closed_ones
        for run in target.runs
    ]
    limit, ticks = evidence.program.process.tolerance, np.array([run.end for run in runs], dtype=np.int64)
    return at_most(evidence, "gap at the end of a cut", np.array(gaps) * 1e6, limit * 1e6, "um", ticks=ticks)


def _gap(evidence: Evidence, run: Run) -> float:
    """How far the second half of a run stays from where the run starts, m.

    Where a lead-in comes before it, the cut starts somewhere on the way to its first tick, and the end of an overcut
    lies beyond that tick.
    """
    led = run.begin < run.first
    start = evidence.sheet[[run.first - led, run.first, run.first + led]]
    way = evidence.sheet[(run.first + run.end) // 2 : run.end + 1]
    return float(shapely.distance(shapely.LineString(start), shapely.LineString(np.concatenate([way, way[-1:]]))))


def _away(evidence: Evidence, target: Target, run: Run) -> float:
    """How far the ends of a run that does not go around are from other cuts, m."""
    ways = [way for cut in target.beside for way in cut.ways]
    ways += [way for one in target.runs if one != run for way in burnt(evidence, one)]
    if not ways:
        return _gap(evidence, run)
    ends = shapely.points(evidence.sheet[[run.first, run.end]])
    return float(shapely.distance(shapely.multilinestrings([*map(shapely.LineString, ways)]), ends).max())


def holes_first(comparison: Comparison) -> Check:
    """A contour is cut after everything that it contains, which would lie loose otherwise."""
    targets = {target.contour.number: target for target in comparison.targets}
    wrong = []
    for target in comparison.targets:
        around = targets.get(target.contour.parent or 0)
        while around and not (around.contour.has_kerf and around.runs):
            around = targets.get(around.contour.parent or 0)
        if around and target.runs and target.runs[-1].end > around.runs[0].first:
            wrong.append((around.runs[0].first, f"{around.contour.where} before {target.contour.where}"))
    tick, words = min(wrong) if wrong else (None, "")
    name, count = "inner contours first", float(len(wrong))
    return at_tick(comparison.evidence, name, not wrong, count, 0.0, "contours", tick=tick, where=words)


def contours_last(comparison: Comparison) -> Check:
    """Nothing is engraved after the first cut, and no open line is cut after the first contour: parts may be loose."""
    open_ones = {target.contour.number for target in comparison.targets if not target.contour.curve.closed}
    runs = comparison.evidence.runs
    stage = np.array(
        [0 if run.operation is Operation.ENGRAVE else 1 if run.contour in open_ones else 2 for run in runs],
        dtype=np.int64,
    )
    late = np.flatnonzero(stage < np.maximum.accumulate(stage))
    tick = runs[late[0]].first if len(late) else None
    words = "" if tick is None else f"{runs[late[0]].operation} after cuts: {comparison.evidence.place(tick)}"
    name, count = "contours cut last", float(len(late))
    return at_tick(comparison.evidence, name, not len(late), count, 0.0, "cuts", tick=tick, where=words)
