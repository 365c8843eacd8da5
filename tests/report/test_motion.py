"""The series of the page are what the checks measure."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.program.program import Program
from deltacam.report.motion import deviations, motion_of
from deltacam.robot.robot import JointLimits
from deltacam.verification.evidence import gather
from deltacam.verification.verify import verify
from tests.bench import Bench


def jerky(program: Program) -> Program:
    """The program with a limit of jerk, and a setpoint that is off."""
    joints: JointLimits = replace(program.robot.joints, max_jerk=(1e4, 1e4, 1e4))
    q = program.q.copy()
    q[1000, 1] += 1e-3
    return replace(program, q=q, robot=replace(program.robot, joints=joints))


def test_the_worst_values_are_those_of_the_checks_at_their_ticks(program: Program) -> None:
    program = jerky(program)
    evidence = gather(program, program.robot)
    motion, report = motion_of(evidence), verify(program, drawing=None)
    for name, values in zip(("joint speed", "joint acceleration", "joint jerk"), motion.joints[1:], strict=True):
        check = Bench.check(report, name)
        assert np.degrees(np.abs(values).max()) == pytest.approx(check.worst, rel=1e-6), name
        assert np.abs(values).max(axis=0).argmax() == check.tick, name
    for name, values in (("tool speed", motion.speed), ("tool acceleration", motion.acceleration)):
        check = Bench.check(report, name)
        assert (values.max(), values.argmax()) == (pytest.approx(check.worst), check.tick), name


def test_a_start_at_speed_counts(program: Program) -> None:
    # Steps of 1, 2, 3, ...: the acceleration is even from the start, so that only the first step has a jerk.
    step = 1e-6 * np.cumsum(np.arange(6.0))
    q = program.q[0] + np.outer(step, np.ones(3))
    few = replace(program, q=q, power=program.power[:6], block=program.block[:6])
    jerk = motion_of(gather(few, few.robot)).joints[3]
    assert jerk[:, 0] == pytest.approx(np.full(3, 1e-6 * 400.0**3))
    assert jerk[:, 1:4] == pytest.approx(np.zeros((3, 3)), abs=1e-3)


def test_every_series_has_a_value_for_every_tick(program: Program) -> None:
    for rows in (1, 2, 3, 700):
        few = replace(program, q=program.q[:rows], power=program.power[:rows], block=program.block[:rows])
        motion = motion_of(gather(few, few.robot))
        assert {values.shape for values in motion.joints} == {(3, rows)}
        assert {values.shape for values in (motion.speed, motion.acceleration, motion.worked)} == {(rows,)}


def test_without_positions_there_is_the_motion_of_the_joints_alone(program: Program) -> None:
    q = program.q.copy()
    q[3] = 3.0
    lost = replace(program, q=q)
    motion = motion_of(gather(lost, lost.robot))
    assert motion.joints[0].shape == (3, len(q))
    assert len(motion.speed) == len(motion.acceleration) == len(motion.worked) == 0


def test_the_deviation_is_that_of_the_check_and_known_in_cuts_only(bench: Bench) -> None:
    program = bench.shifted_outwards(bench.program(), 15e-6)
    evidence = gather(program, program.robot)
    check = Bench.check(verify(program, drawing=bench.drawing), "deviation at ticks")
    found = deviations(evidence, bench.drawing)
    assert 1e6 * np.nanmax(found) == pytest.approx(check.worst)
    assert np.nanargmax(found) == check.tick
    cut = np.zeros(len(found), dtype=bool)
    for run in evidence.runs:
        cut[run.first : run.end + 1] = True
    assert (np.isfinite(found) == cut).all()
    lossy = replace(bench.drawing, conversion_error=2e-6)
    assert np.nanmax(deviations(evidence, lossy)) == pytest.approx(np.nanmax(found) + 2e-6)


def test_the_length_that_is_worked_grows_in_cuts_only_and_ends_with_all_of_it(bench: Bench) -> None:
    program = bench.program()
    evidence = gather(program, program.robot)
    worked = motion_of(evidence).worked
    total = verify(program, drawing=bench.drawing).summary["cut_length_mm"]
    assert 1e3 * worked[-1] == pytest.approx(total, abs=1e-6)
    assert (np.diff(worked) >= 0.0).all()
    grows = np.flatnonzero(np.diff(worked) > 1e-12)
    assert all(any(run.first <= row < run.end for run in evidence.runs) for row in grows[::50])
