"""The jerk of the joints: measured as it is, with the ends, and whether or not the robot has a limit."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from deltacam.model import Check
from deltacam.program.program import Program
from deltacam.report.html import to_html
from deltacam.report.listing import to_json
from deltacam.report.text import to_text
from deltacam.robot.robot import Robot, Triple
from deltacam.verification.checks.limits import joint_jerk
from deltacam.verification.evidence import gather
from deltacam.verification.verify import verify
from tests.bench import Bench

ROUNDED = 0.5e-12  # rad; half of the last digit of the file


def limited(robot: Robot, jerk: Triple | None, *, rate: float = 400.0) -> Robot:
    """The robot with a limit in rad/s^3, and a controller of that rate."""
    controller = replace(robot.controller, rate_hz=rate)
    return replace(robot, joints=replace(robot.joints, max_jerk=jerk), controller=controller)


def jerk_of(program: Program, motion: np.ndarray, jerk: Triple | None = None, *, rate: float = 400.0) -> Check:
    """What the check says about a ``motion`` (N,) rad of joint 2, with the arms about horizontal."""
    q = motion[:, np.newaxis] * np.array([0.0, 1.0, 0.0])
    rows = {"q": q, "power": np.zeros(len(q)), "block": np.zeros(len(q), dtype=int)}
    return joint_jerk(gather(replace(program, **rows), limited(program.robot, jerk, rate=rate)))


def from_accelerations(accelerations: np.ndarray) -> np.ndarray:
    """The positions (N,), held at both ends, whose second differences are these (N,) rad; they must add up to 0."""
    return np.concatenate([[0.0], np.cumsum(np.cumsum(accelerations)[:-1])])


def test_the_jerk_of_a_motion_from_rest_to_rest_is_measured_exactly(program: Program) -> None:
    jerks = np.repeat([1.0, -1.0, 1.0], [12, 24, 12]) * 500.0 / 400.0**3
    motion = from_accelerations(np.append(np.cumsum(jerks), 0.0))
    assert jerk_of(program, motion).worst == pytest.approx(np.degrees(500.0), rel=1e-5)
    for limit, passes in ((500.0, True), (499.0, False)):
        found = jerk_of(program, motion, (1.0, limit, 1e6))
        assert (found.passed, found.where[:7]) == (passes, "joint 2")
        assert found.limit == pytest.approx(np.degrees(limit) * 1.001)


@pytest.mark.parametrize(("back", "tick"), [(False, 0), (True, 49)])
def test_an_end_at_an_acceleration_counts(program: Program, back: bool, tick: int) -> None:
    s = np.linspace(0.0, 1.0, 50)
    fading = 1e-4 * ((1.0 - s) * (1.0 - 3.0 * s))
    motion = from_accelerations(fading - fading.mean())
    found = jerk_of(program, motion[::-1] if back else motion)
    assert found.tick == tick
    assert found.worst == pytest.approx(np.degrees(1e-4 - fading.mean()) * 400.0**3, rel=1e-6)


def test_a_jolt_is_found_at_its_tick(program: Program) -> None:
    motion = np.repeat([0.0, 1e-6], 30)
    assert jerk_of(program, motion).tick in (29, 30)


@pytest.mark.parametrize("rate", [400.0, 10_000.0, 100_000.0])
def test_the_rounding_of_the_file_is_no_jerk(program: Program, rate: float) -> None:
    worst_case = ROUNDED * (-1.0) ** np.arange(40)
    assert jerk_of(program, worst_case, (1e-4,) * 3, rate=rate).passed
    found = jerk_of(program, 2.0 * worst_case, (1e-4,) * 3, rate=rate)
    assert np.radians(found.worst) == pytest.approx(8.0 * ROUNDED * rate**3)
    assert not found.passed


def test_without_a_limit_the_largest_jerk_is_reported_and_passes(bench: Bench, program: Program) -> None:
    assert program.robot.joints.max_jerk is None
    report = verify(program, drawing=bench.drawing)
    found = bench.check(report, "joint jerk")
    worst = np.degrees(np.abs(np.diff(program.q, n=3, axis=0)).max()) * 400.0**3
    assert (found.passed, found.worst, found.limit) == (True, pytest.approx(worst, rel=1e-5), None)
    assert "joint jerk" not in report.summary["share_of_limit"]
    assert " deg/s3, no limit  " in to_text(report, every_check=True)
    assert ">no limit</td>" in to_html(report, program, drawing=None, title="plate")
    shown = next(check for check in json.loads(to_json(report))["checks"] if check["name"] == "joint jerk")
    assert (shown["limit"], shown["worst"]) == (None, found.worst)


def test_with_a_limit_the_share_of_it_is_reported(bench: Bench, program: Program) -> None:
    free = bench.check(verify(program, drawing=None), "joint jerk")
    robot = limited(program.robot, (2.0 * float(np.radians(free.worst)),) * 3)
    report = verify(replace(program, robot=robot), drawing=bench.drawing)
    assert report.summary["share_of_limit"]["joint jerk"] == pytest.approx(0.5)
    shares = "joint speed .+ %, acceleration .+ %, jerk 50 %; tool speed .+ %, acceleration .+ %; feed 100 %\n"
    assert re.search(f"  of limit {shares}", to_text(report))
    assert max(map(len, to_text(report).splitlines())) <= 120


ONE, TWO = "28647.8898 deg/s3", "57295.7795 deg/s3"


@pytest.mark.parametrize(
    ("planned", "own", "words"),
    [
        (500.0, 1e3, f"{ONE} in the program and {TWO} in this robot"),
        (1e3, 500.0, f"{TWO} in the program and {ONE} in this robot"),
        (None, 500.0, f"none in the program and {ONE} in this robot"),
        (500.0, None, f"{ONE} in the program and none in this robot"),
    ],
)
def test_a_plan_may_have_a_limit_of_its_own_but_is_checked_against_that_of_the_robot(
    bench: Bench, program: Program, planned: float | None, own: float | None, words: str
) -> None:
    program = replace(program, robot=limited(program.robot, planned and (planned,) * 3))
    found = np.radians(bench.check(verify(program, drawing=None), "joint jerk").worst)
    assert 500.0 < found < 3e3
    robot = limited(bench.robot, own and (own,) * 3)
    report = verify(program, drawing=None, robot=robot)
    assert bench.failed(report) == (set() if own is None or found < own else {"joint jerk"})
    sentence = f"the limit of joint jerk is {words}, which is the one checked"
    assert bench.check(report, "robot").where == sentence
    assert f"note: {sentence}\n" in to_text(report)


def test_limits_that_differ_by_joint_are_all_named(bench: Bench, program: Program) -> None:
    robot = limited(bench.robot, tuple(np.radians((1e6, 1e6, 2e6)).tolist()))
    report = verify(program, drawing=None, robot=robot)
    assert "none in the program and 1000000, 1000000, 2000000 deg/s3 in" in bench.check(report, "robot").where


def test_another_limit_of_jerk_does_not_hide_that_the_robot_is_another_one(bench: Bench, program: Program) -> None:
    slower = replace(bench.robot, tool=replace(bench.robot.tool, max_speed=0.99))
    report = verify(program, drawing=None, robot=limited(slower, (1e6,) * 3))
    assert bench.failed(report) == {"robot"}
    assert bench.check(report, "robot").where.endswith("whose values differ")
    assert "limit of joint jerk" not in to_text(report)
