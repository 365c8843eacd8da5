"""Whether a document holds every entity that the file holds.

ezdxf leaves out in silence what it finds in a place where it does not look: outside of sections, in a section that
comes twice, in a block that has no end. So the entities are counted in the file itself, and then in the document.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from typing import Any, Final

import numpy as np
from ezdxf.entities import factory
from ezdxf.entities.dxfentity import DXFTagStorage
from ezdxf.entities.dxfgfx import DXFGraphic

from deltacam.drawing.dxf.tags import Group, Groups

DRAWN: Final = frozenset(("LINE", "CIRCLE", "ARC", "ELLIPSE", "LWPOLYLINE", "POLYLINE", "VERTEX", "SPLINE", "INSERT"))
"""Kinds that draw something which can be cut, or are part of such."""

STRUCTURE: Final = frozenset(("SECTION", "ENDSEC", "EOF", "TABLE", "ENDTAB", "BLOCK", "ENDBLK", "SEQEND", "CLASS"))
ELSEWHERE: Final = frozenset(("HEADER", "CLASSES", "TABLES", "OBJECTS", "ACDSDATA", "THUMBNAILIMAGE"))
"""Sections without entities."""

_REARRANGED: Final = frozenset(("MTEXT", "VIEWPORT"))
"""Kinds that ezdxf merges or adds for good reasons; neither draws a line."""

_NEEDED: Final = {
    "LINE": ("start", "end"),
    "CIRCLE": ("center", "radius"),
    "ARC": ("center", "radius", "start_angle", "end_angle"),
    "ELLIPSE": ("center", "major_axis", "ratio"),
    "INSERT": ("name", "insert"),
    "VERTEX": ("location",),
}
"""Attributes for which ezdxf puts in a value of its own where the file has none."""


_ONCE: Final = {
    "LINE": (10, 11),
    "CIRCLE": (10, 40),
    "ARC": (10, 40, 50, 51),
    "ELLIPSE": (10, 11, 40),
    "INSERT": (2, 10),
    "VERTEX": (10,),
    "POLYLINE": (8, 70),
    "LWPOLYLINE": (8, 70, 90),
    "SPLINE": (8, 70, 71),
    "TEXT": (8, 10),
    "MTEXT": (8, 10),
    "POINT": (8, 10),
}
"""Group codes that cannot come twice, unless the head of the next entity is missing and the two run together."""

_EMBEDDED: Final = 101
"""Group code from which on an entity holds another object, as MTEXT does since R2018."""

_VARIABLE: Final = 9
"""Group code of the name of a header variable."""

_NEVER: Final = {"SEQEND": 10, "ENDBLK": 10, "ENDSEC": 10, "TABLE": 10, "ENDTAB": 10}
"""Group codes that do not belong there, unless the head of the next entity is missing."""


def flaw(group: Group) -> str:
    """Why a group seems to be more than one, in words; empty where it does not."""
    codes = [code for code, _ in group.tags]
    if _EMBEDDED in codes:
        codes = codes[: codes.index(_EMBEDDED)]
    twice = [code for code in _ONCE.get(group.kind, ()) if codes.count(code) > 1]
    if twice:
        return f"group code {twice[0]} comes twice, as if two entities ran together"
    never = _NEVER.get(group.kind, 10 if _is_head(group) else -1)
    more_header = group.kind == "ENDSEC" and _VARIABLE in codes
    return "an entity without its start" if never in codes and not more_header else ""


def _is_head(group: Group) -> bool:
    """Whether a group is the head of a section of entities."""
    return group.kind == "SECTION" and group.first(2).upper() in (b"ENTITIES", b"BLOCKS")


def _run_together(groups: Groups) -> bool:
    """Whether any group of a paired file has a flaw."""
    codes = groups.codes()
    of = np.searchsorted(groups.heads, 2 * np.arange(len(codes)), side="right") - 1
    kinds = np.array(groups.kinds)
    for code in {code for once in _ONCE.values() for code in once}:
        counts = np.bincount(of[(codes == code) & (of >= 0)], minlength=len(groups))
        several = np.flatnonzero(counts > 1)
        usual = [kind for kind in np.unique(kinds[several]) if code in _ONCE.get(str(kind), ())]
        if any(flaw(groups.group(i)) for i in several[np.isin(kinds[several], usual)].tolist()):
            return True
    with_point = np.unique(of[(codes == 10) & (of >= 0)])
    suspects = with_point[np.isin(kinds[with_point], [*_NEVER, "SECTION"])]
    return any(flaw(groups.group(i)) for i in suspects.tolist())


def miscounted(groups: Groups) -> int:
    """How many LWPOLYLINEs say that they have another number of vertices than they have."""
    count = 0
    for i, kind in enumerate(groups.kinds):
        if kind == "LWPOLYLINE":
            group = groups.group(i)
            said = group.first(90)
            count += said.isdigit() and said != b"%d" % sum(code == 10 for code, _ in group.tags)
    return count


def entities(groups: Groups) -> Iterator[int]:
    """The indices of the groups that are entities, wherever in the file they are."""
    section = ""
    for i, kind in enumerate(groups.kinds):
        if kind == "SECTION":
            section = groups.group(i).first(2).decode("ascii", "replace").upper()
        elif kind in ("ENDSEC", "EOF"):
            section = ""
        elif is_entity(kind, section):
            yield i


def is_object(kind: str) -> bool:
    """Whether ezdxf knows the kind as that of a table entry or an object without a place in the drawing."""
    known = factory.ENTITY_CLASSES.get(kind)
    return known is not None and not issubclass(known, (DXFGraphic, DXFTagStorage))


def is_entity(kind: str, section: str) -> bool:
    """Whether what stands there is an entity or takes the place of one."""
    if kind in DRAWN:
        return True
    inside = section in ("ENTITIES", "BLOCKS")
    return not (section in ELSEWHERE or kind in STRUCTURE or (is_object(kind) and not inside))


def is_complete(document: Any, groups: Groups) -> bool:
    """Whether the document holds every entity of the file, each with all that it needs.

    Args:
        document: of ezdxf.
        groups: of the same file.
    """
    if not groups.paired or _run_together(groups):
        return False
    blocks = [_name(groups, i) for i, kind in enumerate(groups.kinds) if kind == "BLOCK"]
    if len(set(blocks)) < len(blocks):
        return False  # ezdxf draws the one over the other
    expected = Counter(groups.kinds[i] for i in entities(groups))
    held: Counter[str] = Counter()
    known = {*blocks, "*model_space", "*paper_space"}
    for block in document.blocks:
        if str(block.name).casefold() not in known:
            continue  # ezdxf adds arrow heads to old files
        for entity, is_part in _with_parts(block):
            kind = entity.dxftype()
            held[kind] += 1
            if is_object(kind) or not _has_all(entity, kind) or (kind == "VERTEX" and not is_part):
                return False
    return all(held[kind] >= count for kind, count in expected.items() if kind not in _REARRANGED)


def is_ordered(groups: Groups, unordered: frozenset[str] = frozenset()) -> bool:
    """Whether ezdxf finds each coordinate where it looks for it; what it does not find it drops.

    Args:
        groups: of the file.
        unordered: kinds that need not be.
    """
    if not groups.paired:
        return False
    codes = groups.codes()
    x = np.isin(codes, (10, 11, 12, 13, 210))
    y = np.isin(codes, (20, 21, 22, 23, 220))
    lone = (x[:-1] & ~y[1:]) | (y[1:] & ~x[:-1])
    of = np.searchsorted(groups.heads, 2 * np.flatnonzero(lone), side="right") - 1
    return all(groups.kinds[i] not in DRAWN or groups.kinds[i] in unordered for i in set(of.tolist()))


def _name(groups: Groups, index: int) -> str:
    return groups.group(index).first(2).decode("utf-8", "replace").casefold()


def _with_parts(block: Any) -> Iterator[tuple[Any, bool]]:
    """The entities of a layout or block; and as parts the vertices of polylines and the attributes of INSERTs."""
    for entity in block:
        yield entity, False
        kind = entity.dxftype()
        if kind == "POLYLINE":
            yield from ((vertex, True) for vertex in entity.vertices)
        elif kind == "INSERT":
            yield from ((attribute, True) for attribute in entity.attribs)


def _has_all(entity: Any, kind: str) -> bool:
    """Whether the file gives what makes the shape of an entity."""
    if kind == "LWPOLYLINE":
        return len(entity) > 0
    if kind == "SPLINE":
        return len(entity.control_points) > 0 or len(entity.fit_points) > 0
    # The vertices that are the faces of a mesh have no location.
    has = entity.dxf.hasattr
    return all(has(name) for name in _NEEDED.get(kind, ())) or (kind == "VERTEX" and bool(entity.dxf.flags & 128))
