"""A first order: always the nearest cut that may come next."""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.spatial import cKDTree

from deltacam.cutting.ordering.problem import Problem
from deltacam.model import Array, BoolArray, IntArray

_FEW: Final = 8


def first_order(problem: Problem) -> list[int]:
    """A place of every cut, in an order that keeps to the rule: from the start always on to the nearest that may be.

    Where parts stay together, the nearest place decides on the part.
    """
    walk, owner = _Walk(problem), problem.owner
    stages, parts = problem.stage[:-1], problem.part[:-1]
    for stage in np.unique(stages).tolist():
        left = stages == stage
        if len(np.unique(parts[left])) == 1:
            walk.run(left)
            continue
        near = _Near(problem, left)
        while left.any():
            near = near.renewed(left)
            whole = _whole(problem, left)
            if not whole.any():  # parts wait for each other: they cannot stay together
                walk.run(left)
                break
            part = whole & (parts == parts[owner[near.place(whole, walk.ready, walk.at)]])
            walk.run(part)
            left &= ~part
    return walk.chosen


def _whole(problem: Problem, left: BoolArray) -> BoolArray:
    """The cuts, of those ``left``, of parts that wait for nothing that is left of another part, (N,)."""
    around, part = problem.rule.around[:-1], problem.part
    waits = around[left[:, None] & (around < problem.count) & (part[around] != part[:-1, None])]
    return left & ~np.isin(part[:-1], part[waits])


class _Walk:
    """The way so far.

    Attributes:
        chosen: the places of the cuts that were come to, in order.
        ready: the cuts of which nothing that comes before is left, (N,); those that were come to as well.
        at: where the tool is, (2,) m.
    """

    def __init__(self, problem: Problem) -> None:
        self._problem, self._owner = problem, problem.owner
        self._waiting = problem.rule.waiting.copy()
        self.chosen: list[int] = []
        self.ready: BoolArray = self._waiting == 0
        self.at: Array = problem.ends[-1]

    def run(self, wanted: BoolArray) -> None:
        """Go on to the nearest of those wanted, (N,), until all are done."""
        left, near = wanted.copy(), _Near(self._problem, wanted)
        for _ in range(int(wanted.sum())):
            near = near.renewed(left)
            place = near.place(left, self.ready, self.at)
            cut = int(self._owner[place])
            left[cut] = False
            self.chosen.append(place)
            self.at = self._problem.ends[place]
            for around in self._problem.rule.around[cut].tolist():
                if around < len(left):
                    self._waiting[around] -= 1
                    self.ready[around] = self._waiting[around] == 0


class _Near:
    """Finds the nearest place of the cuts that are left and ready, among those of the cuts wanted, (N,)."""

    def __init__(self, problem: Problem, wanted: BoolArray) -> None:
        self._problem, self._count = problem, int(wanted.sum())
        owner = problem.owner[:-1]
        self._places = np.flatnonzero(wanted[owner])
        self._owner: IntArray = owner[self._places]
        self._tree = cKDTree(problem.begins[self._places])
        self._found = 0

    def renewed(self, left: BoolArray) -> _Near:
        """The same for the cuts that are left, once half of them are done."""
        self._found += 1
        return _Near(self._problem, left) if 2 * self._found > self._count > _FEW else self

    def place(self, left: BoolArray, ready: BoolArray, at: Array) -> int:
        """The place nearest to ``at``, (2,) m, of a cut that is left and ready; there is one."""
        some = _FEW
        while True:
            some = min(some, len(self._places))
            _, found = self._tree.query(at, k=some)
            near = np.atleast_1d(found)
            owner = self._owner[near]
            good = np.flatnonzero(left[owner] & ready[owner])
            if len(good):
                return int(self._places[near[good[0]]])
            some *= 4
