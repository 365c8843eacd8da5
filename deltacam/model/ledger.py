"""What became of the entities of a drawing."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum


class Outcome(StrEnum):
    """What became of an entity of the drawing."""

    CUT = "cut"
    ENGRAVED = "engraved"
    MERGED = "merged"
    IGNORED = "ignored"
    LOST = "lost"


@dataclass(frozen=True, slots=True)
class LedgerEntry:
    """What became of one entity of the drawing, and why.

    Attributes:
        handle: the DXF handle, with a counter where the file gives none.
        kind: the DXF type: LINE, ARC, TEXT, ...
        layer: the layer it is drawn on.
        block: the names of the blocks that hold it, outermost first, joined by "/"; empty in the modelspace.
        outcome: cut, engraved, merged, ignored or lost.
        reason: why it is not machined, in words; empty when it is.
        contour: the number of the contour that it became part of, if any.
    """

    handle: str
    kind: str
    layer: str
    block: str
    outcome: Outcome
    reason: str = ""
    contour: int | None = None
