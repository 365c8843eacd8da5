"""What is cut and where, and the stretches of the program that comes of it."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum

from deltacam.model.curve import Curve
from deltacam.model.drawing import Operation


@dataclass(frozen=True, slots=True)
class Placement:
    """Where the sheet frame lies in the machine frame: machine xy = Rz(rotation) * sheet xy + (x, y), at height z."""

    x: float
    y: float
    rotation: float
    z: float


class BlockKind(StrEnum):
    """What a stretch of the program does."""

    RAPID = "rapid"
    PIERCE = "pierce"
    LEAD_IN = "lead_in"
    CUT = "cut"
    LOOP = "loop"
    TAB = "tab"
    OVERCUT = "overcut"
    LEAD_OUT = "lead_out"
    ENGRAVE = "engrave"


@dataclass(frozen=True, slots=True, eq=False)
class Stretch:
    """A part of the way of the tool along a cut.

    Attributes:
        kind: what is done there. The laser is off in a tab and in a lead-out, and on in all others.
        curve: open, sheet frame, m; it begins where the stretch before it ends.
        feed: m/s; None is that of the cut.
    """

    kind: BlockKind
    curve: Curve
    feed: float | None = None


@dataclass(frozen=True, slots=True, eq=False)
class Cut:
    """One path of the beam's centre, cut or engraved.

    Attributes:
        contour: the number of the drawn contour.
        layer: of the drawn contour.
        handles: of the drawn contour.
        curve: in the sheet frame; it starts at ``curve.points[0]``, and ends there where it is closed, else at
            ``curve.points[-1]``.
        operation: cut or engrave.
        way: of the tool, from the pierce to where the next move begins: lead-in, cut, loops, tabs, overcut, lead-out;
            empty where it is the curve alone.
        feed: m/s; None is that of the process.
        wait: at rest with the laser off before it begins, s.
    """

    contour: int
    layer: str
    handles: tuple[str, ...]
    curve: Curve
    operation: Operation = Operation.CUT
    way: tuple[Stretch, ...] = ()
    feed: float | None = None
    wait: float = 0.0

    @property
    def where(self) -> str:
        """How messages name it: ``contour 3 (layer CUT, #2F)``."""
        return f"contour {self.contour} (layer {self.layer}, #{self.handles[0]})"


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


@dataclass(frozen=True, slots=True)
class Search:
    """How the order of the cuts is looked for, and what of it is fixed.

    Attributes:
        time: about how long, s; None for what usually pays.
        seed: of what is tried at random; the same gives the same order.
        together: whether all contours of a part are cut before those of the next.
        starts: places on closed contours, m, sheet frame, where their cuts begin.
    """

    time: float | None = None
    seed: int = 0
    together: bool = False
    starts: tuple[tuple[float, float], ...] = ()
