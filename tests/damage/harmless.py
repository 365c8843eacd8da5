"""Changes of a valid program that the verifier must let pass: what finds every damage must not find more than that."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from deltacam.model import BlockKind, Mode
from deltacam.program.program import Program
from tests.damage.aim import NoPlaceError
from tests.damage.example import Example
from tests.damage.rows import gathered
from tests.damage.stretches import jobs, plain_jobs, together

THIRD = 2.0 * np.pi / 3.0


def taken_apart(case: Example) -> Program:
    """The same work with rapids of another make."""
    return together(case.program, jobs(case.program))


def another_order(case: Example) -> Program:
    """Two holes of the same part in the other order, where they follow each other."""
    todo = plain_jobs(case.program)
    around = {contour.number: contour.parent for contour in case.drawing.contours}
    places = [(job[-1].block.kind, around[job[-1].block.contour or 0]) for job in todo]
    for index in range(len(todo) - 1):
        kind, parent = places[index]
        if parent and kind is BlockKind.CUT and places[index + 1] == (kind, parent):
            todo[index], todo[index + 1] = todo[index + 1], todo[index]
            return together(case.program, todo)
    raise NoPlaceError


def backwards(case: Example) -> Program:
    """Every closed cut run the other way."""
    closed = {contour.number for contour in case.drawing.contours if contour.curve.closed}
    todo = [
        (*job[:-1], job[-1].backwards()) if job[-1].block.contour in closed else job for job in plain_jobs(case.program)
    ]
    return together(case.program, todo)


def a_rest(case: Example) -> Program:
    """The tool waits at the park position."""
    return gathered(case.program, np.r_[np.zeros(50, dtype=int), : len(case.tool)])


def a_third_of_a_turn(case: Example) -> Program:
    """The sheet and the work of the joints a third of a turn on: the robot is the same from there."""
    where = case.program.placement
    cos, sin = np.cos(THIRD), np.sin(THIRD)
    placement = replace(
        where, x=cos * where.x - sin * where.y, y=sin * where.x + cos * where.y, rotation=where.rotation + THIRD
    )
    return replace(case.program, q=np.roll(case.program.q, 1, axis=1), placement=placement)


def laser_off(case: Example) -> Program:
    """A dry run."""
    return replace(case.program, mode=Mode.DRY_RUN, power=np.zeros(len(case.program.power)))


def stronger_robot(case: Example) -> Program:
    """Limits of the joints that are a tenth higher."""
    joints = case.robot.joints
    speeds, accelerations = (
        [1.1 * limit for limit in limits] for limits in (joints.max_speed, joints.max_acceleration)
    )
    stronger = replace(joints, max_speed=tuple(speeds), max_acceleration=tuple(accelerations), max_jerk=None)
    return replace(case.program, robot=replace(case.robot, joints=stronger))


HARMLESS: dict[str, Callable[[Example], Program]] = {
    "taken apart and put together": taken_apart,
    "another order of holes": another_order,
    "run backwards": backwards,
    "a rest at the start": a_rest,
    "a third of a turn": a_third_of_a_turn,
    "a dry run": laser_off,
    "a stronger robot": stronger_robot,
}
"""Every one of these passes every check."""
