"""The main job: real drawings to verified programs."""

import os
import shutil
import signal
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from deltacam.cutting.process import load_process
from deltacam.errors import DeltacamError, DrawingError, InfeasibleError, ProcessError, ProgramError, RobotError
from deltacam.examine import verify
from deltacam.geometry import curve as curves
from deltacam.model import BlockKind, Lead, Mode
from deltacam.pipeline import Outputs, Planned, plan, plan_to_folder
from deltacam.program.formats import read_program
from deltacam.report.text import to_text
from deltacam.robot.rapid import Rapids
from tests.sheets import drawn

DXF = Path(__file__).parent / "data" / "dxf"
DEG = np.pi / 180.0

MUST_PLAN = {
    "drone-top-onshape": ("mm", "delta-300", (150.0, 150.0)),
    "gear-logo-inkscape": ("mm", "delta-300", (107.1, 96.4)),
    "sweep-plate-kicad": ("mm", "delta-300", (111.6, 95.2)),
    "key-plate-bulge": (None, "delta-300", (145.4, 116.3)),
    "wrench-inch": (None, "delta-300", (82.6, 23.8)),
    "rational-spline-inch": (None, "delta-300", (38.4, 38.4)),
    "plate-solidworks-inch": (None, "delta-300", (200.9, 114.3)),
    "tank-lid-inkscape": ("mm", "delta-300", (294.6, 61.7)),
    "channel-bulge-inch": (None, "irb360-1600", (93.2, 304.8)),
    "nest-forms": (None, "irb360-1600", (1016.0, 831.3)),
}
"""The unit to give, the robot, and the size in mm that a person expects."""


@pytest.fixture(scope="module")
def drone() -> Planned:
    return plan(DXF / "drone-top-onshape.dxf", unit="mm")


@pytest.mark.parametrize("name", MUST_PLAN)
def test_a_real_drawing_is_planned_and_verified_from_its_files(name: str, tmp_path: Path) -> None:
    unit, robot, size = MUST_PLAN[name]
    planned, outputs = plan_to_folder(DXF / f"{name}.dxf", tmp_path, unit=unit, robot=robot)
    assert planned.report.passed, [check for check in planned.report.checks if not check.passed]
    assert verify(outputs.program, drawing=DXF / f"{name}.dxf").passed
    boxes = np.array([curves.bounds(contour.curve) for contour in planned.drawing.contours])
    assert (boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)) * 1e3 == pytest.approx(size, abs=0.06)
    assert sorted(path.name for path in tmp_path.iterdir()) == sorted(
        path.name for path in (outputs.program, outputs.report_json, outputs.report_html)
    )


@pytest.mark.parametrize("name", MUST_PLAN)
def test_another_judge_agrees(name: str, tmp_path: Path) -> None:
    """Limits by differences and deviation by shapely, from the bytes of the file alone."""
    unit, robot, _ = MUST_PLAN[name]
    planned, outputs = plan_to_folder(DXF / f"{name}.dxf", tmp_path, unit=unit, robot=robot)
    program = read_program(outputs.program)
    table = np.loadtxt(outputs.program, delimiter=",", skiprows=3)
    q, tick = table[:, 1:4], 1.0 / 400.0
    held = np.concatenate([q[:1], q, q[-1:]])
    machine = program.robot
    position = machine.forward(held)
    assert (np.abs(np.diff(held, 2, axis=0)) / tick**2 / machine.joints.max_acceleration).max() <= 1.001
    assert (np.abs(np.diff(held, axis=0)) / tick / machine.joints.max_speed).max() <= 1.001
    assert np.linalg.norm(np.diff(position, 2, axis=0), axis=1).max() / tick**2 <= machine.tool.max_acceleration * 1.001
    where = program.placement
    cos, sin = np.cos(where.rotation), np.sin(where.rotation)
    sheet = (position[1:-1, :2] - [where.x, where.y]) @ np.array([[cos, -sin], [sin, cos]])
    for contour in planned.drawing.contours:
        shift = program.process.kerf / 2.0 * (-1.0 if contour.depth % 2 else 1.0)
        edge = shapely.Polygon(curves.flatten(contour.curve, 2e-7)[0]).buffer(shift, quad_segs=48).boundary
        blocks = [b for b in program.blocks if b.kind is BlockKind.CUT and b.contour == contour.number]
        runs = [sheet[b.first : b.last + 2] for b in blocks]
        assert shapely.distance(shapely.points(np.concatenate(runs)), edge).max() <= program.process.tolerance + 1e-6
        swept = shapely.union_all([shapely.LineString(run) for run in runs])
        led = shapely.union_all([shapely.LineString(sheet[b.first - 1 : b.last + 2]) for b in blocks])
        assert edge.difference(led.buffer(60e-6)).length < 1e-6
        # A cut begins somewhere in the step that ends at its first tick.
        step = program.process.feed * tick * len(runs)
        assert 0.98 * edge.length - step <= swept.length <= 1.05 * edge.length


def test_the_same_input_gives_the_same_bytes_from_any_folder(
    drone: Planned, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    copy = shutil.copy(DXF / "drone-top-onshape.dxf", tmp_path)
    monkeypatch.chdir(tmp_path)
    again, outputs = plan_to_folder(Path(copy).name, "out", unit="mm")
    assert again.content == drone.content == outputs.program.read_bytes()
    assert str(tmp_path).encode() not in outputs.program.read_bytes() + outputs.report_html.read_bytes()


def test_the_report_says_that_the_joint_limits_are_derived(drone: Planned) -> None:
    assert drone.report.summary["derived_joint_limits"] == ["max_speed", "max_acceleration"]
    assert "derived from the tool rating" in to_text(drone.report)


def test_a_dry_run_and_a_frame_keep_the_laser_off(drone: Planned) -> None:
    dry = plan(DXF / "drone-top-onshape.dxf", unit="mm", mode=Mode.DRY_RUN)
    frame = plan(DXF / "drone-top-onshape.dxf", unit="mm", mode=Mode.FRAME)
    for planned in (dry, frame):
        assert planned.report.passed, [check for check in planned.report.checks if not check.passed]
        assert not planned.program.power.any()
    assert np.array_equal(dry.program.q, drone.program.q)
    assert frame.program.duration < 0.5 * drone.program.duration


@pytest.mark.parametrize("corner", ["round", "stop"])
def test_both_ways_to_take_a_corner_verify(corner: str) -> None:
    process = replace(load_process("acrylic-3mm-co2"), corner=corner, feed=0.2)
    assert plan(DXF / "gear-logo-inkscape.dxf", unit="mm", process=process).report.passed


def test_a_turned_and_moved_part_verifies() -> None:
    planned = plan(DXF / "wrench-inch.dxf", at=(0.05, -0.04), rotation=37.0 * DEG)
    assert planned.report.passed
    assert planned.program.placement.rotation == pytest.approx(37.0 * DEG)


def test_without_leads_the_first_cut_begins_at_its_point_nearest_in_time_to_the_park_position() -> None:
    process = replace(load_process("steel-1mm-fibre"), lead_in=Lead(), lead_out=Lead(), overcut=0.0)
    options = {"robot": "irb360-1600", "at": (0.2, -0.1), "rotation": 0.7, "process": process}
    planned = plan(DXF / "channel-bulge-inch.dxf", **options)
    program = planned.program
    where = program.placement
    (contour,) = planned.drawing.contours
    placed = curves.transform(contour.curve, rotation=where.rotation, shift=(where.x, where.y))
    path = shapely.Polygon(curves.flatten(placed, 1e-7)[0]).buffer(program.process.kerf / 2.0, quad_segs=48).exterior
    pierce = program.robot.forward(program.q[[program.blocks[1].first]])[0, :2]
    park = program.robot.workspace.park
    # The robot is not as fast in all directions, so that the nearest in time is not quite the nearest.
    assert np.hypot(*(pierce - park)) == pytest.approx(path.distance(shapely.Point(park)), rel=0.03)
    rapids, places = Rapids(program.robot), np.asarray(path.segmentize(0.2e-3).coords)
    there_and_back = [
        rapids(np.broadcast_to(park, one.shape), one) + rapids(one, np.broadcast_to(park, one.shape))
        for one in (pierce[None], places)
    ]
    assert there_and_back[0][0] <= 1.0005 * there_and_back[1].min()


@pytest.mark.parametrize(
    ("options", "kind", "says"),
    [
        ({}, DrawingError, "unit"),
        ({"unit": "mm", "robot": "delta-30"}, RobotError, "delta-300"),
        ({"unit": "mm", "process": "no-such"}, ProcessError, "no-such"),
        ({"unit": "mm", "at": (0.1, 0.0)}, InfeasibleError, "25.075 mm"),
        ({"unit": "cm"}, InfeasibleError, "leaves the sheet"),
        ({"unit": "parsec"}, DeltacamError, "parsec"),
        ({"unit": "mm", "at": (0.046, 0.0), "rotation": 45 * DEG, "mode": Mode.FRAME}, InfeasibleError, "frame"),
    ],
)
def test_a_failed_plan_leaves_no_program_of_an_earlier_run(
    tmp_path: Path, options: dict[str, object], kind: type[DeltacamError], says: str
) -> None:
    outputs = Outputs.of("drone-top-onshape.dxf", tmp_path)
    parquet = tmp_path / "drone-top-onshape.program.parquet"
    for path in (outputs.program, parquet, outputs.report_json, outputs.report_html):
        path.write_text("old")
    with pytest.raises(kind) as caught:
        plan_to_folder(DXF / "drone-top-onshape.dxf", tmp_path, **options)
    assert says in f"{caught.value.what} {caught.value.hint}"
    assert list(tmp_path.iterdir()) == []


def test_a_tolerance_below_the_error_of_reading_is_refused_with_the_least_that_works() -> None:
    process = load_process("steel-1mm-fibre")
    with pytest.raises(InfeasibleError, match="only known to within") as caught:
        plan(DXF / "gear-unitless.dxf", unit="in", robot="irb360-1600", process=replace(process, tolerance=2e-6))
    assert "--tolerance 5.4um" in caught.value.hint
    least = replace(process, tolerance=5.4e-6)
    assert plan(DXF / "gear-unitless.dxf", unit="in", robot="irb360-1600", process=least).report.passed


def test_a_failed_check_leaves_the_reports_and_no_program(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from deltacam.motion import setpoints

    # A planner with a fault: it forgets the kerf's tolerance and rounds corners by half a millimetre.
    monkeypatch.setattr(setpoints, "FIT_ALLOWANCE", -5e-4)
    planned, outputs = plan_to_folder(DXF / "gear-logo-inkscape.dxf", tmp_path, unit="mm")
    assert not planned.report.passed
    assert not outputs.program.exists()
    assert outputs.report_json.exists()
    assert outputs.report_html.exists()


def test_a_folder_that_cannot_be_written_is_refused_first(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(ProgramError, match="not a folder"):
        plan_to_folder(DXF / "no-such.dxf", tmp_path / "file")


@pytest.mark.parametrize("moment", [0.3, 0.9, 1.3, 1.7, 2.1])
def test_killing_the_planner_leaves_no_program_or_a_whole_one(drone: Planned, tmp_path: Path, moment: float) -> None:
    code = (
        "import sys; from deltacam.pipeline import plan_to_folder; plan_to_folder(sys.argv[1], sys.argv[2], unit='mm')"
    )
    child = subprocess.Popen(
        [sys.executable, "-c", code, str(DXF / "drone-top-onshape.dxf"), str(tmp_path)],
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
    )
    time.sleep(moment)
    child.send_signal(signal.SIGKILL)
    child.wait()
    program = Outputs.of("drone-top-onshape.dxf", tmp_path).program
    assert not program.exists() or program.read_bytes() == drone.content
    assert [path.name for path in tmp_path.glob("*.csv")] == [program.name] * program.exists()


def test_a_frame_goes_around_the_leads_too(drone: Planned) -> None:
    frame = plan(DXF / "drone-top-onshape.dxf", unit="mm", mode=Mode.FRAME)
    inside, around = (planned.program.robot.forward(planned.program.q)[:, :2] for planned in (drone, frame))
    on = np.isin([drone.program.blocks[index].kind for index in drone.program.block], ["lead_in", "cut", "lead_out"])
    assert (inside[on].min(axis=0) > around.min(axis=0) - 50e-6).all()
    assert (inside[on].max(axis=0) < around.max(axis=0) + 50e-6).all()


def test_leads_stay_inside_holes_whose_outline_is_not_cut() -> None:
    planned = plan(DXF / "switch-mount-duplicates.dxf", what_if=False)
    assert planned.report.passed, [check for check in planned.report.checks if not check.passed]


def test_the_overcut_of_a_tiny_gear_verifies() -> None:
    """The tool rounds its corners within the tolerance, so that its way is shorter than the contour."""
    turn = 2.0 * np.pi * np.arange(24) / 24.0
    radius = np.where(np.arange(24) % 2, 0.6, 0.48)
    gear = list(zip(radius * np.cos(turn), radius * np.sin(turn), strict=True))
    data = drawn([(-10.0, -10.0, 20.0, 20.0)], outlines=[gear])
    process = replace(load_process("steel-1mm-fibre"), feed=0.02, overcut=1e-3)
    planned = plan("gear.dxf", data=data, robot="irb360-1600", process=process, what_if=False, jobs=1)
    assert planned.report.passed
