"""What a person should know about the entities of a drawing, apart from how their lines meet."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from deltacam.drawing import operations
from deltacam.drawing.entities.walk import Drawn, Entity
from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Contour, Finding, Layer, Selection
from deltacam.units import to_mm

_WORDS: Final = frozenset({"TEXT", "MTEXT", "DIMENSION", "LEADER", "MULTILEADER", "TOLERANCE", "ACAD_TABLE"})
_MANY_WORDS: Final = 10
"""Texts and dimensions from which on a file looks like a drawing for people."""

_PAGES_MM: Final = {
    "A5": (148.0, 210.0),
    "A4": (210.0, 297.0),
    "A3": (297.0, 420.0),
    "A2": (420.0, 594.0),
    "A1": (594.0, 841.0),
    "A0": (841.0, 1189.0),
    "letter": (215.9, 279.4),
    "legal": (215.9, 355.6),
    "tabloid": (279.4, 431.8),
    "ANSI C": (431.8, 558.8),
    "ANSI D": (558.8, 863.6),
    "ANSI E": (863.6, 1117.6),
}
"""Sizes of paper (ISO 216, ANSI/ASME Y14.1), mm."""

_PAGE_TOLERANCE_MM: Final = 1.0

_DOUBLE: Final = 0.3e-3
"""Contours nearer than this to the one around them, m, look like the edges of a thick line."""

_MOST_DOUBLES: Final = 200
_MOST_NAMED: Final = 8


def hidden_layers(layers: Iterable[Layer], selection: Selection) -> list[Finding]:
    """One finding per layer that is frozen or off and holds lines, unless the user leaves it out."""
    return [
        Finding(
            f"the layer is {layer.state}, but its {counted(layer.curves, 'curve')} read like all others",
            where=f"layer {layer.name}",
            hint="leave it out with --ignore-layer if it is not to be cut",
            kind="layer",
        )
        for layer in layers
        if layer.state != "on" and layer.curves and not operations.left_out(layer.name, selection)
    ]


def left_out(layers: Iterable[Layer], selection: Selection) -> list[Finding]:
    """The finding that the user leaves layers out, with what they hold."""
    those = [layer for layer in layers if operations.left_out(layer.name, selection)]
    if not those:
        return []
    names = ", ".join(layer.name for layer in those[:_MOST_NAMED])
    more = f" and {len(those) - _MOST_NAMED} more" if len(those) > _MOST_NAMED else ""
    count = counted(sum(layer.entities for layer in those), "entity", "entities")
    where = f"layer {names}{more}"
    return [Finding(f"{count} left out as --layer and --ignore-layer say", where=where, kind="layer")]


def not_cut(found: Drawn) -> list[Finding]:
    """One finding per kind and layer of entities that draw no line."""
    left = [entity for entity in found.without_curve() if not entity.is_insert and not entity.lost]
    kinds: dict[tuple[str, str], list[Entity]] = {}
    for entity in left:
        kinds.setdefault((entity.kind, entity.reason), []).append(entity)
    return [
        Finding(f"{counted(len(those), kind)} not cut: {reason}", where=_layers(those), kind="not_cut")
        for (kind, reason), those in kinds.items()
    ]


def paper_space(count: int) -> list[Finding]:
    """The finding that entities in paper space were not read."""
    if not count:
        return []
    what = f"{counted(count, 'entity', 'entities')} not read: in paper space"
    return [Finding(what, hint="move what is to be cut to the modelspace", kind="paper_space")]


def open_chains(layers: Iterable[str]) -> list[Finding]:
    """One finding per layer that counts the chains that are only ignored because they do not close.

    Args:
        layers: that of each such chain.
    """
    hint = "close them in the drawing if they are outlines, or map them to engrave or cut in the process"
    return [
        Finding(f"{counted(count, 'open chain')} not cut", where=f"layer {layer}", hint=hint, kind="open")
        for layer, count in Counter(layers).items()
    ]


def drawing_sheet(entities: Sequence[Entity], contours: Sequence[Contour]) -> list[Finding]:
    """The findings that a file looks like a drawing for people: full of text, or with the frame of a page."""
    hint = "leave frames and title blocks out with --ignore-layer, or save only what is to be cut"
    findings = []
    words = Counter(entity.kind for entity in entities if entity.kind in _WORDS)
    if words.total() >= _MANY_WORDS:
        held = ", ".join(f"{count} {kind}" for kind, count in words.most_common(3))
        what = f"this looks like a drawing for people rather than a cut file: it holds {held}"
        findings.append(Finding(what, hint=hint, kind="drawing_sheet"))
    parents = {contour.parent for contour in contours}
    for contour in contours:
        if contour.depth or contour.number not in parents or len(contour.curve.points) != 4:
            continue
        left, bottom, right, top = curves.bounds(contour.curve)
        page = _page(to_mm(right - left), to_mm(top - bottom))
        if page:
            what = f"it has the size of a page ({page}) and lies around other contours: is it a frame?"
            findings.append(Finding(what, where=contour.where, hint=hint, kind="drawing_sheet"))
    return findings


def doubles(contours: Sequence[Contour]) -> list[Finding]:
    """Findings for contours that run just inside their neighbour all around: the two edges of one thick line.

    Args:
        contours: closed, nested.
    """
    place = {contour.number: i for i, contour in enumerate(contours)}
    pairs = [(i, place[contour.parent]) for i, contour in enumerate(contours) if contour.parent in place]
    if not pairs:
        return []
    inner, outer = np.array(pairs).T
    pack = Pack.of(contour.curve for contour in contours)
    boxes, lengths = pack.bounds(), pack.lengths()
    apart = np.abs(boxes[inner] - boxes[outer])
    narrow, wide = apart.min(axis=1), apart.max(axis=1)
    # Beside a curve that goes around once, one at the distance d is 2 pi d shorter, and 8 d beside a rectangle.
    alike = np.abs(lengths[outer] - lengths[inner]) <= 16.0 * wide
    close = (narrow > 0.0) & (wide <= np.minimum(_DOUBLE, 3.0 * narrow)) & (wide < 0.05 * lengths[inner]) & alike
    hint = "draw the line itself, without its width, if that is what is to be cut"
    return [
        Finding(
            f"it runs {to_mm(wide[k]):.3g} mm inside contour {contours[outer[k]].number} all around, "
            "like the other edge of a thick line",
            where=contours[inner[k]].where,
            hint=hint,
            kind="double",
            place=(float(contours[inner[k]].curve.points[0, 0]), float(contours[inner[k]].curve.points[0, 1])),
        )
        for k in np.flatnonzero(close)[:_MOST_DOUBLES]
    ]


def counted(count: int, one: str, many: str = "", *, verb: bool = True) -> str:
    """A count with its noun, and is or are: ``2 curves are``."""
    noun = one if count == 1 else many or (one if one.isupper() else f"{one}s")
    return f"{count} {noun}{(' is' if count == 1 else ' are') if verb else ''}"


def _layers(entities: Sequence[Entity]) -> str:
    """Where some entities are: the layer and handle of the first, and the other layers."""
    names = list(dict.fromkeys(entity.layer for entity in entities))
    more = f" and {len(names) - 3} more" if len(names) > 3 else ""
    handle = f", #{entities[0].handle}" if len(entities) == 1 else ""
    return f"layer {', '.join(names[:3])}{more}{handle}"


def _page(width: float, height: float) -> str:
    """The name of the paper size, mm, lying or standing; empty where it is none."""
    short, long = sorted((width, height))
    for name, (low, high) in _PAGES_MM.items():
        if abs(short - low) <= _PAGE_TOLERANCE_MM and abs(long - high) <= _PAGE_TOLERANCE_MM:
            return name
    return ""
