"""Which contour lies in which, by even-odd nesting, and where contours meet.

Contours that cross themselves or each other, that share a line, or that lie among lines whose outlines are unknown are
nested as well as that can be done, and a finding says that nothing may be planned. Two contours may touch in a point.

An outline that is open but for a small gap, such as a holding tab, counts as closed here, as long as it lies in no
contour itself: what lies inside it are the holes of a part.

Where contours cross inside another, such as counterbores on a plate, each of them bounds the same waste, so none of
them counts as being around what lies in it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, Final

import numpy as np

from deltacam.drawing import flaws
from deltacam.drawing.flaws import place
from deltacam.drawing.nesting import crossings
from deltacam.drawing.nesting.outlines import SAGITTA, Outlines, is_mess
from deltacam.errors import DrawingError
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import BoolArray, Contour, Curve, Finding, IntArray

MOST_NESTED: Final = 2_000_000
"""More pairs of contours of which one lies in the other, and 50 for each contour, are refused."""

_BATCH: Final = 256


# GEOS may leave a floating point flag behind where faces vanish; what it returns is sound.
@np.errstate(invalid="ignore")
def nest(
    contours: Sequence[Contour], *, outlines: Sequence[Curve] = (), tangles: Sequence[Curve] = ()
) -> tuple[tuple[Contour, ...], list[Finding]]:
    """The contours with their depth and parent, and findings where they meet or lie in something open.

    Time and memory grow about linearly with the number of contours, and time with the number of pairs of which one
    lies in the other.

    Args:
        contours: closed.
        outlines: open curves that are closed but for a gap, m.
        tangles: open curves between points where more than two lines meet, m.

    Raises:
        DrawingError: contours lie in each other by the thousands.
    """
    import shapely

    if not contours:
        return (), []
    shapes = Outlines.of([contour.curve for contour in contours])
    findings = crossings.with_themselves(contours, shapes)
    meetings = crossings.between(contours, shapes)
    findings += meetings.findings
    inside = shapely.point_on_surface(shapes.polygons)
    depth, parent = _nesting(shapes, inside, meetings.crossing)
    tree = shapely.STRtree(shapes.polygons)
    opened = _in_outlines(inside, tree, outlines)
    findings += _open_findings(contours, inside, opened)
    findings += _in_tangles(contours, inside, tree, tangles)
    numbers = [contour.number for contour in contours]
    nested = tuple(
        replace(contour, depth=level, parent=numbers[around] if around >= 0 else None)
        for contour, level, around in zip(contours, (depth + opened).tolist(), parent.tolist(), strict=True)
    )
    return nested, findings


def _nesting(shapes: Outlines, inside: Any, crossing: IntArray) -> tuple[IntArray, IntArray]:
    """How many contours are around each, (M,), and the smallest of them, (M,), -1 where there is none.

    Args:
        shapes: the contours.
        inside: (M,) a point in each.
        crossing: (K, 2) pairs that cross.
    """
    crosses = np.zeros(len(inside), dtype=np.bool_)
    crosses[crossing] = True
    if not crosses.any():
        return _around(shapes, inside, ~crosses, crossing)
    depth, _ = _around(shapes, inside, ~crosses, crossing)
    return _around(shapes, inside, ~crosses | (depth == 0), crossing)


def _around(shapes: Outlines, inside: Any, counted: BoolArray, crossing: IntArray) -> tuple[IntArray, IntArray]:
    """Depth and parent of each contour, (M,), among the larger ones that count and do not cross it.

    Raises:
        DrawingError: more pairs than ``MOST_NESTED``.
    """
    import shapely

    left = MOST_NESTED + 50 * len(inside)
    areas, count = shapes.areas, len(inside)
    tree = shapely.STRtree(inside)
    depth, parent = np.zeros(count, dtype=np.int64), np.full(count, -1)
    both = np.concatenate([crossing, crossing[:, ::-1]])
    apart = np.sort(both[:, 0] * count + both[:, 1])
    by_size = np.flatnonzero(counted)[np.argsort(areas[counted], kind="stable")]
    for begin in range(0, len(by_size), _BATCH):
        those = by_size[begin : begin + _BATCH]
        outer, inner = tree.query(shapes.polygons[those], predicate="contains")
        left -= len(outer)
        if left < 0:
            what = "thousands of contours lie in each other"
            raise DrawingError(what, hint="save only what is to be cut; hatching is not drawn as contours")
        outer = those[outer]
        around = areas[outer] > areas[inner]
        if len(apart):
            around &= ~np.isin(outer * count + inner, apart)
        outer, inner = outer[around], inner[around]
        depth += np.bincount(inner, minlength=count)
        # The smallest comes last here, so that it is the one that stays.
        lone = parent[inner] < 0
        parent[inner[lone][::-1]] = outer[lone][::-1]
    return depth, parent


def _in_outlines(inside: Any, tree: Any, outlines: Sequence[Curve]) -> IntArray:
    """In how many open outlines, themselves in no contour, each of the points (M,) lies."""
    import shapely

    outer = _outermost(outlines, tree)
    if not outer:
        return np.zeros(len(inside), dtype=np.int64)
    points, line_of = rings.full(*rings.flatten(Pack.of(outer), SAGITTA))
    loops = shapely.linearrings(points, indices=line_of)
    faces = [
        shapely.convex_hull(loop) if is_mess(loop) else shapely.make_valid(shapely.Polygon(loop)) for loop in loops
    ]
    _, index = shapely.STRtree(inside).query(faces, predicate="contains")
    return np.bincount(index, minlength=len(inside)).astype(np.int64)


def _open_findings(contours: Sequence[Contour], inside: Any, opened: IntArray) -> list[Finding]:
    """The finding that some contours lie in open outlines, where ``opened``, (M,), is not 0."""
    import shapely

    count = np.count_nonzero(opened)
    if not count:
        return []
    many = "1 contour lies" if count == 1 else f"{count} contours lie"
    first = int(np.argmax(opened > 0))
    what = f"{many} in an outline that is open: cut as its holes"
    spot = place(shapely.get_coordinates(inside[first])[0])
    return [Finding(what, where=contours[first].where, kind="open", place=spot)]


def _in_tangles(contours: Sequence[Contour], inside: Any, tree: Any, tangles: Sequence[Curve]) -> list[Finding]:
    """One finding per contour that lies inside a tangle of lines that itself lies in no contour."""
    import shapely

    outer = _outermost(tangles, tree)
    if not outer:
        return []
    points, line_of = rings.flatten(Pack.of(outer), SAGITTA)
    lines = shapely.multilinestrings(shapely.linestrings(points, indices=line_of))
    noded = lines if is_mess(lines) else shapely.unary_union(lines)
    faces = shapely.get_parts(shapely.polygonize([noded]))
    _, index = shapely.STRtree(inside).query(faces, predicate="contains")
    what = "it lies among lines that could be closed in more than one way, so its side is unknown"
    hint = "draw each outline around it for itself"
    spots = shapely.get_coordinates(inside)
    found = [
        Finding(what, contours[i].where, hint, "branch", place(spots[i]), blocks=True)
        for i in np.unique(index).tolist()
    ]
    return flaws.limited(found)


def _outermost(open_curves: Sequence[Curve], tree: Any) -> list[Curve]:
    """The open curves that start in none of the polygons of the tree."""
    import shapely

    starts = np.array([curve.points[0] for curve in open_curves]).reshape(-1, 2)
    within = set(tree.query(shapely.points(starts), predicate="within")[0].tolist()) if len(starts) else set()
    return [curve for i, curve in enumerate(open_curves) if i not in within]
