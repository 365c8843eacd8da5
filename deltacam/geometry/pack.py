"""Many curves in a few arrays: what is cheap for one curve must be cheap for a million."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model import STRAIGHT, Array, BoolArray, Curve, IntArray, readonly

_FLAT: Final = 1e-8
"""Bulges that rise by less than half of this part of their chord, which is where the radius loses its digits."""


@dataclass(frozen=True, slots=True, eq=False)
class Pack:
    """M curves, their vertices one after the other.

    Vertex i begins a segment with bulge ``bulges[i]``, except the last vertex of an open curve, whose bulge is 0 and
    means nothing.

    Every curve has at least one vertex.

    Attributes:
        points: (P, 2) m.
        bulges: (P,).
        first: (M + 1,) where each curve's vertices begin in ``points``, and P.
        closed: (M,) whether the last vertex of each joins its first.
    """

    points: Array
    bulges: Array
    first: IntArray
    closed: BoolArray

    def __post_init__(self) -> None:
        object.__setattr__(self, "points", readonly(self.points, columns=2))
        bulges = np.asarray(self.bulges, dtype=np.float64)
        object.__setattr__(self, "bulges", readonly(np.where(np.abs(bulges) < STRAIGHT, 0.0, bulges)))
        if not len(self.points) == len(self.bulges) == self.first[-1] or len(self.first) != len(self.closed) + 1:
            raise ValueError(f"{len(self.points)} points and {len(self.bulges)} bulges of {len(self.closed)} curves")

    @classmethod
    def of(cls, curves: Iterable[Curve]) -> Pack:
        """The pack of these curves."""
        curves = list(curves)
        bulges = [curve.bulges if curve.closed else np.append(curve.bulges, 0.0) for curve in curves]
        return cls(
            points=np.concatenate([np.empty((0, 2)), *(curve.points for curve in curves)]),
            bulges=np.concatenate([np.empty(0), *bulges]),
            first=np.cumsum([0, *(len(curve.points) for curve in curves)]),
            closed=np.array([curve.closed for curve in curves], dtype=np.bool_),
        )

    def __len__(self) -> int:
        return len(self.closed)

    def __getitem__(self, index: int) -> Curve:
        closed = bool(self.closed[index])
        low, high = int(self.first[index]), int(self.first[index + 1])
        return Curve(
            points=self.points[low:high], bulges=self.bulges[low : high if closed else high - 1], closed=closed
        )

    def __iter__(self) -> Iterator[Curve]:
        return (self[i] for i in range(len(self)))

    @property
    def counts(self) -> IntArray:
        """How many vertices each curve has, (M,)."""
        return np.diff(self.first)

    def take(self, indices: IntArray) -> Pack:
        """The curves at ``indices``, (K,), in that order."""
        counts = self.counts[indices]
        first = np.concatenate([[0], np.cumsum(counts)])
        source = np.repeat(self.first[indices] - first[:-1], counts) + np.arange(first[-1])
        return Pack(self.points[source], self.bulges[source], first, self.closed[indices])

    def ends(self) -> Array:
        """The first and the last vertex of each curve, (M, 2, 2) m; equal for a closed one."""
        start = self.points[self.first[:-1]]
        return np.stack([start, np.where(self.closed[:, None], start, self.points[self.first[1:] - 1])], axis=1)

    def chords(self) -> tuple[Array, Array]:
        """For each vertex the vector to the next one and its length, (P, 2) and (P,) m; zero without a segment."""
        after = np.arange(1, len(self.points) + 1)
        last = self.first[1:] - 1
        after[last] = np.where(self.closed, self.first[:-1], last)
        step = self.points[after] - self.points
        return step, np.hypot(*step.T)

    def lengths(self) -> Array:
        """How long each curve is, (M,) m."""
        _, chord = self.chords()
        # np.sinc(x / pi) is sin(x) / x, exact at 0; half the angle turned through is 2 atan(bulge).
        arc = chord / np.sinc(2.0 * np.arctan(self.bulges) / np.pi)
        return np.asarray(np.add.reduceat(arc, self.first[:-1]))

    def bounds(self) -> Array:
        """The smallest x, smallest y, largest x and largest y of each curve, arcs included exactly, (M, 4) m."""
        low, high = self.points.copy(), self.points.copy()
        arcs = np.flatnonzero(np.abs(self.bulges) > _FLAT)
        step, chord = (each[arcs] for each in self.chords())
        half = 2.0 * np.arctan(self.bulges[arcs])
        middle = np.arctan2(step[:, 1], step[:, 0])
        radius = 0.5 * chord / np.sin(np.abs(half))
        right = np.stack([np.sin(middle), -np.cos(middle)], axis=1)  # unit vector to the right of the chord
        centre = self.points[arcs] + 0.5 * step - right * (np.sign(half) * radius * np.cos(half))[:, None]
        for axis, sign in ((0, 1.0), (1, 1.0), (0, -1.0), (1, -1.0)):
            # The arc reaches furthest along an axis where the way out from its centre to the arc's middle is within
            # half its angle of that axis.
            out = right[:, axis] * sign * np.sign(half)
            reached = out >= np.cos(half)
            extreme = centre[reached, axis] + sign * radius[reached]
            far = np.maximum if sign > 0.0 else np.minimum
            side = high if sign > 0.0 else low
            side[arcs[reached], axis] = far(side[arcs[reached], axis], extreme)
        low = np.minimum.reduceat(low, self.first[:-1], axis=0)
        high = np.maximum.reduceat(high, self.first[:-1], axis=0)
        return np.concatenate([low, high], axis=1)
