"""Ways to plan the motion along a contour: those that come naturally with toppra, and that of deltacam."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, NamedTuple

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve
from deltacam.motion.corners import pieces
from deltacam.motion.parametrize import parametrize
from deltacam.motion.path import Path, from_curve
from deltacam.motion.route import Limits, Route
from deltacam.robot.robot import Robot

SPACING: Final = 5e-4
"""Distance of gridpoints and of samples of the inverse kinematics, m."""

FEWEST: Final = 4
"""Fewest intervals per line or arc where joints are on the grid; toppra's own rule is 100 for the path."""

DEVIATION: Final = 18e-6
"""How far the path of deltacam may leave sharp corners, m."""

NO_LIMIT: Final = Limits(speed=1e3, acceleration=1e6)
"""Of the tool: only the joints bound the motion."""

_MM, _UM = 1e3, 1e6


@dataclass(frozen=True, slots=True, eq=False)
class Case:
    """A contour and the robot that runs it.

    Attributes:
        smooth: a closed chain of lines and arcs, every one tangent to the next.
        sharp: the polygon that it rounds.
        robot: the machine.
        joints: the name of the robot's joints.
    """

    smooth: Curve
    sharp: Curve
    robot: Robot
    joints: str


class Plan(NamedTuple):
    """A motion that was planned for the joints.

    Attributes:
        distance: (G,) m, the gridpoints.
        speed: (G,) m/s along the path; its square is linear in between.
        joints: of a distance (N,) m and an order 0 to 2: the joints' angles or derivatives by it, (N, 3); the second
            argument says on which side of a joint of the path.
        breaks: (J,) m, where the path has joints.
        sample: the joints at times (N,) s after the start, (N, 3) rad.
        duration: s.
    """

    distance: Array
    speed: Array
    joints: Callable[[Array, int, str], Array]
    breaks: Array
    sample: Callable[[Array], Array]
    duration: float


class JointPath:
    """The joints along a path of lines and arcs, as toppra wants it, with exact derivatives.

    Where a line meets an arc the derivatives are those of the segment behind.
    """

    def __init__(self, path: Path, robot: Robot, unit: float = 1.0) -> None:
        """The path of a robot with its length in ``unit`` per metre."""
        self.path, self.robot, self.unit = path, robot, unit
        self.dof = 3
        self.path_interval = np.array([0.0, path.total * unit])
        self.waypoints = None
        self.breaks = np.cumsum(path.length)[:-1]

    @property
    def duration(self) -> float:
        """What toppra calls the length."""
        return float(self.path_interval[1])

    get_duration = duration.fget

    def __call__(self, places: Any, order: int = 0) -> Array:
        """The angles or their derivatives by the distance in the unit, (N, 3) or (3,)."""
        found = self.at(np.atleast_1d(places) / self.unit, order, "behind") / self.unit**order
        return found if np.ndim(places) else found[0]

    def at(self, distance: Array, order: int, side: str) -> Array:
        """The same by m, on the given side of joints of the path: before or behind."""
        ends = np.cumsum(self.path.length)
        segment = np.searchsorted(ends, distance, side="left" if side == "before" else "right")
        segment = np.minimum(segment, len(ends) - 1)
        inside = np.clip(distance - (ends - self.path.length)[segment], 0.0, self.path.length[segment])
        return self.robot.path_derivatives(*self.path.evaluate(segment, inside)[:3])[order]


def with_toppra(
    path: Any, grid: Array | None, robot: Robot, joints: Callable[[Array, int, str], Array], breaks: Array
) -> Plan | None:
    """What toppra plans with its own constraints; None where it says that there is no motion."""
    from toppra.algorithm import TOPPRA
    from toppra.constraint import JointAccelerationConstraint, JointVelocityConstraint
    from toppra.parametrizer import ParametrizeConstAccel

    limits = [
        JointVelocityConstraint(np.asarray(robot.joints.max_speed)),
        JointAccelerationConstraint(np.asarray(robot.joints.max_acceleration)),
    ]
    solver = TOPPRA(limits, path, gridpoints=grid, solver_wrapper="seidel", parametrizer="ParametrizeConstAccel")
    solver.compute_parameterization(0.0, 0.0)
    speed, points = solver.problem_data.sd_vec, solver.problem_data.gridpoints
    if speed is None or not np.isfinite(speed).all() or ((speed[:-1] + speed[1:]) <= 0.0).any():
        return None
    unit = getattr(path, "unit", 1.0)
    moved = ParametrizeConstAccel(path, points, speed)
    return Plan(points / unit, speed / unit, joints, breaks, moved, float(moved.duration))


def uniform(case: Case) -> Plan | None:
    """Exact derivatives on a grid that does not know of the joints of the path."""
    path = JointPath(from_curve(opened(case.smooth), case.robot.workspace.sheet_z), case.robot)
    count = max(100, int(np.ceil(path.path.total / SPACING)))
    return with_toppra(path, np.linspace(*path.path_interval, count + 1), case.robot, path.at, path.breaks)


def joints_on_grid(case: Case, unit: float = 1.0) -> Plan | None:
    """Exact derivatives on a grid with all joints of the path."""
    return _on_joints(case, case.smooth, unit)


def corners(case: Case) -> Plan | None:
    """The same through sharp corners."""
    return _on_joints(case, case.sharp, 1.0)


def _on_joints(case: Case, curve: Curve, unit: float) -> Plan | None:
    path = JointPath(from_curve(opened(curve), case.robot.workspace.sheet_z), case.robot, unit)
    ends = np.concatenate([[0.0], np.cumsum(path.path.length)])
    counts = np.maximum(FEWEST, np.ceil(path.path.length / SPACING).astype(int))
    parts = [np.linspace(*pair, count, endpoint=False) for *pair, count in zip(ends, ends[1:], counts, strict=False)]
    grid = np.append(np.concatenate(parts), ends[-1]) * unit
    grid[-1] = path.path_interval[1]
    return with_toppra(path, grid, case.robot, path.at, path.breaks)


def in_millimetres(case: Case) -> Plan | None:
    """Joints on the grid, lengths in millimetres."""
    return joints_on_grid(case, _MM)


def in_micrometres(case: Case) -> Plan | None:
    """Joints on the grid, lengths in micrometres."""
    return joints_on_grid(case, _UM)


def spline(case: Case) -> Plan | None:
    """A spline through samples of the inverse kinematics, on the gridpoints that toppra proposes."""
    from toppra.interpolator import SplineInterpolator

    path = JointPath(from_curve(opened(case.smooth), case.robot.workspace.sheet_z), case.robot)
    places = np.linspace(*path.path_interval, int(np.ceil(path.path.total / SPACING)) + 1)
    through = SplineInterpolator(places, path(places))
    return with_toppra(through, None, case.robot, lambda at, order, _side: through(at, order), np.zeros(0))


def sampled(case: Case) -> Plan | None:
    """Joints on the grid, sampled by the parametrizer that toppra takes where none is named."""
    from toppra.parametrizer import ParametrizeSpline

    plan = joints_on_grid(case)
    if plan is None:
        return None
    path = JointPath(from_curve(opened(case.smooth), case.robot.workspace.sheet_z), case.robot)
    moved = ParametrizeSpline(path, plan.distance, plan.speed)
    return plan._replace(sample=moved, duration=float(moved.path_interval[1]))


def with_deltacam(case: Case, curve: Curve, deviation: float) -> Plan:
    """What deltacam plans, without ramps at jumps of the curvature, for which only a limit of jerk asks."""
    z = case.robot.workspace.sheet_z
    (path,) = pieces(opened(curve), corner="round", deviation=deviation, ramps=False, z=z)
    return _by_deltacam(case, path)


def _by_deltacam(case: Case, path: Path) -> Plan:
    law = parametrize(Route.of([(path, NO_LIMIT)]), case.robot)
    joints = JointPath(path, case.robot)

    def sample(time: Array) -> Array:
        return joints(law.at(np.zeros(len(time), dtype=np.int64), time), 0)

    return Plan(law.distance, np.sqrt(law.squared), joints.at, joints.breaks, sample, float(law.durations[0]))


def deltacam(case: Case) -> Plan:
    """The chain of tangent lines and arcs with deltacam, exactly as it is drawn."""
    return with_deltacam(case, case.smooth, 0.0)


def arcs(case: Case) -> Plan:
    """The sharp corners rounded by arcs that leave them by as much as deltacam's blends may, planned by deltacam."""
    points, z = case.sharp.points, case.robot.workspace.sheet_z
    way = np.roll(points, -1, axis=0) - points
    side = np.hypot(*way.T)
    turn = np.abs(curves.corner_angles(case.sharp))
    # An arc that begins at d from the corner leaves it by d tan(turn / 4).
    room = 0.49 * np.minimum(side, np.roll(side, 1))
    rounded = round_corners(points, np.minimum(room, DEVIATION / np.tan(0.25 * turn)))
    (path,) = pieces(opened(rounded, like=case.sharp), corner="round", deviation=0.0, ramps=False, z=z)
    return _by_deltacam(case, path)


def round_corners(points: Array, distance: Array) -> Curve:
    """A polygon (N, 2) m with arcs for corners that begin and end at a distance (N,) m from them."""
    way = np.roll(points, -1, axis=0) - points
    along = way / np.hypot(*way.T)[:, None]
    before = np.roll(along, 1, axis=0)
    turn = np.angle((along @ np.array([1.0, 1j])) / (before @ np.array([1.0, 1j])))
    ends = np.stack([points - before * distance[:, None], points + along * distance[:, None]], axis=1).reshape(-1, 2)
    bulges = np.stack([np.tan(0.25 * turn), np.zeros(len(points))], axis=1).ravel()
    gone = np.hypot(*(np.roll(ends, -1, axis=0) - ends).T) < 1e-9
    return Curve(points=ends[~gone], bulges=bulges[~gone])


def deltacam_corners(case: Case) -> Plan:
    """The sharp corners with deltacam."""
    return with_deltacam(case, case.sharp, DEVIATION)


WAYS: Final[dict[str, Callable[[Case], Plan | None]]] = {
    "uniform grid": uniform,
    "joints on the grid": joints_on_grid,
    "spline through samples": spline,
    "default sampling": sampled,
    "lengths in mm": in_millimetres,
    "lengths in um": in_micrometres,
    "deltacam": deltacam,
    "corners": corners,
    "arcs for corners": arcs,
    "deltacam, corners": deltacam_corners,
}
"""Ways to plan a motion, in the order of the table; those for corners get the sharp contours."""


def opened(curve: Curve, like: Curve | None = None) -> Curve:
    """A closed curve from the middle of its longest segment, or that of another curve, around and back to there."""
    longest = curve if like is None else like
    length = curves.lengths(longest)
    segment = int(np.argmax(length))
    middle, _ = curves.evaluate(longest, np.array([segment]), 0.5 * length[[segment]])
    start = curves.start_at(curve, *curves.nearest(curve, middle[0])[:2])
    return Curve(points=np.vstack([start.points, start.points[:1]]), bulges=start.bulges, closed=False)
