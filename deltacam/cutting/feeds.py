"""Feeds that are reduced by rule: in small holes, whose heat does not spread, and in small bends.

A hole is as large as the circle of its area. The radius of a bend is that of the drawn line, not of the kerf path.
A bend that is drawn as short lines, or short arcs, has the radius of the circle that these are chords of.
"""

from __future__ import annotations

import itertools
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Contour, Curve, Cut, IntArray, Operation, Process, Stretch

SHARPEST_CHORDS: Final = np.radians(20.0)
"""Chords of a bend meet at no larger angle, rad: beyond it is a corner."""

SLACK: Final = 1e-6
"""How much larger than a rule says a hole or a radius may be, m: drawings round their numbers."""

_STRAIGHT: Final = 1e-4
_FLATTENING: Final = 1e-6
_BESIDE: Final = frozenset({BlockKind.CUT, BlockKind.OVERCUT})


def in_holes(cuts: Sequence[Cut], contours: Sequence[Contour], *, process: Process) -> tuple[Cut, ...]:
    """The cuts with the feed that the process has for holes of their size.

    Args:
        cuts: any.
        contours: of the drawing, m.
        process: its rules; of several that match the smallest factor counts.
    """
    rules = [(rule.diameter, rule.factor) for rule in process.slower if rule.diameter is not None]
    if not rules:
        return tuple(cuts)
    holes = [contour for contour in contours if contour.has_kerf and contour.is_hole]
    sizes = {hole.number: 2.0 * np.sqrt(abs(curves.signed_area(hole.curve)) / np.pi) for hole in holes}
    limits, factors = np.array(rules).T
    found = []
    for cut in cuts:
        factor = np.min(factors, where=sizes.get(cut.contour, np.inf) <= limits + SLACK, initial=1.0)
        found.append(replace(cut, feed=float(factor * process.feed)) if factor < 1.0 else cut)
    return tuple(found)


def in_bends(cuts: Sequence[Cut], contours: Sequence[Contour], *, process: Process) -> tuple[Cut, ...]:
    """The cuts with ways whose small bends are stretches with a feed of their own.

    Args:
        cuts: as they are run; a cut without a way gets one where it has a small bend.
        contours: of the drawing, m.
        process: its rules; of several that match the smallest factor counts.
    """
    rules = [(rule.radius, rule.factor) for rule in process.slower if rule.radius is not None]
    if not rules:
        return tuple(cuts)
    drawn = {contour.number: contour for contour in contours}
    return tuple(
        _with_slow_bends(cut, drawn[cut.contour].curve, np.array(rules), process.feed)
        if cut.operation is Operation.CUT
        else cut
        for cut in cuts
    )


def _with_slow_bends(cut: Cut, drawn: Curve, rules: Array, feed: float) -> Cut:
    """The cut with its bends in stretches of their own, where it has any that is small."""
    factors = np.min(
        np.broadcast_to(rules[:, 1], (len(drawn.bulges), len(rules))),
        axis=1,
        where=radii(drawn)[:, None] <= rules[:, 0] + SLACK,
        initial=1.0,
    )
    if (factors == 1.0).all():
        return cut
    usual = feed if cut.feed is None else cut.feed
    way = cut.way or (Stretch(BlockKind.CUT, curves.opened(cut.curve) if cut.curve.closed else cut.curve),)
    found: list[Stretch] = []
    for stretch in way:
        if stretch.kind not in _BESIDE:
            found.append(stretch)
            continue
        feeds = np.minimum(usual, feed * factors[_nearest(drawn, _middles(stretch.curve))])
        edges = [0, *(np.flatnonzero(np.diff(feeds)) + 1).tolist(), len(feeds)]
        for first, end in itertools.pairwise(edges):
            own = float(feeds[first])
            part = Curve(stretch.curve.points[first : end + 1], stretch.curve.bulges[first:end], closed=False)
            found.append(replace(stretch, curve=part, feed=own if own < usual else stretch.feed))
    return replace(cut, way=tuple(found))


def radii(curve: Curve) -> Array:
    """The radius of every segment of a drawn line, (M,) m; infinite where it is straight.

    Segments that turn little are chords of a bend too, where the next one goes on at less than `SHARPEST_CHORDS`: the
    radius is the mean length of both over that angle. Of its own and those at its ends the smallest one counts.
    """
    bend, chord = np.abs(curves.curvatures(curve)), curves.chords(curve)
    found = np.divide(1.0, bend, out=np.full_like(bend, np.inf), where=bend > 0.0)
    behind = np.arange(0 if curve.closed else 1, len(bend))
    before = behind - 1  # of a closed curve the last one comes before the first
    one, other = chord[before], chord[behind]
    angle = np.abs(np.arctan2(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0], np.sum(one * other, axis=1)))
    short = np.abs(curves.turns(curve)) <= SHARPEST_CHORDS
    bent = (angle > _STRAIGHT) & (angle <= SHARPEST_CHORDS) & short[before] & short[behind]
    length = 0.5 * (np.hypot(*one.T) + np.hypot(*other.T))
    radius = np.divide(length, angle, out=np.full_like(length, np.inf), where=bent)
    for side in (before, behind):
        np.minimum.at(found, side, radius)
    return found


def _middles(curve: Curve) -> Array:
    """The middle of every segment, (M, 2) m."""
    return curves.evaluate(curve, np.arange(len(curve.bulges)), 0.5 * curves.lengths(curve))[0]


def _nearest(drawn: Curve, points: Array) -> IntArray:
    """The segment of the drawn line that is nearest to each of the ``points`` (N, 2) m, (N,)."""
    flat, segment = curves.flatten(drawn, _FLATTENING)
    after = np.roll(flat, -1, axis=0) if drawn.closed else flat[1:]
    chords = shapely.linestrings(np.stack([flat[: len(after)], after], axis=1))
    nearest = shapely.STRtree(chords).query_nearest(shapely.points(points), all_matches=False)[1]
    return np.asarray(segment[nearest])
