"""Damage to the machine: other dimensions, turned or swapped joints, another robot than the one that is there."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from deltacam.model import Array
from deltacam.program.program import Program
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot
from tests.damage.aim import NoPlaceError, aim
from tests.damage.example import WORKING, Example
from tests.damage.kind import Mutant
from tests.damage.rows import with_q

MICROMETRE = 1e-6
SAMPLES = 40  # rows

Make = Callable[[Example, float, np.random.Generator], Program]


def dimension(name: str) -> Make:
    """Another dimension in the meta object, so that some tick is so many micrometres off the sheet's plane."""

    def make(case: Example, amount: float, chance: np.random.Generator) -> Program:
        value, sign = getattr(case.robot.geometry, name), float(chance.choice([-1.0, 1.0]))

        def changed(size: float) -> Robot:
            return replace(case.robot, geometry=replace(case.robot.geometry, **{name: value + size}))

        size = aim(lambda size: _off_plane(case, changed(size), case.program.q), amount, start=sign * 1e-7)
        return replace(case.program, robot=changed(size))

    return make


def azimuth(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """One arm in another direction, so that some tick is so many micrometres off the sheet's plane."""
    arm = np.eye(3)[int(chance.integers(3))]

    def changed(size: float) -> Robot:
        return _turned(case.robot, size * arm)

    # The plane tilts about the middle of the sheet; a small part there hardly moves.
    size = aim(lambda size: _off_plane(case, changed(size), case.program.q), amount, start=1e-7)
    if size > np.radians(30.0):
        raise NoPlaceError
    return replace(case.program, robot=changed(size))


def all_azimuths(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """The whole robot turned, so that some tick of a cut is so many tolerances off its path."""
    rows = chance.choice(case.rows(*WORKING), SAMPLES)

    def measure(size: float) -> float:
        tool = _turned(case.robot, np.full(3, size)).forward(case.program.q[rows])
        return float(case.off_path(rows, tool).max()) / case.program.process.tolerance

    return replace(case.program, robot=_turned(case.robot, np.full(3, aim(measure, amount, start=1e-6))))


def joints_offset(*joints: int) -> Make:
    """The same angle added to some joints in all rows, so that some tick is so many micrometres off the plane."""
    way = np.isin(np.arange(3), joints).astype(float)

    def make(case: Example, amount: float, chance: np.random.Generator) -> Program:
        sign = float(chance.choice([-1.0, 1.0]))
        size = aim(lambda size: _off_plane(case, case.robot, case.program.q + size * way), amount, start=sign * 1e-7)
        return replace(case.program, q=case.program.q + size * way)

    return make


def joints_swapped(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """Two joints swapped in a row (1), or in every row (more), where that puts a tick of a cut beside its path."""
    order = np.arange(3)
    one, other = chance.choice(3, 2, replace=False)
    order[[one, other]] = order[[other, one]]
    rows = case.rows(*WORKING)
    off = case.off_path(rows, case.robot.forward(case.program.q[rows][:, order]))
    far = rows[off > 1.1 * case.program.process.tolerance]
    if not len(far):
        raise NoPlaceError
    chosen = chance.choice(far, 1) if amount <= 1.0 else np.arange(len(case.program.q))
    return with_q(case.program, chosen, case.program.q[chosen][:, order])


def folded(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """An arm turned up until its forearm no longer reaches the platform, and by so much further, rad."""
    row, joint = int(chance.integers(len(case.program.q))), int(chance.integers(3))
    q = case.program.q[row].copy()
    while _closes(case.robot, q) and q[joint] > -np.pi:
        q[joint] -= 0.002
    if q[joint] <= -np.pi:
        raise NoPlaceError
    q[joint] = max(q[joint] - amount, -np.pi)
    return with_q(case.program, row, q)


def other_plane(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """The height of the sheet in the placement, by so many micrometres."""
    where = case.program.placement
    height = where.z + chance.choice([-1.0, 1.0]) * amount * MICROMETRE
    return replace(case.program, placement=replace(where, z=float(height)))


def other_sheet(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """The height of the sheet in the robot, and in the placement too, by so many micrometres."""
    changed = other_plane(case, amount, chance)
    workspace = replace(case.robot.workspace, sheet_z=changed.placement.z)
    return replace(changed, robot=replace(case.robot, workspace=workspace))


def slightly_other_robot(case: Example, amount: float, _: np.random.Generator) -> Mutant:
    """Checked against a robot whose forearm is so many micrometres longer."""
    geometry = replace(case.robot.geometry, forearm=case.robot.geometry.forearm + amount * MICROMETRE)
    return Mutant(case.program, robot=replace(case.robot, geometry=geometry))


def quite_another_robot(case: Example, amount: float, _: np.random.Generator) -> Mutant:
    """Checked against the other built-in robot (more than 1), or one with another limit of speed."""
    if amount > 1.0:
        other = "irb360-1600" if case.robot.name == "delta-300" else "delta-300"
        return Mutant(case.program, robot=load_robot(other))
    tool = replace(case.robot.tool, max_speed=case.robot.tool.max_speed * 1.000001)
    return Mutant(case.program, robot=replace(case.robot, tool=tool))


def limits_raised(case: Example, amount: float, _: np.random.Generator) -> Mutant:
    """A robot in the meta object that may accelerate more than the one there is, by this share."""
    joints = case.robot.joints
    raised = replace(joints, max_acceleration=tuple((1.0 + amount) * limit for limit in joints.max_acceleration))
    return Mutant(replace(case.program, robot=replace(case.robot, joints=raised)), robot=case.robot)


def joint_stop(case: Example, amount: float, chance: np.random.Generator) -> Mutant:
    """Checked against a robot that has a stop so many microdegrees inside the motion."""
    joint, upper = int(chance.integers(3)), bool(chance.integers(2))
    angles, step = case.program.q[:, joint], np.radians(amount * 1e-6)
    value = float(angles.max() - step) if upper else float(angles.min() + step)
    name = "max" if upper else "min"
    stops = list(getattr(case.robot.joints, name))
    stops[joint] = value
    return Mutant(case.program, robot=replace(case.robot, joints=replace(case.robot.joints, **{name: tuple(stops)})))


def pressure(case: Example, amount: float, _: np.random.Generator) -> Mutant:
    """Checked against a robot whose largest pressure angle is so many microdegrees less than in the motion."""
    used = max(float(mu.max()) for tool in (case.tool, case.middles) for mu in case.robot.pressure_angles(tool))
    return _with_workspace(case, max_pressure_angle=used - np.radians(amount * 1e-6))


def swing(case: Example, amount: float, _: np.random.Generator) -> Mutant:
    """The same for the swing of the forearms."""
    used = max(float(case.robot.forearm_swing(tool).max()) for tool in (case.tool, case.middles))
    limit = used - np.radians(amount * 1e-6)
    if limit < np.radians(1.0):  # a robot with less cannot be
        raise NoPlaceError
    return _with_workspace(case, max_forearm_swing=limit)


def _with_workspace(case: Example, **values: float) -> Mutant:
    return Mutant(case.program, robot=replace(case.robot, workspace=replace(case.robot.workspace, **values)))


def _turned(robot: Robot, angles: Array) -> Robot:
    azimuths = tuple(float(azimuth) for azimuth in np.add(robot.geometry.azimuths, angles))
    return replace(robot, geometry=replace(robot.geometry, azimuths=azimuths))


def _off_plane(case: Example, robot: Robot, q: Array) -> float:
    """How far a robot is off the sheet's plane at these angles, micrometres."""
    return float(np.abs(robot.forward(q)[:, 2] - case.program.placement.z).max()) / MICROMETRE


def _closes(robot: Robot, q: Array) -> bool:
    """Whether the forearms reach the platform: three spheres about the elbows, moved in by its radius, meet."""
    geometry = robot.geometry
    out = geometry.offsets + geometry.upper_arms * np.cos(q)
    elbows = np.stack(
        [out * np.cos(geometry.azimuths), out * np.sin(geometry.azimuths), -geometry.upper_arms * np.sin(q)], axis=1
    )
    sides = [float(np.linalg.norm(elbows[i] - elbows[i - 1])) for i in range(3)]
    area = 0.5 * float(np.linalg.norm(np.cross(elbows[1] - elbows[0], elbows[2] - elbows[0])))
    return area > 0.0 and np.prod(sides) / (4.0 * area) < geometry.forearms[0]
