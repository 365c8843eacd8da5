"""Where the tool may go with the laser on: through the waste, half a kerf away from every part."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping, Sequence
from typing import Final

import numpy as np
import numpy.typing as npt
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Contour

SLACK: Final = 3e-6
"""How far a way may come too near to a part, m: above the errors of reading and flattening."""

_FLATTENING: Final = 1e-6
_RIM: Final = 50e-3  # m, wider than leads are long


def finished_parts(contours: Sequence[Contour]) -> npt.NDArray[np.object_]:
    """What is to stay of the sheet, (P,) polygons: every outline that is cut, without the holes directly in it.

    Around a hole whose outline is not cut that is all there is nearby.
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
    """The material around holes whose outline is not cut: it stays as well."""
    areas = {number: shapely.Polygon(lines[number]) for number, one in cut.items() if one.is_hole}
    alone = [number for number in areas if cut[number].parent not in cut]
    if not alone:
        return []
    waste = shapely.union_all(list(areas.values()))
    return [shapely.difference(shapely.buffer(areas[number], _RIM), waste) for number in alone]


class Waste:
    """The part of the sheet that the beam may burn.

    Args:
        contours: of the drawing.
        kerf: width of the cut, m.
        is_allowed: which places (N, 2) m, sheet frame, the tool may go to at all, (N,).
    """

    def __init__(
        self, contours: Sequence[Contour], *, kerf: float, is_allowed: Callable[[Array], BoolArray] | None = None
    ) -> None:
        self.parts = finished_parts(contours)
        self.kerf = kerf
        self._distance = kerf / 2.0 - SLACK
        self._is_allowed = is_allowed
        kept = self.parts if self._distance > 0.0 else shapely.buffer(self.parts, -SLACK)
        self._tree = shapely.STRtree(kept)

    def is_free(self, ways: Array) -> BoolArray:
        """Which ways, (N, K, 2) m, the beam may run along without burning a part, (N,)."""
        free = np.ones(len(ways), dtype=np.bool_)
        if not len(ways):
            return free
        lines = shapely.linestrings(ways)
        if self._distance > 0.0:
            hit, _ = self._tree.query(lines, predicate="dwithin", distance=self._distance)
        else:
            hit, _ = self._tree.query(lines, predicate="intersects")
        free[hit] = False
        if self._is_allowed is not None:
            free &= self._is_allowed(ways.reshape(-1, 2)).reshape(ways.shape[:2]).all(axis=1)
        return free
