"""The demands of a wish as functions of a candidate and a point: positive where a demand is not met.

An excess has no unit, or radians: it is smooth, of the order of one, and continues out of reach, so that a search can
go by it. Its worst value over the workspace and the limit give the measured value back.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from deltacam.model import Array
from deltacam.robot.synthesis import kernel
from deltacam.robot.synthesis.wish import Wish

REACH_MARGIN: Final = 0.001
"""The least reach margin, of the upper arm. At the edge of reach itself a joint no longer moves the tool."""


class View:
    """Candidates at points, with the quantities that several demands share worked out once."""

    def __init__(self, candidates: Array, points: Array) -> None:
        self.poses = kernel.poses(candidates, points)

    @cached_property
    def angles(self) -> Array:
        """(3, C, N) rad."""
        return kernel.joint_angles(self.poses)

    @cached_property
    def cosines(self) -> Array:
        """Between the forearms, (3, C, N)."""
        return kernel.forearm_cosines(self.poses)

    @cached_property
    def singular_values(self) -> tuple[Array, Array]:
        """The smallest and the largest of the inverse Jacobian, (C, N) rad/m."""
        return kernel.singular_values(self.poses, self.cosines)


@dataclass(frozen=True, slots=True)
class Demand:
    """One demand that holds at every point.

    Attributes:
        name: for JSON, with its unit at the end.
        label: for people.
        unit: of value and limit, "" for a ratio.
        limit: in that unit.
        at_least: whether the value must be at least the limit, or at most.
        excess: (C, N), the worst of the three arms; positive where it is not met.
        value: the measured value in that unit, from the excess.
    """

    name: str
    label: str
    unit: str
    limit: float
    at_least: bool
    excess: Callable[[View], Array]
    value: Callable[[float], float]


def demands(wish: Wish) -> tuple[Demand, ...]:
    """The demands of a wish, reach first."""
    found = [_reach(), _joint_min(wish.joint_min), _joint_max(wish.joint_max)]
    found += [_inverse_condition(wish.min_inverse_condition), _transmission(wish.max_transmission_angle)]
    if wish.max_drive_angle is not None:
        found.append(_drive(wish.max_drive_angle))
    if wish.max_forearm_swing is not None:
        found.append(_swing(wish.max_forearm_swing))
    if wish.max_joint_speed is not None and wish.speed is not None:
        found.append(_joint_speed(wish.max_joint_speed, wish.speed))
    if wish.max_joint_acceleration is not None and wish.speed is not None and wish.acceleration is not None:
        found.append(_joint_acceleration(wish.max_joint_acceleration, wish.speed, wish.acceleration))
    if wish.max_error is not None and wish.encoder_step is not None:
        found.append(_error(wish.max_error, wish.encoder_step))
    return tuple(found)


def excesses(found: tuple[Demand, ...], candidates: Array, points: Array) -> Array:
    """By how much every demand is missed: (K, C, N) for candidates (C, 4) at points (N, 3) m."""
    view = View(candidates, points)
    return np.stack([demand.excess(view) for demand in found])


def bounds_excess(wish: Wish, candidates: Array) -> Array:
    """By how much the bounds on the dimensions themselves are exceeded: (C, 4) m, linear in the candidates.

    The size; the clearance under the base; room for motors and head; and that the elbow stands outside of the
    effector's joint when the upper arm is horizontal, R - r >= -La. Without the last, "smallest" is a robot turned
    inside out, with a small base and an effector as large as the workspace, because R - r counts as negative length.
    """
    offset, La, Lb, middle = candidates.T
    low = wish.lowest_offset
    room = np.full(len(candidates), -1.0) if low is None else low - offset
    below = middle + wish.shape.height / 2.0 + wish.clearance
    return np.column_stack((offset + La + Lb - wish.size_limit, below, room, -La - offset))


def _reach() -> Demand:
    def excess(view: View) -> Array:
        return np.asarray(REACH_MARGIN - view.poses.reach.min(axis=0))

    return Demand(
        "reach_margin", "reach margin / upper arm", "", REACH_MARGIN, True, excess, lambda e: REACH_MARGIN - e
    )


def _joint_min(limit: float) -> Demand:
    def excess(view: View) -> Array:
        return np.asarray(limit - view.angles.min(axis=0))

    return Demand(
        "joint_min_deg",
        "smallest joint angle",
        "deg",
        math.degrees(limit),
        True,
        excess,
        lambda e: math.degrees(limit - e),
    )


def _joint_max(limit: float) -> Demand:
    def excess(view: View) -> Array:
        return np.asarray(view.angles.max(axis=0) - limit)

    return Demand(
        "joint_max_deg",
        "largest joint angle",
        "deg",
        math.degrees(limit),
        False,
        excess,
        lambda e: math.degrees(limit + e),
    )


def _inverse_condition(limit: float) -> Demand:
    def excess(view: View) -> Array:
        smallest, largest = view.singular_values
        return np.asarray(limit - smallest / largest)

    return Demand("inverse_condition", "1/cond", "", limit, True, excess, lambda e: limit - e)


def _transmission(limit: float) -> Demand:
    def excess(view: View) -> Array:
        return np.asarray(math.cos(limit) - kernel.transmission(view.cosines).min(axis=0))

    return _angle("transmission_angle_deg", "pressure angle mu2", limit, excess)


def _drive(limit: float) -> Demand:
    def excess(view: View) -> Array:
        return np.asarray(math.cos(limit) - (view.poses.t / view.poses.Lb).min(axis=0))

    return _angle("drive_angle_deg", "pressure angle mu1", limit, excess)


def _angle(name: str, label: str, limit: float, excess: Callable[[View], Array]) -> Demand:
    """A demand whose excess is the cosine of the limit less the cosine of the angle."""

    def value(e: float) -> float:
        return math.degrees(math.acos(min(max(math.cos(limit) - e, -1.0), 1.0)))

    return Demand(name, label, "deg", math.degrees(limit), False, excess, value)


def _swing(limit: float) -> Demand:
    def excess(view: View) -> Array:
        return np.asarray(np.abs(view.poses.y / view.poses.Lb).max(axis=0) - math.sin(limit))

    def value(e: float) -> float:
        return math.degrees(math.asin(min(math.sin(limit) + e, 1.0)))

    return Demand("forearm_swing_deg", "forearm swing", "deg", math.degrees(limit), False, excess, value)


def _joint_speed(limit: float, speed: float) -> Demand:
    def excess(view: View) -> Array:
        return np.asarray(_part(kernel.joint_speeds(view.poses, speed).max(axis=0), limit))

    return _ratio("joint_speed_deg_s", "joint speed", "deg/s", math.degrees(limit), excess)


def _joint_acceleration(limit: float, speed: float, acceleration: float) -> Demand:
    def excess(view: View) -> Array:
        return _part(kernel.joint_accelerations(view.poses, speed, acceleration).max(axis=0), limit)

    return _ratio("joint_acceleration_deg_s2", "joint acceleration", "deg/s^2", math.degrees(limit), excess)


def _error(limit: float, step: float) -> Demand:
    """Three joints that err by a step each err by sqrt(3) steps together; the worst direction has the largest gain."""

    def excess(view: View) -> Array:
        smallest, _ = view.singular_values
        return _part(math.sqrt(3.0) * step / np.maximum(smallest, 1e-9), limit)

    return _ratio("tool_error_um", "tool error", "um", limit * 1e6, excess)


def _ratio(name: str, label: str, unit: str, limit: float, excess: Callable[[View], Array]) -> Demand:
    """A demand whose excess is `_part` of a positive value that must be at most the limit."""
    return Demand(name, label, unit, limit, False, excess, lambda e: limit / (1.0 - e))


def _part(value: Array, limit: float) -> Array:
    """1 - limit / value: the excess of a positive value, below one however large it is."""
    return np.asarray(1.0 - limit / np.maximum(value, 1e-12))
