"""The order of the cuts: what lies inside a contour before the contour, and little travel in between.

A part that has been cut out may drop or tilt, so nothing on it can be engraved or cut afterwards: the whole sheet is
engraved first, then the open lines are cut, then the contours, inner before outer. Within that rule the order comes
from the nearest neighbour, improved as `improve` says.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.cutting.beginnings import Beginnings, Place
from deltacam.cutting.improve import Tour, improve
from deltacam.cutting.neighbour import nearest_neighbour
from deltacam.cutting.precedence import Precedence
from deltacam.model import Cut, IntArray, Operation

_ROUNDS: Final = 20
_WORTH: Final = 2e-4  # of the travel; a round that saves less is not worth another one
_STAGES: Final = 3


def order(cuts: Sequence[Cut], *, parents: Mapping[int, int | None], start: tuple[float, float]) -> tuple[Cut, ...]:
    """Order the cuts and choose where each begins, and which way open ones are run.

    Args:
        cuts: in the sheet frame.
        parents: for the number of each contour, the number of the contour around it.
        start: where the tool is before the first cut and after the last, sheet frame, m.

    Returns:
        the same cuts: engraving, then open cuts, then closed ones, where every contour comes after all that lies inside
        it. Each begins at its point nearest to where the one before it ended; an open one at the nearer end.
    """
    ordered: tuple[Cut, ...] = ()
    place = start
    for stage in range(_STAGES):
        ordered += _order([cut for cut in cuts if _stage(cut) == stage], parents, place, start)
        place = _end(ordered[-1]) if ordered else start
    return ordered


def _stage(cut: Cut) -> int:
    """0 for engraving, 1 for open cuts, 2 for closed ones."""
    if cut.operation is Operation.ENGRAVE:
        return 0
    return 2 if cut.curve.closed else 1


def _order(
    cuts: Sequence[Cut], parents: Mapping[int, int | None], start: tuple[float, float], home: tuple[float, float]
) -> tuple[Cut, ...]:
    """The cuts of one stage in order, from ``start`` and then on to ``home``."""
    if not cuts:
        return ()
    rule, beginnings = Precedence.between(cuts, parents), Beginnings(cuts)
    best = _Walk.along(beginnings, nearest_neighbour(beginnings, rule, start), start, home)
    moved = None
    for _ in range(_ROUNDS):
        tour = best.tour()
        walk = _Walk.along(beginnings, improve(tour, rule, moved), start, home)
        saved, everywhere = best.travel - walk.travel, moved is None
        if saved > 0.0:
            best, moved = walk, walk.tour().differs(tour)
        if saved <= _WORTH * best.travel:
            if everywhere:
                break
            moved = None
    return tuple(
        beginnings.begun(index, place) for index, place in zip(best.sequence.tolist(), best.places, strict=True)
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Walk:
    """Cuts in ``sequence``, each begun at that of its ``places`` that is nearest to the end of the one before."""

    sequence: IntArray
    places: list[Place]
    start: tuple[float, float]
    home: tuple[float, float]

    @classmethod
    def along(
        cls, beginnings: Beginnings, sequence: IntArray, start: tuple[float, float], home: tuple[float, float]
    ) -> _Walk:
        return cls(sequence, beginnings.walk(sequence, start), start, home)

    def tour(self) -> Tour:
        back = np.argsort(self.sequence)
        begins = np.array([place.begin for place in self.places])[back]
        ends = np.array([place.end for place in self.places])[back]
        return Tour(self.sequence.copy(), begins, ends, np.array(self.start), np.array(self.home))

    @property
    def travel(self) -> float:
        return self.tour().travel()


def _end(cut: Cut) -> tuple[float, float]:
    x, y = cut.curve.ends[-1]
    return float(x), float(y)
