"""The limits along a route, as linear rows on the intervals of its grid.

toppra gives each gridpoint one second derivative of the path, but where the curvature jumps there are two. So the rows
here belong to the intervals, not to the points: at the start of an interval they use the derivatives seen from inside
it, at the end likewise, and in the middle too. With u the path acceleration, constant in an interval, and x the squared
path speed, every quantity v that is limited is a u + b x.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Final

import numpy as np

from deltacam.model import Array, IntArray
from deltacam.motion.route import Grid, Route

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

STATIONS: Final = (0.0, 0.5, 1.0)
"""Where in each interval the limits are held; with both ends alone they were exceeded by 0.36 % in between."""

SIDES: Final = 20
"""Sides of the half polygon, drawn inside the half circle, that stands for the cap on the tool's acceleration."""


_ON_RAMPS: Final = 0.9984


@dataclass(frozen=True, slots=True, eq=False)
class Rows:
    """The limits at the stations of every interval, as shares: |joint_a u + joint_b x| <= 1, likewise for the tool.

    Attributes:
        joint_a: (S, I, 3) s2/m, the acceleration of the joints by that of the path, over its limit.
        joint_b: (S, I, 3) s2/m2, the acceleration of the joints by the squared speed of the path, over its limit.
        along: (I,) s2/m, the acceleration of the tool along the path by that of the path, over its limit.
        across: (S, I) s2/m2, the acceleration of the tool across the path by the squared speed, over its limit.
        bound: (S, I) m2/s2, the largest squared speed.
        width: (I,) m, of the intervals.
    """

    joint_a: Array
    joint_b: Array
    along: Array
    across: Array
    bound: Array
    width: Array

    @classmethod
    def over(cls, route: Route, grid: Grid, robot: Robot) -> Rows:
        """The limits of the joints, the tool, the feed and the chord along a route."""
        knot = np.arange(len(grid.segment)) + grid.segment  # each segment has one knot more than intervals
        last = np.flatnonzero(np.diff(grid.segment, append=-1))
        knots = np.insert(grid.segment, last + 1, grid.segment[last]), np.insert(grid.start, last + 1, grid.end[last])
        at_knots = limits_at(route, robot, *knots)
        in_middle = limits_at(route, robot, grid.segment, 0.5 * (grid.start + grid.end))
        stations = [[one[knot] for one in at_knots], in_middle, [one[knot + 1] for one in at_knots]]
        first, second, curvature, bound = (np.stack(one) for one in zip(*stations, strict=True))
        joints, tool = np.asarray(robot.joints.max_acceleration), route.acceleration[grid.segment]
        return cls(first / joints, second / joints, 1.0 / tool, curvature / tool, bound, np.diff(grid.distance))


def limits_at(route: Route, robot: Robot, segment: IntArray, place: Array) -> tuple[Array, Array, Array, Array]:
    """What limits the motion at places of the given segments.

    Args:
        route: the moves.
        robot: the machine.
        segment: (N,) indices.
        place: (N,) m from the start of the segments.

    Returns:
        the first two derivatives of the joint angles along the path (N, 3) rad/m and rad/m2, the curvature (N,) 1/m,
        and the largest squared speed (N,) m2/s2 that joint speed, feed and chord allow.
    """
    position, tangent, bend, _ = route.path.evaluate(segment, place)
    _, dq, ddq = robot.path_derivatives(position, tangent, bend)
    fastest = np.min(np.asarray(robot.joints.max_speed) / np.maximum(np.abs(dq), 1e-12), axis=1)
    bound = np.minimum(fastest, route.speed[segment]) ** 2
    held = np.flatnonzero(np.isfinite(route.chord[segment]))
    if len(held) and robot.controller.interpolation == "linear":
        chord = _chord_bound(robot, position[held], tangent[held], ddq[held], route.chord[segment[held]])
        # On a clothoid the bound is convex along the path: between stations a straight x may lie above it by so much.
        ramp = np.where(route.path.sharpness[segment[held]] == 0.0, 1.0, _ON_RAMPS)
        bound[held] = np.minimum(bound[held], ramp * chord)
    return dq, ddq, np.hypot(bend[:, 0], bend[:, 1]), bound


def _chord_bound(robot: Robot, position: Array, tangent: Array, ddq: Array, chord: Array) -> Array:
    """The squared path speed, (N,) m2/s2, at which straight joint motion between ticks leaves the path by ``chord``.

    Straight motion in the joints lags behind by (q' u + q'' x) dt^2 / 8 in the middle of a tick, at the tool by J times
    that. The first part lies along the path and does no harm; the second has a part across.
    """
    lag = np.linalg.solve(robot.inverse_jacobian(position), ddq[:, :, None])[:, :, 0]
    across = np.linalg.norm(lag - np.sum(lag * tangent, axis=1, keepdims=True) * tangent, axis=1)
    tick = 1.0 / robot.controller.rate_hz
    return np.asarray(8.0 * chord / (tick**2 * np.maximum(across, 1e-12)))
