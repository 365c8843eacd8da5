"""The curves of many entities in a few arrays, while blocks are put in their places."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from deltacam.model import Array, BoolArray, Curve, IntArray


@dataclass(frozen=True, slots=True, eq=False)
class Trace:
    """One curve and what is known about it.

    Attributes:
        curve: m.
        heights: the lowest and the highest z that it reaches, m.
        error: largest distance of the curve from what the entity draws, m.
    """

    curve: Curve
    heights: tuple[float, float]
    error: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class Traces:
    """M curves; the numbers may still be absurd or no numbers at all.

    Attributes:
        owner: (M,) the index of the entity that each curve is of.
        points: (P, 2) m, the vertices of one curve after those of the other.
        bulges: (P,); that of the last vertex of an open curve is 0.
        counts: (M,) how many vertices each has, > 0.
        closed: (M,) whether the last vertex joins the first.
        heights: (M, 2) m, the lowest and the highest z.
        errors: (M,) m.
    """

    owner: IntArray
    points: Array
    bulges: Array
    counts: IntArray
    closed: BoolArray
    heights: Array
    errors: Array

    def __len__(self) -> int:
        return len(self.owner)

    @property
    def first(self) -> IntArray:
        """Where the vertices of each curve begin, and how many there are, (M + 1,)."""
        return np.concatenate([np.zeros(1, dtype=np.int64), np.cumsum(self.counts)])

    def copies(self, offsets: Array, stride: int) -> Traces:
        """The curves at K places, (K, 3) m; the owners of each copy count on by ``stride``."""
        many = len(offsets)
        return Traces(
            owner=(np.arange(many)[:, None] * stride + self.owner).ravel(),
            points=(offsets[:, None, :2] + self.points).reshape(-1, 2),
            bulges=np.tile(self.bulges, many),
            counts=np.tile(self.counts, many),
            closed=np.tile(self.closed, many),
            heights=(offsets[:, None, 2:] + self.heights).reshape(-1, 2),
            errors=np.tile(self.errors, many),
        )

    def owned_by(self, owner: IntArray) -> Traces:
        """The same curves with other owners, (M,)."""
        return Traces(owner, self.points, self.bulges, self.counts, self.closed, self.heights, self.errors)

    def take(self, indices: IntArray) -> Traces:
        """The curves at ``indices``, (K,), in that order."""
        counts = self.counts[indices]
        begin = np.cumsum(counts) - counts
        source = np.repeat(self.first[indices] - begin, counts) + np.arange(int(counts.sum()))
        return Traces(
            self.owner[indices],
            self.points[source],
            self.bulges[source],
            counts,
            self.closed[indices],
            self.heights[indices],
            self.errors[indices],
        )


def of(owners: Sequence[int], traces: Sequence[Trace]) -> Traces:
    """Single curves and the entities that they are of, as arrays."""
    found = [trace.curve for trace in traces]
    bulges = [curve.bulges if curve.closed else np.append(curve.bulges, 0.0) for curve in found]
    return Traces(
        owner=np.array(owners, dtype=np.int64),
        points=np.concatenate([np.empty((0, 2)), *(curve.points for curve in found)]),
        bulges=np.concatenate([np.empty(0), *bulges]),
        counts=np.array([len(curve.points) for curve in found], dtype=np.int64),
        closed=np.array([curve.closed for curve in found], dtype=np.bool_),
        heights=np.array([trace.heights for trace in traces], dtype=np.float64).reshape(-1, 2),
        errors=np.array([trace.error for trace in traces], dtype=np.float64),
    )


def merge(parts: Sequence[Traces]) -> Traces:
    """All curves of several arrays, in the order of their owners."""
    parts = [part for part in parts if len(part)] or list(parts[:1])
    if len(parts) > 1:
        whole = Traces(
            owner=np.concatenate([part.owner for part in parts]),
            points=np.concatenate([part.points for part in parts]),
            bulges=np.concatenate([part.bulges for part in parts]),
            counts=np.concatenate([part.counts for part in parts]),
            closed=np.concatenate([part.closed for part in parts]),
            heights=np.concatenate([part.heights for part in parts]),
            errors=np.concatenate([part.errors for part in parts]),
        )
    else:
        whole = parts[0]
    if (np.diff(whole.owner) >= 0).all():
        return whole
    return whole.take(np.argsort(whole.owner, kind="stable"))
