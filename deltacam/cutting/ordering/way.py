"""An order of cuts with the place where each begins, and the changes that can be made to it and taken back.

Positions run from 0, that of the rest of all, to N. Step s leads from the cut at position s - 1 to that at s, and step
N + 1 back to the rest. Two changes make up all others: a stretch is run the other way, or two neighbouring stretches
change places. The cuts of a stretch that is run the other way begin at the mirrored places.
"""

from __future__ import annotations

import math
from itertools import pairwise

from deltacam.cutting.ordering.problem import Lookup, Problem

TURN, SWAP, PLACE = range(3)


class Way:
    """An order, which changes.

    Attributes:
        sequence: the cuts by position, the rest of all first.
        position: of every cut.
        place: of every cut.
        ruled: whether anything must come before anything.
        rows: the costs, ``rows[left][reached]``, by places.
        outermost: the last of the cuts that come after each cut because they are around it, or itself.
        mirror: the place that a place becomes where its cut is run the other way.
        exact: whether a stretch costs the same either way.
        made: the changes since they were last kept, as `undo` takes them.
    """

    __slots__ = (
        "_inner",
        "_outer",
        "exact",
        "made",
        "mirror",
        "outermost",
        "place",
        "position",
        "rows",
        "ruled",
        "sequence",
    )

    def __init__(self, problem: Problem, lookup: Lookup, places: list[int]) -> None:
        rest = problem.count
        owner = problem.owner
        self.sequence = [rest, *owner[places].tolist()]
        self.position = [0] * (rest + 1)
        self.place = [len(problem.begins) - 1] * (rest + 1)
        for position, (cut, place) in enumerate(zip(self.sequence[1:], places, strict=True), start=1):
            self.position[cut], self.place[cut] = position, place
        self.rows = lookup.rows
        mirror, self.exact = problem.mirrors()
        self.mirror: list[int] = mirror.tolist()
        self.made: list[tuple[int, int, int, int]] = []
        self._outer = [tuple(around for around in row if around < rest) for row in problem.rule.around.tolist()]
        inner: list[list[int]] = [[] for _ in self._outer]
        for cut, outer in enumerate(self._outer):
            for around in outer:
                inner[around].append(cut)
        self._inner = [tuple(cuts) for cuts in inner]
        self.ruled = any(self._outer)
        self.outermost: list[int] = problem.rule.outermost.tolist()

    @property
    def places(self) -> list[int]:
        """Of the cuts in order."""
        return [self.place[cut] for cut in self.sequence[1:]]

    def total(self) -> float:
        """The cost of all steps."""
        places = [self.place[cut] for cut in self.sequence]
        return math.fsum(
            self.rows[left][reached] for left, reached in zip(places, [*places[1:], places[0]], strict=True)
        )

    def turn(self, p: int, r: int) -> None:
        """Run the stretch from step p to step r the other way."""
        sequence, position, place, mirror = self.sequence, self.position, self.place, self.mirror
        stretch = sequence[p:r]
        stretch.reverse()
        sequence[p:r] = stretch
        for at, cut in enumerate(stretch, p):
            position[cut] = at
            place[cut] = mirror[place[cut]]
        self.made.append((TURN, p, r, 0))

    def swap(self, p: int, q: int, r: int) -> None:
        """Let the stretches from step p to q and from q to r change places."""
        sequence, position = self.sequence, self.position
        stretch = sequence[q:r] + sequence[p:q]
        sequence[p:r] = stretch
        for at, cut in enumerate(stretch, p):
            position[cut] = at
        self.made.append((SWAP, p, p + r - q, r))

    def begin(self, cut: int, place: int) -> None:
        """Begin a cut at another place."""
        self.made.append((PLACE, cut, self.place[cut], 0))
        self.place[cut] = place

    def keep(self) -> None:
        """Keep what was changed."""
        self.made.clear()

    def undo(self) -> None:
        """Take back what was changed since it was last kept."""
        made = self.made
        for kind, p, q, r in reversed(made[:]):
            if kind == PLACE:
                self.place[p] = q
            elif kind == SWAP:
                self.swap(p, q, r)
            else:
                self.turn(p, q)
        made.clear()

    def may_turn(self, p: int, r: int) -> bool:
        """Whether the rule lets the stretch be run the other way."""
        if not self.ruled:
            return True
        position, outer = self.position, self._outer
        for cut in self.sequence[p:r]:
            for around in outer[cut]:
                if position[around] < r:  # it is behind the cut, so that it is in the stretch
                    return False
        return True

    def may_swap(self, p: int, q: int, r: int) -> bool:
        """Whether the rule lets the stretches change places."""
        if not self.ruled:
            return True
        position = self.position
        if q - p <= r - q:
            for cut in self.sequence[p:q]:
                for around in self._outer[cut]:
                    if q <= position[around] < r:
                        return False
            return True
        for cut in self.sequence[q:r]:
            for inside in self._inner[cut]:
                if p <= position[inside] < q:
                    return False
        return True

    def turned_inside(self, p: int, r: int) -> float:
        """How much more the steps inside a stretch cost where it is run the other way."""
        if self.exact:
            return 0.0
        rows, mirror = self.rows, self.mirror
        places = [self.place[cut] for cut in self.sequence[p:r]]
        more = 0.0
        for left, reached in pairwise(places):
            more += rows[mirror[reached]][mirror[left]] - rows[left][reached]
        return more
