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

    def scaled(self, factor: float) -> Size:
        """The same shape, smaller."""
        return Size(self.line * factor, self.radius * factor, self.turn, self.angle)

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


def wanted(lead: Lead, feed: Array, able: Ability, deviation: float) -> Size:
    """The size that a lead should have where the tool is to go at ``feed``, (N,) m/s.

    Args:
        lead: what the process says of it.
        feed: at the contour.
        able: what the tool can do there.
        deviation: that a blend may have, m.
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
        radius = bend(feed, able, deviation)
        if lead.shape == "arc":
            radius = np.maximum(radius, _MORE * length / turn)
    line = none if lead.shape == "arc" else np.maximum(length - radius * turn, 0.0)
    if lead.shape == "line+arc" and lead.length is None:
        line = np.maximum(length - 0.5 * radius * turn, _SHORTEST)
    return Size(line, radius, turn, none)
