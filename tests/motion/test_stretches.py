"""Leads, loops and tabs in the rows of a program: every tick lies on the stretch that it is said to belong to."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Curve, Cut, Placement, Process, Stretch
from deltacam.motion.parts import parts
from deltacam.motion.setpoints import plan_motion
from deltacam.motion.tape import KINDS, Setpoints
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot
from tests.strategies import rectangle

PROCESS = Process(
    name="a trial", source="", material="", thickness=1e-3, kerf=0.2e-3, feed=0.1, power=0.8, pierce_time=0.02
)
DARK = (BlockKind.RAPID, BlockKind.TAB, BlockKind.LEAD_OUT)
TICK = 1.0 / 400.0


def straight(*points: tuple[float, float]) -> Curve:
    return Curve(points=np.array(points), bulges=np.zeros(len(points) - 1), closed=False)


def cut(*, overcut: float = 1e-3) -> Cut:
    """A rectangle of 20 x 10 mm with a lead-in, a tab in its second edge, an overcut and a lead-out."""
    ring = curves.start_at(rectangle(0.02, 0.01), 0, 5e-3)
    around = curves.opened(ring)
    length = curves.length(around)
    way = (
        Stretch(BlockKind.LEAD_IN, straight((0.0, -4e-3), (5e-3, 0.0))),
        Stretch(BlockKind.CUT, curves.part(around, 0.0, 18e-3)),
        Stretch(BlockKind.TAB, curves.part(around, 18e-3, 19e-3)),
        Stretch(BlockKind.CUT, curves.part(around, 19e-3, length)),
        Stretch(BlockKind.OVERCUT, curves.part(around, 0.0, overcut)),
        Stretch(BlockKind.LEAD_OUT, straight((5e-3 + overcut, 0.0), (10e-3, -4e-3))),
    )
    return Cut(1, "CUT", ("2F",), ring, way=way)


def robot(interpolation: str) -> Robot:
    found = load_robot("irb360-1600")
    return replace(found, controller=replace(found.controller, interpolation=interpolation))


def planned(one: Cut, machine: Robot) -> tuple[Setpoints, Array]:
    """The setpoints of a cut, and where the tool is, (N, 2) m."""
    where = Placement(0.0, 0.0, 0.0, machine.workspace.sheet_z)
    found = plan_motion([one], robot=machine, process=PROCESS, placement=where, drawing_error=0.0, jobs=1)
    return found, machine.forward(found.q)[:, :2]


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
def test_the_blocks_follow_each_other_as_the_stretches_do(interpolation: str) -> None:
    found, _ = planned(cut(), robot(interpolation))
    kinds = [block.kind for block in found.blocks if block.kind is not BlockKind.RAPID]
    tab = [BlockKind.CUT, BlockKind.TAB, BlockKind.PIERCE, BlockKind.CUT]
    assert kinds == [BlockKind.PIERCE, BlockKind.LEAD_IN, *tab, BlockKind.OVERCUT, BlockKind.LEAD_OUT]
    working = [index for index, block in enumerate(found.blocks) if block.contour == 1]
    # No rapid lies within the cut, but one tick where the tool is pierced and the controller interpolates so.
    assert working == list(range(working[0], working[-1] + 1))


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
def test_every_tick_lies_on_its_stretch(interpolation: str) -> None:
    found, tool = planned(cut(), robot(interpolation))
    lines = {
        kind: shapely.union_all([shapely.LineString(one.curve.points) for one in cut().way if one.kind is kind])
        for kind in KINDS
    }
    for block in found.blocks:
        if block.contour == 1 and block.kind is not BlockKind.PIERCE:
            away = shapely.distance(shapely.points(tool[block.first : block.last + 1]), lines[block.kind])
            # A row before a lead-out is said to be one: the laser is off before the tool leaves the contour.
            first = 1 if block.kind is BlockKind.LEAD_OUT else 0
            assert away[first:].max(initial=0.0) < PROCESS.tolerance + 1e-9


@pytest.mark.parametrize("interpolation", ["linear", "cubic"])
def test_the_laser_is_off_in_tabs_and_lead_outs_and_nowhere_else(interpolation: str) -> None:
    found, _ = planned(cut(), robot(interpolation))
    kind = np.array([block.kind for block in found.blocks], dtype=object)[found.block]
    dark = np.array([one in DARK for one in kind])
    assert (found.power[dark] == 0.0).all()
    assert (found.power[~dark] == PROCESS.power).all()


@pytest.mark.parametrize("overcut", [0.6e-3, 1e-3, 1.7e-3])
def test_the_laser_stays_on_for_the_overcut_but_for_a_tick(overcut: float) -> None:
    found, tool = planned(cut(overcut=overcut + PROCESS.feed * TICK), robot("linear"))
    off = next(block.first for block in found.blocks if block.kind is BlockKind.LEAD_OUT)
    beyond = tool[off][0] - 5e-3
    assert overcut - PROCESS.tolerance <= beyond <= overcut + 2.0 * PROCESS.feed * TICK


def test_the_tool_rests_at_both_ends_of_a_tab() -> None:
    found, tool = planned(cut(), robot("linear"))
    (tab,) = [block for block in found.blocks if block.kind is BlockKind.TAB]
    assert tool[tab.first] == pytest.approx([0.02, 3e-3], abs=1e-9)
    assert tool[tab.last + 1] == pytest.approx([0.02, 4e-3], abs=1e-9)


def test_the_parts_of_a_cut_are_what_lies_between_its_tabs() -> None:
    before, tab, behind = parts(cut())
    assert [one.is_tab for one in (before, tab, behind)] == [False, True, False]
    assert curves.length(tab.curve) == pytest.approx(1e-3)
    assert before.curve.points[-1] == pytest.approx(tab.curve.points[0])
    assert {KINDS[number] for number in behind.stretch} == {BlockKind.CUT, BlockKind.OVERCUT, BlockKind.LEAD_OUT}


def test_a_cut_without_a_way_is_one_part() -> None:
    ring = rectangle(0.02, 0.01)
    (one,) = parts(Cut(1, "CUT", ("2F",), ring))
    assert one.curve is ring
    assert {KINDS[number] for number in one.stretch} == {BlockKind.CUT}
