"""The setpoints, seen only through differences and forward kinematics."""

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely

from deltacam.cutting.kerf import offset
from deltacam.cutting.process import load_process
from deltacam.errors import ProcessError
from deltacam.geometry import curve as curves
from deltacam.model import Block, BlockKind, Curve, Cut, Mode, Operation, Placement, Process
from deltacam.motion.law import TimeLaw
from deltacam.motion.parametrize import parametrize
from deltacam.motion.path import straight
from deltacam.motion.route import Limits, Route
from deltacam.motion.sample import sample
from deltacam.motion.setpoints import Setpoints, plan_frame, plan_motion
from deltacam.robot.reader import load_robot
from tests.strategies import contour, rectangle, slot

ROBOT = load_robot("delta-300")
PROCESS = load_process("steel-1mm-fibre")
PLACE = Placement(x=0.01, y=-0.02, rotation=0.4, z=ROBOT.workspace.sheet_z)
TICK = 1.0 / ROBOT.controller.rate_hz


def cuts(*drawn: Curve) -> tuple[Cut, ...]:
    return offset([contour(curve, number=n) for n, curve in enumerate(drawn, start=1)], kerf=2e-4).cuts


def planned(mode: Mode = Mode.CUT) -> Setpoints:
    shapes = cuts(slot(0.03, 0.01), rectangle(0.03, 0.02, at=(0.03, 0.02)))
    return plan_motion(shapes, robot=ROBOT, process=PROCESS, placement=PLACE, drawing_error=0.0, mode=mode)


def test_every_limit_holds_in_differences_of_the_held_program() -> None:
    q = planned().q
    held = np.concatenate([q[:1], q, q[-1:]])
    speed = np.diff(held, axis=0) / TICK
    position = ROBOT.forward(held)
    velocity = np.diff(position, axis=0) / TICK
    assert (np.abs(speed) / ROBOT.joints.max_speed).max() <= 1.0
    assert (np.abs(np.diff(speed, axis=0)) / TICK / ROBOT.joints.max_acceleration).max() <= 1.001
    assert np.linalg.norm(velocity, axis=1).max() <= ROBOT.tool.max_speed
    assert np.linalg.norm(np.diff(velocity, axis=0) / TICK, axis=1).max() <= ROBOT.tool.max_acceleration * 1.001
    assert position[:, 2] == pytest.approx(PLACE.z, abs=1e-9)


def test_it_starts_and_ends_at_rest_at_the_park_position() -> None:
    q = planned().q
    park = ROBOT.inverse(np.array([[*ROBOT.workspace.park, PLACE.z]]))
    assert q[[0, 1, -2, -1]] == pytest.approx(np.repeat(park, 4, axis=0), abs=1e-12)


def test_blocks_cover_every_tick_once_and_the_laser_is_on_where_it_cuts() -> None:
    points = planned()
    ticks = np.concatenate([np.arange(b.first, b.last + 1) for b in points.blocks])
    assert np.array_equal(ticks, np.arange(len(points.q)))
    assert [b.kind for b in points.blocks] == ["rapid", "pierce", "cut", "rapid", "pierce", "cut", "rapid"]
    assert all(
        points.block[b.first : b.last + 1].tolist() == [i] * (b.last - b.first + 1) for i, b in enumerate(points.blocks)
    )
    on = np.isin(points.block, [i for i, b in enumerate(points.blocks) if b.kind is not BlockKind.RAPID])
    assert np.array_equal(points.power, np.where(on, PROCESS.power, 0.0))


def test_piercing_rests_for_the_time_of_the_process() -> None:
    points = planned()
    for block in points.blocks:
        if block.kind is BlockKind.PIERCE:
            assert block.last - block.first + 1 == math.ceil(PROCESS.pierce_time / TICK)
            assert np.ptp(points.q[block.first : block.last + 2], axis=0).max() == pytest.approx(0.0, abs=1e-12)


def test_a_dry_run_moves_the_same_with_the_laser_off() -> None:
    wet, dry = planned(), planned(Mode.DRY_RUN)
    assert np.array_equal(wet.q, dry.q)
    assert not dry.power.any()


def test_every_cut_tick_lies_on_the_kerf_path() -> None:
    points = planned()
    xy = ROBOT.forward(points.q)[:, :2]
    for block in points.blocks:
        if block.kind is BlockKind.CUT:
            drawn = [slot(0.03, 0.01), rectangle(0.03, 0.02, at=(0.03, 0.02))][(block.contour or 0) - 1]
            placed = curves.transform(drawn, rotation=PLACE.rotation, shift=(PLACE.x, PLACE.y))
            ring = shapely.Polygon(curves.flatten(placed, 1e-8)[0])
            here = shapely.points(xy[block.first : block.last + 2])
            assert np.abs(shapely.distance(here, ring) - 1e-4).max() <= PROCESS.tolerance
            assert here[0].distance(here[-1]) < 1e-12


def run_straight(start: float, end: float) -> tuple[TimeLaw, np.ndarray]:
    path = straight(np.array([start, 0.0]), np.array([end, 0.0]), PLACE.z)
    law = parametrize(Route.of([(path, Limits(10.0, 23.0))]), ROBOT)
    (q,) = sample(path, law, ROBOT)
    return law, ROBOT.forward(q)[:, 0]


def test_a_move_ends_on_a_tick_and_is_stretched_by_less_than_one() -> None:
    law, x = run_straight(0.0, 0.05)
    assert law.durations[0] <= len(x) * TICK < law.durations[0] + TICK
    assert x[0] == pytest.approx(0.0, abs=1e-12)
    assert 0.0 < 0.05 - x[-1] <= 0.5 * 23.0 * TICK**2 * 1.001


def test_the_stretch_is_the_same_all_along() -> None:
    _, x = run_straight(-0.025, 0.025)
    # The motion is the same forwards and backwards, and so are the ticks, with the end as the tick after the last.
    assert np.append(x, 0.025) == pytest.approx(-np.append(x, 0.025)[::-1], abs=2e-6)


def test_a_move_shorter_than_a_tick_still_takes_one() -> None:
    assert len(run_straight(0.0, 2e-6)[1]) == 1


ENGRAVING = replace(PROCESS, engrave_feed=0.08, engrave_power=0.15)
ZIGZAG = Curve(
    points=np.array([[0.0, 0.0], [0.01, 0.0], [0.01, 0.005], [0.02, 0.005]]), bulges=np.array([0, 0.3, 0]), closed=False
)


def line(curve: Curve, operation: Operation, number: int = 7) -> Cut:
    return Cut(contour=number, layer="MARK", handles=("7",), curve=curve, operation=operation)


def planned_lines(*lines: Cut, process: Process = ENGRAVING, mode: Mode = Mode.CUT) -> Setpoints:
    return plan_motion(lines, robot=ROBOT, process=process, placement=PLACE, drawing_error=0.0, mode=mode)


@pytest.mark.parametrize("corner", ["round", "stop"])
@pytest.mark.parametrize("operation", [Operation.CUT, Operation.ENGRAVE])
def test_an_open_line_is_run_from_end_to_end_and_from_rest_to_rest(operation: Operation, corner: str) -> None:
    points = planned_lines(line(ZIGZAG, operation), process=replace(ENGRAVING, corner=corner))
    kind = BlockKind.ENGRAVE if operation is Operation.ENGRAVE else BlockKind.CUT
    (block,) = [b for b in points.blocks if b.kind is kind]
    xy = ROBOT.forward(points.q)[:, :2]
    placed = curves.transform(ZIGZAG, rotation=PLACE.rotation, shift=(PLACE.x, PLACE.y))
    assert xy[block.first] == pytest.approx(placed.points[0], abs=1e-9)
    assert xy[block.last + 1] == pytest.approx(placed.points[-1], abs=1e-9)
    drawn = shapely.LineString(curves.flatten(placed, 1e-8)[0])
    run = xy[block.first : block.last + 2]
    assert shapely.distance(shapely.points(run), drawn).max() <= PROCESS.tolerance
    assert shapely.LineString(run).length == pytest.approx(drawn.length, rel=0.01)
    rest = 0.5 * ROBOT.tool.max_acceleration * TICK**2 * 1.001
    assert np.hypot(*np.diff(run, axis=0)[[0, -1]].T).max() <= rest
    if corner == "stop":
        (place,) = placed.points[[1]]
        assert np.hypot(*(run - place).T).min() < 1e-9


def test_engraving_has_its_own_feed_and_power_and_no_pierce() -> None:
    points = planned_lines(
        line(slot(0.03, 0.01), Operation.ENGRAVE, 1), line(ZIGZAG, Operation.ENGRAVE, 2), *cuts(slot(0.05, 0.03))
    )
    kinds = [b.kind for b in points.blocks]
    assert kinds == ["rapid", "engrave", "rapid", "engrave", "rapid", "pierce", "cut", "rapid"]
    engraved = np.isin(points.block, [i for i, kind in enumerate(kinds) if kind is BlockKind.ENGRAVE])
    speed = np.hypot(*np.diff(ROBOT.forward(points.q)[:, :2], axis=0).T) / TICK
    assert 0.99 * 0.08 < speed[engraved[:-1]].max() <= 0.08 * 1.0001
    assert set(points.power[engraved]) == {0.15}
    cut = np.isin(points.block, [i for i, kind in enumerate(kinds) if kind in {BlockKind.PIERCE, BlockKind.CUT}])
    assert set(points.power[cut]) == {PROCESS.power}
    assert not points.power[~engraved & ~cut].any()
    assert not planned_lines(line(ZIGZAG, Operation.ENGRAVE), mode=Mode.DRY_RUN).power.any()


def test_an_open_cut_is_pierced() -> None:
    kinds = [b.kind for b in planned_lines(line(ZIGZAG, Operation.CUT)).blocks]
    assert kinds == ["rapid", "pierce", "cut", "rapid"]


@pytest.mark.parametrize("missing", ["engrave_feed", "engrave_power"])
def test_a_process_that_does_not_say_how_to_engrave_is_refused_with_what_to_add(missing: str) -> None:
    process = replace(ENGRAVING, **{missing: None})
    with pytest.raises(ProcessError, match="does not say how") as caught:
        planned_lines(line(ZIGZAG, Operation.ENGRAVE), process=process)
    assert caught.value.where == f"process {PROCESS.name}"
    assert "[engrave] with feed_m_min and power" in caught.value.hint
    assert planned_lines(line(ZIGZAG, Operation.CUT), process=process).blocks


def test_the_frame_goes_around_the_box_at_the_feed_with_the_laser_off() -> None:
    corners = np.array([[0.0, 0.0], [0.1, 0.0], [0.1, 0.05], [0.0, 0.05]])
    points = plan_frame(corners, robot=ROBOT, process=PROCESS, placement=PLACE)
    xy = ROBOT.forward(points.q)[:, :2]
    placed = curves.transform(curves.polygon(corners), rotation=PLACE.rotation, shift=(PLACE.x, PLACE.y)).points
    for corner in placed:
        assert np.hypot(*(xy - corner).T).min() < 1e-12
    assert not points.power.any()
    assert points.blocks == (Block(BlockKind.RAPID, 0, len(points.q) - 1),)


def test_a_process_without_piercing_has_no_pierce_block() -> None:
    points = plan_motion(
        cuts(slot(0.03, 0.01)),
        robot=ROBOT,
        process=replace(PROCESS, pierce_time=0.0),
        placement=PLACE,
        drawing_error=0.0,
    )
    assert [b.kind for b in points.blocks] == ["rapid", "cut", "rapid"]
