"""The order of the cuts: what lies inside a contour before the contour, and little time on the way in between.

A part that has been cut out may drop or tilt, so nothing on it can be engraved or cut afterwards: the whole sheet is
engraved first, then the open lines are cut, then the contours, inner before outer, and those that share an edge with
another one, of which open cuts are left, after that one. What is free is chosen by `search`: the sequence, where a cut
begins, and which way open ones are run.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Final, NamedTuple

import numpy as np

from deltacam.cutting.ordering.choice import Choice, Spot
from deltacam.cutting.ordering.places import best_places
from deltacam.cutting.ordering.problem import Cost, Problem, distance
from deltacam.cutting.ordering.search import search
from deltacam.cutting.precedence import Precedence
from deltacam.model import Cut, Heat, IntArray, Operation

_FINER: Final = 6  # rounds in which the places of a cut that may begin anywhere come nearer to each other
_TRY_TIME: Final = 1e-3  # s, of one try, and of what is done for one cut before, on the machine of benchmarks/README.md
_EFFORT: Final = ((0, 50, 170, 2_000, 10_000, 100_000), (200, 300, 3_000, 2_600, 11_000, 100_000))
"""Tries by contours: as many as take about 5 s for 2,000 and 30 s for 10,000, with what is done before them."""


@dataclass(frozen=True, slots=True, eq=False)
class Ordered:
    """Cuts in the order in which they are made.

    Attributes:
        cuts: each begun at its place, where that was free to choose; else as it was given.
        index: of each among the cuts that were given.
        place: of each in its list of places; None where it had none.
        time: of all ways between, as they were costed, waiting included, s.
        wait: s, for how long the tool waits before each, because heat has to spread; 0 without such a rule.
    """

    cuts: tuple[Cut, ...]
    index: tuple[int, ...]
    place: tuple[int | None, ...]
    time: float
    wait: tuple[float, ...]


def default_effort(contours: int) -> int:
    """How many tries are made where nobody says."""
    return round(float(np.interp(contours, *_EFFORT)))


def effort_for(seconds: float, contours: int) -> int:
    """How many tries take about so many ``seconds`` for a number of contours; the machine decides how exactly."""
    return max(0, round(seconds / _TRY_TIME) - contours)


def order(
    cuts: Sequence[Cut],
    *,
    parents: Mapping[int, int | None],
    start: tuple[float, float],
    cost: Cost = distance,
    places: Sequence[Sequence[Spot] | None] | None = None,
    seed: int = 0,
    effort: int | None = None,
    together: bool = False,
    heat: Heat | None = None,
    after: Mapping[int, Sequence[int]] = MappingProxyType({}),
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> Ordered:
    """Order the cuts and choose where each begins, and which way open ones are run.

    Args:
        cuts: in the sheet frame.
        parents: for the number of each contour, the number of the contour around it.
        start: where the tool is before the first cut and after the last, sheet frame, m.
        cost: of the ways between, s.
        places: for each cut those where it may begin; None for a cut that may begin anywhere, if it is open at either
            end. All are of that kind where None.
        seed: of the search. The same seed and effort give the same order.
        effort: how often the search tries to get out of a dead end; more is better and takes longer.
        together: whether a part's contours stay together, that is, those of one outermost contour.
        heat: a rule for near cuts; what is nearer than its distance waits until its time has passed.
        after: for each contour that lost an edge to others those others, as `shared.Shared.after` has them.
        progress: is told how many tries are done, and of how many.

    Returns:
        all cuts: engraving, then open cuts, then closed ones, where every contour comes after all that lies inside it.
    """
    if not cuts:
        return Ordered((), (), (), 0.0, ())
    choice = Choice.of(cuts, places)
    whole = _Whole.of(cuts, parents, start, cost, together=together, heat=heat, after=after)
    effort = default_effort(len(cuts)) if effort is None else effort
    found = np.array(search(whole.problem(choice), seed=seed, tries=effort, progress=progress))
    sequence = choice.owner[found].tolist()
    for _ in range(_FINER if choice.free.any() else 0):
        choice = choice.finer(found)
        found = np.array(best_places(whole.problem(choice), sequence))
    return _ordered(choice, whole.problem(choice), found)


class _Whole(NamedTuple):
    """All of a problem but the places; as `Problem` has it."""

    start: tuple[float, float]
    rule: Precedence
    stage: IntArray
    part: IntArray
    cost: Cost
    heat: Heat | None

    @classmethod
    def of(
        cls,
        cuts: Sequence[Cut],
        parents: Mapping[int, int | None],
        start: tuple[float, float],
        cost: Cost,
        *,
        together: bool,
        heat: Heat | None,
        after: Mapping[int, Sequence[int]] = MappingProxyType({}),
    ) -> _Whole:
        kinds = [_stage(cut, after) for cut in cuts]
        stages = [sorted(set(kinds)).index(kind) for kind in kinds]
        parts = [_outermost(cut.contour, parents) if together else 0 for cut in cuts]
        rule = Precedence.between(cuts, parents, stages, _by_part(after, parents) if together else after)
        return cls(start, rule, np.array([*stages, max(stages)]), np.array([*parts, -1]), cost, heat)

    def problem(self, choice: Choice) -> Problem:
        begins, ends = np.vstack([choice.begins, self.start]), np.vstack([choice.ends, self.start])
        first = np.append(choice.first, len(begins))
        return Problem(begins, ends, first, self.rule, self.stage, self.part, self.cost, self.heat)


def problem_of(
    cuts: Sequence[Cut],
    *,
    parents: Mapping[int, int | None],
    start: tuple[float, float],
    cost: Cost = distance,
    places: Sequence[Sequence[Spot] | None] | None = None,
    together: bool = False,
    heat: Heat | None = None,
) -> Problem:
    """The problem that `order` searches first, for other solvers; at least one cut."""
    whole = _Whole.of(cuts, parents, start, cost, together=together, heat=heat)
    return whole.problem(Choice.of(cuts, places))


def _stage(cut: Cut, after: Mapping[int, Sequence[int]]) -> int:
    """0 for engraving, 1 for open cuts, 2 for closed ones and what is left of them."""
    if cut.operation is Operation.ENGRAVE:
        return 0
    return 2 if cut.curve.closed or cut.contour in after else 1


def _by_part(after: Mapping[int, Sequence[int]], parents: Mapping[int, int | None]) -> dict[int, tuple[int, ...]]:
    """The same where parts stay together: what a contour waits for, all of its part waits for."""
    part = {contour: _outermost(contour, parents) for contour in parents}
    waiting: dict[int, set[int]] = {}
    for contour, others in after.items():
        waiting.setdefault(part[contour], set()).update(other for other in others if part[other] != part[contour])
    found = {
        contour: waiting.get(part[contour], set()) | set(after.get(contour, ()))
        for contour in parents
        if part[contour] in waiting
    }
    return {contour: tuple(sorted(others)) for contour, others in sorted(found.items()) if others}


def _outermost(contour: int, parents: Mapping[int, int | None]) -> int:
    around = parents.get(contour)
    while around is not None:
        contour, around = around, parents.get(around)
    return contour


def _ordered(choice: Choice, problem: Problem, found: IntArray) -> Ordered:
    """What is handed out for the places found."""
    rest = len(problem.begins) - 1
    ways = problem.ways(np.array([rest, *found]), np.array([*found, rest]))
    moving = problem.cost(problem.ends[[rest, *found]], problem.begins[[*found, rest]])
    listed, owner = choice.listed, choice.owner[found]
    inside = found - choice.first[owner]
    return Ordered(
        tuple(choice.begun(place) for place in found.tolist()),
        tuple(owner.tolist()),
        tuple(at if listed[cut] else None for cut, at in zip(owner.tolist(), inside.tolist(), strict=True)),
        float(ways.sum()),
        tuple(np.maximum(ways - moving, 0.0)[:-1].tolist()),
    )
