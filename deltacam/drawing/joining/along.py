"""Open lines that lie wholly on the edge of a closed one."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from deltacam.drawing.joining.duplicates import SAME
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import Curve


def find(lines: Sequence[Curve], loops: Sequence[Curve]) -> dict[int, int]:
    """For each line that lies on a loop, nowhere further away than ``SAME``, that loop: index to index."""
    if not lines or not loops:
        return {}
    import shapely

    points, loop_of = rings.flatten(Pack.of(loops), 0.1 * SAME)
    points, loop_of = rings.full(points, loop_of)
    edges = shapely.linearrings(points, indices=loop_of)
    starts = shapely.points(np.array([line.points[0] for line in lines]))
    near = shapely.STRtree(edges).query(starts, predicate="dwithin", distance=SAME)
    found: dict[int, int] = {}
    for at, loop in sorted(zip(*near.tolist(), strict=True)):
        if at not in found and _lies_on(lines[at], edges[loop]):
            found[at] = loop
    return found


def _lies_on(line: Curve, edge: object) -> bool:
    """Whether the points along a line are all near an edge."""
    import shapely

    shapely.prepare(edge)
    points, _ = rings.flatten(Pack.of([line]), 0.1 * SAME)
    marks = np.concatenate([points, 0.5 * (points[1:] + points[:-1])])
    return bool(shapely.dwithin(shapely.points(marks), edge, SAME).all())
