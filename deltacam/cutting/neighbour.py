"""A first order: always the nearest cut that may come next."""

from __future__ import annotations

import numpy as np
from scipy.spatial import cKDTree

from deltacam.cutting.beginnings import Beginnings
from deltacam.cutting.precedence import Precedence
from deltacam.model import Array, BoolArray, IntArray

_SAMPLES = 20  # per cut, on average
_FEW = 8


def nearest_neighbour(beginnings: Beginnings, rule: Precedence, start: tuple[float, float]) -> IntArray:
    """A sequence of all cuts that keeps to the rule: from ``start``, m, always on to the nearest cut that may be next.

    Near is meant to within the distance of samples on the cuts.
    """
    count = len(rule.waiting)
    waiting = rule.waiting.copy()
    ready = waiting == 0
    left = np.ones(count, dtype=np.bool_)
    samples, owner = beginnings.samples(_SAMPLES)
    near = _Near(samples, owner)
    (x, y), rebuild, sequence = start, count // 2, []
    for done in range(count):
        if done >= rebuild:
            kept = left[owner]
            samples, owner = samples[kept], owner[kept]
            near, rebuild = _Near(samples, owner), done + (count - done + 1) // 2
        chosen = near.first(ready, x, y)
        sequence.append(chosen)
        ready[chosen] = left[chosen] = False
        for around in rule.around[chosen].tolist():
            if around < count:
                waiting[around] -= 1
                ready[around] = waiting[around] == 0
        x, y = beginnings.nearest(chosen, x, y).end
    return np.array(sequence, dtype=np.int64)


class _Near:
    """Finds the owner of the nearest sample whose owner is ready."""

    def __init__(self, samples: Array, owner: IntArray) -> None:
        self._tree = cKDTree(samples)
        self._owner = owner

    def first(self, ready: BoolArray, x: float, y: float) -> int:
        """The ready owner that is nearest to (x, y), m; there is one."""
        some = _FEW
        while True:
            some = min(some, len(self._owner))
            _, found = self._tree.query((x, y), k=some)
            owners = self._owner[np.atleast_1d(found)]
            at = np.flatnonzero(ready[owners])
            if len(at):
                return int(owners[at[0]])
            some *= 4
