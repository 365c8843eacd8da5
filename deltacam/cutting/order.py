"""The order of the cuts: what lies inside a contour before the contour, and little travel in between.

A part that has been cut out may drop or tilt, so nothing on it can be engraved or cut afterwards: the whole sheet is
engraved first, then the open lines are cut, then the contours, inner before outer. Within that rule the order comes
from the nearest neighbour, improved as `improve` says.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import shapely

from deltacam.cutting.improve import GAIN, Precedence, Tour, improve
from deltacam.geometry import curve as curves
from deltacam.model import Array, Cut, IntArray, Operation

_FLATTENING: Final = 1e-4
_ROUNDS: Final = 20
_STAGES: Final = 3


def order(cuts: Sequence[Cut], *, parents: Mapping[int, int | None], start: tuple[float, float]) -> tuple[Cut, ...]:
    """Order the cuts and choose where each begins, and which way open ones are run.

    Args:
        cuts: in the sheet frame.
        parents: for the number of each contour, the number of the contour around it.
        start: where the tool is before the first cut and after the last, sheet frame, m.

    Returns:
        the same cuts: engraving, then open cuts, then closed ones, where every contour comes after all that lies inside
        it. Each begins at its point nearest to where the one before it ended; an open one at the nearer end.
    """
    ordered: tuple[Cut, ...] = ()
    place = start
    for stage in range(_STAGES):
        ordered += _order([cut for cut in cuts if _stage(cut) == stage], parents, place, start)
        place = _end(ordered[-1]) if ordered else start
    return ordered


def _stage(cut: Cut) -> int:
    """0 for engraving, 1 for open cuts, 2 for closed ones."""
    if cut.operation is Operation.ENGRAVE:
        return 0
    return 2 if cut.curve.closed else 1


def _order(
    cuts: Sequence[Cut], parents: Mapping[int, int | None], start: tuple[float, float], home: tuple[float, float]
) -> tuple[Cut, ...]:
    """The cuts of one stage in order, from ``start`` and then on to ``home``."""
    if not cuts:
        return ()
    rule = Precedence.between(cuts, parents)
    sequence = _nearest_neighbour(cuts, rule, start)
    best = _walk(cuts, sequence, start)
    best_travel = _travel(best, start, home)
    for _ in range(_ROUNDS):
        improved = improve(_tour(best, sequence, start, home), rule)
        if np.array_equal(improved, sequence):
            break
        walked = _walk(cuts, improved, start)
        travel = _travel(walked, start, home)
        if travel >= best_travel - GAIN:
            break
        sequence, best, best_travel = improved, walked, travel
    return best


def _nearest_neighbour(cuts: Sequence[Cut], rule: Precedence, start: tuple[float, float]) -> IntArray:
    lines = np.array([_beginnings(cut) for cut in cuts])
    waiting = np.array([len(inside) for inside in rule.before])
    ready = waiting == 0
    place = np.array(start)
    sequence = []
    for _ in cuts:
        choices = np.flatnonzero(ready)
        chosen = int(choices[np.argmin(shapely.distance(lines[choices], shapely.Point(place)))])
        sequence.append(chosen)
        ready[chosen] = False
        for around in rule.after[chosen]:
            waiting[around] -= 1
            ready[around] = waiting[around] == 0
        place = _begun_near(cuts[chosen], place).curve.ends[-1]
    return np.array(sequence)


def _beginnings(cut: Cut) -> shapely.Geometry:
    """Where a cut may begin: anywhere on a closed one, at the ends of an open one."""
    if not cut.curve.closed:
        return shapely.MultiPoint(cut.curve.points[[0, -1]])
    points, _ = curves.flatten(cut.curve, _FLATTENING)
    return shapely.LineString(np.concatenate([points, points[:1]]))


def _begun_near(cut: Cut, place: Array) -> Cut:
    """The cut, begun where it may begin nearest to ``place``, (2,) m."""
    if not cut.curve.closed:
        first, last = np.hypot(*(cut.curve.points[[0, -1]] - place).T)
        return replace(cut, curve=curves.reverse(cut.curve)) if last < first else cut
    segment, distance, _ = curves.nearest(cut.curve, place)
    return replace(cut, curve=curves.start_at(cut.curve, segment, distance))


def _end(cut: Cut) -> tuple[float, float]:
    x, y = cut.curve.ends[-1]
    return float(x), float(y)


def _walk(cuts: Sequence[Cut], sequence: IntArray, start: tuple[float, float]) -> tuple[Cut, ...]:
    """The cuts in sequence, each begun nearest to the end of the one before."""
    place = np.array(start)
    walked = []
    for index in sequence:
        walked.append(_begun_near(cuts[index], place))
        place = walked[-1].curve.ends[-1]
    return tuple(walked)


def _travel(cuts: Sequence[Cut], start: tuple[float, float], home: tuple[float, float]) -> float:
    begins = np.array([*(cut.curve.points[0] for cut in cuts), home])
    ends = np.array([start, *(cut.curve.ends[-1] for cut in cuts)])
    return float(np.hypot(*(begins - ends).T).sum())


def _tour(walked: Sequence[Cut], sequence: IntArray, start: tuple[float, float], home: tuple[float, float]) -> Tour:
    """Where the walked cuts begin and end, by the index of each."""
    back = np.argsort(sequence)
    begins = np.array([cut.curve.points[0] for cut in walked])[back]
    ends = np.array([cut.curve.ends[-1] for cut in walked])[back]
    return Tour(sequence, begins, ends, np.array(start), np.array(home))
