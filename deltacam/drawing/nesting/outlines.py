"""Contours as polygons, for all questions about what lies where."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Final

import numpy as np

from deltacam.drawing.nesting.pieces import Pieces
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import Array, Curve, IntArray

SAGITTA: Final = 1e-6
"""How far the polygons that stand for contours leave their arcs, m."""

_SAMPLES: Final = 200
_CROWDED: Final = 20


@dataclass(frozen=True, slots=True, eq=False)
class Outlines:
    """M closed curves in the form that shapely works on.

    Attributes:
        vertices: (M,) how many each ring has.
        tangled: the rings that meet themselves, by index.
        polygons: (M,) what is inside, valid; the largest part where the ring meets itself.
        areas: (M,) of the polygons, m2.
        pieces: the rings in short pieces, but for those that cross themselves all over.
    """

    vertices: IntArray
    tangled: dict[int, Any]
    polygons: Any
    areas: Array
    pieces: Pieces

    @classmethod
    def of(cls, curves: Sequence[Curve]) -> Outlines:
        """The outlines of closed curves."""
        import shapely

        points, ring_of = rings.full(*rings.flatten(Pack.of(curves), SAGITTA))
        loops = shapely.linearrings(points, indices=ring_of)
        vertices = shapely.get_num_points(loops).astype(np.int64)
        tangled = {i: loops[i] for i in np.flatnonzero(~shapely.is_simple(loops)).tolist()}
        polygons = shapely.polygons(loops)
        del loops  # the polygons have copies; a million rings are a gigabyte
        clear = np.ones(len(polygons), dtype=np.bool_)
        for i, loop in tangled.items():
            clear[i] = not is_mess(loop)
            polygons[i] = _valid(loop) if clear[i] else shapely.convex_hull(loop)
        if not clear.all():
            kept = clear[ring_of]
            points, ring_of = points[kept], ring_of[kept]
        return cls(vertices, tangled, polygons, shapely.area(polygons), Pieces.of(points, ring_of))


def is_mess(line: Any) -> bool:
    """Whether the segments of a line cross so many others that to work out every crossing would take too long."""
    import shapely

    points = shapely.get_coordinates(line)
    if len(points) < _SAMPLES:
        return False
    segments = shapely.linestrings(np.stack([points[:-1], points[1:]], axis=1))
    samples = segments[np.linspace(0, len(segments) - 1, _SAMPLES).astype(np.int64)]
    crossed, _ = shapely.STRtree(segments).query(samples, predicate="crosses")
    return len(crossed) > _CROWDED * _SAMPLES


def _valid(ring: Any) -> Any:
    """What is inside a ring that meets itself: the largest part."""
    import shapely

    polygon = shapely.Polygon(ring)
    if not polygon.is_valid:
        polygon = max(shapely.get_parts(shapely.make_valid(polygon)), key=shapely.area)
    return polygon if polygon.geom_type == "Polygon" else shapely.convex_hull(ring)
