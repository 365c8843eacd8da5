"""Every entity of the modelspace, and of the blocks inserted there, with its curve in the sheet plane or a reason.

Entities on layers that are frozen or off are read like all others, with a finding per layer: exporters leave the real
part on such layers, and a missing contour is worse than one to switch off. Entities that are themselves marked
invisible are not read: dynamic blocks keep the variants that are not chosen that way.

The numbers of a layout or block are gathered in one pass and become curves as arrays. A block is read once for each
layer, colour and line type that an INSERT gives it, traced once for each way in which it is turned and scaled, and
then copied to its places.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any, Final

import numpy as np

from deltacam.drawing.entities import batches, blocks, content, layers, losses, traces
from deltacam.drawing.entities.content import Content, Insert
from deltacam.drawing.entities.entity import Context, Entity
from deltacam.drawing.entities.traces import Traces
from deltacam.errors import DrawingError
from deltacam.geometry.pack import Pack
from deltacam.model import Array, BoolArray, Finding, IntArray

__all__ = ["MAX_REACH", "MAX_VERTICES", "Drawn", "Entity", "read"]

MAX_REACH: Final = 1e6
"""No part is larger, m; a larger number is damage."""

MAX_VERTICES: Final = 10_000_000
"""A drawing with more, blocks counted as often as they are inserted, is refused."""

_KEPT: Final = 256
"""So many blocks as they are turned and scaled are kept for the next INSERT that needs the same."""


@dataclass(frozen=True, slots=True, eq=False)
class Drawn:
    """What a document draws.

    Attributes:
        entities: every one, in the order of the file, those of blocks after their INSERT.
        curves: what they draw, M curves.
        owner: (M,) the index of the entity that each curve is of; increasing.
        findings: entities that are lost or not flat, and the like.
    """

    entities: list[Entity]
    curves: Pack
    owner: IntArray
    findings: tuple[Finding, ...] = ()

    def without_curve(self) -> list[Entity]:
        """The entities that draw no line."""
        drawn = np.zeros(len(self.entities), dtype=np.bool_)
        drawn[self.owner] = True
        return [self.entities[i] for i in np.flatnonzero(~drawn).tolist()]


@dataclass(frozen=True, slots=True, eq=False)
class _Expanded:
    """A layout or block with the blocks in it, about its own origin: its entities and their curves."""

    entities: list[Entity]
    curves: Traces


def read(
    document: Any, metres_per_unit: float, *, concerns: Callable[[Sequence[Entity]], BoolArray] | None = None
) -> Drawn:
    """Every entity of the modelspace in the order of the file, those of blocks after their INSERT.

    Args:
        document: from ``document.load``.
        metres_per_unit: the scale from the file's numbers to metres.
        concerns: says of N entities which, (N,), findings are to be made of; all where it is not given.

    Raises:
        DrawingError: blocks that hold themselves, more entities or vertices than any drawing needs, no modelspace.
    """
    try:
        modelspace = document.modelspace()
    except KeyError:
        raise DrawingError("the file is damaged: it has no modelspace", hint="export the drawing again") from None
    blocks.Census().check(modelspace)
    walk = _Walk(document)
    whole = walk.expand(modelspace, Context(), metres_per_unit * np.eye(3))
    entities, curves = _within_reach(whole.entities, whole.curves)
    concerns = concerns or (lambda those: np.ones(len(those), dtype=np.bool_))
    concerned = concerns(entities)
    findings = [
        *losses.lost([entities[i] for i in np.flatnonzero(concerned).tolist()]),
        *losses.not_flat(entities, curves.take(np.flatnonzero(concerned[curves.owner]))),
        *losses.wide(_those(concerns, walk.wide)),
        *losses.guessed(_those(concerns, walk.guessed)),
    ]
    pack = Pack(curves.points, curves.bulges, curves.first, curves.closed)
    return Drawn(entities, pack, curves.owner, tuple(findings))


def _those(concerns: Callable[[Sequence[Entity]], BoolArray], named: dict[str, Entity]) -> list[Entity]:
    """The entities that findings are to be made of."""
    entities = list(named.values())
    return [entities[i] for i in np.flatnonzero(concerns(entities)).tolist()]


class _Walk:
    """One pass over a document.

    Attributes:
        wide: the first of all entities with a width that have one handle.
        guessed: the first of all splines through points that have one handle.
    """

    def __init__(self, document: Any) -> None:
        self.wide: dict[str, Entity] = {}
        self.guessed: dict[str, Entity] = {}
        self._styles = layers.styles(document)
        self._contents: dict[Context, Content] = {}
        self._expanded: dict[tuple[Context, bytes], _Expanded] = {}

    def expand(self, container: Any, context: Context, matrix: Array) -> _Expanded:
        """A layout or block, turned and scaled by a matrix (3, 3), with the blocks in it."""
        key = (context, matrix.tobytes())
        known = self._expanded.get(key)
        if known is None:
            if len(self._expanded) >= _KEPT:
                self._expanded.clear()
            known = self._expanded[key] = self._assemble(self._content(container, context), matrix)
        return known

    def _content(self, container: Any, context: Context) -> Content:
        """The entities of a layout or block as they are seen from there."""
        known = self._contents.get(context)
        if known is None:
            if len(self._contents) >= _KEPT:
                self._contents.clear()
            known = self._contents[context] = content.read(container, context, self._styles)
            for indices, named in ((known.gathered.wide, self.wide), (known.gathered.guessed, self.guessed)):
                for i in indices:
                    named.setdefault(known.entities[i].handle, known.entities[i])
        return known

    def _assemble(self, found: Content, matrix: Array) -> _Expanded:
        """The entities and curves of a layout or block, each block in it after its INSERT."""
        traced = batches.trace(found.gathered, matrix)
        curves = traced.curves()
        entities = _with_reasons(found.entities, curves, traced)
        vertices, inserted, parts = len(curves.points), 0, []
        starts = [0]
        pieces: list[list[Entity]] = []
        shift = np.zeros(len(entities) + 1, dtype=np.int64)
        for insert in found.inserts:
            below, offsets = self._below(insert, matrix)
            vertices += len(below.curves.points) * len(offsets)
            _check_vertices(vertices, insert)
            copied = below.curves.copies(offsets, len(below.entities))
            parts.append(copied.owned_by(copied.owner + (insert.after + inserted)))
            shift[insert.after] = len(below.entities) * len(offsets)
            inserted += len(below.entities) * len(offsets)
            pieces += [entities[starts[-1] : insert.after], below.entities * len(offsets)]
            starts.append(insert.after)
        if not found.inserts:
            return _Expanded(entities, curves)
        pieces.append(entities[starts[-1] :])
        curves = curves.owned_by(curves.owner + np.cumsum(shift)[curves.owner])
        return _Expanded([entity for piece in pieces for entity in piece], traces.merge([curves, *parts]))

    def _below(self, insert: Insert, matrix: Array) -> tuple[_Expanded, Array]:
        """The block of an INSERT, turned and scaled, and where it is put, (K, 3)."""
        with np.errstate(all="ignore"):
            placement = insert.placement
            below = self.expand(placement.content, insert.context, placement.matrix @ matrix)
            return below, placement.offsets @ matrix


def _with_reasons(entities: list[Entity], curves: Traces, traced: batches.Traced) -> list[Entity]:
    """The entities with what became known while they were traced."""
    inexact = np.flatnonzero(curves.errors > 0.0).tolist()
    if not (inexact or traced.points or traced.lost):
        return entities
    entities = list(entities)
    for k in inexact:
        i = int(curves.owner[k])
        entities[i] = replace(entities[i], error=float(curves.errors[k]))
    for i in traced.points:
        entities[i] = replace(entities[i], reason=f"a {entities[i].kind} of length zero")
    for i, reason in traced.lost.items():
        entities[i] = replace(entities[i], reason=reason, lost=True)
    return entities


def _within_reach(entities: list[Entity], curves: Traces) -> tuple[list[Entity], Traces]:
    """The entities and their curves, without those that are absurdly far away or nowhere."""
    if not len(curves):
        return entities, curves
    with np.errstate(invalid="ignore"):
        reach = np.maximum.reduceat(np.abs(curves.points).max(axis=1), curves.first[:-1])
        reach = np.maximum(reach, np.abs(curves.heights).max(axis=1))
    sane = reach <= MAX_REACH
    if sane.all():
        return entities, curves
    entities = list(entities)
    for k in np.flatnonzero(~sane).tolist():
        i = int(curves.owner[k])
        far = f"it reaches {reach[k]:.3g} m, {losses.BEYOND} {MAX_REACH:.0f} m"
        reason = "a coordinate is not a number" if np.isnan(reach[k]) else far
        entities[i] = replace(entities[i], reason=reason, error=0.0, lost=True)
    return entities, curves.take(np.flatnonzero(sane))


def _check_vertices(vertices: int, insert: Insert) -> None:
    """Raises where the copies of a block are too much for any machine."""
    if vertices > MAX_VERTICES:
        what = f"the drawing has more than {MAX_VERTICES} vertices, counting blocks as often as they are inserted"
        raise DrawingError(what, where=f"block {'/'.join(insert.context.blocks)}", hint="save only what is to be cut")
