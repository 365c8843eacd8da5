"""Changes that make an order cheaper: stretches turned or moved by new steps to near cuts, and other places.

For a cut a and a near cut c, the step behind a is taken out and c put behind a, in all the ways that the steps of one
or two more places allow (2-opt, Or-opt and or-3opt); likewise the step before a. A change is made as soon as it is found.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import Final

from deltacam.cutting.ordering.way import Way

GAIN: Final = 1e-9
"""s; what saves less is rounding."""

_RUN: Final = 3  # cuts of a stretch that is tried beside a near cut
_THIRD: Final = 5  # near cuts that are tried for the third step


class Descent:
    """Makes an order cheaper where it was touched."""

    def __init__(self, way: Way, near: list[list[tuple[int, float]]], places: list[range], longest: int) -> None:
        """Take an order, the near cuts of each cut, the places of each, and the longest stretch that is moved."""
        self._way, self._near, self._places, self._longest = way, near, places, longest
        self._size = len(way.sequence)

    def run(self, touched: Iterable[int]) -> float:
        """Change the order until nothing about the cuts touched can be made cheaper; returns what was saved."""
        saved, waiting = 0.0, dict.fromkeys(touched)
        while waiting:
            cut = next(iter(waiting))
            del waiting[cut]
            while True:
                gain, moved = self._at(cut)
                if gain <= 0.0:
                    break
                saved += gain
                for other in moved:
                    waiting[other] = None
        return saved

    def swap(self, p: int, q: int, r: int) -> tuple[float, tuple[int, ...]]:
        """Let two stretches change places; what that saves, which may be less than nothing, and the cuts beside."""
        sequence, size = self._way.sequence, self._size
        ends = [sequence[p - 1], sequence[p], sequence[q - 1], sequence[q], sequence[r - 1], sequence[r - size]]
        a, b, c, d, e, f = (self._way.place[cut] for cut in ends)
        rows = self._way.rows
        gain = rows[a][b] + rows[c][d] + rows[e][f] - rows[a][d] - rows[e][b] - rows[c][f]
        return self._swap(gain, p, q, r)

    def _at(self, a: int) -> tuple[float, tuple[int, ...]]:
        """Make one change about a cut; what it saves, and the cuts beside the new steps."""
        gain, moved = self._begin(a)
        if gain > 0.0:
            return gain, moved
        gain, moved = self._behind(a)
        return (gain, moved) if gain > 0.0 else self._before(a)

    def _begin(self, a: int) -> tuple[float, tuple[int, ...]]:
        """Begin a cut at a better place."""
        places = self._places[a]
        if len(places) < 2:
            return 0.0, ()
        way = self._way
        sequence, rows, place, at = way.sequence, way.rows, way.place, way.position[a]
        before, after = sequence[at - 1], sequence[at + 1 - self._size]
        row, reached, here = rows[place[before]], place[after], place[a]
        now = row[here] + rows[here][reached]
        least, best = now - GAIN, -1
        for other in places:
            cost = row[other]
            if cost < least:
                cost += rows[other][reached]
                if cost < least:
                    least, best = cost, other
        if best < 0:
            return 0.0, ()
        way.begin(a, best)
        return now - least, (before, after)

    def _behind(self, a: int) -> tuple[float, tuple[int, ...]]:
        """Let another cut follow a."""
        way, size = self._way, self._size
        sequence, position, rows, place, mirror = way.sequence, way.position, way.rows, way.place, way.mirror
        g = position[a] + 1
        if g > size - 1 and g > size:
            return 0.0, ()
        follows = sequence[g - size]
        row, at_follows = rows[place[a]], place[follows]
        now = row[at_follows]
        from_mirror = mirror[place[a]]
        for c, bound in self._near[a]:
            if bound >= now:
                break
            k, at_c = position[c], place[c]
            if k >= g:
                if k == g:
                    continue
                # c, later, comes to stand behind a.
                left = now - row[at_c]
                b = sequence[k - 1]
                at_b = place[b]
                if left > GAIN:
                    more = left + rows[at_b][at_c]
                    row_b = rows[at_b]
                    for r in self._ends(k, follows):
                        last, next_ = place[sequence[r - 1]], place[sequence[r - size]]
                        gain = more + rows[last][next_] - rows[last][at_follows] - row_b[next_]
                        if gain > GAIN and r - g <= self._longest and way.may_swap(g, k, r):
                            return self._swap(gain, g, k, r)
                    for p in range(max(1, g - _RUN), g):
                        before, start = place[sequence[p - 1]], place[sequence[p]]
                        gain = more + rows[before][start] - rows[before][at_follows] - row_b[start]
                        if gain > GAIN and k - p <= self._longest and way.may_swap(p, g, k):
                            return self._swap(gain, p, g, k)
                left = now - row[mirror[at_c]]
                if left > GAIN:
                    next_ = place[sequence[k + 1 - size]]
                    more = left + rows[at_c][next_]
                    gain = more - rows[mirror[at_follows]][next_]
                    if gain > GAIN and k + 1 - g <= self._longest and way.may_turn(g, k + 1):
                        gain -= way.turned_inside(g, k + 1)
                        if gain > GAIN:
                            return self._turn(gain, g, k + 1)
                    for q in range(max(g + 1, k + 1 - _RUN), k + 1):
                        first, before = place[sequence[q]], place[sequence[q - 1]]
                        gain = more + rows[before][first] - rows[mirror[first]][at_follows] - rows[before][next_]
                        if gain > GAIN and k + 1 - g <= self._longest and way.may_swap(g, q, k + 1):
                            if way.may_turn(q, k + 1):
                                gain -= way.turned_inside(q, k + 1)
                                if gain > GAIN:
                                    return self._swap(gain, g, q, k + 1, turned=(g, g + k + 1 - q))
            elif k < g - 1:
                # c, earlier, comes to stand behind a.
                left = now - row[at_c]
                before = place[sequence[k - 1]]
                row_before = rows[before]
                if left > GAIN:
                    more = left + row_before[at_c]
                    for q in self._middles(k, g, follows):
                        first, last = place[sequence[q]], place[sequence[q - 1]]
                        gain = more + rows[last][first] - row_before[first] - rows[last][at_follows]
                        if gain > GAIN and g - k <= self._longest and way.may_swap(k, q, g):
                            return self._swap(gain, k, q, g)
                left = now - row[mirror[at_c]]
                if left > GAIN:
                    next_ = place[sequence[k + 1]]
                    more = left + rows[at_c][next_]
                    for p in range(max(1, k + 1 - _RUN), k + 1):
                        ahead, start = place[sequence[p - 1]], place[sequence[p]]
                        gain = more + rows[ahead][start] - rows[ahead][next_] - rows[mirror[start]][at_follows]
                        if gain > GAIN and g - p <= self._longest and way.may_swap(p, k + 1, g):
                            if way.may_turn(p, k + 1):
                                gain -= way.turned_inside(p, k + 1)
                                if gain > GAIN:
                                    return self._swap(gain, p, k + 1, g, turned=(p + g - k - 1, g))
                next_ = place[sequence[k + 1]]
                gain = now + rows[at_c][next_] - rows[at_c][from_mirror] - rows[mirror[next_]][at_follows]
                if gain > GAIN and g - k - 1 <= self._longest and way.may_turn(k + 1, g):
                    gain -= way.turned_inside(k + 1, g)
                    if gain > GAIN:
                        return self._turn(gain, k + 1, g)
        return 0.0, ()

    def _before(self, a: int) -> tuple[float, tuple[int, ...]]:
        """Let another cut come before a."""
        way, size = self._way, self._size
        sequence, position, rows, place, mirror = way.sequence, way.position, way.rows, way.place, way.mirror
        g = position[a] or size
        ahead = sequence[g - 1]
        at_a, at_ahead = place[a], place[ahead]
        row = rows[at_ahead]
        now = row[at_a]
        for c, bound in self._near[a]:
            if bound >= now:
                break
            k, at_c = position[c], place[c]
            if k < g - 1:
                left = now - rows[at_c][at_a]
                after = place[sequence[k + 1]]
                if left > GAIN:
                    more = left + rows[at_c][after]
                    for p in range(max(1, k + 1 - _RUN), k + 1):
                        before, start = place[sequence[p - 1]], place[sequence[p]]
                        gain = more + rows[before][start] - rows[before][after] - row[start]
                        if gain > GAIN and g - p <= self._longest and way.may_swap(p, k + 1, g):
                            return self._swap(gain, p, k + 1, g)
                    for r in range(g + 1, min(g + _RUN, size) + 1):
                        last, next_ = place[sequence[r - 1]], place[sequence[r - size]]
                        gain = more + rows[last][next_] - rows[last][after] - row[next_]
                        if gain > GAIN and r - k <= self._longest and way.may_swap(k + 1, g, r):
                            return self._swap(gain, k + 1, g, r)
                at_mirror = mirror[at_c]
                left = now - rows[at_mirror][at_a]
                if left > GAIN:
                    before = place[sequence[k - 1]]
                    more = left + rows[before][at_c]
                    gain = more - rows[before][mirror[at_ahead]]
                    if gain > GAIN and g - k <= self._longest and way.may_turn(k, g):
                        gain -= way.turned_inside(k, g)
                        if gain > GAIN:
                            return self._turn(gain, k, g)
                    for q in range(k + 1, min(k + _RUN, g - 1) + 1):
                        last, first = place[sequence[q - 1]], place[sequence[q]]
                        gain = more + rows[last][first] - rows[before][first] - row[mirror[last]]
                        if gain > GAIN and g - k <= self._longest and way.may_swap(k, q, g) and way.may_turn(k, q):
                            gain -= way.turned_inside(k, q)
                            if gain > GAIN:
                                return self._swap(gain, k, q, g, turned=(k + g - q, g))
            elif k > g:
                left = now - rows[at_c][at_a]
                next_ = place[sequence[k + 1 - size]]
                if left > GAIN:
                    more = left + rows[at_c][next_]
                    for q in range(max(g + 1, k + 1 - _RUN), k + 1):
                        first, last = place[sequence[q]], place[sequence[q - 1]]
                        gain = more + rows[last][first] - row[first] - rows[last][next_]
                        if gain > GAIN and k + 1 - g <= self._longest and way.may_swap(g, q, k + 1):
                            return self._swap(gain, g, q, k + 1)
                    for q in range(g + 1, min(g + _RUN, k) + 1):
                        first, last = place[sequence[q]], place[sequence[q - 1]]
                        gain = more + rows[last][first] - row[first] - rows[last][next_]
                        if gain > GAIN and k + 1 - g <= self._longest and way.may_swap(g, q, k + 1):
                            return self._swap(gain, g, q, k + 1)
                b = place[sequence[k - 1]]
                gain = now + rows[b][at_c] - row[mirror[b]] - rows[mirror[at_a]][at_c]
                if gain > GAIN and k - g <= self._longest and way.may_turn(g, k):
                    gain -= way.turned_inside(g, k)
                    if gain > GAIN:
                        return self._turn(gain, g, k)
                at_mirror = mirror[at_c]
                left = now - rows[at_mirror][at_a]
                if left > GAIN:
                    more = left + rows[b][at_c]
                    for r in range(k + 1, min(k + _RUN, size) + 1):
                        last, next_ = place[sequence[r - 1]], place[sequence[r - size]]
                        gain = more + rows[last][next_] - row[mirror[last]] - rows[b][next_]
                        if gain > GAIN and r - g <= self._longest and way.may_swap(g, k, r) and way.may_turn(k, r):
                            gain -= way.turned_inside(k, r)
                            if gain > GAIN:
                                return self._swap(gain, g, k, r, turned=(g, g + r - k))
        return 0.0, ()

    def _ends(self, k: int, follows: int) -> list[int]:
        """The steps behind position k at which a stretch from there may end that ``follows`` is to come behind."""
        position, size = self._way.position, self._size
        found = [r for r in range(k + 1, min(k + _RUN, size) + 1)]
        for x, _ in self._near[follows][:_THIRD]:
            if position[x] >= k + _RUN:
                found.append(position[x] + 1)
        return found

    def _middles(self, k: int, g: int, follows: int) -> list[int]:
        """The steps between positions k and g at which the first of two stretches may end."""
        position = self._way.position
        found = [*range(k + 1, min(k + 1 + _RUN, g))]
        found += range(max(k + 1 + _RUN, g - _RUN), g)
        for x, _ in self._near[follows][:_THIRD]:
            if k + _RUN <= position[x] < g - _RUN - 1:
                found.append(position[x] + 1)
        return found

    def _turn(self, gain: float, p: int, r: int) -> tuple[float, tuple[int, ...]]:
        sequence, size = self._way.sequence, self._size
        self._way.turn(p, r)
        return gain, (sequence[p - 1], sequence[p], sequence[r - 1], sequence[r - size])

    def _swap(
        self, gain: float, p: int, q: int, r: int, turned: tuple[int, int] | None = None
    ) -> tuple[float, tuple[int, ...]]:
        sequence, size, middle = self._way.sequence, self._size, p + r - q
        self._way.swap(p, q, r)
        if turned is not None:
            self._way.turn(*turned)
        beside = sequence[p - 1], sequence[p], sequence[middle - 1], sequence[middle]
        return gain, (*beside, sequence[r - 1], sequence[r - size])
