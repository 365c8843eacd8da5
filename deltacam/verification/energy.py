"""How much energy every millimetre of a cut gets, beside what the process gives at its feed."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Final

import numpy as np

from deltacam.model import Array, Operation, Process
from deltacam.verification.evidence import ON_PATH_KINDS, Evidence

WINDOW: Final = 1e-3
"""Length of cut over which energy is added up, m."""


def usual_energy(process: Process, operation: Operation) -> float:
    """What a metre gets at the feed and the power of the process, s/m of the rated power.

    Times the rated power of the laser, W, that is J/m. 0 where the process does not say, or has no power.
    """
    if operation is Operation.ENGRAVE:
        return (process.engrave_power or process.power) / (process.engrave_feed or process.feed)
    return process.power / process.feed


def to_j_mm(process: Process) -> float:
    """What a millimetre of a cut gets at the feed, J; 0 where nobody says what the laser has."""
    return 1e-3 * process.laser_power * usual_energy(process, Operation.CUT)


def line_energy(evidence: Evidence) -> Array:
    """The energy of the millimetre about every tick of a cut, as a multiple of the usual one, (N,).

    About the ends of a stretch on the path of a contour it is the first and the last millimetre of it: leads, loops and
    pierces burn the waste. A rest is of all millimetres that hold it.

    Returns:
        nan in rows that are of no such stretch, of one that is shorter than a millimetre, or where nothing is usual.
    """
    process, found = evidence.program.process, np.full(len(evidence.program.q), np.nan)
    step = evidence.speed / evidence.rate
    for first, end, operation in _stretches(evidence):
        rows = slice(first, end)
        way, energy = (
            np.concatenate([[0.0], np.cumsum(one)])
            for one in (step[rows], evidence.program.power[rows] / evidence.rate)
        )
        usual = usual_energy(process, operation)
        if way[-1] < WINDOW or usual == 0.0:
            continue
        start = way[:-1] - 0.5 * WINDOW
        # A rest at an end has no length, so that the energy there is not a function of the place.
        before = np.where(start <= 0.0, 0.0, np.interp(np.minimum(start, way[-1] - WINDOW), way, energy))
        last = start >= way[-1] - WINDOW
        behind = np.where(last, energy[-1], np.interp(np.maximum(start, 0.0) + WINDOW, way, energy))
        found[rows] = (behind - before) / (WINDOW * usual)
    return found


def _stretches(evidence: Evidence) -> Iterator[tuple[int, int, Operation]]:
    """Where the tool is on the path of a contour with the laser on: the first row, and the one after the last."""
    for run in evidence.runs:
        for first, end in evidence.stretches(run, ON_PATH_KINDS):
            yield first, end, run.operation
