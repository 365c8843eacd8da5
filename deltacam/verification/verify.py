"""Verification: everything is recomputed from the setpoints, the robot and the drawing.

Nothing of the planner is used here: not its paths, not its time law, not its kerf offset.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Final

from deltacam.model import UNCHECKED, Drawing, Finding, KerfEffect, Mode, Process, Report, Size
from deltacam.program.program import Program
from deltacam.robot.robot import Robot
from deltacam.verification.checks import file
from deltacam.verification.checks.contours import same_drawing
from deltacam.verification.checks.table import OF_COMMON_EDGES, OF_CONTOURS, OF_POSITIONS, OF_SETPOINTS
from deltacam.verification.comparison import Comparison, compare
from deltacam.verification.evidence import Evidence, gather
from deltacam.verification.kerf_effects import kerf_effects
from deltacam.verification.summary import summarize

CONTOUR_CHECKS: Final = (
    "drawing",
    "cuts of drawn contours only",
    "every contour cut once",
    "begins at its contour",
    "deviation at ticks",
    "deviation between ticks",
    "uncut length",
    "cut length",
    "material cut twice",
    "reduced feed",
    "part size",
    "part edge",
    "pierce outside the part",
    "leads outside the part",
    "overcut",
    "tab width",
    "gap at the end of a cut",
    "inner contours first",
    "contours cut last",
)
"""The names of the checks that need the drawing, to say so where there is none."""

COMMON_EDGE_CHECKS: Final = ("parts come free", "shared edges first")
"""The names of those that there are besides where outlines may share edges."""


def verify(
    program: Program, *, drawing: Drawing | None, robot: Robot | None = None, process: Process | None = None
) -> Report:
    """Check a program against its robot, its process and its drawing.

    Args:
        program: as read from a file, or new.
        drawing: what it should cut; None leaves the contours unchecked, which the report says.
        robot: the machine that it will run on; None takes the one in the program.
        process: how the material is to be cut; None takes what is in the program.

    Returns:
        every check with its worst value, limit, tick and place. The findings say which checks were not made.
    """
    evidence = gather(replace(program, process=process or program.process), robot or program.robot)
    checks = [check(evidence) for check in OF_SETPOINTS]
    checks += [file.same_process(program.process, process)] if process else []
    findings = list(drawing.findings) if drawing else []
    other_jerk = file.other_jerk_limit(evidence)
    if other_jerk:
        findings.append(Finding(other_jerk))
    if drawing:
        checks.append(same_drawing(program, drawing))
    sizes: tuple[Size, ...] = ()
    effects: tuple[KerfEffect, ...] = ()
    if evidence.impossible[1]:
        what = "the arms cannot close at some tick, so that nothing about positions was checked"
        findings.append(Finding(what, kind=UNCHECKED))
    else:
        checks += [check(evidence) for check in OF_POSITIONS]
        comparison = _compared(evidence, drawing, findings)
        checks += [check(comparison) for check in OF_CONTOURS if comparison]
        if evidence.program.process.common_edges:
            checks += [check(comparison) for check in OF_COMMON_EDGES if comparison]
        findings += _not_cut_again(comparison)
        sizes = comparison.sizes if comparison else ()
        effects = _effects(comparison) if comparison else ()
    ledger = drawing.ledger if drawing else ()
    summary = summarize(evidence, drawing, checks)
    return Report(tuple(checks), summary, ledger, tuple(findings), sizes, kerf=effects)


def _effects(comparison: Comparison) -> tuple[KerfEffect, ...]:
    """What the kerf does to the contours of the drawing."""
    rings = [target.rings for target in comparison.targets]
    return kerf_effects(comparison.drawing.contours, rings, comparison.evidence.program.process.kerf)


def _not_cut_again(comparison: Comparison | None) -> list[Finding]:
    """What a program that goes on after a stop leaves out."""
    left_out = [one.contour for one in comparison.targets if one not in comparison.due] if comparison else []
    if not left_out:
        return []
    what = f"not checked: {len(left_out)} contours that this program says were cut before"
    return [Finding(what, where=left_out[0].where, hint="look at the sheet before it runs", kind=UNCHECKED)]


def _compared(evidence: Evidence, drawing: Drawing | None, findings: list[Finding]) -> Comparison | None:
    """The program beside its drawing; where that makes no sense, ``findings`` gets the reason."""
    if evidence.program.mode is Mode.FRAME:
        findings.append(Finding("a frame program cuts nothing: its path was not compared with the drawing"))
        return None
    if drawing is None:
        name = evidence.program.drawing.file
        names = CONTOUR_CHECKS + (COMMON_EDGE_CHECKS if evidence.program.process.common_edges else ())
        what = f"not checked without the drawing: {', '.join(names)}"
        findings.append(Finding(what, hint=f"give the drawing: --drawing {name}", kind=UNCHECKED))
        return None
    return compare(evidence, drawing)
