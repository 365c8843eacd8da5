"""One entity of a drawing: its names, how it looks, and what is wrong with it."""

from __future__ import annotations

from dataclasses import dataclass

from deltacam.drawing.entities.layers import CONTINUOUS, WHITE


@dataclass(frozen=True, slots=True)
class Entity:
    """One entity of the drawing.

    Attributes:
        handle: its DXF handle.
        kind: its DXF type.
        layer: it is drawn on; entities on layer 0 of a block are on the layer of the INSERT.
        block: the names of the blocks around it, joined by "/".
        color: AutoCAD colour index as it is seen, 1 to 255.
        linetype: the name of its line type as it is seen.
        reason: why it draws no line.
        error: largest distance of its curve from what it draws, m.
        hidden: whether it is marked as invisible.
        lost: whether it should draw a line, but is damaged or not in the file.
    """

    handle: str
    kind: str
    layer: str
    block: str = ""
    color: int = WHITE
    linetype: str = CONTINUOUS
    reason: str = ""
    error: float = 0.0
    hidden: bool = False
    lost: bool = False

    @property
    def is_insert(self) -> bool:
        """Whether it stands for the entities of a block, which are listed by themselves."""
        return self.kind == "INSERT" and not self.hidden and not self.lost

    @property
    def where(self) -> str:
        """How messages name it."""
        inside = f" in block {self.block}" if self.block else ""
        return f"layer {self.layer}, {self.kind} #{self.handle}{inside}"


@dataclass(frozen=True, slots=True)
class Context:
    """What an INSERT gives to the entities of its block.

    Attributes:
        blocks: the names of the blocks around them, the outermost first.
        layer: of entities on layer 0.
        color: of entities that have the colour of their block.
        linetype: of entities that have the line type of their block.
    """

    blocks: tuple[str, ...] = ()
    layer: str = "0"
    color: int = WHITE
    linetype: str = CONTINUOUS

    def inside(self, insert: Entity, block: str) -> Context:
        """What an INSERT that is seen like this gives to its block."""
        return Context((*self.blocks, block), insert.layer, insert.color, insert.linetype)
