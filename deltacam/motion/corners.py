"""Makes a cut drivable: a path that is smooth within the tolerance, and places to stop where it cannot be.

Chains of short segments become arcs first. Then every corner gets a blend, as large as the tolerance and the segments
beside it allow, and where jerk is limited so does every other jump of the curvature.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Corner, Curve, IntArray
from deltacam.motion.blends import PIECES, RAMP, Blends, Joints, blend
from deltacam.motion.chains import SHARPEST_IN_CHAIN, fit
from deltacam.motion.path import Path

SHARPEST_PASSED: Final = np.radians(2.0)
"""A corner that turns by less, rad, is rounded even where corners are stopped at: the drawing is uneven there."""

CHAINS: Final = 0.5
"""Part of the deviation that arcs in place of chains of short segments may use; blends get what these leave."""

_TANGENT: Final = 5e-6
_SAME_CURVATURE: Final = 1e-3
_SHORTEST_SEGMENT: Final = 1e-6
_SHORTEST_REACH: Final = 2e-7
_LARGEST_TURN: Final = 0.9
_LARGEST_CORNER: Final = np.radians(179.5)
_SHARE: Final = 0.98
_ROUNDS: Final = 12
_NEAR_ENOUGH: Final = 0.985
_MARGIN: Final = 0.9975


@dataclass(frozen=True, slots=True)
class Pace:
    """What the tool can do about where a cut is, for choosing between a blend and a stop.

    Attributes:
        feed: m/s.
        acceleration: m/s2.
        jerk: m/s3.
        tick: s; a stop waits for the next one, half of it on average.
    """

    feed: float
    acceleration: float
    jerk: float
    tick: float


def pieces(
    cut: Curve,
    *,
    corner: Corner,
    deviation: float,
    ramps: bool,
    z: float,
    pace: Pace | None = None,
    stretch: IntArray | None = None,
    speed: Array | None = None,
) -> tuple[Path, ...]:
    """Split a cut at the corners to stop at, and smooth the rest.

    Args:
        cut: run from ``points[0]``, a closed one around and back, an open one to its last point.
        corner: what to do with sharp corners.
        deviation: how far the path may lie from the drawn one, m, >= 0.
        ramps: whether the curvature may not jump either.
        z: height of the sheet, m.
        pace: of the tool; where it is known, corners at which a stop takes less time than a blend are stopped at.
        stretch: that each segment of the cut belongs to, (M,); of a blend each half belongs to its own side.
        speed: not to be exceeded in each segment of the cut, (M,) m/s; in a blend the smaller one beside it counts.

    Returns:
        paths whose segments are tangent, each to be run from rest to rest, together the whole cut.
    """
    largest = SHARPEST_PASSED if corner == "stop" else SHARPEST_IN_CHAIN
    stretch = np.zeros(len(cut.bulges), dtype=np.int64) if stretch is None else stretch
    speed = np.full(len(cut.bulges), np.inf) if speed is None else speed
    whole, kept = _without_slivers(cut)
    if whole is not cut:
        deviation = max(deviation - _SHORTEST_SEGMENT, 0.0)
    changes = [own[1:] != own[:-1] for own in (stretch[kept], speed[kept])]
    owner = np.concatenate([[0], np.cumsum(changes[0] | changes[1])])
    curve, off, first = fit(whole, allowance=CHAINS * deviation, largest_corner=largest, stretch=owner)
    angle = curves.corner_angles(curve)[1 if curve.closed else 0 :]
    curvature = curves.curvatures(curve)
    turns = np.abs(angle) > _TANGENT
    wanted = turns & (np.abs(angle) <= SHARPEST_PASSED) if corner == "stop" else turns.copy()
    needed = turns.copy()
    if ramps:
        jumps = np.abs(np.diff(curvature)) > _SAME_CURVATURE
        wanted |= jumps & ~turns
        needed |= jumps
    left = deviation - np.maximum(off[:-1], off[1:])
    blends, reach = _blends(curve, angle, wanted, left)
    if pace is not None:
        reach[(np.abs(angle) > SHARPEST_PASSED) & _slower_than_a_stop(blends, pace)] = 0.0
    stops = np.flatnonzero(needed & (reach == 0.0)) + 1
    return _assemble(curve, blends, reach, stops, stretch[kept][first], speed[kept][first], z)


def _slower_than_a_stop(blends: Blends, pace: Pace) -> BoolArray:
    """Where passing a blend takes longer than stopping, (J,): a small blend is passed slowly where jerk is limited.

    Both are compared with going on at the feed. To slow down by dv takes t = dv / a + a / j, or 2 sqrt(dv / j) where
    that is less; slowing down to v and back loses t (1 - v / feed), and a blend of length L another L / v - L / feed.
    The speed on a blend is bounded by its curvature and by how fast that rises.
    """
    length, ramp = blends.length.sum(axis=1), blends.length[:, 0]
    bend = np.maximum(np.abs(blends.curvature).max(axis=1), 1e-9)
    speed = np.minimum(np.sqrt(pace.acceleration / bend), np.cbrt(pace.jerk * ramp / bend))
    speed = np.minimum(speed, pace.feed)

    def taken(change: Array) -> Array:
        steady = change / pace.acceleration + pace.acceleration / pace.jerk
        return np.where(change > pace.acceleration**2 / pace.jerk, steady, 2.0 * np.sqrt(change / pace.jerk))

    passing = taken(pace.feed - speed) * (1.0 - speed / pace.feed) + length * (1.0 / speed - 1.0 / pace.feed)
    return np.asarray(passing > taken(np.full_like(speed, pace.feed)) + 0.5 * pace.tick)


def _without_slivers(curve: Curve) -> tuple[Curve, IntArray]:
    """The curve without segments under a micrometre, and which are left; the next segment starts where they did."""
    kept = (curves.lengths(curve) >= _SHORTEST_SEGMENT) | (np.abs(curve.bulges) > 0.5)
    if kept.all() or np.count_nonzero(kept) < (2 if curve.closed else 1):
        return curve, np.arange(len(kept))
    first = np.flatnonzero(kept)
    # Each kept segment starts where the one before it ends, so that it takes the room of the slivers in between.
    points = curve.points[np.concatenate([[0], first[:-1] + 1])]
    if not curve.closed:
        points = np.concatenate([points, curve.points[-1:]])
    return Curve(points=points, bulges=curve.bulges[first], closed=curve.closed), first


def _blends(curve: Curve, angle: Array, wanted: BoolArray, deviation: Array) -> tuple[Blends, Array]:
    """The blend at every corner 1 to N - 1 of a cut, and where it begins: (N - 1,) m from it, 0 where there is none."""
    joints = _joints(curve, angle)
    most = _room(joints, curves.lengths(curve), wanted & (np.abs(angle) < _LARGEST_CORNER), deviation)
    if not len(angle):
        none = np.zeros((0, PIECES))
        return Blends(np.zeros((0, PIECES, 2)), none, none, none, none, angle), angle
    best = blend(joints, np.maximum(most, _SHORTEST_REACH))
    reach = np.zeros_like(most)
    trial, open_ = most.copy(), np.flatnonzero(most > _SHORTEST_REACH)
    power = np.where(np.abs(angle) > SHARPEST_PASSED, 1.0, 0.5)
    for _ in range(_ROUNDS):
        if not len(open_):
            break
        found = blend(joints[open_], trial[open_])
        fits = found.deviation <= deviation[open_]
        better = open_[fits & (trial[open_] > reach[open_])]
        for column, new in zip(best, found, strict=True):
            column[better] = new[np.isin(open_, better)]
        reach[better] = trial[better]
        share = np.divide(deviation[open_], found.deviation, out=np.zeros(len(open_)), where=found.deviation > 0.0)
        done = fits & ((share <= 1.0 / _NEAR_ENOUGH) | (trial[open_] >= most[open_]))
        grown = trial[open_] * np.clip((share * _MARGIN) ** power[open_], 0.3, 3.0)
        # What fitted is not given up for something smaller.
        trial[open_] = np.minimum(most[open_], np.where(fits, np.maximum(grown, reach[open_]), grown))
        open_ = open_[~done & (trial[open_] > _SHORTEST_REACH)]
    return best, reach


def _joints(curve: Curve, angle: Array) -> Joints:
    curvature = curves.curvatures(curve)
    return Joints(curve.starts[1:], curves.headings(curve)[1][:-1], angle, curvature[:-1], curvature[1:])


def _room(joints: Joints, length: Array, wanted: BoolArray, deviation: Array) -> Array:
    """How far from each corner its blend may begin, (N - 1,) m.

    That is about as far as the deviation allows between straight lines, but so that neighbours do not meet, and not so
    far that the segments beside it turn by much.
    """
    half = 0.5 * np.abs(joints.angle)
    jump = np.abs(joints.behind - joints.before)
    # A blend of length L that turns by a passes the joint at e = a L (1 / 8 - R / 4 + R^2 / 6) / (1 - R), R being RAMP,
    # where a is small. Where only the curvature jumps, by k, it leaves the segments by about 0.0062 k (L / 2)^2.
    share = (0.125 - 0.25 * RAMP + RAMP**2 / 6.0) / (1.0 - RAMP)
    reach = np.divide(deviation, 8.0 * share * np.tan(0.5 * half), out=np.full_like(half, np.inf), where=half > 0.0)
    by_jump = np.divide(deviation, 0.0062 * jump, out=np.full_like(half, np.inf), where=jump > 0.0)
    reach = 1.5 * np.minimum(reach, np.sqrt(np.maximum(by_jump, 0.0)))
    bend = np.maximum(np.abs(joints.before), np.abs(joints.behind))
    reach = np.minimum(reach, np.divide(_LARGEST_TURN, bend, out=np.full_like(bend, np.inf), where=bend > 0.0))
    reach = np.minimum(np.where(wanted & (deviation > 0.0), reach, 0.0), np.minimum(length[:-1], length[1:]))
    # A blend takes no more than both legs have, shared in proportion with the blends at their other ends.
    needed = np.concatenate([[0.0], reach]) + np.concatenate([reach, [0.0]])
    part = np.minimum(1.0, np.divide(_SHARE * length, needed, out=np.ones_like(needed), where=needed > 0.0))
    return np.asarray(reach * np.minimum(part[:-1], part[1:]))


def _assemble(
    curve: Curve, blends: Blends, reach: Array, stops: IntArray, stretch: IntArray, speed: Array, z: float
) -> tuple[Path, ...]:
    """The paths between the stops, with the blends at the corners that have a reach."""
    count = len(curve.bulges)
    head, tail = np.concatenate([[0.0], reach]), np.concatenate([reach, [0.0]])
    start, heading = curves.evaluate(curve, np.arange(count), head)
    start = np.where(head[:, None] > 0.0, start, curve.starts)
    flat = np.zeros((count, 1))
    none = np.zeros((1, PIECES))
    kept = np.hstack([flat == 0.0, np.repeat(tail > 0.0, PIECES).reshape(count, PIECES)]).ravel()
    # Every segment, and after it the clothoids at its end, of which only those of a blend are kept.
    heading, curvature, sharpness, length = (
        np.hstack([own[:, None], np.concatenate([other, none])]).ravel()[kept]
        for own, other in (
            (heading, blends.heading),
            (curves.curvatures(curve), blends.curvature),
            (flat[:, 0], blends.sharpness),
            (curves.lengths(curve) - head - tail, blends.length),
        )
    )
    places = np.concatenate([start[:, None], np.concatenate([blends.start, np.zeros((1, PIECES, 2))])], axis=1)
    after = np.append(stretch[1:], stretch[-1:])
    owner = np.stack([stretch, *[stretch] * (PIECES - 1), after], axis=1).ravel()[kept]
    slower = np.minimum(speed, np.append(speed[1:], speed[-1:]))
    fastest = np.stack([speed, *[slower] * PIECES], axis=1).ravel()[kept]
    whole = Path(places.reshape(-1, 2)[kept], heading, curvature, sharpness, length, owner, fastest, z)
    halved = (stretch != after) & (tail > 0.0)
    counts = kept.reshape(count, -1).sum(axis=1)
    whole = _halved(whole, (np.cumsum(counts) - 2)[halved], after[halved])
    first = np.concatenate([[0], np.cumsum(counts + halved)])
    edges = [0, *first[stops].tolist(), len(whole.length)]
    return tuple(whole.part(a, b) for a, b in itertools.pairwise(edges))


def _halved(path: Path, segments: IntArray, behind: IntArray) -> Path:
    """The path with some segments (K,) cut in the middle, whose second halves belong to the stretches ``behind``."""
    if not len(segments):
        return path
    half = 0.5 * path.length[segments]
    points, tangent, _, _ = path.evaluate(segments, half)
    length, at = path.length.copy(), segments + 1
    length[segments] = half
    return Path(
        np.insert(path.start, at, points[:, :2], axis=0),
        np.insert(path.heading, at, np.arctan2(tangent[:, 1], tangent[:, 0])),
        np.insert(path.curvature, at, path.curvature[segments] + path.sharpness[segments] * half),
        np.insert(path.sharpness, at, path.sharpness[segments]),
        np.insert(length, at, half),
        np.insert(path.stretch, at, behind),
        np.insert(path.speed, at, path.speed[segments]),
        path.z,
    )
