"""Better orders of places to visit, by moving runs of them and by reversing stretches (Or-opt, 2-opt).

`moves` finds them: all at once, those with a new step to one of the nearest places, and after the first time only about
the cuts that a move has touched. The best are made first. So the work grows about as the number of cuts.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Final

import numpy as np

from deltacam.cutting.moves import BEFORE, BEHIND, LONGEST_RUN, REVERSE, Moves, Steps, find, saved
from deltacam.cutting.precedence import Precedence
from deltacam.model import Array, BoolArray, IntArray

GAIN: Final = 1e-9
"""Less travel saved, m, is rounding."""

_HERE: Final = 1e-5  # m, within which a place is still the same
_PASSES: Final = 200
_ALL: Final = np.array([[0, 1, 2]])
_GLANCE: Final = 32  # cuts that are looked at before the rest of a stretch


@dataclass(slots=True, eq=False)
class Tour:
    """A sequence of cuts with where each begins and ends; a stretch that is reversed is run the other way.

    Attributes:
        sequence: (N,) indices of cuts.
        begins: where each cut begins, by its index, (N, 2) m.
        ends: where it ends, likewise.
        start: where the tool is before the first, (2,) m.
        home: where it goes after the last, (2,) m.
        position: of every cut in the sequence, (N + 1,); that of N, which is home, is N.
    """

    sequence: IntArray
    begins: Array
    ends: Array
    start: Array
    home: Array
    position: IntArray = field(init=False)

    def __post_init__(self) -> None:
        self.position = np.empty(len(self.sequence) + 1, dtype=np.int64)
        self.position[self.sequence] = np.arange(len(self.sequence))
        self.position[-1] = len(self.sequence)

    def steps(self) -> Steps:
        """The steps from cut to cut, from the start first and to home last."""
        left = np.concatenate([self.start[None], self.ends[self.sequence]])
        return Steps.between(left, np.concatenate([self.begins[self.sequence], self.home[None]]))

    def travel(self) -> float:
        """The length of all steps, m."""
        return float(self.steps().length.sum())

    def differs(self, other: Tour) -> BoolArray:
        """Which cuts begin or end elsewhere than in the other tour, (N,)."""
        off = np.maximum(np.abs(self.begins - other.begins), np.abs(self.ends - other.ends))
        return np.asarray(off.max(axis=1) > _HERE)

    def before(self, *steps: int) -> list[int]:
        """The cuts that the steps come from, -1 for the start."""
        return [int(self.sequence[step - 1]) if step else -1 for step in steps]

    def saved(self, kind: int, *steps: int) -> float:
        """How much shorter a move of these steps makes the way, m."""
        before, after = (
            self.before(*steps),
            [int(self.sequence[step]) if step < len(self.sequence) else -1 for step in steps],
        )
        left = np.array([self.ends[cut] if cut >= 0 else self.start for cut in before])
        reached = np.array([self.begins[cut] if cut >= 0 else self.home for cut in after])
        return float(saved(Steps.between(left, reached), kind, _ALL)[0])

    def replace(self, first: int, run: IntArray) -> None:
        """Put ``run`` into the sequence from position ``first`` on."""
        self.sequence[first : first + len(run)] = run
        self.position[run] = np.arange(first, first + len(run))

    def touch(self, step: int, active: BoolArray) -> None:
        """Note in ``active``, (N + 1,) by the cut that a step leads to, what moves about ``step`` may take."""
        active[self.sequence[max(step - LONGEST_RUN, 0) : step + 2]] = True
        active[-1] |= step + 2 > len(self.sequence)

    def turn(self, first: int, last: int) -> None:
        """Run the cuts at the positions ``first`` to ``last`` - 1 the other way and in reverse."""
        run = self.sequence[first:last][::-1].copy()
        self.replace(first, run)
        self.begins[run], self.ends[run] = self.ends[run], self.begins[run]


def improve(tour: Tour, rule: Precedence, moved: BoolArray | None = None) -> IntArray:
    """The sequence that no move makes shorter, with the places where cuts begin and end held where they are.

    Args:
        tour: is changed.
        rule: is kept.
        moved: the cuts, (N,) by index, whose places are others than when the sequence was last improved; all by
            default. Moves are looked for near these only, and then near what was changed.
    """
    active = np.ones(len(tour.sequence) + 1, dtype=np.bool_)  # by the cut that a step leads to, home last
    if moved is not None:
        active[:] = False
        for position in np.flatnonzero(moved[tour.sequence]).tolist():
            tour.touch(position, active)
    for _ in range(_PASSES):
        slots = np.append(tour.sequence, len(tour.sequence))
        moves = find(tour.steps(), active[slots], above=GAIN)
        active[:] = False
        if not _make_best(tour, rule, moves, active):
            break
    return tour.sequence


def _make_best(tour: Tour, rule: Precedence, moves: Moves, active: BoolArray) -> bool:
    """Make the moves, the best first, that are still there and keep to the rule; whether any is.

    A move is still there while its steps lead from the same cuts to the same cuts in the same order. ``active``,
    (N + 1,), gets what each step leads to that was touched.
    """
    slots, any_made = np.append(tour.sequence, len(tour.sequence)), False
    best = np.argsort(-moves.gain, kind="stable")
    steps = moves.steps[best]
    before = np.concatenate([[-1], slots[:-1]])[steps].tolist()
    for kind, leads_to, came_from in zip(moves.kind[best].tolist(), slots[steps].tolist(), before, strict=True):
        p, q, r = tour.position[leads_to].tolist()
        if not (p < q < r or (kind == REVERSE and p < r)) or tour.before(p, q, r) != came_from:
            continue
        if _keeps(tour, rule, kind, p, q, r) and tour.saved(kind, p, q, r) > GAIN:
            _make(tour, kind, p, q, r)
            any_made = True
            for step in (p, p + r - q, r):
                tour.touch(step, active)
    return any_made


def _make(tour: Tour, kind: int, p: int, q: int, r: int) -> None:
    if kind == REVERSE:
        tour.turn(p, r)
        return
    tour.replace(p, np.concatenate([tour.sequence[q:r], tour.sequence[p:q]]))
    if kind == BEHIND:
        tour.turn(p + r - q, r)
    if kind == BEFORE:
        tour.turn(p, p + r - q)


def _keeps(tour: Tour, rule: Precedence, kind: int, p: int, q: int, r: int) -> bool:
    """Whether everything still comes before what is around it after a move."""
    if kind == REVERSE:
        return not _any_around(tour, rule, p, r, p, r)
    if _any_around(tour, rule, p, q, p if kind == BEHIND else q, r):
        return False
    return kind != BEFORE or not _any_around(tour, rule, q, r, q, r)


def _any_around(tour: Tour, rule: Precedence, first: int, last: int, low: int, high: int) -> bool:
    """Whether the contour around any cut from position ``first`` to ``last`` is at one from ``low`` to ``high``."""
    some = _GLANCE
    while first < last:
        around = tour.position[rule.around[tour.sequence[first : min(first + some, last)]]]
        if ((around >= low) & (around < high)).any():
            return True
        first += some
        some *= 8
    return False
