"""Thinning of what is known at every tick: extremes are kept.

Short programs are shown tick by tick. Of a long one every sample stands for so many ticks in a row, by the smallest and
the largest of their values.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, TypeVar

import numpy as np
import numpy.typing as npt

from deltacam.model import Array, IntArray

_Number = TypeVar("_Number", bound=np.generic)

EVERY_TICK: Final = 30_000
"""Programs of up to so many ticks are not thinned."""
MOST_SAMPLES: Final = 12_000
"""Of a program that is thinned."""


@dataclass(frozen=True, slots=True)
class Sampling:
    """How N ticks become samples.

    Attributes:
        ticks: N, >= 1.
        step: how many ticks a sample stands for; the last one may stand for fewer.
    """

    ticks: int
    step: int

    @classmethod
    def of(cls, ticks: int) -> Sampling:
        """Every tick where there are few, else as few ticks per sample as `MOST_SAMPLES` allow."""
        return cls(ticks, 1 if ticks <= EVERY_TICK else -(-ticks // MOST_SAMPLES))

    @property
    def first(self) -> IntArray:
        """The first tick of every sample, (S,)."""
        return np.arange(0, self.ticks, self.step)

    def at_first(self, values: npt.NDArray[_Number]) -> npt.NDArray[_Number]:
        """The value at the first tick of every sample: (S,) of (N,)."""
        return values[:: self.step]

    def extremes(self, values: Array) -> tuple[Array, ...]:
        """The smallest and the largest value of every sample, (S,) each; one array where a sample is one tick.

        nan counts only where there is nothing else.
        """
        if self.step == 1:
            return (values,)
        first = self.first
        return np.fmin.reduceat(values, first), np.fmax.reduceat(values, first)

    def largest(self, values: IntArray) -> IntArray:
        """The largest value of every sample, (S,)."""
        return np.asarray(np.maximum.reduceat(values, self.first))
