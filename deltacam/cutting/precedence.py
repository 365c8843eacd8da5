"""Which cut must come before which."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from deltacam.model import Cut, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Precedence:
    """The rule that what lies inside a contour is cut before it, and what is asked besides, by index of N cuts.

    Attributes:
        waiting: how many cuts come directly before each, (N,).
        around: the cuts that each comes directly before, (N + 1, K), with N where there are fewer; the last row, that
            of nobody, is N alone.
    """

    waiting: IntArray
    around: IntArray

    @property
    def outermost(self) -> IntArray:
        """The last of the cuts that come after each because they are around it, or itself, (N + 1,)."""
        itself = np.arange(len(self.around))
        last = np.where(self.around[:, 0] < itself[-1], self.around[:, 0], itself)
        while (last != last[last]).any():
            last = last[last]
        return last

    @classmethod
    def between(
        cls,
        cuts: Sequence[Cut],
        parents: Mapping[int, int | None],
        stages: Sequence[int] | None = None,
        after: Mapping[int, Sequence[int]] = MappingProxyType({}),
    ) -> Precedence:
        """The rule among the cuts, given the number of the contour around each contour.

        Args:
            cuts: of any contours; some have none, and some several.
            parents: by the number of each contour that has a cut or lies around one.
            stages: of each cut; the rule is only within a stage, and reaches past contours of others. All are of one
                stage where None.
            after: for the numbers of some contours those whose cuts of the same stage come before all of theirs too;
                nobody may wait for himself by it.
        """
        stages = [0] * len(cuts) if stages is None else stages
        by_contour: dict[tuple[int, int], list[int]] = {}
        for index, (cut, stage) in enumerate(zip(cuts, stages, strict=True)):
            by_contour.setdefault((cut.contour, stage), []).append(index)
        following: dict[int, list[int]] = {}
        for contour, others in after.items():
            for other in others:
                following.setdefault(other, []).append(contour)
        outer = []
        for cut, stage in zip(cuts, stages, strict=True):
            around = parents[cut.contour]
            while around is not None and (around, stage) not in by_contour:
                around = parents.get(around)
            later = [] if around is None else by_contour[around, stage]
            outer.append([*later, *(one for last in following.get(cut.contour, ()) for one in by_contour[last, stage])])
        widest = max(map(len, outer), default=0)
        table = np.full((len(cuts) + 1, max(widest, 1)), len(cuts), dtype=np.int64)
        for index, found in enumerate(outer):
            table[index, : len(found)] = found
        waiting = np.bincount(table[:-1].ravel(), minlength=len(cuts) + 1)[:-1]
        return cls(waiting, table)
