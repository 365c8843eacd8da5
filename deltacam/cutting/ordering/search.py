"""A good order: the nearest first, made cheaper, and then changed at random here and there to get out of dead ends.

Each try swaps two short stretches next to each other, makes the order cheaper again around them, and is taken back
where the order became dearer (iterated local search, Lourenço, Martin and Stützle 2003; the swap is the double bridge
of Martin, Otto and Felten 1991, kept local). Tries are counted, not timed, so that the same seed gives the same order.
"""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Final

from deltacam.cutting.ordering.descent import Descent
from deltacam.cutting.ordering.first import first_order
from deltacam.cutting.ordering.near import near_cuts
from deltacam.cutting.ordering.places import best_places
from deltacam.cutting.ordering.problem import Lookup, Problem
from deltacam.cutting.ordering.way import Way

STRETCH: Final = 10
"""The most cuts of a stretch that is swapped in a try."""

_LONGEST: Final = 1000  # cuts that one change moves in a try
_ROUNDING: Final = 1e-12
_REPORTS: Final = 50
_REMEMBERED: Final = 1_000_000  # ways


def search(problem: Problem, *, seed: int, tries: int, progress: Callable[[int, int], None]) -> list[int]:
    """A place of every cut, in a good order.

    Args:
        problem: what is put in order.
        seed: of the changes at random.
        tries: how many of them.
        progress: is told how many tries are done, and of how many.
    """
    lookup = Lookup(problem)
    first = first_order(problem)
    owner = problem.owner
    way = Way(problem, lookup, best_places(problem, owner[first].tolist()))
    places = [
        range(low, high) for low, high in zip(problem.first[:-1].tolist(), problem.first[1:].tolist(), strict=True)
    ]
    near = near_cuts(problem)
    Descent(way, near, places, problem.count).run(list(way.sequence))
    way.keep()
    descent, chance = Descent(way, near, places, _LONGEST), Random(seed)  # noqa: S311  # nothing here is secret
    for done in range(tries if problem.count > 2 else 0):
        if done % max(1, tries // _REPORTS) == 0:
            progress(done, tries)
            if lookup.size() > _REMEMBERED:
                lookup.forget()
        _try(way, descent, chance)
    progress(tries, tries)
    return best_places(problem, way.sequence[1:])


def _try(way: Way, descent: Descent, chance: Random) -> None:
    size = len(way.sequence)
    p = 1 + int(chance.random() * (size - 2))
    q = p + 1 + int(chance.random() * min(STRETCH, size - 1 - p))
    r = q + 1 + int(chance.random() * min(STRETCH, size - q))
    if not way.may_swap(p, q, r):
        return
    saved, beside = descent.swap(p, q, r)
    saved += descent.run(beside)
    if saved >= -_ROUNDING:
        way.keep()
    else:
        way.undo()
