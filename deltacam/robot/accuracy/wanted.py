"""What the errors must be for a wanted accuracy in x and y."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import brentq

from deltacam.model import Array
from deltacam.robot.accuracy.budget import Budget
from deltacam.robot.accuracy.draws import draw, usual
from deltacam.robot.accuracy.sensitivity import tool_by_error
from deltacam.robot.accuracy.sources import PER_ARM, Source, columns_of, limit_per_given
from deltacam.robot.robot import Robot

_TOLERANCE: Final = 1e-4  # of a limit that is searched, a part of the largest it can be


@dataclass(frozen=True, slots=True)
class Need:
    """How large the errors of one source may be, given as in `Errors`, rad or m.

    Attributes:
        source: which.
        alone: if there were no other errors.
        beside_others: with all others as they are; None where those alone are too much.
        scaled: if all are made smaller, or may be larger, by one factor.
        equal: if every source that is not zero does the same at the tool.
    """

    source: Source
    alone: float
    beside_others: float | None
    scaled: float
    equal: float


@dataclass(frozen=True, slots=True)
class Needs:
    """What the errors must be for a wanted accuracy.

    Attributes:
        wanted: 95 % of all machines stay within it in x and y, at every place of the sheet, m.
        factor: by which all errors change in ``scaled``; None where none of them moves the tool in x and y.
        needs: one for each source that moves the tool in x and y.
    """

    wanted: float
    factor: float | None
    needs: tuple[Need, ...]


def needs(robot: Robot, found: Budget, *, wanted: float) -> Needs:
    """What the errors must be so that 95 % of all machines stay within ``wanted`` in x and y, everywhere on the sheet.

    The machines and the places are those of the budget. Their errors are taken from the closed form, which scales.

    Args:
        robot: as for the budget.
        found: the budget of the errors as they are.
        wanted: m, > 0.
    """
    errors = found.errors
    moved = _moved_per_given(robot, found)
    given = {source: errors.given(source) for source in PER_ARM}
    used = [source for source in PER_ARM if given[source] > 0.0]
    alone = {source: wanted / _usual(moved[source]) for source in PER_ARM}
    total = sum((given[source] * moved[source] for source in used), np.zeros(1))
    equal = sum((alone[source] * moved[source] for source in used), np.zeros(1))
    factor = wanted / _usual(total) if used else None
    share = wanted / _usual(equal) if used else 0.0
    return Needs(
        wanted=wanted,
        factor=factor,
        needs=tuple(
            Need(
                source=source,
                alone=alone[source],
                beside_others=_beside(total - given[source] * moved[source], moved[source], wanted, alone[source]),
                scaled=given[source] * (factor or 0.0),
                equal=share * alone[source] if source in used else 0.0,
            )
            for source in PER_ARM
        ),
    )


def _moved_per_given(robot: Robot, found: Budget) -> dict[Source, Array]:
    """Where the tools are for one unit of each source, as it is given: x + iy, (D, N) m/rad or m/m."""
    machines, by_error = draw(found.draws, found.seed), tool_by_error(robot.geometry, found.places)[:, :2]
    moved: dict[Source, Array] = {}
    for source in PER_ARM:
        own = columns_of(source)
        x, y = np.einsum("nxk,dk->xdn", by_error[:, :, own], machines[:, own]) * limit_per_given(source)
        moved[source] = np.asarray(x + 1j * y)
    return moved


def _usual(moved: Array) -> float:
    """What 95 % stay within at the worst place, m."""
    return float(usual(np.abs(moved)).max())


def _beside(others: Array, own: Array, wanted: float, alone: float) -> float | None:
    """The largest error for which the tool stays within what is wanted beside the others, or None."""

    def excess(given: float) -> float:
        return _usual(others + given * own) - wanted

    if excess(0.0) >= 0.0:
        return None
    high = alone
    while excess(high) <= 0.0:  # it may cancel a part of the others
        high *= 1.25
    return float(brentq(excess, 0.0, high, xtol=_TOLERANCE * alone))
