"""Which limit is nearest at every tick, from the setpoints alone."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Final

import numpy as np
import numpy.typing as npt

from deltacam.model import Array, BlockKind, IntArray
from deltacam.report.motion import Motion
from deltacam.verification.evidence import MOVING_KINDS, Evidence

LIMITS: Final = (
    "feed",
    "tool speed",
    "tool acceleration",
    "joint speed",
    "joint acceleration",
    "joint jerk",
)
NONE: Final = len(LIMITS)
"""Stands for no limit where none is used to `NEAR`."""
NEAR: Final = 0.9
"""Share of a limit from which it is called near."""

_FINE: Final = 1 << 20  # steps of a share that is compared
_ROOM: Final = 8  # more than there are limits


@dataclass(frozen=True, slots=True, eq=False)
class Binding:
    """The nearest limit at every tick.

    Attributes:
        limit: index into `LIMITS` of the limit of which the largest share is used, (N,).
        share: how much of it is used, (N,); 1 is all of it.
    """

    limit: npt.NDArray[np.uint8]
    share: Array

    def shown(self) -> IntArray:
        """The limit where it is near, else `NONE`, (N,)."""
        return np.where(self.share >= NEAR, self.limit, NONE)

    def ranked(self) -> IntArray:
        """Numbers (N,) of which the largest is that of the largest share; `limit_of` gives the limit back."""
        share = np.minimum(self.share * _FINE, 2.0**52).astype(np.int64)
        return share * _ROOM + self.shown()


def limit_of(ranked: IntArray) -> IntArray:
    """What `Binding.shown` says where `Binding.ranked` says this."""
    return ranked % _ROOM


def binding(evidence: Evidence, motion: Motion) -> Binding:
    """The nearest limit: each tick has the largest share of any limit, of any joint."""
    best = np.zeros(len(evidence.program.q))
    which = np.zeros(len(best), dtype=np.uint8)
    for index, share in _shares(evidence, motion):
        which[share > best] = index
        np.maximum(best, share, out=best)
    return Binding(which, best)


def _shares(evidence: Evidence, motion: Motion) -> Iterator[tuple[int, Array]]:
    """How much is used of each limit that there is, (N,), with its index."""
    if len(motion.speed):
        yield 0, _feed(evidence, motion.speed)
        yield 1, motion.speed / evidence.robot.tool.max_speed
        yield 2, motion.acceleration / evidence.robot.tool.max_acceleration
    joints = evidence.robot.joints
    limits = (joints.max_speed, joints.max_acceleration, joints.max_jerk)
    for index, (values, limit) in enumerate(zip(motion.joints[1:], limits, strict=True), start=3):
        if limit is not None:
            yield index, np.abs(values / np.reshape(limit, (3, 1))).max(axis=0)


def _feed(evidence: Evidence, speed: Array) -> Array:
    """The share of the process's speed while the laser moves along the sheet; 0 elsewhere."""
    process = evidence.program.process
    engraves = evidence.is_kind(frozenset({BlockKind.ENGRAVE}))
    feed = np.where(engraves, process.engrave_feed or np.inf, process.feed)
    return np.where(evidence.is_kind(MOVING_KINDS), speed / feed, 0.0)
