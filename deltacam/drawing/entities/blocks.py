"""Blocks: how many entities they stand for, counted before anything is built, and where an INSERT puts them."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from deltacam.drawing.entities import kinds
from deltacam.drawing.entities.layers import printable
from deltacam.errors import DrawingError
from deltacam.model import Array

MAX_ENTITIES: Final = 5_000_000
"""More, blocks counted as often as they are inserted, are refused."""

MAX_NESTING: Final = 32
"""Blocks nested deeper are refused; a block that holds itself is found by its name."""

_REFERENCE: Final = 4 | 8 | 16
"""Bits of a BLOCK whose content is in another file."""

_HINT: Final = "bind external references, then export again"


@dataclass(frozen=True, slots=True, eq=False)
class Placement:
    """Where an INSERT puts its block.

    Attributes:
        block: its name as the file writes it.
        content: the block.
        matrix: (3, 3) from the block's coordinates to the directions around the INSERT: [x y z] @ matrix.
        offsets: (K, 3) where the origin of the block comes to lie, row by row of an array.
    """

    block: str
    content: Any
    matrix: Array
    offsets: Array


def is_hidden(numbers: dict[str, Any]) -> bool:
    """Whether an entity is marked as invisible."""
    return bool(numbers.get("invisible", 0))


def placement(raw: Any) -> Placement:
    """Where an INSERT puts its block.

    Raises:
        ValueError: the block is not in the file, or its scale makes it vanish.
        KeyError: a number that is missing.
    """
    numbers = raw.dxf.__dict__
    name = printable(numbers["name"])
    block = _block(raw)
    if block is None:
        raise ValueError(f"the block {name} that is inserted here is not in the file")
    if int(block.block.dxf.get("flags", 0)) & _REFERENCE:
        raise ValueError(f"the block {name} that is inserted here is in another file")
    scale = [float(numbers.get(each, 1.0)) for each in ("xscale", "yscale", "zscale")]
    angle = math.radians(float(numbers.get("rotation", 0.0)))
    cos, sin = math.cos(angle), math.sin(angle)
    turn = np.array([(cos, sin, 0.0), (-sin, cos, 0.0), (0.0, 0.0, 1.0)])
    own = kinds.axes(numbers["extrusion"]) if "extrusion" in numbers else np.eye(3)
    with np.errstate(all="ignore"):
        matrix = np.array(scale)[:, None] * turn @ own
        # The rows and columns of an array turn with the INSERT but are not scaled.
        places = np.array(tuple(numbers["insert"])) + _grid(numbers) @ turn
        offsets = places @ own - np.array(tuple(block.block.dxf.base_point)) @ matrix
        if not (np.isfinite(matrix).all() and np.isfinite(offsets).all()):
            raise ValueError("its place, scale or rotation is not a number")
        if not scale[0] * scale[1]:
            raise ValueError("its scale makes the block vanish")
    return Placement(name, block, matrix, offsets)


def hint(reason: str) -> str:
    """What to do about an INSERT that cannot be placed."""
    return _HINT if "inserted here" in reason else "insert the block again in the CAD program"


@dataclass(slots=True)
class Census:
    """Counts the entities of a drawing, each block once, however often it is inserted."""

    counts: dict[str, tuple[int, int]] = field(default_factory=dict)

    def check(self, modelspace: Any) -> None:
        """Raises where the drawing would hold too many entities.

        Raises:
            DrawingError: blocks that hold themselves or are nested too deep, arrays that multiply, too many entities.
        """
        self._count(modelspace, ())

    def _count(self, container: Any, path: tuple[str, ...]) -> tuple[int, int]:
        """How many entities a layout or block stands for, and how deep blocks are nested in it."""
        total, depth = 0, 0
        for raw in container:
            total += 1
            if raw.dxftype() == "INSERT" and not is_hidden(raw.dxf.__dict__):
                many, below = self._insert(raw, path)
                total, depth = total + many, max(depth, below)
            if total > MAX_ENTITIES:
                what = f"the drawing has more than {MAX_ENTITIES} entities"
                hint = "save only what is to be cut"
                raise DrawingError(
                    f"{what}, counting blocks as often as they are inserted", where=_where(raw, path), hint=hint
                )
        return total, depth

    def _insert(self, raw: Any, path: tuple[str, ...]) -> tuple[int, int]:
        """How many entities an INSERT stands for, and how deep blocks are nested there."""
        block = _block(raw)
        if block is None:
            return len(raw.attribs), 0
        name = printable(raw.dxf.__dict__["name"])
        inside = (*path, name)
        if name.casefold() in (each.casefold() for each in path):
            what = f"blocks are nested without end: {'/'.join(inside)[:200]}"
            raise DrawingError(what, where=_where(raw, path), hint="delete the block in the CAD program")
        many, depth = 0, 0
        if len(path) < MAX_NESTING:
            if name not in self.counts:
                self.counts[name] = self._count(block, inside)
            many, depth = self.counts[name]
        if len(path) + depth >= MAX_NESTING:
            what = f"blocks are nested more than {MAX_NESTING} deep: {'/'.join(inside)[:200]}"
            raise DrawingError(what, where=_where(raw, path), hint="explode them in the CAD program")
        rows, columns = _counts(raw.dxf.__dict__)
        if rows * columns > MAX_ENTITIES:
            what = f"an array of {rows * columns} copies is more than {MAX_ENTITIES}"
            raise DrawingError(what, where=_where(raw, path), hint="check its rows and columns")
        return rows * columns * many + len(raw.attribs), depth + 1


def _block(raw: Any) -> Any:
    """The block of an INSERT, or None."""
    name = raw.dxf.__dict__.get("name")
    return None if name is None or raw.doc is None else raw.doc.blocks.get(name)


def _counts(numbers: dict[str, Any]) -> tuple[int, int]:
    """How many rows and columns an INSERT has that do not lie on each other."""
    rows = max(int(numbers.get("row_count", 1)), 1) if numbers.get("row_spacing", 0.0) else 1
    columns = max(int(numbers.get("column_count", 1)), 1) if numbers.get("column_spacing", 0.0) else 1
    return rows, columns


def _grid(numbers: dict[str, Any]) -> Array:
    """Where the copies of an array lie before they are turned, row by row, (K, 3)."""
    rows, columns = _counts(numbers)
    y, x = np.divmod(np.arange(rows * columns), columns)
    across, along = float(numbers.get("column_spacing", 0.0)), float(numbers.get("row_spacing", 0.0))
    return np.stack([across * x, along * y, np.zeros(len(x))], axis=1)


def _where(raw: Any, path: tuple[str, ...]) -> str:
    """How messages name an entity that is not read yet."""
    inside = f" in block {'/'.join(path)}"[:200] if path else ""
    numbers = raw.dxf.__dict__
    layer, handle = (printable(numbers.get(name, default)) for name, default in (("layer", "0"), ("handle", "?")))
    return f"layer {layer}, {raw.dxftype()} #{handle}{inside}"
