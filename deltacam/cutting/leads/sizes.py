"""How long a lead must be: the tool comes from rest to the feed on it.

With an acceleration a and a jerk j, the tool reaches the speed v after the way v (v / a + a / j) / 2, or v sqrt(v / j)
where it never gets to a. On an arc of radius r the speed v needs the acceleration v^2 / r. Where the arc goes over into
the contour its curvature jumps by 1 / r; a blend that leaves it by d spreads that jump over the length
L = 2 sqrt(d r / 0.0062), as `motion.corners` has it, and v^3 / (r L) is the jerk there.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.model import Array, BoolArray, IntArray, Lead

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

_MORE: Final = 1.15
"""What is added to the computed way: the limits of the joints are not the same in all directions."""

_SIDEWAYS: Final = 0.7
"""Part of the acceleration that an arc may need at the feed; the rest still speeds the tool up."""

_SAFE: Final = 0.95  # of the acceleration
_LEAST_JUMP: Final = 0.25  # of what is allowed, where the contour itself bends away from the lead
_ROUNDS: Final = 10
_GROWTH: Final = 1.15
_ENOUGH: Final = 0.99  # of the speed
_WORTH: Final = 1.005
_BLEND: Final = 0.0062  # see `motion.corners`
_SHORTEST: Final = 1e-4  # m


class Ability(NamedTuple):
    """What the tool can do at places in every direction: acceleration, (N,) m/s2, and jerk, (N,) m/s3, or inf."""

    acceleration: Array
    jerk: Array


class Size(NamedTuple):
    """The measures of leads, (N,) each: a line of ``line`` m, and an arc of ``radius`` m that turns by ``turn`` rad.

    ``angle`` rad is that between the line and the contour where there is no arc.
    """

    line: Array
    radius: Array
    turn: Array
    angle: Array

    @property
    def length(self) -> Array:
        """Of the whole lead, (N,) m."""
        return self.line + self.radius * self.turn

    def scaled(self, factor: float, turned: float = 1.0) -> Size:
        """The same shape, smaller; the arc turns by a part of its angle."""
        return Size(self.line * factor, self.radius * factor, self.turn * turned, self.angle)

    def chosen(self, which: IntArray | BoolArray) -> Size:
        """Those of some leads."""
        return Size(*(column[which] for column in self))


def ability(robot: Robot, points: Array) -> Ability:
    """What the tool can do at ``points``, (N, 3) m in the machine frame."""
    needed = np.linalg.norm(robot.inverse_jacobian(points)[:, :, :2], axis=2)
    acceleration = np.min(np.asarray(robot.joints.max_acceleration) / needed, axis=1)
    jerk = np.full(len(points), np.inf)
    if robot.joints.max_jerk is not None:
        jerk = np.min(np.asarray(robot.joints.max_jerk) / needed, axis=1)
    return Ability(np.minimum(acceleration, robot.tool.max_acceleration), jerk)


def run_up(feed: Array, able: Ability) -> Array:
    """The way on which the tool comes from rest to ``feed``, (N,) m/s: (N,) m."""
    a, j = able
    whole = 0.5 * feed * (feed / a + a / j)
    return np.asarray(np.where(a * a / j <= feed, whole, feed * np.sqrt(feed / j)))


def smallest_radius(feed: Array, able: Ability, deviation: float) -> Array:
    """The radius at which the tool passes an arc and its end at ``feed``, (N,) m/s, with a blend within m: (N,) m."""
    by_acceleration = feed**2 / (_SIDEWAYS * able.acceleration)
    by_jerk = (feed**3 / able.jerk * np.sqrt(_BLEND / max(deviation, 1e-7)) / 2.0) ** (2.0 / 3.0)
    return np.asarray(np.maximum(by_acceleration, by_jerk))


def bend(feed: Array, able: Ability, deviation: float) -> Array:
    """The radius that an arc of a lead or a loop should have, (N,) m; see `smallest_radius`."""
    return np.maximum(_MORE * smallest_radius(feed, able, deviation), _SHORTEST)


def wanted(lead: Lead, feed: Array, able: Ability, deviation: float, beyond: Array) -> Size:
    """The size that a lead should have where the tool is to go at ``feed``, (N,) m/s.

    Args:
        lead: what the process says of it.
        feed: at the contour.
        able: what the tool can do there.
        deviation: that a blend may have, m.
        beyond: curvature of the contour, (N,) 1/m, positive where it turns to the side of the lead.
    """
    none, turn = np.zeros(len(feed)), np.full(len(feed), lead.angle)
    needed = _MORE * run_up(feed, able)
    length = np.maximum(needed, _SHORTEST) if lead.length is None else np.full(len(feed), lead.length)
    if lead.shape == "none":
        return Size(none, none, none, none)
    if lead.shape == "line":
        return Size(length, none, none, turn)
    turn = np.maximum(turn, 0.1)
    if lead.radius is not None:
        radius = np.full(len(feed), lead.radius)
    elif lead.length is not None:
        radius = length / turn if lead.shape == "arc" else 0.5 * length / turn
    else:
        radius = _radius(feed, able, deviation, beyond, after_line=lead.shape == "line+arc")
        if lead.shape == "arc":
            radius = np.maximum(radius, length / turn)
    line = none if lead.shape == "arc" else np.maximum(length - radius * turn, 0.0)
    if lead.shape == "line+arc" and lead.length is None:
        line = np.maximum(length - 0.5 * radius * turn, _SHORTEST)
    return Size(line, radius, turn, none)


def _radius(feed: Array, able: Ability, deviation: float, beyond: Array, *, after_line: bool) -> Array:
    """The radius on which the tool can go at the feed, and over into a contour that itself is bent."""
    by_acceleration = feed**2 / (_SIDEWAYS * able.acceleration)
    # At a constant speed v the jerk is v^3 k^2 along the path, and v^3 times the change of k across it.
    left = np.sqrt(np.maximum(1.0 - (feed**3 * beyond**2 / able.jerk) ** 2, _LEAST_JUMP**2))
    jump = (2.0 * left * able.jerk / feed**3 * np.sqrt(max(deviation, 1e-7) / _BLEND)) ** (2.0 / 3.0) / _MORE
    bend = np.maximum(jump + beyond, _LEAST_JUMP * jump)
    if after_line:
        bend = np.minimum(bend, _MORE * jump)
    return np.asarray(np.maximum(np.maximum(_MORE * by_acceleration, 1.0 / bend), _SHORTEST))


def grown(size: Size, speed: Array, able: Ability, deviation: float, beyond: Array, ahead: Array) -> Size:
    """The sizes, larger where the tool would come too slowly and that helps; see `arrival`.

    Args:
        size: of the leads, (N,).
        speed: that is needed, (N,) m/s.
        able: what the tool can do there.
        deviation: that a blend may have, m.
        beyond: curvature of the contour as `wanted` takes it.
        ahead: how far the contour goes on as it begins, (N,) m.
    """
    best, reached = size, arrival(size, able, deviation, beyond, ahead)
    for round_ in range(1, _ROUNDS):
        larger = size.scaled(_GROWTH**round_)
        found = arrival(larger, able, deviation, beyond, ahead)
        better = (reached < _ENOUGH * speed) & (found > _WORTH * reached)
        best = Size(*(np.where(better, new, old) for new, old in zip(larger, best, strict=True)))
        reached = np.where(better, found, reached)
    return best


def arrival(size: Size, able: Ability, deviation: float, beyond: Array, ahead: Array) -> Array:
    """How fast the tool comes to the contour on leads, and over into it, about, (N,) m/s.

    On an arc of radius r the acceleration a is shared: from the speed u it comes to v on the way
    (asin(v^2 / a r) - asin(u^2 / a r)) r / 2, and never beyond the square root of a r.

    Args:
        size: of the leads.
        able: what the tool can do there.
        deviation: that a blend may have, m.
        beyond: curvature of the contour as `wanted` takes it.
        ahead: how far the contour goes on as it begins, (N,) m; a blend takes room on both sides.
    """
    a, j = _SAFE * able.acceleration, able.jerk
    length = size.length
    steady = 0.5 * (np.sqrt((a * a / j) ** 2 + 8.0 * a * length) - a * a / j)
    speed = np.where(steady >= a * a / j, steady, np.cbrt(length**2 * np.where(np.isfinite(j), j, 0.0)))
    arc = size.radius * size.turn > 0.0
    radius = np.where(arc, size.radius, 1.0)
    most = a * radius
    so_far = np.arcsin(np.minimum(2.0 * a * size.line / most, 1.0))
    on_arc = np.sqrt(most * np.sin(np.minimum(so_far + 2.0 * size.turn, 0.5 * np.pi)))
    jump = np.maximum(np.abs(1.0 / radius - beyond), 1e-9)
    room = np.minimum(np.where(size.line > 0.0, 0.5, 0.98) * radius * size.turn, 0.7 * ahead)
    half = np.minimum(np.minimum(np.sqrt(deviation / (_BLEND * jump)), 0.9 * radius), room)
    bent = np.maximum(np.abs(beyond), 1.0 / radius)
    over = np.cbrt(j / np.hypot(0.5 * jump / np.maximum(half, 1e-9), bent**2))
    return np.asarray(np.where(arc, np.minimum(np.minimum(speed, on_arc), over), speed))
