"""What every step of the tool is in a picture, and how such steps are drawn."""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from deltacam.model import BlockKind, BoolArray, IntArray
from deltacam.report import palette
from deltacam.report.palette import Ink
from deltacam.verification.evidence import LASER_KINDS, Evidence

RAPID, ENGRAVED, SUBJECT, BESIDE, TWICE, DARK = range(6)
"""What a step is: the subject is what is cut; lead-ins and loops run beside it, the overcut a second time over it, all
with the laser on; in the dark the tool is on the way of a cut with the laser off."""

BURNT: Final = (ENGRAVED, SUBJECT, BESIDE, TWICE)
"""What is done with the laser on, in the colours of a quantity."""


class Stroke(NamedTuple):
    """How the steps of a band are drawn.

    Attributes:
        width: pixels.
        dash: how long the dashes and the gaps are, pixels; 0 for a line without gaps.
        ink: where the line is not in the colour of a quantity.
    """

    width: float
    dash: tuple[float, float] = (0.0, 0.0)
    ink: Ink | None = None


STROKES: Final = {
    RAPID: Stroke(1.0, (4.0, 4.0), palette.RAPID),
    ENGRAVED: Stroke(1.5),
    SUBJECT: Stroke(2.6),
    BESIDE: Stroke(1.1),
    TWICE: Stroke(5.0),
    DARK: Stroke(1.5, (1.5, 2.0), palette.TEXT),
}

NAMES: Final = {
    SUBJECT: ((BlockKind.CUT, "cut"),),
    BESIDE: ((BlockKind.LEAD_IN, "lead-in"), (BlockKind.LOOP, "loop")),
    TWICE: ((BlockKind.OVERCUT, "overcut"),),
    DARK: ((BlockKind.LEAD_OUT, "lead-out, laser off"),),
    ENGRAVED: ((BlockKind.ENGRAVE, "engraved"),),
    RAPID: ((BlockKind.RAPID, "rapid"),),
}
"""What is in a band, in the order of the legend."""


def bands(evidence: Evidence) -> IntArray:
    """What each step is, (N - 1,). Where nothing is cut and nothing engraved, as in a frame, all is the subject."""
    steps = max(len(evidence.tool) - 1, 0)
    on = (evidence.is_kind(LASER_KINDS) | (evidence.program.power > 0.0))[:steps]

    def of(*kinds: BlockKind) -> BoolArray:
        return evidence.is_kind(frozenset(kinds))[:steps]

    found = np.where(on | (not on.any()), SUBJECT, RAPID)
    found[of(BlockKind.LEAD_OUT, BlockKind.TAB) & ~on] = DARK
    found[of(BlockKind.OVERCUT)] = TWICE
    found[of(BlockKind.LEAD_IN, BlockKind.LOOP)] = BESIDE
    found[of(BlockKind.ENGRAVE)] = ENGRAVED
    return found


def names(evidence: Evidence, band: IntArray) -> dict[int, str]:
    """What the bands that are there are called, in the order of the legend."""
    kinds = {block.kind for block in evidence.program.blocks}
    found = set(band.tolist())
    words = {one: ", ".join(word for kind, word in NAMES[one] if kind in kinds) for one in NAMES if one in found}
    return {one: word or ("laser off" if one == DARK else NAMES[one][0][1]) for one, word in words.items()}
