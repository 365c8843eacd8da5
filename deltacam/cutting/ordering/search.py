"""A good order: the nearest first, made cheaper, and then changed at random here and there to get out of dead ends.

Each try swaps two short stretches next to each other, and begins some of the cuts there at any of their places, those
behind following suit. Then the order is made cheaper again around them, and all is taken back where it became dearer
(iterated local search, Lourenço, Martin and Stützle 2003; the swap is the double bridge of Martin, Otto and Felten,
1991, kept local). Tries are counted, not timed, so that the same seed gives the same order.
"""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise
from random import Random
from typing import Final

from deltacam.cutting.ordering.descent import Change, Descent
from deltacam.cutting.ordering.first import first_order
from deltacam.cutting.ordering.near import near_cuts
from deltacam.cutting.ordering.places import best_places
from deltacam.cutting.ordering.problem import Lookup, Problem
from deltacam.cutting.ordering.way import Way

_SHORT: Final = 10  # the most cuts of a stretch that is swapped
_LONG: Final = 50  # the same in other tries
_OFTEN_SHORT: Final = 0.7  # long ones move parts with all their holes
_LONGEST: Final = 1000  # cuts that one change moves while trying
_TURNED: Final = 0.3  # of the tries put parts into reverse order, where some contours are inside others
_PARTS: Final = 6
_MOVED: Final = 0.3  # of the cuts beside a swap begin anywhere
_FOLLOWING: Final = 8  # the most cuts behind one of them that follow suit
_ROUNDING: Final = 1e-12  # s
_REPORTS: Final = 50
_REMEMBERED: Final = 1_500_000  # ways


def search(problem: Problem, *, seed: int, tries: int, progress: Callable[[int, int], None]) -> list[int]:
    """A place of every cut, in a good order.

    Args:
        problem: what is put in order.
        seed: of the changes at random.
        tries: how many of them.
        progress: is told how many tries are done, and of how many.
    """
    lookup, owner = Lookup(problem), problem.owner
    way = Way(problem, lookup, best_places(problem, owner[first_order(problem)].tolist()))
    places = [range(low, high) for low, high in pairwise(problem.first.tolist())]
    near = near_cuts(problem)
    Descent(way, near, places, problem.count).run(list(way.sequence))
    way.keep()
    trial = _Trial(way, Descent(way, near, places, _LONGEST), places, seed)
    for done in range(tries if problem.count > 1 else 0):
        if done % max(1, tries // _REPORTS) == 0:
            progress(done, tries)
            lookup.forget(above=_REMEMBERED)
        trial.run()
    progress(tries, tries)
    return best_places(problem, way.sequence[1:])


class _Trial:
    """Changes an order at random, and keeps what is no worse."""

    def __init__(self, way: Way, descent: Descent, places: list[range], seed: int) -> None:
        self._way, self._descent, self._places = way, descent, places
        self._random = Random(seed).random  # noqa: S311  # nothing here is secret

    def run(self) -> None:
        """Make one try."""
        shaken = self._turn_parts() if self._way.ruled and self._random() < _TURNED else self._swap()
        if shaken is None:
            self._way.undo()
            return
        saved, touched = shaken.saved, dict.fromkeys(shaken.beside)
        for cut in shaken.beside:
            if self._random() < _MOVED:
                saved += self._begin(cut, touched)
        if saved + self._descent.run(touched) >= -_ROUNDING:
            self._way.keep()
        else:
            self._way.undo()

    def _swap(self) -> Change | None:
        """Let two stretches change places; None where the rule forbids it."""
        random, size = self._random, len(self._way.sequence)
        longest = _SHORT if random() < _OFTEN_SHORT else _LONG
        p = 1 + int(random() * (size - 2))
        q = p + 1 + int(random() * min(longest, size - 1 - p))
        r = q + 1 + int(random() * min(longest, size - q))
        return self._descent.swap(p, q, r) if self._way.may_swap(p, q, r) else None

    def _turn_parts(self) -> Change | None:
        """Put some parts that follow each other into reverse order, each as it is in itself; None likewise."""
        sequence, outermost, size = self._way.sequence, self._way.outermost, len(self._way.sequence)
        p = 1 + int(self._random() * (size - 1))
        while p > 1 and outermost[sequence[p - 1]] == outermost[sequence[p]]:
            p -= 1
        ends, parts = [p], 2 + int(self._random() * _PARTS)
        while len(ends) <= parts and ends[-1] < size:
            r = ends[-1] + 1
            while r < size and outermost[sequence[r]] == outermost[sequence[r - 1]]:
                r += 1
            ends.append(r)
        saved, beside, r = 0.0, list[int](), ends[-1]
        for low, high in pairwise(ends[:-1]):
            if not self._way.may_swap(p, p + high - low, r):
                return None
            change = self._descent.swap(p, p + high - low, r)
            saved += change.saved
            beside += change.beside
            r -= high - low
        return Change(saved, tuple(dict.fromkeys(beside)))

    def _begin(self, cut: int, touched: dict[int, None]) -> float:
        """Begin a cut anywhere, and those behind where it is then nearest; what that saves, mostly below nothing."""
        way, own = self._way, self._places[cut]
        place, at, size, saved = own[int(self._random() * len(own))], way.position[cut], len(way.sequence), 0.0
        for _ in range(_FOLLOWING):
            if place == way.place[cut]:
                break
            row, here = way.rows[way.place[way.sequence[at - 1]]], way.place[cut]
            after = way.place[way.sequence[at + 1 - size]]
            saved += row[here] + way.rows[here][after] - row[place] - way.rows[place][after]
            way.begin(cut, place)
            touched[cut] = None
            at += 1
            if at == size:
                break
            cut = way.sequence[at]
            place = min(self._places[cut], key=way.rows[place].__getitem__)
        return saved
