"""What the script of the page gets: the series, the blocks and the figures, as one JSON text."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Final

import numpy as np

from deltacam.model import Array, BlockKind, Drawing, Mode
from deltacam.plain import plain
from deltacam.report.bands import BESIDE, BURNT, DARK, TWICE, bands
from deltacam.report.binding import LIMITS, Binding, binding, limit_of
from deltacam.report.colouring import Colouring, by_deviation, by_energy, by_kind, by_limit, by_speed
from deltacam.report.figures import Json, packed
from deltacam.report.motion import Motion, deviations, motion_of
from deltacam.report.motion_figure import deviation_figure, motion_figure
from deltacam.report.palette import BINDING, Ink
from deltacam.report.part_figure import part_figure, route
from deltacam.report.samples import Sampling
from deltacam.report.view import View
from deltacam.report.workspace_figure import workspace_figure
from deltacam.units import to_mm, to_um
from deltacam.verification.energy import line_energy, to_j_mm
from deltacam.verification.evidence import Evidence
from deltacam.verification.kerf_path import ACCURACY

_QUANTITIES: Final = ("angle", "joint speed", "joint acceleration", "joint jerk")


def payload(evidence: Evidence, drawing: Drawing | None, view: View) -> tuple[Json, list[Ink]]:
    """The data of the page, and the colours that it uses besides the fixed ones of the palette."""
    motion = motion_of(evidence)
    nearest = binding(evidence, motion)
    deviation, energy = _deviations(evidence, drawing), _energies(evidence)
    sampling = Sampling.of(len(evidence.program.q))
    tolerance = evidence.program.process.tolerance
    limit = tolerance + ACCURACY
    data: Json = {
        "ticks": sampling.ticks,
        "step": sampling.step,
        "rate": evidence.rate,
        "series": _series(sampling, motion, nearest, deviation, evidence, energy),
        "blocks": _blocks(sampling, evidence),
        "limit": packed(limit_of(sampling.largest(nearest.ranked())), "u1"),
        "part": part_figure(evidence, drawing, view),
        "motion": motion_figure(evidence, motion, energy),
        "workspace": workspace_figure(evidence, drawing, view),
        "limits": list(LIMITS),
        "binding": [ink.light for ink in BINDING],
    }
    colourings: list[Colouring] = []
    if len(evidence.sheet) > 1:
        band = bands(evidence)
        subject = np.isin(band, BURNT)
        colourings = [by_speed(motion.speed[:-1], subject), by_limit(nearest)]
        if energy is not None:
            colourings.insert(1, by_energy(energy[:-1], to_j_mm(evidence.program.process)))
        if deviation is not None:
            colourings.insert(1, by_deviation(deviation[:-1], tolerance, limit))
        if np.isin(band, (BESIDE, TWICE, DARK)).any():
            colourings.append(by_kind(evidence))
        data["place"] = [packed(sampling.at_first(to_mm(1.0) * column)) for column in evidence.sheet.T]
        data["route"] = route(evidence, colourings, view, exact=sampling.step == 1)
    if deviation is not None:
        data["deviation"] = deviation_figure(deviation, limit, float(motion.worked[-1]))
    data["colourings"] = [_legend(colouring) for colouring in colourings]
    return data, [ink for colouring in colourings for ink in colouring.inks]


def to_script(data: Json) -> str:
    """JSON that may stand in a script element: ASCII only, and nothing in it opens or closes an element."""
    text = json.dumps(data, allow_nan=False, separators=(",", ":"), sort_keys=True)
    return text.replace("<", "\\u003c").replace(">", "\\u003e").replace("&", "\\u0026")


def _deviations(evidence: Evidence, drawing: Drawing | None) -> Array | None:
    """The deviation at every tick, (N,) m; None where there is nothing that it could be of."""
    if drawing is None or not len(evidence.sheet) or evidence.program.mode is Mode.FRAME:
        return None
    found = deviations(evidence, drawing)
    return found if np.isfinite(found).any() else None


def _energies(evidence: Evidence) -> Array | None:
    """The energy of the millimetre about every tick, (N,); None where nothing is cut."""
    if not len(evidence.sheet) or evidence.program.mode is not Mode.CUT:
        return None
    found = line_energy(evidence)
    return found if np.isfinite(found).any() else None


def _series(
    sampling: Sampling,
    motion: Motion,
    nearest: Binding,
    deviation: Array | None,
    evidence: Evidence,
    energy: Array | None,
) -> Json:
    """By name the smallest and the largest values of every sample, or the values alone."""

    def all_of() -> Iterator[tuple[str, Array]]:
        yield "share", 100.0 * nearest.share
        for name, values in zip(_QUANTITIES, motion.joints, strict=True):
            yield from ((f"{name} {i + 1}", np.degrees(values[i])) for i in range(3))
        if len(motion.speed):
            yield "speed", to_mm(1.0) * motion.speed
            yield "worked", to_mm(1.0) * motion.worked
        if deviation is not None:
            yield "deviation", to_um(1.0) * deviation
        if energy is not None:
            yield "energy", energy
            yield "power", 100.0 * evidence.program.power

    return {name: [packed(part) for part in sampling.extremes(values)] for name, values in all_of()}


def _blocks(sampling: Sampling, evidence: Evidence) -> Json:
    """What is done at every sample: ``at`` indexes ``of``, whose last entry is for rows without a block."""
    program = evidence.program
    names: dict[str, int] = {}
    of = [
        [
            block.kind.value.replace("_", " "),
            block.contour,
            names.setdefault(plain(block.layer), len(names)),
            plain(block.handles[0]) if block.handles else "",
        ]
        for block in program.blocks
    ]
    at = sampling.at_first(program.block)
    known = (at >= 0) & (at < len(of))
    of.append([BlockKind.RAPID.value, None, 0, ""])
    return {"at": packed(np.where(known, at, len(of) - 1), "u4"), "of": of, "layers": list(names) or [""]}


def _legend(colouring: Colouring) -> Json:
    return {
        "name": colouring.name,
        "title": colouring.title,
        "colors": [ink.light for ink in colouring.inks],
        "labels": list(colouring.labels),
        "ramp": colouring.ramp,
    }
