"""Every entity of the modelspace, and of the blocks inserted there, as a curve in the sheet plane or with a reason.

Entities on layers that are frozen or off are read like all others, with a finding per layer: exporters leave the real
part on such layers, and a missing contour is worse than one to switch off. Entities that are themselves marked
invisible are not read: dynamic blocks keep the variants that are not chosen that way.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from deltacam.drawing import kinds, shapes
from deltacam.drawing.document import translated
from deltacam.errors import DrawingError
from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Array, Curve, IntArray
from deltacam.units import to_mm

MAX_ENTITIES: Final = 1_000_000
"""More, blocks counted as often as they are inserted, are refused."""

MAX_NESTING: Final = 32
"""Blocks nested deeper are refused; a block that holds itself is found by its name."""

MAX_REACH: Final = 1e6
"""No part is larger, m; a larger number is damage."""

FLATNESS: Final = 1e-5
"""How far z may differ, m, within a flat drawing."""


_KIND: Final = re.compile(r"[A-Z0-9_]*[A-Z][A-Z0-9_]*")


@dataclass(frozen=True, slots=True, eq=False)
class Entity:
    """One entity of the drawing.

    Attributes:
        handle: its DXF handle.
        kind: its DXF type.
        layer: it is drawn on; entities on layer 0 of a block are on the layer of the INSERT.
        block: the names of the blocks around it, joined by "/".
        curve: what it draws, in the sheet frame, m; None where that is nothing to cut.
        reason: why there is no curve.
        error: largest distance of the curve from what it draws, m.
        hidden: whether it is marked as invisible.
    """

    handle: str
    kind: str
    layer: str
    block: str
    curve: Curve | None = None
    reason: str = ""
    error: float = 0.0
    hidden: bool = False

    @property
    def is_insert(self) -> bool:
        """Whether it stands for the entities of a block, which are listed by themselves."""
        return self.kind == "INSERT" and not self.hidden

    @property
    def where(self) -> str:
        """How messages name it."""
        inside = f" in block {self.block}" if self.block else ""
        return f"layer {self.layer}, {self.kind} #{self.handle}{inside}"


@dataclass(frozen=True, slots=True, eq=False)
class _Place:
    """Where the walk is: the block path, the layer of the INSERT, and the matrix (4, 4) to the sheet."""

    matrix: Array
    blocks: tuple[str, ...] = ()
    layer: str = "0"


class _Walk:
    """One pass over a document; counts entities and keeps the height of the first curve."""

    def __init__(self) -> None:
        self.count = 0
        self.height: float | None = None

    def visit(self, container: Any, place: _Place) -> Iterator[Entity]:
        """The entities of a layout or block, those of inserted blocks right after their INSERT."""
        for raw in container:
            entity = _named(raw, place)
            self._count(entity)
            if kinds.is_hidden(raw):
                yield replace(entity, reason="marked as invisible", hidden=True)
            elif entity.kind == "INSERT":
                yield from self._insert(raw, entity, place)
            elif not kinds.is_drawn(entity.kind):
                yield replace(entity, reason=kinds.why_not(entity.kind))
            else:
                yield self._drawn(raw, entity, place)

    def _count(self, entity: Entity) -> None:
        self.count += 1
        if self.count > MAX_ENTITIES:
            what = f"the drawing has more than {MAX_ENTITIES} entities, counting blocks as often as they are inserted"
            raise DrawingError(what, where=entity.where)

    def _drawn(self, raw: Any, entity: Entity, place: _Place) -> Entity:
        """The entity with its curve."""
        with translated(entity.where):
            shape, matrix = kinds.read(raw)
        if isinstance(shape, str):
            return replace(entity, reason=shape)
        # Absurd numbers overflow without a word here; what comes out is checked.
        with np.errstate(all="ignore"), translated(entity.where, ValueError):
            matrix = matrix @ place.matrix
            _check_numbers(shape, matrix, entity)
            trace = shapes.trace(shape, matrix)
            _check_curve(trace.curve, entity)
        self._check_height(trace.heights, entity)
        if trace.curve is None:
            return replace(entity, reason=f"a {entity.kind} of length zero")
        return replace(entity, curve=trace.curve, error=trace.error)

    def _check_height(self, heights: tuple[float, float], entity: Entity) -> None:
        low, high = heights
        hint = "project the drawing onto the xy plane in the CAD program"
        if high - low > FLATNESS:
            what = f"it is not flat: z runs from {to_mm(low):.6g} to {to_mm(high):.6g} mm"
            raise DrawingError(what, where=entity.where, hint=hint)
        if self.height is None:
            self.height = low
        if abs(low - self.height) > FLATNESS:
            what = (
                f"the drawing is not flat: this lies at z = {to_mm(low):.6g} mm, others at {to_mm(self.height):.6g} mm"
            )
            raise DrawingError(what, where=entity.where, hint=hint)

    def _insert(self, raw: Any, entity: Entity, place: _Place) -> Iterator[Entity]:
        """An INSERT's own line, its attributes, and the entities of its block, once per place of an array."""
        name = _text(raw.dxf.name)
        if name in place.blocks or len(place.blocks) >= MAX_NESTING:
            inside = "/".join((*place.blocks, name))
            raise DrawingError(f"blocks are nested without end: {inside[:200]}", where=entity.where)
        with translated(entity.where):
            block = raw.block()
        if block is None:
            what = f"the block {name} that is inserted here is not in the file"
            raise DrawingError(what, where=entity.where, hint="bind external references, then export again")
        yield replace(entity, reason=f"its block {name} is listed entity by entity")
        for attribute in raw.attribs:
            line = _named(attribute, place)
            self._count(line)
            yield replace(line, reason=kinds.why_not("ATTRIB"))
        with translated(entity.where):
            copies = list(self._copies(raw, entity))
        for matrix in copies:
            yield from self.visit(block, _Place(matrix @ place.matrix, (*place.blocks, name), entity.layer))

    def _copies(self, raw: Any, entity: Entity) -> Iterator[Array]:
        """The matrix (4, 4) of each place of an INSERT."""
        many = max(int(raw.dxf.row_count), 1) * max(int(raw.dxf.column_count), 1)
        if many > MAX_ENTITIES:
            raise DrawingError(f"an array of {many} copies is more than {MAX_ENTITIES}", where=entity.where)
        for insert in raw.multi_insert() if many > 1 else (raw,):
            matrix = np.array(list(insert.matrix44())).reshape(4, 4)
            if not (np.isfinite(matrix).all() and np.cross(matrix[0, :3], matrix[1, :3]).any()):
                raise DrawingError("its scale makes the block vanish", where=entity.where)
            yield matrix


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """What a document draws.

    Attributes:
        entities: every one, in the order of the file, those of blocks after their INSERT.
        curves: what they draw, M curves.
        owner: (M,) the index of the entity that each curve is of; increasing.
    """

    entities: list[Entity]
    curves: Pack
    owner: IntArray

    def without_curve(self) -> list[Entity]:
        """The entities that draw no line."""
        drawn = set(self.owner.tolist())
        return [entity for i, entity in enumerate(self.entities) if i not in drawn]


def read(document: Any, metres_per_unit: float) -> Drawn:
    """Every entity of the modelspace in the order of the file, those of blocks after their INSERT.

    Args:
        document: from ``document.load``.
        metres_per_unit: the scale from the file's numbers to metres.

    Raises:
        DrawingError: an entity that is damaged, not flat or absurdly far away; a missing or endless block.
    """
    scale = np.diag([metres_per_unit, metres_per_unit, metres_per_unit, 1.0])
    found = list(_Walk().visit(document.modelspace(), _Place(scale)))
    owner = np.array([i for i, entity in enumerate(found) if entity.curve is not None], dtype=np.int64)
    pack = Pack.of(entity.curve for entity in found if entity.curve is not None)
    return Drawn([replace(entity, curve=None) for entity in found], pack, owner)


def _named(raw: Any, place: _Place) -> Entity:
    """An entity with its names only."""
    kind = _text(raw.dxftype())
    if not _KIND.fullmatch(kind):
        what = f"where a kind of entity is expected the file says {kind[:40]!r}"
        raise DrawingError(what, where=f"entity #{raw.dxf.handle}", hint="the file is damaged: export it again")
    with translated(f"{kind} #{raw.dxf.handle}"):
        layer = _text(kinds.layer(raw))
    return Entity(
        handle=_text(raw.dxf.handle or "?"),
        kind=kind,
        layer=place.layer if layer == "0" else layer,
        block="/".join(place.blocks),
    )


def _check_numbers(shape: shapes.Shape, matrix: Array, entity: Entity) -> None:
    """Raises where a coordinate is not a number or is absurd."""
    if isinstance(shape, shapes.Conic):
        points = shape.frame[:1] + np.array([[0.0], [1.0], [1.0]]) * shape.frame
    else:
        points = shape.points if isinstance(shape, shapes.Lines) else shape.control
    _check_reach(float(np.abs(points @ matrix[:3, :3] + matrix[3, :3]).max()), entity)


def _check_curve(curve: Curve | None, entity: Entity) -> None:
    """Raises where an arc is absurdly long; its ends alone do not show that."""
    if curve is not None:
        _check_reach(float(curves.lengths(curve).max()), entity)


def _check_reach(reach: float, entity: Entity) -> None:
    """Raises where a coordinate or length, m, is not a number or is absurd."""
    if not reach <= MAX_REACH:
        what = f"it reaches {reach:.3g} m, beyond the limit of {MAX_REACH:.0f} m"
        raise DrawingError(what, where=entity.where, hint="check the unit (--units) and the entity")


def _text(value: object) -> str:
    """A name from the file as printable text; bytes that no encoding explains become question marks."""
    return str(value).encode("utf-8", "surrogateescape").decode("utf-8", "replace")
