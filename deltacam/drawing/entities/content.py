"""The entities of one layout or block as it is seen from its INSERT, and the numbers of what they draw."""

from __future__ import annotations

import re
from dataclasses import dataclass, field, replace
from typing import Any, Final

from deltacam.drawing.entities import blocks, kinds, layers
from deltacam.drawing.entities.batches import Gathered
from deltacam.drawing.entities.blocks import Placement
from deltacam.drawing.entities.entity import Context, Entity
from deltacam.drawing.entities.layers import Style, printable

_KIND: Final = re.compile(r"[A-Z0-9_]*[A-Z][A-Z0-9_]*")

_UNKNOWN: Final = "UNKNOWN"
"""The kind of an entity of which the file does not say what it is."""


@dataclass(frozen=True, slots=True, eq=False)
class Insert:
    """An INSERT whose block is to be put in its places.

    Attributes:
        after: how many entities of the layout or block come before those of the block.
        placement: where the block is put.
        context: what the INSERT gives to it.
    """

    after: int
    placement: Placement
    context: Context


@dataclass(slots=True)
class Content:
    """A layout or block.

    Attributes:
        context: how it is seen.
        entities: its own, in the order of the file.
        gathered: what they draw.
        inserts: the blocks in it.
    """

    context: Context
    entities: list[Entity] = field(default_factory=list)
    gathered: Gathered = field(default_factory=Gathered)
    inserts: list[Insert] = field(default_factory=list)


def read(container: Any, context: Context, styles: dict[str, Style]) -> Content:
    """The entities of a layout or block and the numbers of what they draw.

    Args:
        container: iterable of ezdxf's entities.
        context: what the INSERT around them gives to them.
        styles: the layers of the document by their names in lower case.
    """
    content = Content(context)
    block, looks = "/".join(context.blocks), _Looks(context, styles)
    entities, gathered = content.entities, content.gathered
    for raw in container:
        numbers, kind = raw.dxf.__dict__, raw.dxftype()
        layer, color, linetype = looks.of(raw, numbers)
        reason, hidden, lost = "", False, False
        if numbers.get("invisible"):
            reason, hidden = "marked as invisible", True
        elif kind == "INSERT":
            insert = Entity(_handle(numbers), kind, layer, block, color, linetype)
            _insert(raw, insert, content)
            continue
        elif kinds.is_drawn(kind):
            try:
                reason = kinds.gather(kind, raw, len(entities), gathered)
            except Exception as error:  # noqa: BLE001  # damaged numbers make ezdxf and numpy stumble over anything
                reason, lost = _what(error), True
        elif _KIND.fullmatch(kind):
            reason, lost = kinds.why_not(kind), not kinds.is_known(kind)
        else:
            reason, lost = f"where a kind of entity is expected the file says {printable(kind)[:40]!r}", True
            kind = _UNKNOWN
        entities.append(Entity(_handle(numbers), kind, layer, block, color, linetype, reason, 0.0, hidden, lost))
    return content


class _Looks:
    """Layer, colour and line type of entities; most of a drawing look like one of a few."""

    def __init__(self, context: Context, styles: dict[str, Style]) -> None:
        self._context = context
        self._styles = styles
        self._known: dict[tuple[object, ...], tuple[str, int, str]] = {}

    def of(self, raw: Any, numbers: dict[str, Any]) -> tuple[str, int, str]:
        """The layer, colour and line type of an entity as it is seen, of any kind."""
        get = numbers.get
        key = (get("layer"), get("color"), get("true_color"), get("linetype"))
        if key[0] is None and not raw.dxf.is_supported("layer"):  # an entity that ezdxf only stores
            properties = raw.graphic_properties()
            key = tuple(properties.get(name) for name in ("layer", "color", "true_color", "linetype"))
        found = self._known.get(key)
        if found is None:
            found = self._known[key] = self._resolve(*key)
        return found

    def _resolve(self, layer: Any, color: Any, true_color: Any, linetype: Any) -> tuple[str, int, str]:
        context = self._context
        name = printable("0" if layer is None else layer)
        name = context.layer if name == "0" else name
        style = self._styles.get(name.casefold(), Style(name))
        return (
            name,
            layers.color(256 if color is None else int(color), true_color, layer=style, block=context.color),
            layers.linetype(
                printable("BYLAYER" if linetype is None else linetype), layer=style, block=context.linetype
            ),
        )


def _insert(raw: Any, insert: Entity, content: Content) -> None:
    """An INSERT's own line, its attributes, and where its block is put."""
    placement = None
    try:
        placement = blocks.placement(raw)
        insert = replace(insert, reason=f"its block {placement.block} is listed entity by entity")
    except Exception as error:  # noqa: BLE001  # as above
        insert = replace(insert, reason=_what(error), lost=True)
    content.entities.append(insert)
    for attribute in raw.attribs:
        handle = _handle(attribute.dxf.__dict__)
        reason = kinds.why_not("ATTRIB")
        content.entities.append(replace(insert, handle=handle, kind="ATTRIB", reason=reason, lost=False))
    if placement is not None:
        context = content.context.inside(insert, placement.block)
        content.inserts.append(Insert(len(content.entities), placement, context))


def _handle(numbers: dict[str, Any]) -> str:
    """The handle of an entity, or a question mark."""
    return printable(numbers.get("handle") or "?")


def _what(error: Exception) -> str:
    """What is wrong with an entity, from the exception that it led to; passes on what is no fault of the entity."""
    if isinstance(error, MemoryError):
        raise error
    if isinstance(error, KeyError):
        return f"it gives no {str(error.args[0]).replace('_', ' ')}" if error.args else "a number is missing"
    text = next(iter(str(error).splitlines()), "") or type(error).__name__
    return text if isinstance(error, ValueError) else f"it is damaged: {text[:120]}"
