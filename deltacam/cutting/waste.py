"""Where the tool may go with the laser on beside its cuts: through the waste, half a kerf away from every part."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from typing import Final

import numpy as np
import numpy.typing as npt
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Contour

SLACK: Final = 3e-6
"""How far a way may come too near to a part, m: above the errors of reading and flattening."""

_FLATTENING: Final = 1e-6
_RIM: Final = 1e-3  # m; what leaves a hole must cross it, and no other part is so near


class Waste:
    """The part of the sheet that the beam may burn.

    Args:
        contours: of the drawing.
        kerf: width of the cut, m.
        room: what the tool may not leave, sheet frame, m; None where it may go anywhere.
    """

    def __init__(self, contours: Sequence[Contour], *, kerf: float, room: shapely.Geometry | None = None) -> None:
        self._distance = kerf / 2.0 - SLACK
        parts = _finished_parts(contours)
        self._parts = shapely.STRtree(parts if self._distance > 0.0 else shapely.buffer(parts, -SLACK))
        self._room = room
        if room is not None:
            shapely.prepare(room)

    def is_free(self, shapes: npt.NDArray[np.object_]) -> BoolArray:
        """Which lines the beam may run along, and which areas it may run around, without burning a part, (N,)."""
        free = np.ones(len(shapes), dtype=np.bool_)
        if self._distance > 0.0:
            hit, _ = self._parts.query(shapes, predicate="dwithin", distance=self._distance)
        else:
            hit, _ = self._parts.query(shapes, predicate="intersects")
        free[hit] = False
        return free if self._room is None else free & shapely.covers(self._room, shapes)


def _finished_parts(contours: Sequence[Contour]) -> npt.NDArray[np.object_]:
    """What is to stay of the sheet, (P,) polygons: every outline that is cut, without the holes directly in it.

    Around a hole whose outline is not cut a rim stays.
    """
    cut = {contour.number: contour for contour in contours if contour.has_kerf}
    lines = {number: curves.flatten(contour.curve, _FLATTENING)[0] for number, contour in cut.items()}
    holes: defaultdict[int | None, list[Array]] = defaultdict(list)
    for number, contour in cut.items():
        if contour.is_hole:
            holes[contour.parent].append(lines[number])
    found = [
        shapely.Polygon(lines[number], holes[number])
        for number, contour in cut.items()
        if not contour.is_hole and len(lines[number]) > 2
    ]
    return np.array([*found, *_rims(cut, lines)], dtype=np.object_)


def _rims(cut: Mapping[int, Contour], lines: Mapping[int, Array]) -> list[shapely.Geometry]:
    """The material around holes whose outline is not cut."""
    areas = {number: shapely.Polygon(lines[number]) for number, one in cut.items() if one.is_hole}
    alone = [number for number in areas if cut[number].parent not in cut]
    if not alone:
        return []
    waste = shapely.union_all(list(areas.values()))
    return [shapely.difference(shapely.buffer(areas[number], _RIM), waste) for number in alone]
