"""One function per kind of DXF entity that draws a line: its attributes to a shape, the only place that reads them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np
from ezdxf.math import OCS, Vec3, fit_points_to_cad_cv

from deltacam.drawing.shapes import Conic, Lines, Shape, Spline
from deltacam.model import Array

_IGNORED: Final = {
    **dict.fromkeys(("TEXT", "MTEXT", "ATTRIB", "ATTDEF", "ARCALIGNEDTEXT", "RTEXT"), "text is never cut"),
    **dict.fromkeys(("DIMENSION", "ARC_DIMENSION", "LARGE_RADIAL_DIMENSION", "TOLERANCE"), "a dimension is never cut"),
    **dict.fromkeys(("LEADER", "MULTILEADER", "MLEADER"), "a leader is never cut"),
    **dict.fromkeys(("HATCH", "MPOLYGON", "SOLID", "TRACE", "WIPEOUT"), "a fill, not a line"),
    **dict.fromkeys(("IMAGE", "PDFUNDERLAY", "DWFUNDERLAY", "DGNUNDERLAY", "OLE2FRAME", "OLEFRAME"), "a picture"),
    **dict.fromkeys(("RAY", "XLINE"), "a construction line without an end"),
    **dict.fromkeys(("3DFACE", "3DSOLID", "BODY", "REGION", "SURFACE", "MESH", "HELIX"), "a body or face in space"),
    **dict.fromkeys(("VIEWPORT", "ACAD_TABLE", "LIGHT", "SUN", "SECTION", "GEODATA"), "not geometry of the part"),
    "POINT": "a point is not a line",
    "SHAPE": "a symbol from a font",
    "MLINE": "a multiple line: explode it to lines if it is to be cut",
}
_MESH: Final = "a mesh in space"
_FRAME: Final = 16
"""Bit of a VERTEX that belongs to the frame of a fitted polyline and is not on the line."""


def layer(entity: Any) -> str:
    """The layer of an entity of any kind, also of one that ezdxf only stores."""
    if entity.dxf.is_supported("layer"):
        return str(entity.dxf.get("layer", "0"))
    return str(entity.graphic_properties().get("layer", "0"))


def is_hidden(entity: Any) -> bool:
    """Whether an entity is marked as invisible."""
    return entity.dxf.is_supported("invisible") and bool(entity.dxf.get("invisible", 0))


def is_drawn(kind: str) -> bool:
    """Whether entities of this kind draw a line."""
    return kind in _READERS


def why_not(kind: str) -> str:
    """Why entities of this kind are not cut, in words."""
    return _IGNORED.get(kind, f"deltacam does not cut {kind} entities")


def read(entity: Any) -> tuple[Shape | str, Array]:
    """The shape of an entity, or in words why it has none; and the matrix (4, 4) from its coordinates to the drawing's.

    Raises:
        ValueError: numbers that make no shape.
    """
    shape = _READERS[entity.dxftype()](entity)
    flat = isinstance(shape, Lines) and not shape.bulges.any()
    in_world = entity.dxftype() in ("LINE", "SPLINE", "ELLIPSE") or (
        flat and entity.dxftype() == "POLYLINE" and entity.is_3d_polyline
    )
    return shape, np.eye(4) if in_world else _ocs(entity.dxf.extrusion)


def _ocs(extrusion: Any) -> Array:
    """The matrix (4, 4) from object coordinates to the drawing's; an extrusion of (0, 0, 0) means (0, 0, 1)."""
    normal = Vec3(extrusion)
    ocs = OCS(normal if normal.magnitude > 0.0 else Vec3(0, 0, 1))
    matrix = np.eye(4)
    matrix[:3, :3] = [tuple(axis) for axis in (ocs.ux, ocs.uy, ocs.uz)]
    return matrix


def _line(entity: Any) -> Shape | str:
    return Lines(points=np.array([entity.dxf.start.xyz, entity.dxf.end.xyz]), bulges=np.zeros(1))


def _circle(entity: Any) -> Shape | str:
    return Conic(frame=_round(entity))


def _arc(entity: Any) -> Shape | str:
    start, end = float(entity.dxf.start_angle), float(entity.dxf.end_angle)
    return Conic(_round(entity), math.radians(start), math.radians(_span(end - start, 360.0)))


def _round(entity: Any) -> Array:
    """Centre and the two radii of a circle, (3, 3)."""
    radius = float(entity.dxf.radius)
    if radius < 0.0:
        raise ValueError(f"the radius {radius:g} is negative")
    return np.array([entity.dxf.center.xyz, (radius, 0.0, 0.0), (0.0, radius, 0.0)])


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


def _ellipse(entity: Any) -> Shape | str:
    major = Vec3(entity.dxf.major_axis)
    normal = Vec3(entity.dxf.extrusion)
    normal = normal.normalize() if normal.magnitude > 0.0 else Vec3(0, 0, 1)
    minor = normal.cross(major) * float(entity.dxf.ratio)
    start, end = float(entity.dxf.start_param), float(entity.dxf.end_param)
    return Conic(np.array([entity.dxf.center.xyz, major.xyz, minor.xyz]), start, _span(end - start, 2.0 * math.pi))


def _lwpolyline(entity: Any) -> Shape | str:
    vertices = np.array([(x, y, bulge) for x, y, bulge in entity.get_points("xyb")]).reshape(-1, 3)
    points = vertices.copy()
    points[:, 2] = float(entity.dxf.elevation)
    return _polyline(points, vertices[:, 2], closed=bool(entity.closed))


def _old_polyline(entity: Any) -> Shape | str:
    if entity.is_polygon_mesh or entity.is_poly_face_mesh:
        return _MESH
    vertices = [vertex for vertex in entity.vertices if not vertex.dxf.flags & _FRAME]
    points = np.array([vertex.dxf.location.xyz for vertex in vertices]).reshape(-1, 3)
    bulges = np.array([float(vertex.dxf.get("bulge", 0.0)) for vertex in vertices])
    if entity.is_3d_polyline:
        return _polyline(points, np.zeros(len(points)), closed=entity.is_closed)
    points[:, 2] = entity.dxf.elevation.z
    return _polyline(points, bulges, closed=entity.is_closed)


def _polyline(points: Array, bulges: Array, *, closed: bool) -> Shape | str:
    """A polyline without repeated vertices, (N, 3) and (N,) bulges of the segments that leave them."""
    after = np.roll(points, -1, axis=0)
    keep = (points != after).any(axis=1)
    if len(points) and not closed:
        keep[-1] = True
    points, bulges = points[keep], bulges[keep]
    if len(points) < 2:
        return "a polyline of length zero"
    return Lines(points, bulges if closed else bulges[:-1], closed=closed)


def _spline(entity: Any) -> Shape | str:
    control = np.array([Vec3(point).xyz for point in entity.control_points]).reshape(-1, 3)
    weights, knots, degree = np.array(entity.weights, dtype=float), np.array(entity.knots), int(entity.dxf.degree)
    if not len(control):
        tangents = [entity.dxf.get("start_tangent"), entity.dxf.get("end_tangent")]
        fit = [Vec3(point) for point in entity.fit_points]
        if len(fit) < 2:
            return "a spline without points"
        # ezdxf's reading of what CAD programs draw through fit points alone.
        tool = fit_points_to_cad_cv(fit, [Vec3(tangent) for tangent in tangents] if all(tangents) else None)
        control = np.array([point.xyz for point in tool.control_points])
        weights, knots, degree = np.empty(0), np.array(tool.knots()), tool.order - 1
    return Spline(control, weights if len(weights) else np.ones(len(control)), knots, degree)


_READERS: Final[dict[str, Callable[[Any], Shape | str]]] = {
    "LINE": _line,
    "CIRCLE": _circle,
    "ARC": _arc,
    "ELLIPSE": _ellipse,
    "LWPOLYLINE": _lwpolyline,
    "POLYLINE": _old_polyline,
    "SPLINE": _spline,
}
