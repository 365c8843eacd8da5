"""What entities look like: the colours and line types that their layers give them, and what each layer holds."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import TYPE_CHECKING, Any, Final

import numpy as np
from ezdxf.colors import DXF_DEFAULT_COLORS

from deltacam.model import Array, IntArray, Layer

if TYPE_CHECKING:
    from deltacam.drawing.entities.entity import Entity

WHITE: Final = 7
"""The colour of what has none: white on black, black on white."""

CONTINUOUS: Final = "Continuous"
"""The line type of what has none."""

_BYBLOCK, _BYLAYER = 0, 256


@dataclass(frozen=True, slots=True)
class Style:
    """How a layer is drawn.

    Attributes:
        name: as the table of layers writes it.
        state: on, off or frozen.
        color: AutoCAD colour index, 1 to 255.
        linetype: its name.
    """

    name: str
    state: str = "on"
    color: int = WHITE
    linetype: str = CONTINUOUS


def styles(document: Any) -> dict[str, Style]:
    """The layers of a document by their names in lower case."""
    found = {}
    for layer in document.layers:
        name = printable(layer.dxf.name)
        state = "frozen" if layer.is_frozen() else "off" if layer.is_off() else "on"
        color = _index(abs(int(layer.dxf.get("color", WHITE))), layer.dxf.get("true_color"))
        linetype = printable(layer.dxf.get("linetype", CONTINUOUS))
        found[name.casefold()] = Style(name, state, color if 0 < color < _BYLAYER else WHITE, linetype)
    return found


def color(index: int, true_color: int | None, *, layer: Style, block: int) -> int:
    """The AutoCAD colour index of an entity as it is seen, 1 to 255.

    Args:
        index: as the entity has it: 0 for that of the block, 256 for that of the layer.
        true_color: 0xRRGGBB, if the entity has one; the nearest index stands for it where the entity has none.
        layer: of the entity.
        block: the colour of the INSERT around it.
    """
    index = _index(index, true_color)
    if index == _BYBLOCK:
        return block
    return index if 0 < index < _BYLAYER else layer.color


def linetype(name: str, *, layer: Style, block: str) -> str:
    """The name of an entity's line type as it is seen."""
    known = name.casefold()
    return layer.linetype if known == "bylayer" else block if known == "byblock" else name


def tabulate(document: Any, entities: Sequence[Entity], owner: IntArray) -> tuple[Layer, ...]:
    """The layers that hold something, in the order of their first entity.

    Args:
        document: from ``document.load``.
        entities: everything that was read from it.
        owner: the index of the entity that each curve is of.
    """
    known = styles(document)
    held = Counter(entity.layer for entity in entities)
    drawn = Counter(entities[i].layer for i in owner.tolist())
    names: dict[str, list[str]] = {}
    for name in held:
        names.setdefault(name.casefold(), []).append(name)
    table = []
    for key, spellings in names.items():
        style = known.get(key, Style(spellings[0]))
        count, curves = (sum(counter[name] for name in spellings) for counter in (held, drawn))
        table.append(Layer(style.name, style.state, style.color, style.linetype, count, curves))
    return tuple(table)


def printable(value: object) -> str:
    """A name from the file as printable text; bytes that no encoding explains become question marks."""
    text = str(value)
    return text if text.isascii() else text.encode("utf-8", "surrogateescape").decode("utf-8", "replace")


def _index(index: int, true_color: int | None) -> int:
    """The colour index that the file gives, or the one nearest to a true colour where it gives none or a default."""
    return _nearest(true_color) if true_color is not None and index in (_BYLAYER, WHITE) else index


@cache
def _palette() -> Array:
    """The colours 1 to 255, (255, 3)."""
    values = np.array(DXF_DEFAULT_COLORS[1:256])
    return np.stack([values >> 16, values >> 8 & 255, values & 255], axis=1).astype(np.float64)


@cache
def _nearest(true_color: int) -> int:
    """The colour index nearest to 0xRRGGBB; black is drawn as white, like the lines that are not coloured at all."""
    rgb = np.array([true_color >> 16 & 255, true_color >> 8 & 255, true_color & 255])
    if not rgb.any():
        return WHITE
    return 1 + int(np.argmin(np.sum((_palette() - rgb) ** 2, axis=1)))
