"""Changes that make an order cheaper: stretches turned or moved by new steps to near cuts, and other places.

A change takes out two or three steps and joins the loose ends again (2-opt, Or-opt and the or-3opt that turns nothing).
For a cut and the cuts near to it, one new step joins these two; the changes with such a step are tried while what the
steps taken out cost is more than what the new ones cost (Lin and Kernighan 1973). A change is made when it is found.
"""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import Final, NamedTuple

from deltacam.cutting.ordering.way import Way

GAIN: Final = 1e-9
"""s; what saves less is rounding."""

_RUN: Final = 3  # cuts of a stretch that is moved beside a near cut
_LONGEST_PART: Final = 10  # cuts that are begun elsewhere together
_SECOND: Final = 16  # near cuts that are tried for a second new step


class Change(NamedTuple):
    """A change that was made: what it saves, s, and the cuts beside the new steps."""

    saved: float
    beside: tuple[int, ...]


class Descent:
    """Makes an order cheaper where it was touched."""

    def __init__(self, way: Way, near: list[list[tuple[int, float]]], places: list[range], longest: int) -> None:
        """Take an order, the near cuts of each cut, the places of each, and the longest stretch that is moved."""
        self._way, self._near, self._places, self._longest = way, near, places, longest
        self._second = [[cut for cut, _ in cuts[:_SECOND]] for cuts in near]
        self._size = len(way.sequence)
        self._nearest: dict[tuple[int, int], int] = {}

    def run(self, touched: Iterable[int]) -> float:
        """Change the order until nothing about the cuts touched can be made cheaper; returns what was saved."""
        saved, waiting = 0.0, dict.fromkeys(touched)
        while waiting:
            cut = next(iter(waiting))
            del waiting[cut]
            while (change := self._about(cut)) is not None:
                saved += change.saved
                waiting.update(dict.fromkeys(change.beside))
        return saved

    def swap(self, p: int, q: int, r: int) -> Change:
        """Let two stretches change places; that may save less than nothing."""
        sequence = self._way.sequence
        ends = sequence[p - 1], sequence[p], sequence[q - 1], sequence[q], sequence[r - 1], sequence[r - self._size]
        a, b, c, d, e, f = (self._way.place[cut] for cut in ends)
        rows = self._way.rows
        return self._swap(rows[a][b] + rows[c][d] + rows[e][f] - rows[a][d] - rows[e][b] - rows[c][f], p, q, r)

    def _about(self, a: int) -> Change | None:
        """Make one change about a cut, if there is one."""
        return self._begin(a) or self._begin_part(a) or self._swaps(a) or self._turns_behind(a) or self._turns_before(a)

    def _begin(self, a: int) -> Change | None:
        """Begin a cut at a better place."""
        places = self._places[a]
        if len(places) < 2:
            return None
        way = self._way
        rows, place, at = way.rows, way.place, way.position[a]
        before, after = way.sequence[at - 1], way.sequence[at + 1 - self._size]
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
            return None
        way.begin(a, best)
        return Change(now - least, (before, after))

    def _begin_part(self, a: int) -> Change | None:
        """Begin a cut and those behind it that belong to its part at better places, each near to the one before."""
        way = self._way
        sequence, outermost, place, rows, at = way.sequence, way.outermost, way.place, way.rows, way.position[a]
        part = outermost[a]
        if not way.ruled or at == 0 or outermost[sequence[at - 1]] == part:
            return None
        end = at + 1
        while end < self._size and end - at < _LONGEST_PART and outermost[sequence[end]] == part:
            end += 1
        if end - at < 2:
            return None
        cuts, after = sequence[at:end], place[sequence[end - self._size]]
        row = rows[place[sequence[at - 1]]]
        now = self._through(row, [place[cut] for cut in cuts], after)
        chains = [self._following(cuts, first) for first in self._places[a]]
        costs = [self._through(row, chain, after) for chain in chains]
        least = min(costs)
        if now - least < GAIN:
            return None
        for cut, new in zip(cuts, chains[costs.index(least)], strict=True):
            way.begin(cut, new)
        return Change(now - least, (sequence[at - 1], *cuts, sequence[end - self._size]))

    def _following(self, cuts: list[int], first: int) -> list[int]:
        """Places of cuts that follow each other: the first one's, and then always the nearest."""
        chain, rows, nearest = [first], self._way.rows, self._nearest
        for cut in cuts[1:]:
            key = chain[-1], cut
            if key not in nearest:
                nearest[key] = min(self._places[cut], key=rows[chain[-1]].__getitem__)
            chain.append(nearest[key])
        return chain

    def _through(self, row: dict[int, float], chain: list[int], after: int) -> float:
        """What the steps through places cost, from one with the costs ``row`` on to one behind them."""
        rows, cost = self._way.rows, row[chain[0]]
        for left, reached in pairwise(chain):
            cost += rows[left][reached]
        return cost + rows[chain[-1]][after]

    def _swaps(self, a: int) -> Change | None:
        """Let two stretches change places, so that a near cut comes behind ``a``: nothing is turned."""
        way, size, near = self._way, self._size, self._second
        sequence, position, rows, place = way.sequence, way.position, way.rows, way.place
        g = position[a] + 1
        follows = place[sequence[g - size]]
        row = rows[place[a]]
        now = row[follows]
        for c, bound in self._near[a]:
            if bound >= now:
                break
            k, at_c = position[c], place[c]
            left = now - row[at_c]
            if left < GAIN or k == g:
                continue
            b = sequence[k - 1]
            row_b = rows[place[b]]
            left += row_b[at_c]
            thirds = {k + 1, k + 2, k + 3, g - 1, g - 2, g - 3}
            thirds.update([position[e] for e in near[b]])
            for m in thirds:
                # What was behind a, before c and before m comes behind m - 1, a and b: right in one order round.
                if not (g < k < m <= size or 0 < k < m < g or 0 < m < g < k):
                    continue
                at_m = place[sequence[m - size]]
                gain = left - row_b[at_m]
                if gain > GAIN:
                    row_m = rows[place[sequence[m - 1]]]
                    gain += row_m[at_m] - row_m[follows]
                    if gain > GAIN:
                        p, q, r = (g, k, m) if g < k < m else (k, m, g) if k < m else (m, g, k)
                        if r - p <= self._longest and way.may_swap(p, q, r):
                            return self._swap(gain, p, q, r)
        return None

    def _turns_behind(self, a: int) -> Change | None:
        """Join ``a`` to a near cut by a stretch that is turned, taking out the step behind ``a``."""
        way = self._way
        position, rows, place, mirror = way.position, way.rows, way.place, way.mirror
        g, at_a = position[a] + 1, place[a]
        now = rows[at_a][place[way.sequence[g - self._size]]]
        for c, bound in self._near[a]:
            if bound >= now:
                break
            k = position[c]
            change = None
            if rows[at_a][mirror[place[c]]] < now:  # c, turned, comes behind a
                if k > g:
                    change = self._turned(g, k + 1)
                change = change or self._moved_backwards(range(k, k - _RUN, -1), range(k + 1, k + 2), g)
            if change is None and g > 1 and rows[place[c]][mirror[at_a]] < now:  # a, turned, comes behind c
                if k < g - 2:
                    change = self._turned(k + 1, g)
                change = change or self._moved_backwards(range(g - 1, g - 1 - _RUN, -1), range(g, g + 1), k + 1)
            if change is not None:
                return change
        return None

    def _turns_before(self, a: int) -> Change | None:
        """The same taking out the step before ``a``."""
        way, size = self._way, self._size
        position, rows, place, mirror = way.position, way.rows, way.place, way.mirror
        i, at_a = position[a] or size, place[a]
        now = rows[place[way.sequence[i - 1]]][at_a]
        for c, bound in self._near[a]:
            if bound >= now:
                break
            k = position[c]
            change = None
            if rows[mirror[place[c]]][at_a] < now:  # c, turned, comes before a
                if k < i - 1:
                    change = self._turned(k, i)
                change = change or self._moved_backwards(range(k, k + 1), range(k + 1, k + 1 + _RUN), i)
            if change is None and i < size and rows[mirror[at_a]][place[c]] < now:  # a, turned, comes before c
                if k > i + 1:
                    change = self._turned(i, k)
                change = change or self._moved_backwards(range(i, i + 1), range(i + 1, i + 1 + _RUN), k)
            if change is not None:
                return change
        return None

    def _turned(self, p: int, r: int) -> Change | None:
        """Turn the stretch from step p to step r, if that saves anything."""
        way = self._way
        sequence, rows, place, mirror = way.sequence, way.rows, way.place, way.mirror
        first, last = place[sequence[p]], place[sequence[r - 1]]
        row, after = rows[place[sequence[p - 1]]], place[sequence[r - self._size]]
        gain = row[first] + rows[last][after] - row[mirror[last]] - rows[mirror[first]][after]
        if gain < GAIN or r - p > self._longest or not way.may_turn(p, r):
            return None
        gain -= way.turned_inside(p, r)
        if gain < GAIN:
            return None
        way.turn(p, r)
        return Change(gain, (sequence[p - 1], sequence[p], sequence[r - 1], sequence[r - self._size]))

    def _moved_backwards(self, firsts: range, ends: range, to: int) -> Change | None:
        """Turn a short stretch, from one of ``firsts`` to one of ``ends``, and put it into the step ``to``."""
        way, size = self._way, self._size
        sequence, rows, place, mirror = way.sequence, way.rows, way.place, way.mirror
        ahead, behind = place[sequence[to - 1]], place[sequence[to - size]]
        row, now = rows[ahead], rows[ahead][behind]
        for i in firsts:
            for j in ends:
                if i < 1 or j > size or i <= to <= j:
                    continue
                first, last = place[sequence[i]], place[sequence[j - 1]]
                if first == last == mirror[first]:
                    continue  # it is the same either way
                before, after = rows[place[sequence[i - 1]]], place[sequence[j - size]]
                gain = now + before[first] + rows[last][after]
                gain -= row[mirror[last]] + rows[mirror[first]][behind] + before[after]
                if gain < GAIN:
                    continue
                p, q, r = (to, i, j) if to < i else (i, j, to)
                if r - p > self._longest or not way.may_turn(i, j) or not way.may_swap(p, q, r):
                    continue
                gain -= way.turned_inside(i, j)
                if gain > GAIN:
                    way.turn(i, j)
                    return self._swap(gain, p, q, r)
        return None

    def _swap(self, gain: float, p: int, q: int, r: int) -> Change:
        sequence, middle = self._way.sequence, p + r - q
        self._way.swap(p, q, r)
        beside = sequence[p - 1], sequence[p], sequence[middle - 1], sequence[middle]
        return Change(gain, (*beside, sequence[r - 1], sequence[r - self._size]))
