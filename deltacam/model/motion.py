"""What is cut and where, and the stretches of the program that comes of it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from deltacam.model.curve import Curve


@dataclass(frozen=True, slots=True)
class Placement:
    """Where the sheet frame lies in the base frame: base xy = Rz(rotation) * sheet xy + (x, y), at height z."""

    x: float
    y: float
    rotation: float
    z: float


@dataclass(frozen=True, slots=True, eq=False)
class Cut:
    """One closed path of the beam's centre.

    Attributes:
        contour: the number of the drawn contour.
        layer: of the drawn contour.
        handles: of the drawn contour.
        curve: closed, in the sheet frame; it starts and ends at ``curve.points[0]``.
    """

    contour: int
    layer: str
    handles: tuple[str, ...]
    curve: Curve


class BlockKind(StrEnum):
    """What a stretch of the program does."""

    RAPID = "rapid"
    PIERCE = "pierce"
    LEAD_IN = "lead_in"
    CUT = "cut"
    LEAD_OUT = "lead_out"


class Mode(StrEnum):
    """What a program is for: to cut, the same motion with the laser off, or the bounding box with the laser off."""

    CUT = "cut"
    DRY_RUN = "dry_run"
    FRAME = "frame"


@dataclass(frozen=True, slots=True)
class Block:
    """A stretch of the program from tick ``first`` to tick ``last``, both included."""

    kind: BlockKind
    first: int
    last: int
    contour: int | None = None
    layer: str = ""
    handles: tuple[str, ...] = ()
