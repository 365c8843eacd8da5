"""What lines enclose that could be closed in more than one way: the outlines of parts that would go missing."""

from __future__ import annotations

from typing import Any

import numpy as np

from deltacam.drawing import flaws
from deltacam.drawing.flaws import Name, place, point_mm
from deltacam.drawing.joining.chains import Steps
from deltacam.drawing.joining.link import link
from deltacam.drawing.joining.nodes import Nodes
from deltacam.drawing.joining.overlaps import Strands
from deltacam.geometry import rings
from deltacam.model import Array, Finding, IntArray

_FLATNESS = 1e-6

_COMMON_HINT = "draw each part's outline for itself and leave room for the cut between them"
_SPLIT_HINT = "draw each outline for itself, so that it closes in one way only"


# GEOS may leave a floating point flag behind where lines cross; what it returns is sound.
@np.errstate(invalid="ignore")
def find(strands: Strands, nodes: Nodes, tangled: list[Steps], name: Name) -> list[Finding]:
    """One finding per group of chains between branch points that encloses something; nothing may be planned then.

    Args:
        strands: the open curves.
        nodes: where they meet.
        tangled: the chains, as steps.
        name: how messages name a curve.
    """
    if not tangled:
        return []
    import shapely

    ends = nodes.labels.reshape(-1)[np.array([(run[0], run[-1] ^ 1) for run in tangled])]
    group = _groups(ends, len(nodes.places))
    points, line_of = _lines(strands, nodes, tangled, ends)
    first = np.concatenate([[0], np.cumsum(np.bincount(line_of, minlength=len(tangled)))])
    lines = shapely.linestrings(points, indices=line_of)
    common, split = [], []
    order = np.argsort(group, kind="stable")
    for those in np.split(order, np.flatnonzero(np.diff(group[order])) + 1):
        faces = shapely.get_parts(shapely.polygonize(lines[those]))
        if not len(faces):
            continue
        where = name(int(min(strands.owner[step >> 1] for step in tangled[those[0]])))
        count, shared = _sharing(faces)
        if count > 1:
            what = f"{count} outlines share lines, for one at {point_mm(shared)} mm"
            common.append(Finding(what, where, _COMMON_HINT, "common_edge", place(shared), blocks=True))
        else:
            at = points[first[those[0]]]
            what = f"lines enclose something but could be closed in more than one way, at {point_mm(at)} mm"
            split.append(Finding(what, where, _SPLIT_HINT, "branch", place(at), blocks=True))
    return flaws.limited(common) + flaws.limited(split)


def _groups(ends: IntArray, count: int) -> IntArray:
    """The connected group of each chain, (T,), given the nodes at its ends, (T, 2), of ``count`` nodes."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    links = coo_array((np.ones(len(ends), dtype=np.int8), (ends[:, 0], ends[:, 1])), shape=(count, count))
    _, labels = connected_components(links, directed=False)
    _, first, which = np.unique(labels[ends[:, 0]], return_index=True, return_inverse=True)
    return np.asarray(first[which.reshape(-1)], dtype=np.int64)


def _lines(strands: Strands, nodes: Nodes, tangled: list[Steps], ends: IntArray) -> tuple[Array, IntArray]:
    """Points along the chains, (N, 2) m, which meet exactly at their nodes, and the chain of each, (N,)."""
    pack, _ = link(strands.pack, tangled, closed=False)
    points, line_of = rings.flatten(pack, _FLATNESS)
    last = np.cumsum(np.bincount(line_of)) - 1
    points[last] = nodes.places[ends[:, 1]]
    points[np.concatenate([[0], last[:-1] + 1])] = nodes.places[ends[:, 0]]
    return points, line_of


def _sharing(faces: Any) -> tuple[int, Array]:
    """How many of the polygons have an edge in common with another, and the middle of such an edge, (2,) m."""
    import shapely

    edges, face = shapely.get_coordinates(faces, return_index=True)
    same = face[1:] == face[:-1]
    pairs = np.hstack([edges[:-1], edges[1:]])[same]
    swapped = (pairs[:, 0] > pairs[:, 2]) | ((pairs[:, 0] == pairs[:, 2]) & (pairs[:, 1] > pairs[:, 3]))
    pairs[swapped] = pairs[swapped][:, [2, 3, 0, 1]]
    _, index, which, counts = np.unique(pairs, axis=0, return_index=True, return_inverse=True, return_counts=True)
    shared = np.flatnonzero(counts > 1)
    if not len(shared):
        return 0, pairs[0, :2]
    first = pairs[index[shared].min()]
    of_face = face[:-1][same][np.isin(which.reshape(-1), shared)]
    return len(np.unique(of_face)), 0.5 * (first[:2] + first[2:])
