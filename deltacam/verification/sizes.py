"""What is left of every contour when the beam has passed: the kerf, swept along the way of the tool."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
import shapely
from scipy.spatial import cKDTree
from shapely import LineString, MultiPolygon, Polygon

from deltacam.model import Array, Contour, Size
from deltacam.verification.kerf_path import all_corners, flattened, quarter_sides
from deltacam.verification.near import Lines

_SIMPLER: Final = 0.2e-6  # m; how far a way may be off so that it needs fewer points
_SPACING: Final = 0.5e-3  # m, of samples along straight edges; a bump has vertices of its own
_THINNEST: Final = 1e-6  # m, half of the width that a cut without a kerf is taken to have where it has leads
_CLOSED: Final = 50e-6  # m
_REACH: Final = 5.0  # how far a corner shifts an edge, in multiples of what its sides are shifted


def size(contour: Contour, rings: Sequence[Array], ways: Sequence[Array], *, kerf: float, exact_above: float) -> Size:
    """The part or hole that is left of a closed contour, beside what an exact cut would leave.

    An exact cut is the same with the exact path, so that a corner which no beam of this kerf reaches does not count.

    Args:
        contour: of the drawing, cut with a kerf.
        rings: its kerf path, (K, 2) m each, the first point not repeated; at least one.
        ways: of the tool, (K, 2) m each, from start to end; at least one.
        kerf: width of the cut, m, >= 0.
        exact_above: m; a smaller distance between the edges may be found a little too large, but stays below it.
    """
    drawn = Polygon(flattened(contour))
    ideal = _left([np.vstack([ring, ring[:1]]) for ring in rings], kerf, contour, drawn)
    left = _left(ways, kerf, contour, drawn)
    offset = abs(left.area - ideal.area) / ideal.length if ideal.length else 0.0
    edge, place = _largest_gap(ideal, left, rings, kerf / 2.0, exact_above)
    return Size(
        contour=contour.number,
        drawn=drawn.area,
        area=left.area,
        offset=offset,
        edge=edge,
        place=place,
        exact=ideal.area,
        drawn_box=_box(drawn),
        box=_box(left),
    )


def _box(shape: Polygon | MultiPolygon) -> tuple[float, float]:
    """The width and the height of a shape, m; none of one that is empty."""
    if shape.is_empty:
        return 0.0, 0.0
    left, bottom, right, top = shape.bounds
    return right - left, top - bottom


def _left(ways: Sequence[Array], kerf: float, contour: Contour, drawn: Polygon) -> Polygon | MultiPolygon:
    """What the cuts along ``ways`` leave inside an outline, or open in the material of a hole."""
    lines = [shapely.simplify(LineString(way), _SIMPLER, preserve_topology=False) for way in ways if len(way) > 1]
    if not lines:
        return Polygon()
    if kerf == 0.0 and all(line.is_closed or _ends_near(line) for line in lines):
        closed = [Polygon(line.coords) for line in lines if len(line.coords) > 3]
        return shapely.union_all([shapely.make_valid(one) for one in closed])
    half = max(kerf / 2.0, _THINNEST)
    swept = shapely.union_all(shapely.buffer(lines, half, quad_segs=quarter_sides(half)))
    ribbons = list(swept.geoms) if isinstance(swept, MultiPolygon) else [swept]
    if contour.is_hole:
        return shapely.union_all([Polygon(ribbon.exterior) for ribbon in ribbons])
    if len(ribbons) == 1 and len(ribbons[0].interiors) == 1:
        return Polygon(ribbons[0].interiors[0])
    enclosed = shapely.union_all([Polygon(ribbon.exterior) for ribbon in ribbons]).difference(swept)
    pieces = np.array(shapely.get_parts(enclosed))
    return shapely.union_all(pieces[shapely.contains(drawn, shapely.point_on_surface(pieces))])


def _ends_near(line: LineString) -> bool:
    """Whether a way ends where it begins, without leads."""
    first, last = np.asarray(line.coords)[[0, -1]]
    return bool(np.hypot(*(last - first)) < _CLOSED)


def _largest_gap(
    ideal: Polygon | MultiPolygon,
    left: Polygon | MultiPolygon,
    rings: Sequence[Array],
    half: float,
    exact_above: float,
) -> tuple[float, tuple[float, float]]:
    """The largest distance between both edges either way, m, and where it is; less counts at a sharp corner.

    Sides that are shifted by d move the tip of a corner by d over the sine of half the angle between them. That is so
    for the corners of the edge itself, and, ``half`` a kerf away from them, for those of the path.
    """
    edges, found = _edges(ideal), _edges(left)
    if not edges or not found:
        x, y = (edges or found or [np.zeros((1, 2))])[0][0].tolist()
        return float(max(np.sqrt(ideal.area), np.sqrt(left.area))), (x, y)
    exact, real = (Lines(lines, closed=True, spacing=_SPACING) for lines in (edges, found))
    points = np.concatenate([real.samples, exact.samples])
    gaps = np.concatenate(
        [
            exact.distance(real.samples, exact_above=exact_above),
            real.distance(exact.samples, exact_above=exact_above),
        ]
    )
    share = np.minimum(_share(points, edges, _REACH * gaps), _share(points, rings, half + _REACH * gaps))
    worst = int(np.argmax(gaps * share))
    return float(gaps[worst] * share[worst]), (float(points[worst, 0]), float(points[worst, 1]))


def _share(points: Array, lines: Sequence[Array], reach: Array) -> Array:
    """The sine of half the angle at the nearest sharp corner of closed ``lines`` within ``reach`` (N,) m, else 1."""
    tips, turns = all_corners(lines, closed=True)
    if not len(tips):
        return np.ones(len(points))
    away, tip = cKDTree(tips).query(points)
    return np.where(away <= reach, np.cos(turns[tip] / 2.0), 1.0)


def _edges(shape: Polygon | MultiPolygon) -> list[Array]:
    """All rings of a shape, (K, 2) m each, the first point not repeated."""
    polygons = [part for part in shapely.get_parts(shape) if isinstance(part, Polygon) and not part.is_empty]
    return [np.asarray(ring.coords)[:-1] for part in polygons for ring in (part.exterior, *part.interiors)]
