"""The order of the cuts: what lies inside a contour before the contour, and little travel in between.

A part that has been cut out may drop or tilt, so nothing inside it can be cut afterwards. Within that rule the order
comes from the nearest neighbour, improved by moving short runs of cuts and by reversing stretches (Or-opt, 2-opt).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Final

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, Cut, IntArray

_FLATTENING: Final = 1e-4
_ROUNDS: Final = 20
_LONGEST_RUN: Final = 3
_GAIN: Final = 1e-9


def order(cuts: Sequence[Cut], *, parents: Mapping[int, int | None], start: tuple[float, float]) -> tuple[Cut, ...]:
    """Order the cuts and choose where each begins.

    Args:
        cuts: closed, in the sheet frame.
        parents: for the number of each contour, the number of the contour around it.
        start: where the tool is before the first cut and after the last, sheet frame, m.

    Returns:
        the same cuts; every contour comes after all that lies inside it, and each cut begins at its point nearest to
        where the one before it ended.
    """
    if not cuts:
        return ()
    rule = Precedence.between(cuts, parents)
    sequence = _nearest_neighbour(cuts, rule, start)
    best = _walk(cuts, sequence, start)
    best_travel = _travel(best, start)
    for _ in range(_ROUNDS):
        places = np.array([cut.curve.points[0] for cut in best])[np.argsort(sequence)]
        improved = _improve(sequence, places, rule, start)
        if np.array_equal(improved, sequence):
            break
        walked = _walk(cuts, improved, start)
        travel = _travel(walked, start)
        if travel >= best_travel - _GAIN:
            break
        sequence, best, best_travel = improved, walked, travel
    return best


@dataclass(frozen=True, slots=True, eq=False)
class Precedence:
    """Which cut must come before which, by index.

    Attributes:
        before: for each cut, the cuts inside its contour.
        after: for each cut, the cuts of the contour around it.
        inner: with ``outer`` the same as pairs, (P,): ``inner[i]`` comes before ``outer[i]``.
        outer: (P,).
    """

    before: tuple[tuple[int, ...], ...]
    after: tuple[tuple[int, ...], ...]
    inner: IntArray
    outer: IntArray

    @classmethod
    def between(cls, cuts: Sequence[Cut], parents: Mapping[int, int | None]) -> Precedence:
        """The rule that what lies directly inside a contour is cut before it."""
        by_contour: dict[int, list[int]] = {}
        for index, cut in enumerate(cuts):
            by_contour.setdefault(cut.contour, []).append(index)
        before: list[list[int]] = [[] for _ in cuts]
        after: list[list[int]] = [[] for _ in cuts]
        for index, cut in enumerate(cuts):
            parent = parents[cut.contour]
            for around in by_contour.get(parent, []) if parent is not None else []:
                before[around].append(index)
                after[index].append(around)
        pairs = np.array([(i, o) for i, outer in enumerate(after) for o in outer], dtype=np.int64).reshape(-1, 2)
        return cls(tuple(map(tuple, before)), tuple(map(tuple, after)), pairs[:, 0], pairs[:, 1])


def _nearest_neighbour(cuts: Sequence[Cut], rule: Precedence, start: tuple[float, float]) -> IntArray:
    lines = np.array([_outline(cut) for cut in cuts])
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
        place = _nearest_place(cuts[chosen], place)
    return np.array(sequence)


def _outline(cut: Cut) -> shapely.LineString:
    points, _ = curves.flatten(cut.curve, _FLATTENING)
    return shapely.LineString(np.concatenate([points, points[:1]]))


def _nearest_place(cut: Cut, place: Array) -> Array:
    segment, distance, _ = curves.nearest(cut.curve, place)
    points, _ = curves.evaluate(cut.curve, np.array([segment]), np.array([distance]))
    return np.asarray(points[0])


def _walk(cuts: Sequence[Cut], sequence: IntArray, start: tuple[float, float]) -> tuple[Cut, ...]:
    """The cuts in sequence, each beginning at its point nearest to the end of the one before."""
    place = np.array(start)
    walked = []
    for index in sequence:
        segment, distance, _ = curves.nearest(cuts[index].curve, place)
        curve = curves.start_at(cuts[index].curve, segment, distance)
        walked.append(replace(cuts[index], curve=curve))
        place = curve.points[0]
    return tuple(walked)


def _travel(cuts: Sequence[Cut], start: tuple[float, float]) -> float:
    places = np.array([start, *(cut.curve.points[0] for cut in cuts), start])
    return float(np.hypot(*np.diff(places, axis=0).T).sum())


def _improve(sequence: IntArray, places: Array, rule: Precedence, start: tuple[float, float]) -> IntArray:
    """One pass of both moves over the whole sequence, with the start points held where they are."""
    for run in range(_LONGEST_RUN, 0, -1):
        for index in range(len(places)):
            sequence = _best_insertion(sequence, places, rule, start, index, run)
    for first in range(len(places) - 1):
        sequence = _best_reversal(sequence, places, rule, start, first)
    return sequence


def _stops(sequence: IntArray, places: Array, start: tuple[float, float]) -> Array:
    """The places in sequence between the start and the return to it, (N + 2, 2) m."""
    home = np.array([start])
    return np.concatenate([home, places[sequence], home])


def _distance(first: Array, second: Array) -> Array:
    return np.asarray(np.hypot(first[..., 0] - second[..., 0], first[..., 1] - second[..., 1]))


def _positions(sequence: IntArray) -> IntArray:
    """The position of every cut in the sequence, (N,)."""
    position = np.empty(len(sequence), dtype=np.int64)
    position[sequence] = np.arange(len(sequence))
    return position


def _best_insertion(
    sequence: IntArray, places: Array, rule: Precedence, start: tuple[float, float], index: int, run: int
) -> IntArray:
    """Move the ``run`` cuts from cut ``index`` on to where they cost least, if anywhere less than now."""
    position = _positions(sequence)
    here = int(position[index])
    if here + run > len(sequence):
        return sequence
    moved, rest = sequence[here : here + run], np.concatenate([sequence[:here], sequence[here + run :]])
    low, high = _allowed_slots(moved.tolist(), position, rule)
    stops = _stops(rest, places, start)
    head, tail = places[moved[0]], places[moved[-1]]
    before, after = stops[low : high + 1], stops[low + 1 : high + 2]
    cost = _distance(before, head) + _distance(tail, after) - _distance(before, after)
    best = int(np.argmin(cost))
    if cost[best] >= cost[here - low] - _GAIN:
        return sequence
    return np.insert(rest, low + best, moved)


def _allowed_slots(moved: list[int], position: IntArray, rule: Precedence) -> tuple[int, int]:
    """The first and last slot for a run, counted without it: after what lies inside it, before what is around it."""
    inside = [int(position[cut]) for index in moved for cut in rule.before[index] if cut not in moved]
    around = [int(position[cut]) for index in moved for cut in rule.after[index] if cut not in moved]
    # What lies inside stands before the run, what lies around stands behind it, where taking the run out shifts it.
    return max(inside, default=-1) + 1, min(around, default=len(position)) - len(moved)


def _best_reversal(
    sequence: IntArray, places: Array, rule: Precedence, start: tuple[float, float], first: int
) -> IntArray:
    """Reverse the stretch that begins at position ``first`` and saves most, if any saves."""
    position = _positions(sequence)
    behind = position[rule.inner] >= first
    last = int(position[rule.outer[behind]].min(initial=len(sequence)))
    if last - first < 2:
        return sequence
    stops = _stops(sequence, places, start)
    ends, after = stops[first + 2 : last + 1], stops[first + 3 : last + 2]
    before, head = stops[first], stops[first + 1]
    gain = _distance(before, head) + _distance(ends, after) - _distance(before, ends) - _distance(head, after)
    best = int(np.argmax(gain))
    if gain[best] <= _GAIN:
        return sequence
    stop = first + 2 + best
    return np.concatenate([sequence[:first], sequence[first:stop][::-1], sequence[stop:]])
