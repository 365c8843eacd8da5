"""The parts of a cut that are each run from rest to rest: what lies between its tabs, and the tabs."""

from __future__ import annotations

import itertools
from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Curve, Cut, IntArray, Operation, Stretch
from deltacam.motion.tape import NUMBER


class Part(NamedTuple):
    """A part of a cut.

    Attributes:
        curve: of all its stretches, sheet frame.
        stretch: (M,) what is done along each segment, as `tape.KINDS` numbers it.
        speed: (M,) m/s, not to be exceeded in each segment; infinite where the cut's own feed counts.
        is_tab: whether it is run with the laser off, from where the part before it ended.
    """

    curve: Curve
    stretch: IntArray
    speed: Array
    is_tab: bool


def parts(cut: Cut) -> Iterator[Part]:
    """The parts of a cut in order."""
    kind = BlockKind.ENGRAVE if cut.operation is Operation.ENGRAVE else BlockKind.CUT
    way = cut.way or (Stretch(kind, cut.curve),)
    for is_tab, stretches in itertools.groupby(way, key=lambda one: one.kind is BlockKind.TAB):
        found = tuple(stretches)
        counts = [len(one.curve.bulges) for one in found]
        stretch = np.repeat([NUMBER[one.kind] for one in found], counts)
        speed = np.repeat([np.inf if one.feed is None else one.feed for one in found], counts)
        yield Part(curves.chain([one.curve for one in found]), stretch, speed, is_tab)
