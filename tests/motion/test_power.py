"""The power of the laser, beside speeds that are known in closed form or summed up between the ticks."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.cutting.process import load_process
from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Curve, Cut, Mode, Operation, Placement, PowerLaw, Process
from deltacam.motion.power import powers, tool_speeds
from deltacam.motion.setpoints import Setpoints, plan_motion
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot

ROBOT = load_robot("delta-300")
CUBIC = replace(ROBOT, controller=replace(ROBOT.controller, interpolation="cubic"))
RATE = ROBOT.controller.rate_hz
Z = ROBOT.workspace.sheet_z
STEEL = replace(load_process("steel-1mm-fibre"), feed=0.1, power=0.8, pierce_power=None)
LAW = PowerLaw(at_rest=0.25, exponent=1.0)
SQUARE = Cut(1, "CUT", ("2F",), curves.polygon(np.array([[0.0, 0.0], [0.02, 0.0], [0.02, 0.02], [0.0, 0.02]])))
LINE = Cut(
    2, "MARK", ("30",), Curve(np.array([[0.0, 0.03], [0.02, 0.03]]), np.zeros(1), closed=False), Operation.ENGRAVE
)


def straight(speeds: Array) -> Array:
    """Setpoints along x with a speed, m/s, from every tick to the next."""
    x = np.concatenate([[0.0], np.cumsum(speeds / RATE)])
    return ROBOT.inverse(np.column_stack([x, np.zeros_like(x), np.full_like(x, Z)]))


def of_cut(speeds: list[float], law: PowerLaw, **changes: object) -> list[float]:
    q = straight(np.array(speeds))
    process = replace(STEEL, power_law=law, **changes)
    found = powers(q, np.zeros(len(q), dtype=np.int64), [BlockKind.CUT], robot=ROBOT, process=process)
    return found[:-1].tolist()


def planned(process: Process, *cuts: Cut, robot: Robot = ROBOT, mode: Mode = Mode.CUT) -> Setpoints:
    where = Placement(0.0, 0.0, 0.0, Z)
    return plan_motion(cuts, robot=robot, process=process, placement=where, drawing_error=0.0, mode=mode, what_if=False)


def of_kind(points: Setpoints, *kinds: BlockKind) -> Array:
    return np.array([block.kind in kinds for block in points.blocks])[points.block]


def test_the_power_rises_from_that_at_rest_to_that_at_the_feed() -> None:
    speeds = [0.0, 0.025, 0.05, 0.1]
    assert of_cut(speeds, LAW) == [0.2, 0.35, 0.5, 0.8]
    assert of_cut(speeds, PowerLaw(0.25, 3.0)) == [0.2, 0.209, 0.275, 0.8]
    assert of_cut(speeds, PowerLaw(0.0, 0.5)) == [0.0, 0.4, 0.566, 0.8]


def test_the_power_is_at_least_the_lowest_and_at_most_that_at_the_feed() -> None:
    assert of_cut([0.0, 0.05, 0.2], PowerLaw(0.25, lowest=0.6)) == [0.6, 0.6, 0.8]
    assert of_cut([0.0, 0.2], PowerLaw(0.25, lowest=0.9)) == [0.8, 0.8]
    assert of_cut([0.0, 0.2], PowerLaw(1.0), power=0.76543) == [0.765, 0.765]
    assert of_cut([0.2], LAW, power=0.0004) == [0.0]


def test_without_a_law_the_power_stays() -> None:
    assert set(planned(STEEL, SQUARE).power[of_kind(planned(STEEL, SQUARE), BlockKind.CUT)]) == {0.8}


@pytest.mark.parametrize("robot", [ROBOT, CUBIC], ids=["linear", "cubic"])
def test_the_speed_is_that_of_the_way_between_the_ticks(robot: Robot) -> None:
    q = planned(STEEL, SQUARE, robot=robot).q
    held = np.pad(q, ((1, 1), (0, 0)), mode="edge")
    slope = 0.5 * (held[2:] - held[:-2])
    parts = []
    for u in np.linspace(0.0, 1.0, 33):
        if robot.controller.interpolation == "cubic":
            blend, leave, arrive = u * u * (3.0 - 2.0 * u), u * (1.0 - u) ** 2, u * u * (1.0 - u)
            parts.append(q[:-1] + blend * np.diff(q, axis=0) + leave * slope[:-1] - arrive * slope[1:])
        else:
            parts.append(q[:-1] + u * np.diff(q, axis=0))
    tool = np.stack([robot.forward(part) for part in parts])
    way = np.linalg.norm(np.diff(tool, axis=0), axis=2).sum(axis=0) * RATE
    found = tool_speeds(q, robot)
    assert found[-1] == 0.0
    assert found[:-1] == pytest.approx(way, rel=2e-3, abs=2e-4)  # a cubic curve may swing back where a rest begins


def test_a_corner_gets_less_power_and_a_side_gets_all() -> None:
    points = planned(replace(STEEL, corner="stop", power_law=LAW), SQUARE)
    cut = of_kind(points, BlockKind.CUT)
    assert points.power[cut].max() == pytest.approx(0.8, rel=6e-3)  # a move is stretched by up to a tick
    assert points.power[cut].min() == pytest.approx(0.2, abs=0.02)
    speed = np.linalg.norm(np.diff(ROBOT.forward(points.q), axis=0), axis=1) * RATE
    law = 0.2 + 0.6 * np.minimum(speed / 0.1, 1.0)
    assert points.power[:-1][cut[:-1]] == pytest.approx(law[cut[:-1]], abs=0.6e-3)
    assert (points.power[~of_kind(points, BlockKind.CUT, BlockKind.PIERCE)] == 0.0).all()


def test_a_pierce_has_the_power_that_is_for_it() -> None:
    for process, wanted in ((STEEL, 0.8), (replace(STEEL, pierce_power=0.55), 0.55)):
        for law in (None, LAW):
            points = planned(replace(process, power_law=law), SQUARE)
            assert set(points.power[of_kind(points, BlockKind.PIERCE)]) == {wanted}


def test_engraving_follows_its_own_feed_and_power() -> None:
    process = replace(STEEL, engrave_feed=0.05, engrave_power=0.4, power_law=LAW)
    points = planned(process, LINE)
    power = points.power[of_kind(points, BlockKind.ENGRAVE)]
    assert (power.max(), power.min()) == (pytest.approx(0.4, rel=6e-3), pytest.approx(0.1, abs=0.03))


def test_a_slower_cut_has_the_power_of_its_speed() -> None:
    points = planned(replace(STEEL, power_law=LAW), replace(SQUARE, feed=0.05))
    assert points.power[of_kind(points, BlockKind.CUT)].max() == pytest.approx(0.5, rel=6e-3)


def test_a_dry_run_has_none() -> None:
    assert not planned(replace(STEEL, power_law=LAW), SQUARE, mode=Mode.DRY_RUN).power.any()


def test_what_the_laser_does_not_work_on_gets_nothing() -> None:
    q = straight(np.full(8, 0.1))
    kinds = list(BlockKind)
    found = powers(q, np.arange(len(q)), kinds, robot=ROBOT, process=replace(STEEL, power_law=LAW))
    off = {kind for kind, power in zip(kinds, found.tolist(), strict=True) if power == 0.0}
    assert off == {BlockKind.RAPID, BlockKind.TAB, BlockKind.LEAD_OUT}
