"""Tabs: bridges across the kerf that hold a part in its sheet until it is broken out.

The laser leaves a gap in the path. The ends of the cuts on both sides of it are half discs, so that of a gap whose ends
are g apart a bridge of g - kerf is left: g is the width plus the kerf, measured straight from end to end.

A tab may be at a place s along the path where

- the gap is ``rule.corner`` m away from every corner, every sharp bend, and every end of what is cut;
- beyond the kerf there is material to hold on to: a disc as wide as the tab, there, is not cut;
- nothing else that is cut on the way, such as an overcut or a loop, runs within a kerf of the gap.

All places are tried in steps of a quarter of the gap, or less. The tabs are wanted at even distances; of all positions
of this comb the one counts that has the fewest teeth without a place, then the one whose teeth must move least. A tooth
moves to the nearest place within its share of the path.
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Final, Literal, NamedTuple

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, BoolArray, Contour, Curve, Finding, IntArray, Stretch, Tabs
from deltacam.units import to_mm

Side = Literal["left", "right"]

_CORNER: Final = np.radians(10.0)  # that a vertex or a sharp bend turns by at least
_SHARP: Final = 2.0  # gaps: the radius of a bend below which it counts like a corner
_APART: Final = 2.0  # gaps: between the middles of neighbouring tabs, at least
_STEPS: Final = 4  # places per gap
_MOST_PLACES: Final = 20_000
_MORE: Final = 10  # tabs than a spacing asks for at least, that are tried where corners push them apart
_ROUNDS: Final = 10  # of the search for the ends of a gap
_FLATTENING: Final = 1e-6  # m
_SLACK: Final = 3e-6  # m; above the errors of flattening
_DARK: Final = frozenset({BlockKind.CUT, BlockKind.TAB, BlockKind.LEAD_OUT})


class Tabbed(NamedTuple):
    """The way of a cut with tabs, and what a person should know about it."""

    way: tuple[Stretch, ...]
    findings: tuple[Finding, ...]


def with_tabs(
    way: Sequence[Stretch],
    contour: Contour,
    *,
    side: Side,
    kerf: float,
    rule: Tabs,
    others: shapely.STRtree,
    clear: Sequence[Curve] = (),
) -> Tabbed:
    """The way of a cut with tabs in it: what was CUT becomes CUT, TAB, CUT.

    Args:
        way: of a closed cut from its beginning to its end, with its leads, loops and overcut; sheet frame, m.
        contour: what was drawn; a hole gets none unless the rule says so.
        side: where the waste is, seen along the way.
        kerf: width of the cut, m, >= 0.
        rule: how wide, and how many or how far apart.
        others: the ways of all other cuts as lines, m.
        clear: what no tab may be within a kerf of: edges that are shared with another part.

    Returns:
        the way, and findings where there are fewer tabs than asked for or they are further apart.
    """
    if contour.is_hole and not rule.holes:
        return Tabbed(tuple(way), ())
    path = _Path.of([stretch.curve for stretch in way if stretch.kind is BlockKind.CUT])
    gap = rule.width + kerf
    burning = [stretch.curve for stretch in way if stretch.kind not in _DARK]
    surroundings = _Surroundings(side, kerf, rule.width, others, burning, clear)
    chosen, wanted = _chosen(path, gap, rule, surroundings)
    return Tabbed(_with_gaps(way, path, _gaps(path, chosen, gap)), _findings(contour, path, rule, chosen, wanted))


class _Path(NamedTuple):
    """What is cut of a way, one stretch after the other: M segments.

    Attributes:
        curves: the stretches.
        starts: where each segment starts, (M, 2) m.
        headings: the direction there, (M,) rad.
        curvatures: (M,) 1/m.
        begins: what is cut before each segment, and the length of all, (M + 1,) m.
        borders: what is cut before each stretch, and the length of all, (number of stretches + 1,) m.
    """

    curves: tuple[Curve, ...]
    starts: Array
    headings: Array
    curvatures: Array
    begins: Array
    borders: Array

    @classmethod
    def of(cls, stretches: Sequence[Curve]) -> _Path:
        """The path along these open curves."""
        lengths = [curves.lengths(curve) for curve in stretches]
        return cls(
            tuple(stretches),
            np.concatenate([np.zeros((0, 2)), *(curve.starts for curve in stretches)]),
            np.concatenate([np.zeros(0), *(curves.headings(curve)[0] for curve in stretches)]),
            np.concatenate([np.zeros(0), *(curves.curvatures(curve) for curve in stretches)]),
            np.concatenate([[0.0], np.cumsum(np.concatenate([np.zeros(0), *lengths]))]),
            np.concatenate([[0.0], np.cumsum([each.sum() for each in lengths])]),
        )

    @property
    def length(self) -> float:
        """Of all that is cut, m."""
        return float(self.begins[-1])

    def at(self, distances: Array) -> tuple[Array, Array]:
        """The places (K, 2) m and directions (K,) rad at distances (K,) m along the path."""
        segment = np.clip(np.searchsorted(self.begins, distances, side="right") - 1, 0, len(self.starts) - 1)
        along = distances - self.begins[segment]
        return curves.advance(self.starts[segment], self.headings[segment], self.curvatures[segment], along)


class _Surroundings(NamedTuple):
    """What is around a path: the side of the waste, the kerf and the width of a tab in m, and all other cuts."""

    side: Side
    kerf: float
    width: float
    others: shapely.STRtree
    burning: Sequence[Curve]
    clear: Sequence[Curve]


def _chosen(path: _Path, gap: float, rule: Tabs, surroundings: _Surroundings) -> tuple[Array, int]:
    """Where the tabs' middles are along the path, (K,) m, and how many there should be."""
    room = int(path.length / (_APART * gap))
    if rule.count is not None:
        count = min(rule.count, room)
        return _comb(path, gap, count, rule, surroundings)[0] if count else np.zeros(0), rule.count
    spacing = rule.spacing or path.length
    least = max(int(np.ceil(path.length / spacing - 1e-9)), 1)
    best, fewest = np.zeros(0), np.inf
    for count in range(min(least, room), min(least + _MORE, room) + 1):
        found, missing = _comb(path, gap, count, rule, surroundings) if count else (np.zeros(0), 0)
        far = _furthest(path, found)
        if far < fewest:
            best, fewest = found, far
        if not missing and far <= spacing * (1.0 + 1e-9):
            break
    return best, least


def _furthest(path: _Path, chosen: Array) -> float:
    """The largest distance along a closed path from a tab to the next, m."""
    if not len(chosen):
        return np.inf
    return float(np.diff(chosen, append=chosen[0] + path.length).max())


def _comb(path: _Path, gap: float, count: int, rule: Tabs, surroundings: _Surroundings) -> tuple[Array, int]:
    """The best places of ``count`` >= 1 tabs at distances that are as even as possible, (K,) m, and how many have none.

    All places are numbered; tooth k of the comb in its position p wants the place p + k * per, and may move by ``most``
    places at most.
    """
    share = path.length / count
    per = int(np.clip(np.ceil(_STEPS * share / gap), 1, max(_MOST_PLACES // count, 1)))
    step = share / per
    places = np.linspace(0.5, per * count - 0.5, per * count) * step
    allowed = _allowed(path, places, gap, rule, surroundings)
    if not len(allowed):
        return np.zeros(0), count
    most = int(max(share - _APART * gap, 0.0) / (2.0 * step))
    wanted = np.arange(per)[:, None] + per * np.arange(count)[None, :]
    nearest = _nearest(allowed, wanted)
    moved = np.abs(nearest - wanted)
    missing = moved > most
    moved = np.where(missing, 0, moved)
    best = int(np.lexsort((moved.sum(axis=1), moved.max(axis=1), missing.sum(axis=1)))[0])
    return places[nearest[best][~missing[best]]], int(missing[best].sum())


def _nearest(allowed: IntArray, wanted: IntArray) -> IntArray:
    """For each number that is wanted the nearest of those that are allowed, which count up."""
    after = np.searchsorted(allowed, wanted).clip(0, len(allowed) - 1)
    before = (after - 1).clip(0)
    low, high = allowed[before], allowed[after]
    return np.asarray(np.where(np.abs(wanted - low) <= np.abs(high - wanted), low, high))


def _allowed(path: _Path, places: Array, gap: float, rule: Tabs, surroundings: _Surroundings) -> IntArray:
    """Which of the places along the path, (N,) m, may be the middle of a gap."""
    low, high = _bends(path, gap)
    clear = 0.5 * gap + rule.corner
    begins, ends = np.sort(low - clear), np.sort(high + clear)
    # A place lies in as many of these spans as have begun before it and not ended.
    free = np.searchsorted(begins, places, side="left") == np.searchsorted(ends, places, side="right")
    kept = np.flatnonzero(free)
    return kept[_has_hold(path, places[kept], gap, surroundings)]


def _bends(path: _Path, gap: float) -> tuple[Array, Array]:
    """Where corners, sharp bends and ends of what is cut begin and end along the path, (K,) m each."""
    low, high = [path.borders], [path.borders]
    for curve, border in zip(path.curves, path.borders.tolist(), strict=False):
        reach = border + np.concatenate([[0.0], np.cumsum(curves.lengths(curve))])
        corner = reach[1:-1][np.abs(curves.corner_angles(curve)) > _CORNER]
        bent = np.abs(curves.curvatures(curve)) * _SHARP * gap > 1.0
        edge = np.diff(np.concatenate([[0], bent.astype(np.int64), [0]]))
        begin, end = np.flatnonzero(edge == 1), np.flatnonzero(edge == -1)
        turned = np.concatenate([[0.0], np.cumsum(np.where(bent, np.abs(curves.turns(curve)), 0.0))])
        real = turned[end] - turned[begin] > _CORNER
        low += [corner, reach[begin[real]]]
        high += [corner, reach[end[real]]]
    return np.concatenate(low), np.concatenate(high)


def _has_hold(path: _Path, places: Array, gap: float, surroundings: _Surroundings) -> BoolArray:
    """At which places there is material beyond the kerf, and nothing else burns the bridge away, (N,)."""
    reach = 0.5 * (surroundings.kerf + surroundings.width)
    own = [_line(curve) for curve in (*path.curves, *surroundings.burning)]
    kept_from = [_line(curve) for curve in (*surroundings.burning, *surroundings.clear)]
    tree = shapely.STRtree(own)
    away = 1.0 if surroundings.side == "left" else -1.0
    good = np.ones(len(places), dtype=np.bool_)
    for share in (-0.5, 0.0, 0.5):
        points, headings = path.at(places + share * gap)
        waste = away * np.stack([-np.sin(headings), np.cos(headings)], axis=1)
        landing = shapely.points(points + reach * waste)
        for lines in (tree, surroundings.others):
            near = lines.query(landing, predicate="dwithin", distance=reach - _SLACK)
            good[near[0]] = False
        for line in kept_from:
            good &= ~shapely.dwithin(line, shapely.points(points), surroundings.kerf)
    return good


def _line(curve: Curve) -> shapely.LineString:
    return shapely.LineString(curves.flatten(curve, _FLATTENING)[0])


def _gaps(path: _Path, middles: Array, gap: float) -> Array:
    """The begin and the end of every gap along the path, (K, 2) m, ``gap`` m apart as the crow flies.

    On a bend the gap is longer along the path, by little: each round of the search leaves a few percent of the error.
    """
    half = np.full(len(middles), 0.5 * gap)
    for _ in range(_ROUNDS):
        half *= gap / np.hypot(*(path.at(middles + half)[0] - path.at(middles - half)[0]).T)
    return np.stack([middles - half, middles + half], axis=1)


def _with_gaps(way: Sequence[Stretch], path: _Path, gaps: Array) -> tuple[Stretch, ...]:
    """The way, with a TAB for every gap."""
    stretches, borders = [], iter(zip(path.borders[:-1].tolist(), path.borders[1:].tolist(), strict=True))
    for stretch in way:
        if stretch.kind is not BlockKind.CUT:
            stretches.append(stretch)
            continue
        begin, end = next(borders)
        inside = gaps[(gaps[:, 0] > begin) & (gaps[:, 1] < end)] - begin
        if not len(inside):
            stretches.append(stretch)
            continue
        knots = [0.0, *inside.ravel().tolist(), end - begin]
        for number, (first, last) in enumerate(pairwise(knots)):
            kind = BlockKind.TAB if number % 2 else BlockKind.CUT
            stretches.append(Stretch(kind, curves.part(stretch.curve, first, last)))
    return tuple(stretches)


def _findings(contour: Contour, path: _Path, rule: Tabs, chosen: Array, wanted: int) -> tuple[Finding, ...]:
    """What a person should know of the tabs of one contour."""
    width = f"{to_mm(rule.width):.3g} mm"
    hint = "use narrower or fewer tabs, or let them be nearer to corners"
    if len(chosen) < wanted:
        found = "none fits" if not len(chosen) else f"only {len(chosen)} fit"
        what = f"{wanted} {'tab' if wanted == 1 else 'tabs'} of {width} asked for, {found}"
    elif rule.count is None and rule.spacing and _furthest(path, chosen) > rule.spacing * (1.0 + 1e-9):
        what = f"tabs of {width} are up to {to_mm(_furthest(path, chosen)):.3g} mm apart, "
        what += f"{to_mm(rule.spacing):.3g} mm asked for"
    else:
        return ()
    x, y = contour.curve.points[0].tolist()
    return (Finding(what, where=contour.where, hint=hint, kind="tab", place=(x, y)),)
