"""How far along a route the tool is at a time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from deltacam.model import Array, IntArray


class Law(Protocol):
    """When the tool is where, for moves that follow each other."""

    @property
    def durations(self) -> Array:
        """How long every move takes from rest to rest, (K,) s."""
        ...

    def at(self, move: IntArray, since: Array) -> Array:
        """The distance from the start of the route, (N,) m, at ``since`` (N,) s after the start of moves (N,)."""
        ...


@dataclass(frozen=True, slots=True, eq=False)
class TimeLaw:
    """The motion along a route with a constant path acceleration in every interval of its grid.

    Attributes:
        distance: (G,) m from the start of the route, the gridpoints.
        squared: (G,) m2/s2, the squared speed there; linear in between.
        time: (G,) s from the start of the route, as if the moves followed each other without a pause.
        rest: (K + 1,) the gridpoints at which the moves begin, and the last one.
    """

    distance: Array
    squared: Array
    time: Array
    rest: IntArray

    @classmethod
    def of(cls, distance: Array, squared: Array, rest: IntArray) -> TimeLaw:
        """The law with the given squared speeds at the gridpoints; no two neighbours of them are both 0."""
        speed = np.sqrt(squared)
        taken = 2.0 * np.diff(distance) / (speed[:-1] + speed[1:])
        return cls(distance, squared, np.concatenate([[0.0], np.cumsum(taken)]), rest)

    @property
    def durations(self) -> Array:
        """How long every move takes from rest to rest, (K,) s."""
        return np.diff(self.time[self.rest])

    @property
    def acceleration(self) -> Array:
        """Along the path in every interval, (G - 1,) m/s2."""
        return np.diff(self.squared) / (2.0 * np.diff(self.distance))

    def at(self, move: IntArray, since: Array) -> Array:
        """The distance from the start of the route, (N,) m, at ``since`` (N,) s after moves (N,) began; exact."""
        time = self.time[self.rest[move]] + since
        interval = np.searchsorted(self.time, time, side="right") - 1
        interval = np.clip(interval, self.rest[move], self.rest[move + 1] - 1)
        passed = time - self.time[interval]
        moved = np.sqrt(self.squared[interval]) * passed + 0.5 * self.acceleration[interval] * passed**2
        return np.asarray(self.distance[interval] + np.clip(moved, 0.0, np.diff(self.distance)[interval]))
