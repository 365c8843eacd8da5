"""The figures of a program that people ask for, by name; the names carry the units."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Final

import numpy as np

from deltacam.geometry.pack import Pack
from deltacam.model import Array, BlockKind, Check, Drawing, Mode, Operation
from deltacam.verification.checks.measure import DIFFERENCES
from deltacam.verification.energy import line_energy, to_j_mm
from deltacam.verification.evidence import KINDS, MOVING_KINDS, Evidence

_SHARES: Final = (
    "joint speed",
    "joint acceleration",
    "joint jerk",
    "tool speed",
    "tool acceleration",
    "feed while cutting",
)


def summarize(evidence: Evidence, drawing: Drawing | None, checks: Sequence[Check]) -> dict[str, Any]:
    """The figures, from the setpoints themselves; those that cannot be known are not there."""
    program, process = evidence.program, evidence.program.process
    figures: dict[str, Any] = {
        "program": {"rows": len(program.q), "rate_hz": evidence.rate, "duration_s": program.duration},
        "mode": program.mode.value,
        "robot": evidence.robot.name,
        "process": process.name,
        "drawing": program.drawing.file,
        "kerf_mm": process.kerf * 1e3,
        "feed_mm_s": process.feed * 1e3,
        "tolerance_um": process.tolerance * 1e6,
        "chord_tolerance_um": process.chord_tolerance * 1e6,
        "contours_cut": _contours(evidence, Operation.CUT),
        "contours_engraved": _contours(evidence, Operation.ENGRAVE),
        "time_s": _times(evidence),
        "share_of_limit": _shares(checks),
    }
    figures |= _lengths(evidence) | _energy(evidence)
    if drawing:
        figures["unit"] = drawing.unit_in_words
        figures["conversion_error_um"] = drawing.conversion_error * 1e6
    if drawing and drawing.contours:
        boxes = Pack.of(contour.curve for contour in drawing.contours).bounds()
        figures["contours_drawn"] = len(drawing.contours)
        figures["part_size_mm"] = _size(boxes.reshape(-1, 2))
    return figures


def _contours(evidence: Evidence, operation: Operation) -> int:
    return len({run.contour for run in evidence.runs if run.operation is operation})


def _shares(checks: Sequence[Check]) -> dict[str, float]:
    """How much of each limit the worst moment uses; 1 is all of it, without what differences may have on top."""
    named = [check for check in checks if check.name in _SHARES]
    return {check.name: check.worst / check.limit * DIFFERENCES for check in named if check.worst and check.limit}


def _times(evidence: Evidence) -> dict[str, float]:
    """Seconds in every kind of block; the last row holds for no time."""
    counts = np.bincount(evidence.kind[:-1], minlength=len(KINDS))
    return {kind.value: float(count / evidence.rate) for kind, count in zip(KINDS, counts, strict=True) if count}


def _lengths(evidence: Evidence) -> dict[str, Any]:
    if not len(evidence.tool):
        return {}
    steps = evidence.speed / evidence.rate
    working = evidence.is_kind(MOVING_KINDS)[:-1]
    engraving = evidence.is_kind(frozenset({BlockKind.ENGRAVE}))[:-1]
    rapid = evidence.is_kind(frozenset({BlockKind.RAPID}))[:-1]
    figures: dict[str, Any] = {
        "cut_length_mm": float(steps[working & ~engraving].sum() * 1e3),
        "engraved_length_mm": float(steps[engraving].sum() * 1e3),
        "rapid_length_mm": float(steps[rapid].sum() * 1e3),
    }
    if working.any():
        figures["path_size_mm"] = _size(evidence.sheet[:-1][working])
    return figures


def _energy(evidence: Evidence) -> dict[str, Any]:
    """The least and the most energy of a millimetre of a cut, times that at the feed; nothing where nothing is cut."""
    if not len(evidence.tool) or evidence.program.mode is not Mode.CUT:
        return {}
    found = line_energy(evidence)
    if not np.isfinite(found).any():
        return {}
    figures = {"least": float(np.nanmin(found)), "most": float(np.nanmax(found))}
    usual = to_j_mm(evidence.program.process)
    return {"line_energy": figures | ({"at_feed_j_mm": usual} if usual else {})}


def _size(points: Array) -> list[float]:
    return [float(extent) * 1e3 for extent in np.ptp(points, axis=0)]
