"""A drawing as it was read, and how it is to be read."""

from __future__ import annotations

from dataclasses import dataclass
from enum import StrEnum
from typing import Final

from deltacam.model.curve import Curve
from deltacam.model.findings import Finding
from deltacam.model.ledger import LedgerEntry


class Operation(StrEnum):
    """What is done with the lines of a drawing.

    Closed lines to be cut are shifted by half a kerf to their waste side; what is engraved, and what is open, is
    followed on the line itself.
    """

    CUT = "cut"
    ENGRAVE = "engrave"
    IGNORE = "ignore"


@dataclass(frozen=True, slots=True)
class Rule:
    """Which lines of a drawing an operation is for; what is not given matches everything.

    Attributes:
        operation: of the entities that match.
        layer: pattern of the layer's name with ``*`` and ``?``, in any case; several with commas between them.
        color: AutoCAD colour index, 1 to 255, as it is seen: that of the layer where the entity says so.
        linetype: pattern of the line type's name as it is seen, like that of the layer.
        open: what is done with chains of these entities that do not close.
    """

    operation: Operation
    layer: str | None = None
    color: int | None = None
    linetype: str | None = None
    open: Operation = Operation.IGNORE


_ENGRAVED: Final = (
    "*ENGRAV*,*GRAVUR*,*GRAVIER*,ETCH*,*_ETCH*,*-ETCH*,* ETCH*,"
    "SCORE,SCORES,SCORE_*,SCORE-*,SCORE *,SCORING*,*_SCORE,*-SCORE,* SCORE,"
    "MARK,MARK_*,MARK-*,MARK *,MARKING*,IV_MARK_SURFACE"
)  # names with sketch, underscore, market or centre mark in them are not meant

DEFAULT_RULES: Final = (
    Rule(Operation.ENGRAVE, layer=_ENGRAVED, open=Operation.ENGRAVE),
    Rule(Operation.IGNORE, layer="DEFPOINTS"),  # which CAD programs never plot
)
"""What is done with the lines of a drawing where nobody says otherwise; all others are cut."""

DEFAULT_JOINING: Final = 1e-5
"""Ends up to 0.01 mm apart are joined where nobody says otherwise."""


@dataclass(frozen=True, slots=True)
class Selection:
    """Which lines of a drawing are machined, and how far apart their ends may be.

    Attributes:
        rules: the first one that matches an entity says what is done with it; where none does, it is cut.
        open: what is done with chains that do not close, of entities that no rule matches.
        layers: patterns; where there are any, entities on other layers are ignored.
        ignored_layers: patterns; entities on these layers are ignored.
        joining: largest distance between ends that are joined, m.
        accept_loss: whether to go on where parts of a damaged file could not be read.
    """

    rules: tuple[Rule, ...] = DEFAULT_RULES
    open: Operation = Operation.IGNORE
    layers: tuple[str, ...] = ()
    ignored_layers: tuple[str, ...] = ()
    joining: float = DEFAULT_JOINING
    accept_loss: bool = False


EVERYTHING: Final = Selection()
"""All layers, by the default rules."""


@dataclass(frozen=True, slots=True, eq=False)
class Contour:
    """One closed line of the drawing, or one chain of lines that does not close.

    Attributes:
        number: closed ones count from 1 in the order of the file, then the open ones; the same in every run.
        curve: in the sheet frame, m; counter-clockwise where it is closed.
        layer: the layer of its first entity.
        handles: the handles of its entities in the order of the curve.
        depth: how many contours contain it: even for outlines of material, odd for holes.
        parent: the number of the contour directly around it.
        operation: what is done with it.
    """

    number: int
    curve: Curve
    layer: str
    handles: tuple[str, ...]
    depth: int = 0
    parent: int | None = None
    operation: Operation = Operation.CUT

    @property
    def where(self) -> str:
        """How messages name it: ``contour 3 (layer CUT, #2F)``."""
        return f"contour {self.number} (layer {self.layer}, #{self.handles[0]})"

    @property
    def is_hole(self) -> bool:
        """Whether the material is outside it."""
        return self.depth % 2 == 1

    @property
    def has_kerf(self) -> bool:
        """Whether it is cut beside the line rather than followed on it."""
        return self.curve.closed and self.operation is Operation.CUT


@dataclass(frozen=True, slots=True)
class Layer:
    """A layer of the drawing that holds something.

    Attributes:
        name: as the file writes it.
        state: on, off or frozen.
        color: AutoCAD colour index.
        linetype: its name.
        entities: how many entities lie on it, those of inserted blocks counted as often as they are inserted.
        curves: how many of them draw a line.
    """

    name: str
    state: str
    color: int
    linetype: str
    entities: int
    curves: int


@dataclass(frozen=True, slots=True, eq=False)
class Drawing:
    """What was read from a drawing.

    Attributes:
        file: the file's name without its folder.
        sha256: of the file's bytes, hexadecimal.
        metres_per_unit: the scale that was applied to the file's numbers.
        unit: its name; empty where nobody states one.
        unit_source: who states it: header, --units, deltacam.toml, given or missing.
        contours: what is cut or engraved, in the order of their numbers.
        ledger: one entry per entity.
        findings: what a person should know.
        conversion_error: largest distance of the contours from the exact geometry of the file, m.
        ignored: contours that were joined like the others but are neither cut nor engraved.
        layers: in the order in which they first appear.
        extents: smallest x and y, largest x and y of all curves, m; None where there is none.
        selection: how it was read.
    """

    file: str
    sha256: str
    metres_per_unit: float
    unit: str
    unit_source: str
    contours: tuple[Contour, ...]
    ledger: tuple[LedgerEntry, ...]
    findings: tuple[Finding, ...] = ()
    conversion_error: float = 0.0
    ignored: tuple[Contour, ...] = ()
    layers: tuple[Layer, ...] = ()
    extents: tuple[float, float, float, float] | None = None
    selection: Selection = EVERYTHING

    @property
    def unit_in_words(self) -> str:
        """The unit and who states it: ``mm (header)``."""
        return f"{self.unit or 'mm'} ({self.unit_source})"
