"""The ways of colouring the path of the tool: by speed, by deviation, by energy, by the nearest limit, by kind."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model import Array, BlockKind, IntArray
from deltacam.report import palette
from deltacam.report.bands import BURNT, bands
from deltacam.report.binding import LIMITS, NEAR, Binding, limit_of
from deltacam.report.palette import Ink
from deltacam.report.picture import colours_of, speed_colours
from deltacam.report.stretches import Choice, largest, most_unusual
from deltacam.units import to_mm, to_um
from deltacam.verification.evidence import KINDS, Evidence

_LEVELS: Final = 8  # of deviation, up to the limit
_ENERGIES: Final = (0.5, 0.8, 0.95, 1.05, 1.25, 1.6, 2.0, 3.0, 5.0)  # times the usual one, between the levels
_USUAL: Final = 4  # the level that holds 1; 0 is where nothing is known


@dataclass(frozen=True, slots=True, eq=False)
class Colouring:
    """One way of colouring the steps of the tool's path.

    Attributes:
        name: on its button.
        title: of its legend.
        inks: the colours, in the order of the legend.
        labels: of the colours; an empty one is not in the legend.
        choice: which of them stands for several steps.
        ramp: whether the colours are in the order of a quantity.
    """

    name: str
    title: str
    inks: Sequence[Ink]
    labels: Sequence[str]
    choice: Choice
    ramp: bool = True


def by_speed(speed: Array, subject: np.ndarray) -> Colouring:
    """The speed of every step, (M,) m/s; the colours are for the steps that are the ``subject``, (M,)."""
    values = to_mm(1.0) * speed
    step, count = speed_colours(values[subject]) if subject.any() else (1.0, 1)
    colour = np.where(subject, colours_of(values, step, count), 0)
    usual = float(np.median(colour[subject])) if subject.any() else 0.0
    labels = [f"{step * i:g}" for i in range(count)]
    return Colouring("Speed", "tool speed, mm/s", palette.speeds(count), labels, most_unusual(colour, usual))


def by_deviation(deviation: Array, tolerance: float, limit: float) -> Colouring:
    """The deviation of every step, (M,) m, nan where it is not known: levels up to the tolerance, m.

    What is over the ``limit``, which is the tolerance and what rounding may add, m, has a colour of its own.
    """
    known = np.isfinite(deviation)
    level = np.clip(np.ceil(np.where(known, deviation, 0.0) * (_LEVELS / tolerance)), 1, _LEVELS)
    colour = np.where(known, np.where(deviation > limit, _LEVELS + 1, level.astype(np.int64)), 0)
    step = to_um(tolerance) / _LEVELS
    over = f"over {to_um(tolerance):.3g}" if (colour > _LEVELS).any() else ""
    labels = ["", *(f"{step * (i + 1):.3g}" for i in range(_LEVELS)), over]
    inks = [palette.BINDING[-1], *palette.deviations(_LEVELS), palette.OVER]
    return Colouring("Deviation", "deviation up to, µm", inks, labels, largest(colour))


def by_energy(energy: Array, usual_j_mm: float) -> Colouring:
    """The energy of the millimetre about every step, (M,) times that at the feed, nan where it is not known.

    Args:
        energy: as `verification.energy.line_energy` gives it.
        usual_j_mm: that at the feed, J/mm; 0 where nobody says what the laser has.
    """
    known = np.isfinite(energy)
    colour = np.where(known, 1 + np.searchsorted(_ENERGIES, np.where(known, energy, 1.0)), 0)
    labels = ["", *(f"{level:g}" for level in _ENERGIES), "more"]
    inks = [palette.BINDING[-1], *palette.energies(_USUAL - 1, len(_ENERGIES) - _USUAL + 1)]
    unit = f"1 is {usual_j_mm:.3g} J/mm" if usual_j_mm else "1 is that at the feed"
    found = most_unusual(np.where(known, colour, _USUAL), float(_USUAL))
    some = largest(known.astype(np.int64))

    def choose(first: IntArray) -> IntArray:
        return np.where(some(first) == 1, found(first), 0)

    return Colouring("Energy", f"energy per mm up to, {unit}", inks, labels, choose)


def by_kind(evidence: Evidence) -> Colouring:
    """What is done at every step with the laser on."""
    kinds = {BlockKind.LEAD_IN: 1, BlockKind.LOOP: 2, BlockKind.OVERCUT: 3, BlockKind.ENGRAVE: 4}
    colour = np.array([kinds.get(kind, 0) for kind in KINDS])[evidence.kind[:-1]]
    there = set(colour[np.isin(bands(evidence), BURNT)].tolist())
    labels = [name if index in there else "" for index, name in enumerate(palette.KINDS)]
    return Colouring("Kind", "with the laser on", list(palette.KINDS.values()), labels, largest(colour), ramp=False)


def by_limit(nearest: Binding) -> Colouring:
    """The limit that is nearest at every step."""
    ranked = nearest.ranked()

    def choose(first: IntArray) -> IntArray:
        return limit_of(np.maximum.reduceat(ranked[:-1], first))

    labels = [*LIMITS, f"none near ({100 * NEAR:.0f} %)"]
    return Colouring("Limit", "nearest limit", palette.BINDING, labels, choose, ramp=False)
