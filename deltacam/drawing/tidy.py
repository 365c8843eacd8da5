"""Small repairs of one curve that stay within stated distances: closing it, and dropping specks of segments."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve

SHORTEST: Final = 1e-6
"""Shorter segments are merged into their neighbours, m."""


def link(pieces: list[Curve], *, closed: bool) -> tuple[Curve, float]:
    """The open curves run one after the other, and how far an end had to move, m.

    Where two ends differ, the end of a line moves to that of an arc; of two of a kind the second moves to the first.

    Args:
        pieces: open, each starting about where the one before ends.
        closed: whether the last also ends where the first starts.
    """
    blocks = [piece.points.copy() for piece in pieces]
    moved = 0.0
    for i in range(0 if closed else 1, len(pieces)):
        end, start = blocks[i - 1][-1], blocks[i][0]
        gap = float(np.hypot(*(end - start)))
        moved = max(moved, gap)
        if gap and pieces[i - 1].bulges[-1] == 0.0 and pieces[i].bulges[0] != 0.0:
            end[:] = start
        else:
            start[:] = end
    points = np.concatenate([block[:-1] for block in blocks] + ([] if closed else [blocks[-1][-1:]]))
    return Curve(points=points, bulges=np.concatenate([piece.bulges for piece in pieces]), closed=closed), moved


def cleaned(curve: Curve) -> tuple[Curve | None, float]:
    """A closed curve without segments under ``SHORTEST``, and how far that moves it, m; None where nothing is left.

    Vertices nearer than that, along the curve, to the last one kept are dropped. A kept vertex at the end of a line
    gives way to the start of an arc, so that the arc stays exact.
    """
    reach = curves.lengths(curve)
    if (reach >= SHORTEST).all():
        return curve, 0.0
    first = int(np.argmax(reach))
    if reach[first] < SHORTEST and reach.sum() < 4.0 * SHORTEST:
        return None, 0.0
    points, bulges, reach = (np.roll(each, -first, axis=0) for each in (curve.points, curve.bulges, reach))
    kept, leaving, moved = [points[0]], [bulges[0]], 0.0
    walked = reach[0]
    for i in range(1, len(points)):
        if walked >= SHORTEST:
            kept.append(points[i])
            leaving.append(bulges[i])
            walked = reach[i]
            continue
        moved = max(moved, walked)
        into_arc = bulges[i] != 0.0 and reach[i] >= SHORTEST
        if into_arc and len(kept) > 1 and leaving[-2] == 0.0:
            kept[-1] = points[i]
        leaving[-1] = bulges[i] if reach[i] >= SHORTEST else 0.0
        walked += reach[i]
    if walked < SHORTEST:
        moved = max(moved, walked)
        kept.pop()
        leaving.pop()
    if len(kept) < 2:
        return None, 0.0
    return _rolled(np.array(kept), np.array(leaving), len(curve.points) - first), moved


def _rolled(points: Array, bulges: Array, back: int) -> Curve:
    """A closed curve that starts ``back`` vertices later, as far as there are so many."""
    by = -(back % len(points))
    return Curve(points=np.roll(points, by, axis=0), bulges=np.roll(bulges, by))
