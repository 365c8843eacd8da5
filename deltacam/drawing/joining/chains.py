"""Open curves that meet at nodes, as chains and closed loops, without a guess where more than two meet.

A dead end is on no loop, so dead ends are set aside. A chain that comes back to the node it left is a loop and is taken
out. Either may make its node simple for what remains. What still runs between nodes with more than two curves could be
closed in several ways and is left open.

A step of a chain is one number: twice the index of the curve, plus 1 where it is run backwards; so it is also the
number of the end where the step begins, and ``step ^ 1`` that of the end where it arrives.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from deltacam.drawing.joining.nodes import Nodes
from deltacam.model import BoolArray, IntArray

Steps = list[int]


@dataclass(frozen=True, slots=True, eq=False)
class Chains:
    """What the curves form, each in the order of the first curve.

    Attributes:
        loops: closed, each starting with its first curve in the order of the file, run forwards.
        open: chains that end at a dead end or at a node where more than two curves meet.
        ambiguous: chains between such nodes; they could be closed in more than one way.
        branches: the nodes where more than two curves meet.
    """

    loops: list[Steps]
    open: list[Steps]
    ambiguous: list[Steps]
    branches: IntArray


def trace(nodes: Nodes) -> Chains:
    """The chains and loops that the curves of ``nodes`` form; every curve but the specks is in exactly one."""
    node_of = nodes.labels.reshape(-1)
    present = np.repeat(~nodes.specks, 2)
    degree = np.bincount(node_of[present], minlength=len(nodes.places))
    loops, strings = walk(_partners(node_of, present, degree), np.flatnonzero(present[::2]).tolist())
    web = _Web(strings, node_of)
    web.simplify()
    loops += web.loops
    loops.sort(key=lambda loop: loop[0])
    return Chains(loops, web.dead(), web.rest(), np.flatnonzero(degree > 2))


def _partners(node_of: IntArray, present: BoolArray, degree: IntArray) -> list[int]:
    """For each end the one that it meets at a node with just two; -1 at other nodes."""
    paired = np.flatnonzero(present & (degree[node_of] == 2))
    by_node = paired[np.argsort(node_of[paired], kind="stable")].reshape(-1, 2)
    partner = np.full(len(node_of), -1, dtype=np.int64)
    partner[by_node[:, 0]], partner[by_node[:, 1]] = by_node[:, 1], by_node[:, 0]
    found: list[int] = partner.tolist()
    return found


def walk(partner: list[int], wanted: Iterable[int]) -> tuple[list[Steps], list[Steps]]:
    """Closed and open runs of curves whose ends are paired; each has its first curve run forwards.

    Args:
        partner: for each end the end that it meets, or -1.
        wanted: the curves, in order.

    Returns:
        the closed runs, which start with their first curve, and the open ones.
    """
    fresh = bytearray(b"\1") * (len(partner) // 2)
    closed, opened = [], []
    for curve in wanted:
        if not fresh[curve]:
            continue
        fresh[curve] = 0
        steps = [2 * curve]
        following = partner[2 * curve + 1]
        while following >= 0 and fresh[following >> 1]:
            fresh[following >> 1] = 0
            steps.append(following)
            following = partner[following ^ 1]
        if following == 2 * curve:
            closed.append(steps)
            continue
        back = []
        before = partner[2 * curve]
        while before >= 0:
            fresh[before >> 1] = 0
            back.append(before ^ 1)
            before = partner[before ^ 1]
        opened.append(back[::-1] + steps)
    return closed, opened


class _Web:
    """Strings of curves between nodes, simplified until every node left has more than two.

    String s has the ends 2 s and 2 s + 1. Strings that come to meet alone at a node are linked to a path.
    """

    def __init__(self, strings: list[Steps], node_of: IntArray) -> None:
        self.strings = strings
        self.loops: list[Steps] = []
        self._far = [end ^ 1 for end in range(2 * len(strings))]  # the other end of the path that begins at an end
        self._link = [-1] * (2 * len(strings))
        self._dead: list[int] = []
        self._node = [int(node_of[end]) for steps in strings for end in (steps[0], steps[-1] ^ 1)]
        self._at: dict[int, dict[int, None]] = {}
        for end, node in enumerate(self._node):
            self._at.setdefault(node, {})[end] = None

    def simplify(self) -> None:
        """Takes out dead ends and loops, and links what then meets alone, until nothing changes."""
        for end in range(0, len(self._node), 2):
            if self._node[end] == self._node[end + 1]:
                self._take_loop(end)
        waiting = list(self._at)
        while waiting:
            ends = list(self._at[waiting.pop()])
            if len(ends) == 1:
                waiting.append(self._drop(ends[0]))
            elif len(ends) == 2:
                waiting += self._join(*ends)

    def dead(self) -> list[Steps]:
        """The strings that lead to a dead end."""
        return [self.strings[string] for string in sorted(self._dead)]

    def rest(self) -> list[Steps]:
        """The paths that are left between nodes."""
        paths = []
        for ends in self._at.values():
            paths += [_forwards(self._steps(end)) for end in ends if end <= self._far[end]]
        return sorted(paths, key=min)

    def _steps(self, end: int) -> Steps:
        """The steps of the path that begins at an end."""
        steps: Steps = []
        while end >= 0:
            string = self.strings[end >> 1]
            steps += [step ^ 1 for step in reversed(string)] if end & 1 else string
            end = self._link[end ^ 1]
        return steps

    def _take_loop(self, end: int) -> None:
        """Takes out the path that begins and ends at the node of an end."""
        del self._at[self._node[end]][end], self._at[self._node[end]][self._far[end]]
        self.loops.append(_from_first(self._steps(end)))

    def _drop(self, end: int) -> int:
        """Sets aside the path that begins at a dead end; returns the node where it arrives."""
        far = self._far[end]
        del self._at[self._node[end]][end], self._at[self._node[far]][far]
        while end >= 0:
            self._dead.append(end >> 1)
            end = self._link[end ^ 1]
        return self._node[far]

    def _join(self, one: int, other: int) -> list[int]:
        """Links the only two paths at a node; returns the nodes where that changes something."""
        del self._at[self._node[one]][one], self._at[self._node[other]][other]
        start, stop = self._far[one], self._far[other]
        self._link[one], self._link[other] = other, one
        self._far[start], self._far[stop] = stop, start
        if self._node[start] != self._node[stop]:
            return []
        self._take_loop(start)
        return [self._node[start]]


def _from_first(loop: Steps) -> Steps:
    """The same loop from its first curve on, run forwards."""
    at = min(range(len(loop)), key=lambda i: loop[i] >> 1)
    if loop[at] & 1:
        loop = [step ^ 1 for step in reversed(loop)]
        at = len(loop) - 1 - at
    return loop[at:] + loop[:at]


def _forwards(chain: Steps) -> Steps:
    """The same chain in the direction in which its first curve is run forwards."""
    first = min(chain, key=lambda step: step >> 1)
    return [step ^ 1 for step in reversed(chain)] if first & 1 else chain
