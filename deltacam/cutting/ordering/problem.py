"""What is put in order: cuts, where each may begin and end, what each way between costs, and what must come first."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from math import dist
from typing import Final, Protocol

import numpy as np

from deltacam.cutting.precedence import Precedence
from deltacam.model import Array, Heat, IntArray

STAGE: Final = 2.0**17
"""s, what it costs to pass from one stage to the next: more than any change of some steps saves, so that nobody goes
back. It must not be so large that rounding eats what is saved elsewhere."""

PART: Final = 2.0**10
"""s, what it costs to leave a part for another where parts stay together, likewise."""

_SAME: Final = 1e-9  # m


class Cost(Protocol):
    """What ways cost.

    What also has ``one``, which takes x and y where one way begins and where it ends, is asked for single ways there.
    """

    def __call__(self, begin: Array, end: Array, /) -> Array:
        """The costs of the straight ways from ``begin`` to ``end``, (N, 2) m in the sheet frame: (N,) s."""
        ...


def distance(begin: Array, end: Array) -> Array:
    """The length of ways as their cost."""
    step = end - begin
    return np.asarray(np.hypot(step[:, 0], step[:, 1]))


@dataclass(frozen=True, slots=True, eq=False)
class Problem:
    """N cuts with M places in all, cut by cut, where they may begin; a last place and cut, M and N, is the rest of all.

    Attributes:
        begins: where the tool comes to, (M + 1, 2) m; last where it goes after all.
        ends: where it leaves, (M + 1, 2) m; last where it is before all.
        first: the first place of every cut, (N + 2,).
        rule: what must come before what.
        stage: of every cut, (N + 1,): those of a lower one come first.
        part: of every cut, (N + 1,): those of one part and stage follow each other; all the same where that is free.
        cost: of the ways.
        heat: what is so near to the end of the cut before costs at least so much; None for no rule.
    """

    begins: Array
    ends: Array
    first: IntArray
    rule: Precedence
    stage: IntArray
    part: IntArray
    cost: Cost
    heat: Heat | None = None

    @property
    def count(self) -> int:
        """How many cuts there are."""
        return len(self.first) - 2

    @property
    def owner(self) -> IntArray:
        """The cut of every place, (M + 1,)."""
        return np.repeat(np.arange(self.count + 1), np.diff(self.first))

    def ways(self, left: IntArray, reached: IntArray) -> Array:
        """What the ways from the ends of places to the beginnings of others cost, (N,) s, without stages and parts."""
        begin, end = self.ends[left], self.begins[reached]
        found = self.cost(begin, end)
        if self.heat is not None:
            near = (distance(begin, end) < self.heat.distance) & (left != self.first[-2]) & (reached != self.first[-2])
            found = np.where(near, np.maximum(found, self.heat.time), found)
        return np.asarray(found)

    def fences(self, left: IntArray, reached: IntArray) -> Array:
        """What passing from the cuts ``left`` to the cuts ``reached`` costs because of stages and parts, (N,) s."""
        stages = np.where(left == self.count, 0, self.stage[left])
        steps = np.abs(self.stage[reached] - stages)
        inside = (steps == 0) & (left < self.count) & (reached < self.count)
        return np.asarray(STAGE * steps + PART * (inside & (self.part[left] != self.part[reached])))

    def mirrors(self) -> tuple[IntArray, bool]:
        """For every place that of the same cut which is most like it run the other way, (M + 1,).

        The mirror of a mirror is the place itself: where that is not so, a place is its own. The other value says
        whether all are exact, so that a stretch of cuts that is reversed costs the same inside.
        """
        mirror = np.arange(len(self.begins))
        lopsided = np.flatnonzero(distance(self.begins, self.ends)[:-1] > _SAME)
        if not len(lopsided):
            return mirror, True
        cut = self.owner[lopsided]
        counts = np.diff(self.first)[cut]
        start = np.cumsum(counts) - counts
        place = np.repeat(lopsided, counts)
        other = np.repeat(self.first[cut] - start, counts) + np.arange(len(place))
        off = distance(self.begins[other], self.ends[place]) + distance(self.ends[other], self.begins[place])
        least = np.minimum.reduceat(off, start)
        equal = np.flatnonzero(off == np.repeat(least, counts))
        mirror[lopsided] = other[equal[np.searchsorted(equal, start)]]
        itself = np.arange(len(mirror))
        mirror = np.where(mirror[mirror] == itself, mirror, itself)
        off = distance(self.begins[mirror], self.ends)[:-1]
        return mirror, bool(off.max() < _SAME)


class Lookup:
    """What single ways cost, found once: ``rows[left][reached]``, by places."""

    def __init__(self, problem: Problem) -> None:
        begins, ends, one = problem.begins.tolist(), problem.ends.tolist(), _one(problem)
        more = _rules(problem)
        if more is None:

            def way(left: int, reached: int) -> float:
                return one(*ends[left], *begins[reached])
        else:

            def way(left: int, reached: int) -> float:
                return more(left, reached, one(*ends[left], *begins[reached]))

        self.rows: list[dict[int, float]] = [_Row(way, place) for place in range(len(begins))]

    def forget(self, *, above: int) -> None:
        """Give the memory back where more than so many are remembered."""
        if sum(map(len, self.rows)) > above:
            for row in self.rows:
                row.clear()


class _Row(dict[int, float]):
    """What the ways from one place cost, by the places reached."""

    __slots__ = ("_left", "_way")

    def __init__(self, way: Callable[[int, int], float], left: int) -> None:
        super().__init__()
        self._way, self._left = way, left

    def __missing__(self, reached: int) -> float:
        found = self[reached] = self._way(self._left, reached)
        return found


def _one(problem: Problem) -> Callable[[float, float, float, float], float]:
    """The cost of one way."""
    one = getattr(problem.cost, "one", None)
    if one is not None:
        return one  # type: ignore[no-any-return]
    if problem.cost is distance:
        return lambda x, y, to_x, to_y: dist((x, y), (to_x, to_y))

    def asked(x: float, y: float, to_x: float, to_y: float) -> float:
        return float(problem.cost(np.array([[x, y]]), np.array([[to_x, to_y]]))[0])

    return asked


def _rules(problem: Problem) -> Callable[[int, int, float], float] | None:
    """What a way costs with the rules on stages, parts and heat, given its places and its cost without; None for none.

    The same as `Problem.ways` and `Problem.fences` for a single way.
    """
    heat, rest = problem.heat, problem.count
    stage: list[int] = problem.stage.tolist()
    part: list[int] = problem.part.tolist()
    if heat is None and max(stage) == min(stage) == 0 and len(set(part[:-1])) < 2:
        return None
    owner: list[int] = problem.owner.tolist()
    begins, ends = problem.begins.tolist(), problem.ends.tolist()

    def cost(left: int, reached: int, alone: float) -> float:
        one, other = owner[left], owner[reached]
        if heat is not None and alone < heat.time and rest not in {one, other}:
            alone = heat.time if dist(ends[left], begins[reached]) < heat.distance else alone
        steps = abs(stage[other] - (0 if one == rest else stage[one]))
        if steps:
            return alone + STAGE * steps
        return alone + PART if rest not in {one, other} and part[one] != part[other] else alone

    return cost
