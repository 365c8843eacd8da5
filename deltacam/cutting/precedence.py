"""Which cut must come before which."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from deltacam.model import Cut, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Precedence:
    """The rule that what lies directly inside a contour is cut before it, by index of N cuts.

    Attributes:
        waiting: how many cuts lie directly inside the contour of each, (N,).
        around: the cuts of the contour directly around each, (N + 1, K), with N where there are fewer; the last row,
            that of nobody, is N alone.
    """

    waiting: IntArray
    around: IntArray

    @classmethod
    def between(cls, cuts: Sequence[Cut], parents: Mapping[int, int | None]) -> Precedence:
        """The rule among the cuts, given the number of the contour around each contour."""
        by_contour: dict[int | None, list[int]] = {}
        for index, cut in enumerate(cuts):
            by_contour.setdefault(cut.contour, []).append(index)
        outer = [by_contour.get(parents[cut.contour] or None, []) for cut in cuts]
        widest = max(map(len, outer), default=0)
        around = np.full((len(cuts) + 1, max(widest, 1)), len(cuts), dtype=np.int64)
        for index, found in enumerate(outer):
            around[index, : len(found)] = found
        waiting = np.bincount(around[:-1].ravel(), minlength=len(cuts) + 1)[:-1]
        return cls(waiting, around)
