"""A valid program passes, a limit bites exactly where it should, and the report says what was not checked."""

import ast
import hashlib
import io
import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import deltacam
from deltacam.geometry import curve as curves
from deltacam.model import UNCHECKED, Block, BlockKind, Gas, Lead, Mode, Placement, Provenance
from deltacam.program import csv
from deltacam.program.program import Program
from deltacam.verification.checks.table import OF_CONTOURS, OF_POSITIONS, OF_SETPOINTS
from deltacam.verification.verify import verify
from tests.bench import Bench


def test_a_valid_program_passes_every_check(bench: Bench, program: Program) -> None:
    report = verify(program, drawing=bench.drawing, robot=bench.robot)
    assert bench.failed(report) == set()
    assert report.passed
    assert len(report.checks) == len(OF_SETPOINTS) + len(OF_POSITIONS) + len(OF_CONTOURS) + 1
    assert bench.check(report, "deviation at ticks").worst == pytest.approx(0.0, abs=0.3)
    assert bench.check(report, "uncut length").worst == 0.0


VALID: dict[str, Callable[[Bench], Bench]] = {
    "reversed": lambda b: b.but(paths=lambda h: {n: curves.reverse(c) for n, c in b.paths(h).items()}),
    "started elsewhere": lambda b: b.but(
        paths=lambda h: {n: curves.start_at(c, 1, 1e-3) for n, c in b.paths(h).items()}
    ),
    "at the origin": lambda b: b.but(placement=Placement(0.0, 0.0, 0.0, -0.65)),
    "turned over": lambda b: b.but(placement=Placement(-0.02, 0.01, -3.0, -0.65)),
    "another order of holes": lambda b: b.but(order=(2, 4, 3, 1)),
    "no kerf": lambda b: b.but(process=replace(b.process, kerf=0.0)),
    "a wide kerf": lambda b: b.but(process=replace(b.process, kerf=1e-3)),
    "a dry run": lambda b: b.but(mode=Mode.DRY_RUN),
    "another rate": lambda b: b.but(
        robot=replace(b.robot, controller=replace(b.robot.controller, rate_hz=1000.0)), pierce_ticks=50
    ),
    "no pierce": lambda b: b.but(process=replace(b.process, pierce_time=0.0), pierce_ticks=0),
}


@pytest.mark.parametrize("kind", VALID)
def test_other_valid_programs_pass(bench: Bench, kind: str) -> None:
    bench = VALID[kind](bench)
    assert bench.failed(verify(bench.program(), drawing=bench.drawing)) == set()


@dataclass(frozen=True)
class Limit:
    """How to set a limit of the robot to ``value`` in the unit of the report."""

    section: str
    field: str
    convert: Callable[[float], Any]


def three_radians(value: float) -> tuple[float, float, float]:
    return (np.radians(value),) * 3


LIMITS: dict[str, Limit] = {
    "joint speed": Limit("joints", "max_speed", three_radians),
    "joint acceleration": Limit("joints", "max_acceleration", three_radians),
    "joint jerk": Limit("joints", "max_jerk", three_radians),
    "tool speed": Limit("tool", "max_speed", float),
    "tool acceleration": Limit("tool", "max_acceleration", float),
    "pressure angle": Limit("workspace", "max_pressure_angle", np.radians),
    "forearm swing": Limit("workspace", "max_forearm_swing", np.radians),
}


@pytest.mark.parametrize("name", LIMITS)
def test_a_limit_just_above_the_worst_value_passes_and_just_below_fails(
    bench: Bench, program: Program, name: str
) -> None:
    limit = LIMITS[name]
    worst = bench.check(verify(program, drawing=None), name).worst
    assert worst is not None
    for share, passes in ((1.0005, True), (0.998, False)):
        section = replace(getattr(program.robot, limit.section), **{limit.field: limit.convert(share * worst)})
        robot = replace(program.robot, **{limit.section: section})
        assert bench.check(verify(replace(program, robot=robot), drawing=None), name).passed is passes


@pytest.mark.parametrize("side", ["min", "max"])
def test_the_joint_range_is_checked_on_both_sides(bench: Bench, program: Program, side: str) -> None:
    extreme = program.q[:, 1].min() if side == "min" else program.q[:, 1].max()
    for change, passes in ((1e-6, True), (-1e-6, False)):
        value = list(getattr(program.robot.joints, side))
        value[1] = float(extreme - change if side == "min" else extreme + change)
        robot = replace(program.robot, joints=replace(program.robot.joints, **{side: tuple(value)}))
        found = bench.check(verify(replace(program, robot=robot), drawing=None), "joint range (at least)")
        assert found.passed is passes
        assert passes or "joint 2" in found.where


def test_an_impossible_pose_is_named_and_nothing_about_positions_is_claimed(bench: Bench, program: Program) -> None:
    q = program.q.copy()
    q[700] = -3.0
    report = verify(replace(program, q=q), drawing=bench.drawing)
    assert bench.check(report, "possible poses").tick == 700
    names = {found.name for found in report.checks}
    assert not names & {"tool speed", "deviation at ticks", "sheet plane"}
    assert any("nothing about positions" in finding.what for finding in report.findings)


def test_a_given_robot_must_be_the_one_in_the_program(bench: Bench, program: Program) -> None:
    other = replace(bench.robot, tool=replace(bench.robot.tool, max_speed=0.99))
    assert bench.failed(verify(program, drawing=None, robot=other)) == {"robot"}
    slow = replace(bench.robot, tool=replace(bench.robot.tool, max_speed=0.1))
    assert bench.failed(verify(program, drawing=None, robot=slow)) == {"robot", "tool speed"}


def test_without_a_drawing_the_report_says_what_was_not_checked(bench: Bench, program: Program) -> None:
    report = verify(program, drawing=None)
    made = {check.name for check in report.checks}
    all_names = [check.name for check in verify(program, drawing=bench.drawing).checks]
    missing = next(finding.what for finding in report.findings if finding.kind == UNCHECKED)
    assert missing == f"not checked without the drawing: {', '.join(name for name in all_names if name not in made)}"
    assert report.passed
    assert len(report.checks) == len(OF_SETPOINTS) + len(OF_POSITIONS)


def test_a_given_process_is_the_one_that_counts(bench: Bench, program: Program) -> None:
    same = verify(program, drawing=bench.drawing, process=replace(program.process, name="the same, renamed"))
    assert bench.failed(same) == set()
    assert bench.check(same, "process").passed
    loose = replace(program, process=replace(program.process, tolerance=1e-3, feed=0.5))
    moved = bench.shifted_outwards(loose, 30e-6)
    assert bench.failed(verify(moved, drawing=bench.drawing)) <= {"joint jerk"}
    strict = verify(moved, drawing=bench.drawing, process=program.process)
    assert bench.failed(strict) >= {"process", "deviation at ticks"}
    assert bench.check(strict, "process").where == "feed 0.5 for 0.1, tolerance 0.001 for 2e-05"


def test_what_a_process_says_for_people_may_differ(bench: Bench, program: Program) -> None:
    own = program.process
    words = {"gas": "air", "gases": (Gas("air"),), "laser": "co2", "laser_power": 60.0, "feeds": (0.05, 0.2)}
    said = replace(own, **words, provenance=(Provenance("kerf_mm", "vendor"),), source="another", material="another")
    assert bench.check(verify(program, drawing=bench.drawing, process=said), "process").passed
    other = replace(own, lead_in=Lead("line"), overcut=1e-3)
    where = bench.check(verify(program, drawing=bench.drawing, process=other), "process").where
    assert where == "lead_in others for others, overcut 0 for 0.001"


def test_a_frame_program_is_not_compared_with_the_contours(bench: Bench, program: Program) -> None:
    frame = replace(program, mode=Mode.FRAME, power=np.zeros(len(program.q)))
    report = verify(frame, drawing=bench.drawing)
    assert report.passed
    assert [finding for finding in report.findings if "frame" in finding.what]
    assert not [found for found in report.checks if found.name == "deviation at ticks"]


def test_the_summary_is_measured_from_the_setpoints(bench: Bench, program: Program) -> None:
    summary = verify(program, drawing=bench.drawing).summary
    length = sum(curves.length(path) for path in bench.paths(bench.process.kerf / 2).values())
    assert summary["cut_length_mm"] == pytest.approx(length * 1e3, rel=1e-3)
    assert summary["program"]["rows"] == len(program.q)
    assert sum(summary["time_s"].values()) == pytest.approx(program.duration)
    assert summary["time_s"]["pierce"] == pytest.approx(4 * 20 / 400)
    assert summary["part_size_mm"] == pytest.approx([60.0, 40.0])
    assert summary["path_size_mm"] == pytest.approx([60.2, 40.2], abs=1e-2)
    assert summary["contours_cut"] == summary["contours_drawn"] == 4
    assert summary["share_of_limit"]["feed while cutting"] == pytest.approx(1.0, abs=2e-3)


def test_one_row_is_enough_for_a_report(bench: Bench, program: Program) -> None:
    one = replace(
        program,
        q=program.q[:1],
        power=np.zeros(1),
        block=np.zeros(1, dtype=int),
        blocks=(Block(BlockKind.RAPID, 0, 0),),
    )
    assert bench.failed(verify(one, drawing=None)) == set()
    assert bench.failed(verify(one, drawing=bench.drawing)) == {"every contour cut once", "uncut length"}
    burning = replace(one, power=np.full(1, 0.85), blocks=(Block(BlockKind.CUT, 0, 0, 1),))
    assert "uncut length" in bench.failed(verify(burning, drawing=bench.drawing))


def test_verification_never_imports_the_planner() -> None:
    folder = Path(deltacam.__file__).parent / "verification"
    for path in folder.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            assert not [name for name in names if name.startswith(("deltacam.cutting", "deltacam.motion"))], path.name


def rows_of(program: Program) -> list[bytes]:
    stream = io.BytesIO()
    csv.write(program, stream)
    return stream.getvalue().split(b"\n")


def with_repaired_hash(lines: list[bytes]) -> Program:
    meta = json.loads(lines[1][2:])
    meta["sha256"] = hashlib.sha256(b"\n".join(lines[2:])).hexdigest()
    return csv.read(io.BytesIO(b"\n".join([lines[0], b"# " + json.dumps(meta).encode(), *lines[2:]])), name="a")


def test_an_edit_whose_hash_was_repaired_is_found_by_the_motion(bench: Bench, program: Program) -> None:
    lines, edited = rows_of(program), rows_of(bench.shifted_outwards(program, 30e-6))
    changed = [index for index, (old, new) in enumerate(zip(lines, edited, strict=True)) if index > 1 and old != new]
    assert len(changed) == 1
    assert with_repaired_hash(lines).integrity == ()
    report = verify(with_repaired_hash(edited), drawing=bench.drawing)
    assert "deviation at ticks" in bench.failed(report)
    assert bench.check(report, "file integrity").passed
    assert bench.check(report, "deviation at ticks").tick == changed[0] - 3


def test_swapped_rows_are_found_even_with_a_repaired_hash(bench: Bench, program: Program) -> None:
    lines = rows_of(program)
    lines[500], lines[501] = lines[501], lines[500]
    report = verify(with_repaired_hash(lines), drawing=bench.drawing)
    assert (
        bench.check(report, "tick continuity").where
        == "expected tick 497, found 498 in line 501; 2 of 2686 rows differ"
    )
    assert "tick continuity" in bench.failed(report)


@pytest.mark.parametrize("end", [0, -1])
@pytest.mark.parametrize(("step", "passes"), [(68e-6, True), (76e-6, False)])
def test_the_ends_may_move_in_one_tick_as_far_as_from_rest(
    bench: Bench, program: Program, end: int, step: float, passes: bool
) -> None:
    limit = 0.5 * bench.robot.tool.max_acceleration / 400**2
    assert limit == pytest.approx(71.9e-6, abs=0.1e-6)
    found = bench.check(verify(bench.shifted(program, end % len(program.q), step), drawing=None), "rest at both ends")
    assert found.worst == pytest.approx(step * 1e6, abs=3.5)
    assert found.passed is passes
