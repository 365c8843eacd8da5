"""Which contour lies in which, by even-odd nesting; contours that cross themselves or each other are refused.

An outline that is open but for a small gap, such as a holding tab, counts as closed here, as long as it lies in no
contour itself: what lies inside it are the holes of a part. What lies inside a tangle of lines is refused, for its side
is unknown.

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
from deltacam.model import Contour, Curve, Finding, IntArray
from deltacam.units import to_mm

SAGITTA: Final = 1e-6
"""How far the polygons that stand for contours leave their arcs, m."""

OVERLAP: Final = 1e-5
"""Two contours cross where they overlap by more than this, m; by less they touch."""

SHARED: Final = 1e-3
"""Two contours that touch along more than this, m, share a line."""

_HINT: Final = "separate the outlines in the drawing, or put what is not to be cut on its own layer and leave it out"


def nest(
    contours: Sequence[Contour], *, outlines: Sequence[Curve] = (), tangles: Sequence[Curve] = ()
) -> tuple[tuple[Contour, ...], list[Finding]]:
    """The contours with their depth and parent, and findings where two touch or an outline around them is open.

    Args:
        contours: closed, in the order of the file.
        outlines: open curves that are closed but for a gap, m.
        tangles: open curves between points where more than two lines meet, m.

    Raises:
        DrawingError: a contour that crosses itself, two that cross each other or share a stretch of line, or one that
            lies inside a tangle.
    """
    import shapely

    rings = [shapely.LinearRing(curves.flatten(contour.curve, SAGITTA)[0]) for contour in contours]
    for contour, ring in zip(contours, rings, strict=True):
        if not ring.is_simple:
            _refuse_self_crossing(contour, ring)
    polygons = np.array([_polygon(ring) for ring in rings])
    findings = _check_pairs(contours, rings, polygons)
    areas = shapely.area(polygons)
    tree, inside = shapely.STRtree(polygons), shapely.point_on_surface(polygons)
    _refuse_tangles(contours, inside, tree, tangles)
    inner, outer = tree.query(inside, predicate="within")
    around = areas[outer] > areas[inner]
    inner, outer = inner[around], outer[around]
    opened = _in_outlines(inside, tree, outlines)
    findings += _open_findings(contours, opened)
    depth = np.bincount(inner, minlength=len(contours)) + opened
    parent: dict[int, int] = {}
    for i, j in zip(inner.tolist(), outer.tolist(), strict=True):
        if i not in parent or areas[j] < areas[parent[i]]:
            parent[i] = j
    nested = tuple(
        replace(contour, depth=int(depth[i]), parent=contours[parent[i]].number if i in parent else None)
        for i, contour in enumerate(contours)
    )
    return nested, findings


def _polygon(ring: Any) -> Any:
    """The polygon in a ring; where the ring meets itself within rounding, its largest part."""
    import shapely

    polygon = shapely.Polygon(ring)
    if not polygon.is_valid:
        polygon = max(shapely.get_parts(shapely.make_valid(polygon)), key=shapely.area)
    return polygon


def _in_outlines(inside: Any, tree: Any, outlines: Sequence[Curve]) -> IntArray:
    """In how many open outlines, themselves in no contour, each of the points (N,) lies."""
    import shapely

    places = [curves.flatten(curve, SAGITTA)[0] for curve in _outermost(outlines, tree)]
    faces = [shapely.make_valid(shapely.Polygon(points)) for points in places]
    index, _ = shapely.STRtree(faces).query(inside, predicate="within")
    return np.bincount(index, minlength=len(inside)).astype(np.int64)


def _open_findings(contours: Sequence[Contour], opened: IntArray) -> list[Finding]:
    """The finding that some contours lie in open outlines, where ``opened``, (N,), is not 0."""
    count = np.count_nonzero(opened)
    if not count:
        return []
    many = "1 contour lies" if count == 1 else f"{count} contours lie"
    where = contours[int(np.argmax(opened > 0))].where
    return [Finding(f"{many} in an outline that is open: cut as its holes", where=where)]


def _refuse_tangles(contours: Sequence[Contour], inside: Any, tree: Any, tangles: Sequence[Curve]) -> None:
    """Raises where a contour lies inside a tangle of lines that itself lies in no contour."""
    import shapely

    lines = [shapely.LineString(curves.flatten(curve, SAGITTA)[0]) for curve in _outermost(tangles, tree)]
    faces = shapely.get_parts(shapely.polygonize([shapely.unary_union(lines)]))
    index, _ = shapely.STRtree(faces).query(inside, predicate="within")
    if len(index):
        what = "it lies among lines that could be closed in more than one way, so its side is unknown"
        raise DrawingError(what, where=contours[int(index.min())].where, hint="draw each outline around it for itself")


def _outermost(open_curves: Sequence[Curve], tree: Any) -> list[Curve]:
    """The open curves that start in none of the polygons of the tree."""
    import shapely

    starts = np.array([curve.points[0] for curve in open_curves]).reshape(-1, 2)
    within = set(tree.query(shapely.points(starts), predicate="within")[0].tolist())
    return [curve for i, curve in enumerate(open_curves) if i not in within]


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
