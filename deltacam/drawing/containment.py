"""Which contour lies in which, by even-odd nesting; contours that cross themselves or each other are refused.

Two contours may touch in a point. Where they share a stretch of line, each would be cut half a kerf into the other, so
that is refused like a crossing.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from deltacam.drawing.join import point_mm
from deltacam.errors import DrawingError
from deltacam.geometry import curve as curves
from deltacam.model import Contour, Finding
from deltacam.units import to_mm

SAGITTA: Final = 1e-6
"""How far the polygons that stand for contours leave their arcs, m."""

OVERLAP: Final = 1e-5
"""Two contours cross where they overlap by more than this, m; by less they touch."""

SHARED: Final = 1e-3
"""Two contours that touch along more than this, m, share a line."""

_HINT: Final = "separate the outlines in the drawing, or put what is not to be cut on its own layer and leave it out"


def nest(contours: Sequence[Contour]) -> tuple[tuple[Contour, ...], list[Finding]]:
    """The contours with their depth and parent, and findings where two touch.

    Raises:
        DrawingError: a contour that crosses itself, two that cross each other or share a stretch of line.
    """
    import shapely

    rings = [shapely.LinearRing(curves.flatten(contour.curve, SAGITTA)[0]) for contour in contours]
    for contour, ring in zip(contours, rings, strict=True):
        if not ring.is_simple:
            _refuse_self_crossing(contour, ring)
    polygons = shapely.polygons(rings)
    findings = _check_pairs(contours, rings, polygons)
    areas = shapely.area(polygons)
    inner, outer = shapely.STRtree(polygons).query(shapely.point_on_surface(polygons), predicate="within")
    around = areas[outer] > areas[inner]
    inner, outer = inner[around], outer[around]
    depth = np.bincount(inner, minlength=len(contours))
    parent: dict[int, int] = {}
    for i, j in zip(inner.tolist(), outer.tolist(), strict=True):
        if i not in parent or areas[j] < areas[parent[i]]:
            parent[i] = j
    nested = tuple(
        replace(contour, depth=int(depth[i]), parent=contours[parent[i]].number if i in parent else None)
        for i, contour in enumerate(contours)
    )
    return nested, findings


def _refuse_self_crossing(contour: Contour, ring: Any) -> None:
    """Raises where a ring that is not simple really crosses or touches itself, beyond rounding."""
    import shapely

    parts = shapely.unary_union(ring)
    faces = shapely.get_parts(shapely.polygonize([parts]))
    wide = [face for face in faces if not face.buffer(-0.5 * OVERLAP).is_empty]
    retraced = float(ring.length - parts.length)
    if len(wide) <= 1 and retraced <= OVERLAP:
        return
    reason = str(shapely.is_valid_reason(shapely.Polygon(ring)))
    stated = re.search(r"\[(\S+) (\S+)\]", reason)
    place = np.array(stated.groups() if stated else ring.coords[0], dtype=float)
    what = f"the contour crosses or touches itself at {point_mm(place)} mm"
    raise DrawingError(what, where=contour.where, hint="draw each outline as a line that does not meet itself")


def _check_pairs(contours: Sequence[Contour], rings: list[Any], polygons: Any) -> list[Finding]:
    """Findings for contours that touch.

    Raises:
        DrawingError: two that cross, or share a stretch of line.
    """
    import shapely

    one, other = shapely.STRtree(rings).query(rings, predicate="intersects")
    findings = []
    for i, j in sorted({(int(a), int(b)) for a, b in zip(one, other, strict=True) if a < b}):
        first, second = contours[i], contours[j]
        place = point_mm(_first_point(rings[i].intersection(rings[j])))
        parts = (
            polygons[i].intersection(polygons[j]),
            polygons[i].difference(polygons[j]),
            polygons[j].difference(polygons[i]),
        )
        if all(not part.buffer(-0.5 * OVERLAP).is_empty for part in parts):
            raise DrawingError(f"it crosses {second.where} at {place} mm", where=first.where, hint=_HINT)
        shared = float(rings[i].intersection(rings[j].buffer(SAGITTA)).length)
        if shared > SHARED:
            what = f"it shares {to_mm(shared):.3g} mm of line with {second.where} at {place} mm"
            raise DrawingError(what, where=first.where, hint=_HINT)
        findings.append(Finding(f"it touches {second.where}", where=f"{first.where}, {place} mm"))
    return findings


def _first_point(geometry: Any) -> Any:
    """The left-most, then lowest vertex of a geometry, (2,) m."""
    import shapely

    points = shapely.get_coordinates(geometry)
    return points[np.lexsort((points[:, 1], points[:, 0]))[0]]
