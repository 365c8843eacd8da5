"""One function per kind of DXF entity that draws a line: its numbers as the file gives them, read nowhere else.

The numbers come straight from where ezdxf keeps them: its attribute access takes most of the time of a large drawing,
and puts a default in the place of a number that is missing, like a radius of 1.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np
from ezdxf.math import OCS, Vec3

from deltacam.drawing.entities import splines
from deltacam.drawing.entities.batches import Gathered
from deltacam.drawing.entities.shapes import Lines, Spline
from deltacam.model import Array

_IGNORED: Final = {
    **dict.fromkeys(("TEXT", "MTEXT", "ATTRIB", "ATTDEF", "ARCALIGNEDTEXT", "RTEXT"), "text is never cut"),
    **dict.fromkeys(("DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION", "TOLERANCE"), "a dimension is never cut"),
    **dict.fromkeys(("LEADER", "MULTILEADER", "MLEADER"), "a leader is never cut"),
    **dict.fromkeys(("HATCH", "MPOLYGON", "SOLID", "TRACE", "WIPEOUT"), "a fill, not a line"),
    **dict.fromkeys(("IMAGE", "PDFUNDERLAY", "DWFUNDERLAY", "DGNUNDERLAY", "OLE2FRAME", "OLEFRAME"), "a picture"),
    **dict.fromkeys(("RAY", "XLINE"), "a construction line without an end"),
    **dict.fromkeys(("3DFACE", "3DSOLID", "BODY", "REGION", "SURFACE", "MESH", "HELIX"), "a body or face in space"),
    **dict.fromkeys(("EXTRUDEDSURFACE", "LOFTEDSURFACE", "PLANESURFACE", "REVOLVEDSURFACE"), "a body or face in space"),
    **dict.fromkeys(("NURBSURFACE", "SWEPTSURFACE", "SECTIONOBJECT"), "a body or face in space"),
    **dict.fromkeys(("VIEWPORT", "ACAD_TABLE", "LIGHT", "SUN", "SECTION", "GEODATA"), "not geometry of the part"),
    "POINT": "a point is not a line",
    "SHAPE": "a symbol from a font",
    "MLINE": "a multiple line: explode it to lines if it is to be cut",
}
_MESH: Final = "a mesh in space"
_FRAME: Final = 16
"""Bit of a VERTEX that belongs to the frame of a fitted polyline and is not on the line."""

_CLOSED, _SPACE, _MESHES = 1, 8, 16 | 64
"""Bits of a POLYLINE: closed; in space; a mesh."""


def is_drawn(kind: str) -> bool:
    """Whether entities of this kind draw a line."""
    return kind in _READERS


def why_not(kind: str) -> str:
    """Why entities of this kind are not cut, in words."""
    return _IGNORED.get(kind, "an object that only the program that made it can draw")


def is_known(kind: str) -> bool:
    """Whether the DXF reference says what entities of this kind draw."""
    return kind in _IGNORED or is_drawn(kind)


def gather(kind: str, raw: Any, index: int, into: Gathered) -> str:
    """Adds the numbers of an entity to those of its layout or block; in words why it draws no line, else nothing.

    Args:
        kind: its DXF type.
        raw: the entity.
        index: its number in its layout or block.
        into: where to.

    Raises:
        ValueError: numbers that make no shape.
        KeyError: a number that is missing.
    """
    return _READERS[kind](raw, raw.dxf.__dict__, index, into)


def axes(extrusion: Any) -> Array:
    """The matrix (3, 3) from object coordinates to the drawing's; an extrusion of (0, 0, 0) means (0, 0, 1)."""
    normal = Vec3(extrusion)
    ocs = OCS(normal if normal.magnitude > 0.0 else Vec3(0, 0, 1))
    return np.array([tuple(axis) for axis in (ocs.ux, ocs.uy, ocs.uz)])


def _up(numbers: dict[str, Any]) -> float:
    """1 where object coordinates are the drawing's, -1 where they are seen from below, 0 where they are tilted."""
    extrusion = numbers.get("extrusion")
    if extrusion is None:
        return 1.0
    x, y, z = extrusion
    if x == 0.0 and y == 0.0:
        return -1.0 if z < 0.0 else 1.0
    return 0.0


def _line(_raw: Any, numbers: dict[str, Any], index: int, into: Gathered) -> str:
    start, end = numbers["start"].xyz, numbers["end"].xyz
    into.segments.extend(start)
    into.segments.extend(end)
    into.segment_of.append(index)
    return ""


def _circle(_raw: Any, numbers: dict[str, Any], index: int, into: Gathered) -> str:
    return _round(numbers, index, into, 0.0, 2.0 * math.pi)


def _arc(_raw: Any, numbers: dict[str, Any], index: int, into: Gathered) -> str:
    start, end = numbers["start_angle"], numbers["end_angle"]
    return _round(numbers, index, into, math.radians(start), math.radians(_span(end - start, 360.0)))


def _round(numbers: dict[str, Any], index: int, into: Gathered, start: float, span: float) -> str:
    """A circle or an arc."""
    x, y, z = numbers["center"].xyz
    radius = numbers["radius"]
    if radius < 0.0:
        raise ValueError(f"the radius {radius:g} is negative")
    up = _up(numbers)
    if up:
        into.conics.extend((up * x, y, up * z, up * radius, 0.0, 0.0, 0.0, radius, 0.0, start, span))
    else:
        frame = np.array([(x, y, z), (radius, 0.0, 0.0), (0.0, radius, 0.0)]) @ axes(numbers["extrusion"])
        into.conics.extend((*frame.ravel().tolist(), start, span))
    into.conic_of.append(index)
    return ""


def _span(difference: float, turn: float) -> float:
    """The angle from start to end, counter-clockwise, in (0, turn].

    Raises:
        ValueError: start and end are the same: nothing, or everything.
    """
    if difference == 0.0 or not math.isfinite(difference):
        raise ValueError("it starts and ends at the same angle, which may mean nothing or a whole turn")
    span = difference % turn
    # An angle written with few digits may miss the whole turn by its rounding.
    return turn if min(span, turn - span) < 1e-9 * turn else span


def _ellipse(_raw: Any, numbers: dict[str, Any], index: int, into: Gathered) -> str:
    centre, major = Vec3(numbers["center"]), Vec3(numbers["major_axis"])
    normal = Vec3(numbers.get("extrusion", (0, 0, 1)))
    normal = normal if normal.magnitude > 0.0 else Vec3(0, 0, 1)
    ratio, across = float(numbers["ratio"]), normal.cross(major)
    if not (major.magnitude > 0.0 and across.magnitude > 0.0):
        raise ValueError("its major axis is no direction in its plane")
    if ratio == 0.0:
        raise ValueError("its axes have the ratio 0")
    minor = across.normalize(major.magnitude * ratio)
    start, end = float(numbers.get("start_param", 0.0)), float(numbers.get("end_param", 2.0 * math.pi))
    span = _span(end - start, 2.0 * math.pi)
    into.conics.extend((*centre.xyz, *major.xyz, *minor.xyz, start, span))
    into.conic_of.append(index)
    return ""


def _lwpolyline(raw: Any, numbers: dict[str, Any], index: int, into: Gathered) -> str:
    vertices = raw.lwpoints.values
    if numbers.get("const_width", 0.0) or vertices[:, 2:4].any():
        into.wide.append(index)
    closed = bool(numbers.get("flags", 0) & _CLOSED)
    return _flat(vertices, float(numbers.get("elevation", 0.0)), numbers, index, into, closed=closed)


def _old_polyline(raw: Any, numbers: dict[str, Any], index: int, into: Gathered) -> str:
    flags = numbers.get("flags", 0)
    if flags & _MESHES:
        return _MESH
    found = [vertex.dxf.__dict__ for vertex in raw.vertices]
    found = [vertex for vertex in found if not vertex.get("flags", 0) & _FRAME]
    closed = bool(flags & _CLOSED)
    if flags & _SPACE:
        points = np.array([vertex["location"].xyz for vertex in found]).reshape(-1, 3)
        return _in_space(points, index, into, closed=closed)
    get = [(*vertex["location"].xyz[:2], *(vertex.get(name, 0.0) for name in _VERTEX)) for vertex in found]
    vertices = np.array(get, dtype=np.float64).reshape(-1, 5)
    if vertices[:, 2:4].any() or numbers.get("default_start_width") or numbers.get("default_end_width"):
        into.wide.append(index)
    z = Vec3(numbers.get("elevation", (0, 0, 0))).z
    return _flat(vertices, z, numbers, index, into, closed=closed)


_VERTEX: Final = ("start_width", "end_width", "bulge")


def _flat(vertices: Array, z: float, numbers: dict[str, Any], index: int, into: Gathered, *, closed: bool) -> str:
    """A polyline in a plane of its own."""
    up = _up(numbers)
    if up:
        into.polylines.add(index, vertices, z, up, closed=closed)
        return ""
    points = np.column_stack([vertices[:, :2], np.full(len(vertices), z)])
    return _tilted(points, vertices[:, 4], axes(numbers["extrusion"]), index, into, closed=closed)


def _in_space(points: Array, index: int, into: Gathered, *, closed: bool) -> str:
    """A polyline of lines in the drawing's coordinates."""
    return _tilted(points, np.zeros(len(points)), np.eye(3), index, into, closed=closed)


def _tilted(points: Array, bulges: Array, own: Array, index: int, into: Gathered, *, closed: bool) -> str:
    """A polyline without repeated vertices, (N, 3) and (N,) bulges of the segments that leave them."""
    keep = (points != np.roll(points, -1, axis=0)).any(axis=1)
    if len(points) and not closed:
        keep[-1] = True
    points, bulges = points[keep], bulges[keep]
    if len(points) < 2:
        return "a POLYLINE of length zero"
    into.singles.append((index, Lines(points, bulges if closed else bulges[:-1], closed=closed), own))
    return ""


def _spline(raw: Any, numbers: dict[str, Any], index: int, into: Gathered) -> str:
    control = np.asarray(raw.control_points.values, dtype=np.float64)
    weights, knots = np.array(raw.weights, dtype=np.float64), np.array(raw.knots, dtype=np.float64)
    degree = int(numbers.get("degree", 3))
    closed = bool(numbers.get("flags", 0) & (_CLOSED | 2))
    if len(control):
        control, weights, knots = splines.regular(control, weights, knots, degree, closed=closed)
    else:
        fit = np.asarray(raw.fit_points.values, dtype=np.float64)
        tangents = [numbers.get(name) for name in ("start_tangent", "end_tangent")]
        ends = [None if tangent is None else np.array(Vec3(tangent).xyz) for tangent in tangents]
        found = splines.through(fit, ends[0], ends[1], closed=closed)
        if found is None:
            return "a SPLINE of length zero" if len(fit) else "a spline without points"
        control, knots = found
        weights, degree = np.ones(len(control)), 3
        if len(control) > 4 or any(tangents):
            into.guessed.append(index)
    into.singles.append((index, Spline(control, weights, knots, degree), np.eye(3)))
    return ""


_READERS: Final[dict[str, Callable[[Any, dict[str, Any], int, Gathered], str]]] = {
    "LINE": _line,
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _old_polyline,
    "SPLINE": _spline,
}
