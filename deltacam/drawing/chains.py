"""Open curves that meet at nodes, as chains and closed loops, without a guess where more than two meet.

A dead end is on no loop, so dead ends are set aside first. A chain that comes back to the node it left is a loop and is
taken out, which may make its node simple for what remains. What still runs between nodes with more than two curves
could be closed in several ways and is left open.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.drawing.nodes import Nodes
from deltacam.model import BoolArray, IntArray

_ROUNDS: Final = 200
"""Loops that hang on loops are taken out layer by layer, at most so many; what is left counts as ambiguous."""

Step = tuple[int, bool]
"""A curve, and whether it is run backwards."""


@dataclass(frozen=True, slots=True)
class Chains:
    """What the curves form.

    Attributes:
        loops: closed, each starting with its first curve in the order of the file.
        open: chains that end at a dead end or at a node where more than two curves meet.
        ambiguous: chains between such nodes; they could be closed in more than one way.
        branches: the nodes where more than two curves meet.
    """

    loops: list[list[Step]]
    open: list[list[Step]]
    ambiguous: list[list[Step]]
    branches: list[int]


def trace(nodes: Nodes) -> Chains:
    """The chains and loops that the curves of ``nodes`` form; every curve but the specks is in exactly one."""
    labels = nodes.labels
    present = ~nodes.specks
    degree = _degrees(labels, present, len(nodes.places))
    core, looped = present, np.zeros(len(labels), dtype=np.bool_)
    loops: list[list[Step]] = []
    rest: list[list[Step]] = []
    for _ in range(_ROUNDS):
        core = _without_dead_ends(labels, core, _degrees(labels, core, len(degree)))
        found, rest = _walk(labels, core, _degrees(labels, core, len(degree)))
        if not found:
            break
        loops += found
        looped[[curve for loop in found for curve, _ in loop]] = True
        core &= ~looped
    loops.sort(key=lambda loop: loop[0][0])
    _, open_chains = _walk(labels, present & ~core & ~looped, degree)
    return Chains(loops, open_chains, rest, [int(node) for node in np.flatnonzero(degree > 2)])


def _degrees(labels: IntArray, members: BoolArray, count: int) -> IntArray:
    """How many ends of the members meet at each of ``count`` nodes."""
    return np.bincount(labels[members].ravel(), minlength=count).astype(np.int64)


def _without_dead_ends(labels: IntArray, present: BoolArray, degree: IntArray) -> BoolArray:
    """The curves that remain when those with an end that meets nothing are taken away, again and again."""
    core = present.copy()
    at = _curves_at(labels, present)
    waiting = [int(node) for node in np.flatnonzero(degree == 1)]
    while waiting:
        for curve in at[waiting.pop()]:
            if core[curve]:
                core[curve] = False
                degree[labels[curve]] -= 1
                waiting += [int(end) for end in labels[curve] if degree[end] == 1]
    return core


def _walk(labels: IntArray, members: BoolArray, degree: IntArray) -> tuple[list[list[Step]], list[list[Step]]]:
    """Loops and other chains of the members; a chain runs on through nodes of degree 2 only.

    Args:
        labels: (M, 2) nodes.
        members: (M,) the curves to walk.
        degree: how many ends meet at each node.
    """
    at = _curves_at(labels, members)
    fresh = members.copy()
    loops, chains = [], []
    for first in np.flatnonzero(members):
        if not fresh[first]:
            continue
        fresh[first] = False
        chain: list[Step] = [(int(first), False)]
        chain += _ahead(int(labels[first, 1]), labels, at, fresh, degree)
        back = _ahead(int(labels[first, 0]), labels, at, fresh, degree)
        if _end(labels, back[-1] if back else (int(first), True)) == _end(labels, chain[-1]):
            loops.append(chain + [(curve, not turned) for curve, turned in reversed(back)])
        else:
            chains.append([(curve, not turned) for curve, turned in reversed(back)] + chain)
    return loops, chains


def _ahead(node: int, labels: IntArray, at: dict[int, list[int]], fresh: BoolArray, degree: IntArray) -> list[Step]:
    """The curves from ``node`` on until one cannot go on; marks them as no longer fresh."""
    steps: list[Step] = []
    while degree[node] == 2:
        following = next((curve for curve in at[node] if fresh[curve]), None)
        if following is None:
            break
        fresh[following] = False
        turned = bool(labels[following, 0] != node)
        steps.append((following, turned))
        node = int(labels[following, 0 if turned else 1])
    return steps


def _end(labels: IntArray, step: Step) -> int:
    """The node that a step arrives at."""
    curve, turned = step
    return int(labels[curve, 0 if turned else 1])


def _curves_at(labels: IntArray, members: BoolArray) -> dict[int, list[int]]:
    """The members at each node, in the order of the file."""
    at: dict[int, list[int]] = {}
    for curve in np.flatnonzero(members):
        for node in dict.fromkeys(labels[curve].tolist()):
            at.setdefault(node, []).append(int(curve))
    return at
