"""One damaged or sloppy entity as DXF text that ezdxf reads, or in words why that is not possible.

Coordinates are put in order and subclass markers are added. Nothing is guessed: a number that is none, a coordinate
without its other half or a missing radius make the entity unreadable.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final

from deltacam.drawing.dxf.census import DRAWN, flaw
from deltacam.drawing.dxf.tags import Group, Tag

_NUMBER: Final = re.compile(rb"[+-]?(\d+\.?\d*|\.\d+)([eEdD][+-]?\d{1,4})?")
_WHOLE: Final = re.compile(rb"([+-]?\d{1,9})(\.0*)?")
COMMA: Final = re.compile(rb"[+-]?\d*,\d+([eE][+-]?\d+)?")
_HANDLE: Final = re.compile(rb"[0-9A-Fa-f]{1,16}")


class DamagedError(Exception):
    """An entity that cannot be read, with the reason in words."""


@dataclass(frozen=True, slots=True)
class _Form:
    """How entities of a kind are written.

    Attributes:
        subclasses: each marker with the group codes of single values that follow it.
        points: group codes of the x of points; they follow the first marker.
        needed: group codes without which there is no shape.
    """

    subclasses: tuple[tuple[str, tuple[int, ...]], ...]
    points: tuple[int, ...] = ()
    needed: tuple[int, ...] = ()


_FORMS: Final = {
    "LINE": _Form((("AcDbLine", ()),), (10, 11, 210), (10, 11)),
    "CIRCLE": _Form((("AcDbCircle", (40,)),), (10, 210), (10, 40)),
    "ARC": _Form((("AcDbCircle", (40,)), ("AcDbArc", (50, 51))), (10, 210), (10, 40, 50, 51)),
    "ELLIPSE": _Form((("AcDbEllipse", (40, 41, 42)),), (10, 11, 210), (10, 11, 40)),
    "POLYLINE": _Form((("AcDb2dPolyline", (70, 71, 72, 73, 74, 75, 40, 41)),), (10, 210)),
    "VERTEX": _Form((("AcDbVertex", ()), ("AcDb2dVertex", (40, 41, 42, 70, 50, 71, 72, 73, 74))), (10,), (10,)),
    "INSERT": _Form((("AcDbBlockReference", (2, 41, 42, 43, 50, 70, 71, 44, 45)),), (10, 210), (2, 10)),
}
_WHOLE_NUMBERS: Final = frozenset((60, 62, 66, 67, 70, 71, 72, 73, 74, 75, 90))
_TEXTS: Final = frozenset((2,))
_WITH_CONTENT: Final = frozenset(("IMAGE", "WIPEOUT", "MESH", "MPOLYGON"))
_HATCH: Final = "100\nAcDbHatch\n10\n0\n20\n0\n30\n0\n2\nSOLID\n70\n1\n71\n0\n91\n0\n75\n1\n76\n1\n98\n0\n"
"""A fill without an outline."""

_COMMON: Final = (8, 6, 62, 60, 67)
"""Layer, line type, colour, invisible, paper space."""


def write(group: Group, handles: set[bytes]) -> str:
    """An entity as DXF text.

    Args:
        group: its tags.
        handles: those that are taken; the entity's own is added. An entity whose handle is taken gets a new one.

    Raises:
        DamagedError: it cannot be read.
    """
    if group.kind not in DRAWN:
        return _head(group, handles, ["AcDbEntity"]) + _as_it_is(group)
    if not group.whole:
        raise DamagedError("lines of it are missing or damaged")
    if flaw(group):
        raise DamagedError(flaw(group))
    own = _own(group.tags)
    if group.kind == "LWPOLYLINE":
        body = _lwpolyline(own)
    elif group.kind == "SPLINE":
        body = _spline(own)
    else:
        body = _plain(own, _FORMS[group.kind])
    return _head(group, handles, ["AcDbEntity"]) + body


def write_bare(group: Group, handles: set[bytes]) -> str:
    """An entity that draws nothing, with no more than its kind, handle and layer.

    Raises:
        DamagedError: ezdxf wants more than that.
    """
    if group.kind in _WITH_CONTENT or group.kind.endswith("SURFACE"):
        raise DamagedError("its contents are damaged")
    body = _HATCH if group.kind == "HATCH" else "".join(f"100\n{_marker(group.kind)}\n" for _ in range(2))
    return _head(group, handles, ["AcDbEntity"]) + body


def layer(group: Group) -> str:
    """The layer of an entity."""
    return text(group.first(8)) or "0"


def handle(group: Group) -> str:
    """The handle of an entity; ? where it has none."""
    return text(group.first(5)) or "?"


def text(value: bytes) -> str:
    """A name as text; bytes that are not UTF-8 are kept as surrogates."""
    return value.decode("utf-8", "surrogateescape")


def number(value: bytes) -> str:
    """A number as Python and ezdxf write it.

    Raises:
        DamagedError: it is none.
    """
    if not _NUMBER.fullmatch(value):
        raise DamagedError(f"{_shown(value)} is not a number")
    return value.decode("ascii").replace("d", "e").replace("D", "e")


def _head(group: Group, handles: set[bytes], markers: Iterable[str]) -> str:
    """Kind, handle, marker and the attributes that every entity has."""
    lines = [f"0\n{group.kind}\n"]
    own = group.first(5).upper()
    if _HANDLE.fullmatch(own) and own not in handles and own.strip(b"0"):
        handles.add(own)
        lines.append(f"5\n{own.decode('ascii')}\n")
    lines += [f"100\n{marker}\n" for marker in markers]
    for code in _COMMON:
        value = group.first(code)
        if value and (code not in _WHOLE_NUMBERS or _WHOLE.fullmatch(value)):
            lines.append(_tag(code, value))
    return "".join(lines)


def _own(tags: list[Tag]) -> list[Tag]:
    """The tags of the entity itself: no application data, embedded objects or extended data."""
    own = []
    inside = False
    for code, value in tags:
        if code >= 1000 or code == 101:
            break
        if code == 102:
            inside = value.startswith(b"{")
        elif not inside:
            own.append((code, value))
    return own


def _tag(code: int, value: bytes) -> str:
    """One tag; numbers are checked."""
    if code in _TEXTS or code in (6, 8):
        return f"{code}\n{text(value)}\n"
    if code in _WHOLE_NUMBERS:
        found = _WHOLE.fullmatch(value)
        if not found:
            raise DamagedError(f"{_shown(value)} is not a whole number")
        return f"{code}\n{int(found[1])}\n"
    return f"{code}\n{number(value)}\n"


def _plain(tags: list[Tag], form: _Form) -> str:
    """An entity with a fixed set of values."""
    last = dict(tags)
    missing = [code for code in form.needed if not last.get(code)]
    if missing:
        raise DamagedError(f"group code {missing[0]} is missing")
    parts = []
    points = "".join(_point(last, code) for code in form.points if code in last or code + 10 in last)
    for marker, codes in form.subclasses:
        parts.append(f"100\n{marker}\n")
        parts.append(points)
        points = ""
        parts += [_tag(code, last[code]) for code in codes if code in last]
    return "".join(parts)


def _point(values: dict[int, bytes], code: int) -> str:
    """A point from its coordinates, wherever they were."""
    for axis in (code, code + 10):
        if axis not in values:
            raise DamagedError(f"a coordinate is missing (group code {axis})")
    axes = [code, code + 10, code + 20] if code + 20 in values else [code, code + 10]
    return "".join(f"{axis}\n{number(values[axis])}\n" for axis in axes)


def _lwpolyline(tags: list[Tag]) -> str:
    """A LWPOLYLINE; widths and bulges belong to the x that they follow."""
    xs = [i for i, (code, _) in enumerate(tags) if code == 10]
    ys = [value for code, value in tags if code == 20]
    if not xs:
        raise DamagedError("it has no vertices")
    if len(ys) != len(xs):
        raise DamagedError(f"it has {len(xs)} x but {len(ys)} y")
    single = dict(tags[: xs[0]]) | {code: value for code, value in tags if code in (38, 39, 43, 70)}
    parts = ["100\nAcDbPolyline\n", f"90\n{len(xs)}\n"]
    parts += [_tag(code, single[code]) for code in (70, 43, 38, 39) if code in single]
    for start, end, y in zip(xs, [*xs[1:], len(tags)], ys, strict=True):
        parts.append(f"10\n{number(tags[start][1])}\n20\n{number(y)}\n")
        parts += [_tag(code, value) for code, value in tags[start:end] if code in (40, 41, 42)]
    values = dict(tags)
    return "".join(parts) + (_point(values, 210) if 210 in values else "")


def _spline(tags: list[Tag]) -> str:
    """A SPLINE; the n-th x goes with the n-th y and z."""
    last = dict(tags)
    many = {code: [value for own, value in tags if own == code] for code in (40, 41, *_axes(10), *_axes(11))}
    for count, code, what in ((72, 40, "knots"), (73, 10, "control points"), (74, 11, "fit points")):
        said = last.get(count, b"")
        if _WHOLE.fullmatch(said) and int(float(said)) != len(many[code]):
            raise DamagedError(f"it says that it has {text(said)} {what} but has {len(many[code])}")
    if not (many[10] or many[11]):
        raise DamagedError("it has no points")
    if not last.get(71):
        raise DamagedError("it has no degree")
    parts = ["100\nAcDbSpline\n"]
    parts += [_point(last, 210)] if 210 in last else []
    parts += [_tag(code, last[code]) for code in (70, 71) if code in last]
    parts += [f"72\n{len(many[40])}\n73\n{len(many[10])}\n74\n{len(many[11])}\n"]
    parts += [_tag(code, last[code]) for code in (42, 43, 44) if code in last]
    parts += [_point(last, code) for code in (12, 13) if code in last]
    parts += [_tag(code, value) for code in (40, 41) for value in many[code]]
    parts += [_points(many, code) for code in (10, 11)]
    return "".join(parts)


def _axes(code: int) -> tuple[int, int, int]:
    return code, code + 10, code + 20


def _points(many: dict[int, list[bytes]], code: int) -> str:
    """Points from the lists of their coordinates."""
    x, y, z = (many[axis] for axis in _axes(code))
    if len(x) != len(y) or len(z) not in (0, len(x)):
        raise DamagedError("a coordinate of its points is missing")
    rows = zip(x, y, z or [b"0"] * len(x), strict=True)
    return "".join(f"{axis}\n{number(value)}\n" for row in rows for axis, value in zip(_axes(code), row, strict=True))


def _as_it_is(group: Group) -> str:
    """The rest of an entity that draws nothing: text and numbers that ezdxf can take, else only its kind."""
    own = _own(group.tags)
    first = next((i for i, (code, value) in enumerate(own) if code == 100 and value != b"AcDbEntity"), None)
    if first is None or not group.whole:
        return "".join(f"100\n{_marker(group.kind)}\n" for _ in range(2))
    # The layer is in the head already.
    return "".join(f"{code}\n{text(value)}\n" for code, value in own[first:] if code != 8)


def _marker(kind: str) -> str:
    """The subclass that ezdxf looks for in an entity that draws nothing."""
    known = {"MTEXT": "AcDbMText", "LEADER": "AcDbLeader", "MULTILEADER": "AcDbMLeader", "MLEADER": "AcDbMLeader"}
    return known.get(kind, f"AcDb{kind.title()}")


def _shown(value: bytes) -> str:
    """A value as messages show it."""
    return repr(value[:24].decode("utf-8", "replace"))
