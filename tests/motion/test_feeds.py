"""Slow stretches of a cut, seen through the tool's speed at every place."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.cutting.feeds import in_bends
from deltacam.cutting.kerf import offset
from deltacam.cutting.process import load_process
from deltacam.model import Array, BlockKind, Curve, Placement, Slower
from deltacam.motion.setpoints import plan_motion
from deltacam.robot.reader import load_robot
from tests.strategies import contour

ROBOT = load_robot("delta-300")
QUARTER = np.tan(np.pi / 8.0)
STEEL = replace(load_process("steel-1mm-fibre"), feed=0.1, kerf=0.2e-3)
RADIUS, SIZE = 2e-3, 0.03
CENTRES = np.array([[RADIUS, RADIUS], [SIZE - RADIUS, RADIUS], [SIZE - RADIUS, SIZE - RADIUS], [RADIUS, SIZE - RADIUS]])


def rounded() -> Curve:
    a, b = RADIUS, SIZE - RADIUS
    points = [(a, 0), (b, 0), (SIZE, a), (SIZE, b), (b, SIZE), (a, SIZE), (0, b), (0, a)]
    return Curve(points=np.array(points, dtype=float), bulges=np.array([0.0, QUARTER] * 4))


def run(jerk: float | None, *rules: Slower) -> tuple[Array, Array]:
    """Places (N, 2) m half-way of every step of the cut, and the speed there, (N,) m/s."""
    robot = replace(ROBOT, joints=replace(ROBOT.joints, max_jerk=None if jerk is None else (jerk,) * 3))
    process = replace(STEEL, slower=rules)
    drawn = (contour(rounded(), number=1),)
    cuts = in_bends(offset(drawn, kerf=process.kerf).cuts, drawn, process=process)
    where = Placement(0.0, 0.0, 0.0, ROBOT.workspace.sheet_z)
    found = plan_motion(cuts, robot=robot, process=process, placement=where, drawing_error=0.0, what_if=False)
    assert [block.kind for block in found.blocks] == [BlockKind.RAPID, BlockKind.PIERCE, BlockKind.CUT, BlockKind.RAPID]
    block = found.blocks[2]
    tool = robot.forward(found.q[block.first : block.last + 2])[:, :2]
    return 0.5 * (tool[1:] + tool[:-1]), np.linalg.norm(np.diff(tool, axis=0), axis=1) * robot.controller.rate_hz


def in_bend(places: Array) -> Array:
    """Whether a place is in the quarter of a corner, (N,)."""
    away = np.abs(places - SIZE / 2.0) - (SIZE / 2.0 - RADIUS)
    return (away > 0.0).all(axis=1)


@pytest.mark.parametrize("jerk", [None, 6388.0])
def test_only_the_bends_are_slow(jerk: float | None) -> None:
    places, speed = run(jerk, Slower(0.3, radius=RADIUS))
    bend = in_bend(places)
    assert bend.sum() > 4 * RADIUS * np.pi / 2.0 / 0.03 * 400.0 * 0.95
    inside = bend & np.roll(bend, 1) & np.roll(bend, -1)  # a step at the edge of a bend is partly outside
    assert speed[inside].max() <= 0.03 * 1.0001
    assert speed[inside].max() >= 0.03 * 0.98
    middle = (np.abs(places - SIZE / 2.0).min(axis=1) < 5e-3) & ~bend
    assert speed[middle].min() >= 0.1 * 0.98
    assert speed.max() <= 0.1 * 1.0001


@pytest.mark.parametrize("jerk", [None, 6388.0])
def test_without_a_rule_bends_are_as_fast_as_they_can_be(jerk: float | None) -> None:
    places, speed = run(jerk)
    assert speed[in_bend(places)].max() >= 0.1 * 0.98
