"""What a motion along a route asks of the joints and of the tool."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from deltacam.model import Array, IntArray
from deltacam.motion.route import Route
from deltacam.motion.rows import limits_at
from deltacam.motion.tempo import Motion

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot


class Along(NamedTuple):
    """A motion along a route: derivatives by its parameter of the joints (N, 3), and what bounds the tool (N,).

    Attributes:
        joints: the first three, rad by the parameter.
        across: m/s2, the acceleration of the tool across the path.
        bound: m2/s2, the largest squared speed.
        cap: m/s2, the largest acceleration of the tool.
    """

    joints: tuple[Array, Array, Array]
    across: Array
    bound: Array
    cap: Array

    @classmethod
    def of(cls, route: Route, robot: Robot, motion: Motion, move: IntArray) -> Along:
        """For a motion anywhere along moves (N,)."""
        return cls.at(route, robot, motion, *route.locate(move, motion.distance))

    @classmethod
    def at(cls, route: Route, robot: Robot, motion: Motion, segment: IntArray, place: Array) -> Along:
        """For a motion at places (N,) m from the start of segments (N,)."""
        first, second, curvature, bound = limits_at(route, robot, segment, place)
        third = robot.third_derivative(*route.path.evaluate(segment, place))
        v, a, j = (one[:, None] for one in motion[1:])
        joints = first * v, first * a + second * v**2, first * j + 3.0 * second * v * a + third * v**3
        return cls(joints, curvature * motion.speed**2, bound, route.acceleration[segment])
