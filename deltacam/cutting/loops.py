"""Loops: outer sharp corners are cut to their tip at speed, by a way that swings out through the waste.

At an outer corner, whose tip points into the waste, the path of the beam's centre turns by t about the drawn corner C,
on an arc of half the kerf h that ends the offsets of both sides. In its place the path goes straight on where that arc
began, crosses the other side's straight line, swings round through the waste and comes back along that line::

    crossing     X, at h / cos(t / 2) from C on the bisector u = (a - b) / |a - b| of the corner, where a and b are
                 the directions of coming and going; h tan(t / 2) beyond the end of either side
    run-out      from X to A = X + r tan(t / 2) a, and back from B = X - r tan(t / 2) b
    arc          from A to B about X + r / cos(t / 2) u with the radius r, by 2 pi - t against the turn of the corner

The circle touches the lines in A and B, so that the direction never jumps. The loop and the cone from X around it are
convex, and a smaller loop lies within a larger one; where no beam may come near that cone, a smaller radius is tried.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Final, Literal, NamedTuple

import numpy as np
import shapely
from scipy.spatial import cKDTree

from deltacam.cutting.waste import Waste
from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, BoolArray, Contour, Curve, Finding, IntArray, Loops, Stretch
from deltacam.units import to_mm

Side = Literal["left", "right"]

SHARPEST: Final = np.radians(170.0)
"""Corners that turn by more get no loop: the way out and back would be more than eleven radii long."""

_SMALLER: Final = 0.8 ** np.arange(8)  # of the radius that is needed: what is tried
_FLATTENING: Final = 1e-6  # m
_NEAR: Final = 3e-6  # m; how far the ends of a round may be from where the drawing says they are
_ALONG: Final = 0.02  # rad; how far the path may leave the directions of the drawing there
_NAMED: Final = 3  # places in a finding


class Looped(NamedTuple):
    """The way of a cut with loops, and what a person should know about it."""

    way: tuple[Stretch, ...]
    findings: tuple[Finding, ...]


def with_loops(
    way: Sequence[Stretch],
    contour: Contour,
    *,
    side: Side,
    kerf: float,
    rule: Loops,
    needed: Callable[[Array], float],
    waste: Waste,
) -> Looped:
    """The way of a cut, with a loop at every outer corner that turns by at least ``rule.angle``.

    What was CUT becomes CUT, LOOP, CUT. A loop begins and ends where the round about the corner does, so that what is
    cut before and behind it is on the kerf path. The angle is that of the drawn corner: what is drawn as a chain of
    short lines has none.

    Args:
        way: of a cut along the contour's kerf path, from its beginning to its end; sheet frame, m.
        contour: what was drawn.
        side: where the waste is, seen along the way.
        kerf: width of the cut, m, >= 0.
        rule: which corners, and the radius if that is given.
        needed: the radius, m, > 0, that the speed needs at a place, (2,) m.
        waste: where loops may run.

    Returns:
        the way, and findings about corners that keep their round because no loop fits or the cut begins there, and
        about loops that are smaller than what the speed needs.
    """
    corners = _corners(contour, side, rule.angle)
    if not len(corners.tips):
        return Looped(tuple(way), ())
    stretches: list[Stretch] = []
    outcomes = []
    for stretch in way:
        if stretch.kind is not BlockKind.CUT:
            stretches.append(stretch)
            continue
        found = _found(stretch.curve, corners, kerf / 2.0)
        wanted = [rule.radius or needed(crossing) for crossing in found.crossings]
        radii = _fitting(found, np.array(wanted), waste)
        stretches += _split(stretch.curve, found, radii)
        outcomes.append((found, radii, np.array(wanted)))
    return Looped(tuple(stretches), _findings(contour, outcomes))


class _Corners(NamedTuple):
    """Corners of a contour, K of them, in the direction of the way.

    Attributes:
        tips: (K, 2) m.
        coming: the direction before each, (K,) rad.
        going: the direction after it, (K,) rad.
    """

    tips: Array
    coming: Array
    going: Array


class _Found(NamedTuple):
    """Corners on an open curve, K of them, and those at its ends.

    Attributes:
        first: the vertex where the round of each begins, (K,).
        last: the vertex where it ends, (K,).
        before: the place where it begins, (K, 2) m.
        after: the place where it ends, (K, 2) m.
        coming: the unit vector before each, (K, 2).
        going: the unit vector after it, (K, 2).
        crossings: where the lines along them cross, (K, 2) m.
        turns: from the one to the other, (K,) rad; positive to the left.
        ends: the tips that the curve begins or ends at, (L, 2) m.
    """

    first: IntArray
    last: IntArray
    before: Array
    after: Array
    coming: Array
    going: Array
    crossings: Array
    turns: Array
    ends: Array


def _corners(contour: Contour, side: Side, angle: float) -> _Corners:
    """The outer corners of a contour that turn by at least ``angle`` rad."""
    with_drawing = (side == "left") == contour.is_hole
    drawn = contour.curve if with_drawing else curves.reverse(contour.curve)
    start, end = curves.headings(drawn)
    turns = curves.corner_angles(drawn)
    outer = -turns if side == "left" else turns
    sharp = np.flatnonzero(outer >= angle - 1e-9)
    return _Corners(drawn.points[sharp], end[sharp - 1], start[sharp])


def _found(curve: Curve, corners: _Corners, half_kerf: float) -> _Found:
    """Where the corners' rounds are on an open curve; corners that it does not pass are left out."""
    turn = _wrapped(corners.going - corners.coming)
    arm = half_kerf * np.sign(turn)[:, None]
    begins, ends = (corners.tips + arm * _right(heading) for heading in (corners.coming, corners.going))
    tree = cKDTree(curve.points)
    (from_begin, first), (from_end, last) = tree.query(begins), tree.query(ends)
    there = (from_begin <= _NEAR) & (from_end <= _NEAR)
    middle = (first > 0) & (last < len(curve.points) - 1) & (first <= last)
    start, end = curves.headings(curve)
    coming, going = end[np.maximum(first - 1, 0)], start[np.minimum(last, len(start) - 1)]
    length = np.concatenate([[0.0], np.cumsum(curves.lengths(curve))])
    is_round = np.abs(length[last] - length[first] - half_kerf * np.abs(turn)) <= 0.05 * half_kerf + _NEAR
    is_round &= np.abs(_wrapped(coming - corners.coming)) < _ALONG
    is_round &= np.abs(_wrapped(going - corners.going)) < _ALONG
    good = np.flatnonzero(there & middle & is_round)
    good = good[np.argsort(first[good], kind="stable")]
    a, b = _unit(coming[good]), _unit(going[good])
    before, after = curve.points[first[good]], curve.points[last[good]]
    along = _cross(after - before, b) / _cross(a, b)
    crossings = before + along[:, None] * a
    return _Found(first[good], last[good], before, after, a, b, crossings, turn[good], corners.tips[there & ~middle])


def _fitting(found: _Found, wanted: Array, waste: Waste) -> Array:
    """The largest radius that fits at every corner, of those that are tried, (K,) m; nan where none does."""
    radii = np.full(len(wanted), np.nan)
    apart = found.first[1:] > found.last[:-1]
    possible = np.abs(found.turns) <= SHARPEST
    possible[1:] &= apart
    possible[:-1] &= apart
    # The lines from the round to the crossing and back must be free, whatever the radius.
    possible &= waste.is_free(shapely.linestrings(np.stack([found.before, found.crossings, found.after], axis=1)))
    left = np.flatnonzero(possible)
    for share in _SMALLER:
        if not len(left):
            break
        tried = share * wanted[left]
        cones = [_cone(found, k, radius) for k, radius in zip(left.tolist(), tried.tolist(), strict=True)]
        fits = waste.is_free(np.array([shapely.Polygon(curves.flatten(cone, _FLATTENING)[0]) for cone in cones]))
        radii[left[fits]] = tried[fits]
        left = left[~fits]
    return radii


def _cone(found: _Found, k: int, radius: float) -> Curve:
    """The loop at corner ``k`` from its crossing, closed: two lines and an arc in two pieces."""
    coming, going, turn = found.coming[k], found.going[k], abs(float(found.turns[k]))
    reach = radius * np.tan(0.5 * turn)
    away = (coming - going) / (2.0 * np.sin(0.5 * turn))
    tip = found.crossings[k]
    far = tip + (radius / np.cos(0.5 * turn) + radius) * away
    bulge = -np.sign(found.turns[k]) * np.tan((2.0 * np.pi - turn) / 8.0)
    return Curve(
        points=np.stack([tip, tip + reach * coming, far, tip - reach * going]),
        bulges=np.array([0.0, bulge, bulge, 0.0]),
    )


def _split(curve: Curve, found: _Found, radii: Array) -> list[Stretch]:
    """An open curve as CUT, LOOP, CUT, ..."""
    stretches, begin = [], 0
    for k in np.flatnonzero(~np.isnan(radii)).tolist():
        first, last = int(found.first[k]), int(found.last[k])
        stretches.append(Stretch(BlockKind.CUT, _between(curve, begin, first)))
        cone = _cone(found, k, float(radii[k]))
        points = np.concatenate([curve.points[first : first + 1], cone.points[1:], curve.points[last : last + 1]])
        stretches.append(Stretch(BlockKind.LOOP, Curve(points=points, bulges=cone.bulges, closed=False)))
        begin = last
    stretches.append(Stretch(BlockKind.CUT, _between(curve, begin, len(curve.points) - 1)))
    return stretches


def _between(curve: Curve, first: int, last: int) -> Curve:
    """The part of an open curve from one vertex to a later one."""
    return Curve(points=curve.points[first : last + 1], bulges=curve.bulges[first:last], closed=False)


def _findings(contour: Contour, outcomes: Sequence[tuple[_Found, Array, Array]]) -> tuple[Finding, ...]:
    """What a person should know of the loops of one contour."""
    if not outcomes:
        return ()
    crossings, radii, wanted = (
        np.concatenate(parts)
        for parts in zip(*((found.crossings, radii, wanted) for found, radii, wanted in outcomes), strict=True)
    )
    too_large, small = np.isnan(radii), radii < 0.999 * wanted
    findings = []
    if too_large.any():
        what = f"a loop does not fit at {_count(too_large)}, kept round: {_places(crossings[too_large])}"
        hint = "move the parts apart, or give a smaller radius of the loops"
        findings.append(_finding(contour, what, hint, crossings[too_large]))
    if small.any():
        least = float(np.min(radii[small] / wanted[small]))
        what = f"the loops at {_count(small)} are smaller than the feed needs, down to {100.0 * least:.0f} % of the "
        what += f"radius: {_places(crossings[small])}"
        findings.append(_finding(contour, what, "move the parts apart", crossings[small]))
    ends = np.unique(np.concatenate([found.ends for found, _, _ in outcomes]), axis=0)
    if len(ends):
        what = f"no loop at a corner where the cut begins: {_places(ends)}"
        findings.append(_finding(contour, what, "let cuts begin in the middle of an edge", ends))
    return tuple(findings)


def _finding(contour: Contour, what: str, hint: str, places: Array) -> Finding:
    return Finding(what, where=contour.where, hint=hint, kind="loop", place=(float(places[0, 0]), float(places[0, 1])))


def _count(which: BoolArray) -> str:
    count = int(which.sum())
    return "1 corner" if count == 1 else f"{count} corners"


def _places(points: Array) -> str:
    named = ", ".join(f"({to_mm(x):.3f}, {to_mm(y):.3f}) mm" for x, y in points[:_NAMED].tolist())
    return named + (f" and {len(points) - _NAMED} more" if len(points) > _NAMED else "")


def _right(headings: Array) -> Array:
    """The unit vectors to the right of directions, (K, 2)."""
    return np.stack([np.sin(headings), -np.cos(headings)], axis=1)


def _unit(headings: Array) -> Array:
    """The unit vectors of directions, (K, 2)."""
    return np.stack([np.cos(headings), np.sin(headings)], axis=1)


def _cross(one: Array, other: Array) -> Array:
    """The cross products of vectors, (K,)."""
    return np.asarray(one[:, 0] * other[:, 1] - one[:, 1] * other[:, 0])


def _wrapped(angles: Array) -> Array:
    """The same angles in (-pi, pi]."""
    return np.asarray(np.pi - np.mod(np.pi - angles, 2.0 * np.pi))
