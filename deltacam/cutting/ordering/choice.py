"""The places that cuts may begin at: those of a list, the ends of an open cut, or some along a closed one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final, Protocol

import numpy as np

from deltacam.cutting.beginnings import Beginnings
from deltacam.model import Array, BoolArray, Cut, IntArray

_PLACES: Final = 8  # along a closed cut
_AROUND: Final = np.array([0.0, -0.5, 0.5, -1.0, 1.0])


class Spot(Protocol):
    """A place where a cut may begin, as `beginnings.Place` is one."""

    @property
    def begin(self) -> tuple[float, float]:
        """Where the tool comes to, (x, y) m in the sheet frame."""
        ...

    @property
    def end(self) -> tuple[float, float]:
        """Where it leaves."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class Choice:
    """The places of N cuts, M in all, cut by cut.

    Attributes:
        beginnings: of the cuts.
        free: the cuts that may begin anywhere, (N,).
        listed: the cuts that have a list, (N,).
        apart: how far apart the places of a free cut are, (N,) m.
        owner: the cut of each place, (M,).
        along: how far from the first point of its cut a place is, (M,) m; the length for the last point of an open one,
            and of no meaning in a list.
        begins: where the tool comes to, (M, 2) m.
        ends: where it leaves, (M, 2) m.
    """

    beginnings: Beginnings
    free: BoolArray
    listed: BoolArray
    apart: Array
    owner: IntArray
    along: Array
    begins: Array
    ends: Array

    @classmethod
    def of(cls, cuts: Sequence[Cut], places: Sequence[Sequence[Spot] | None] | None) -> Choice:
        """The places of the lists, and some of the cuts that have none."""
        lists = [None] * len(cuts) if places is None else places
        beginnings = Beginnings(cuts)
        listed = np.array([spots is not None for spots in lists])
        closed = np.array([cut.curve.closed for cut in cuts])
        counts = np.where(closed, _PLACES, 2)
        counts[listed] = [len(spots) for spots in lists if spots is not None]
        owner = np.repeat(np.arange(len(cuts)), counts)
        inside = np.arange(len(owner)) - np.repeat(np.cumsum(counts) - counts, counts)
        apart = beginnings.lengths / np.where(closed, _PLACES, 1)
        along = inside * apart[owner]
        begins, ends = _ends(beginnings, closed, owner, along)
        given = [spot for spots in lists if spots is not None for spot in spots]
        if given:
            begins[listed[owner]] = [spot.begin for spot in given]
            ends[listed[owner]] = [spot.end for spot in given]
        return cls(beginnings, closed & ~listed, listed, apart, owner, along, begins, ends)

    @property
    def first(self) -> IntArray:
        """The first place of every cut, and M, (N + 1,)."""
        return np.searchsorted(self.owner, np.arange(len(self.free) + 1))

    def finer(self, found: IntArray) -> Choice:
        """The places of the free cuts nearer to those ``found`` (N,), at half the distance; and the nearest corners."""
        chosen = self.along[found[np.argsort(self.owner[found])]]
        cut = np.flatnonzero(self.free)
        near = chosen[cut][:, None] + 0.5 * _AROUND * self.apart[cut][:, None]
        corner = self.beginnings.corner(cut, chosen[cut] % np.maximum(self.beginnings.lengths[cut], 1e-300))
        along = np.column_stack([corner, near])
        places = self.beginnings.at(np.repeat(cut, along.shape[1]), along.ravel())
        kept = np.flatnonzero(~self.free[self.owner])
        owner = np.concatenate([self.owner[kept], np.repeat(cut, along.shape[1])])
        order = np.argsort(owner, kind="stable")
        return replace(
            self,
            apart=0.5 * self.apart,
            owner=owner[order],
            along=np.concatenate([self.along[kept], along.ravel()])[order],
            begins=np.concatenate([self.begins[kept], places])[order],
            ends=np.concatenate([self.ends[kept], places])[order],
        )

    def begun(self, place: int) -> Cut:
        """The cut of a place, begun there; as it is where it has a list."""
        cut = int(self.owner[place])
        return self.beginnings.cuts[cut] if self.listed[cut] else self.beginnings.begun(cut, float(self.along[place]))


def _ends(beginnings: Beginnings, closed: BoolArray, owner: IntArray, along: Array) -> tuple[Array, Array]:
    """Where the tool comes to and leaves at places along cuts, (M, 2) m each."""
    begins = beginnings.at(owner, along)
    other = beginnings.at(owner, beginnings.lengths[owner] - along)
    return begins, np.where(closed[owner][:, None], begins, other)
