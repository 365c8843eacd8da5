"""What differs between two programs is found, and nothing else."""

from dataclasses import replace

import pytest

from deltacam.program.program import Program
from deltacam.report import difference as report
from deltacam.robot.dimensions import Mount
from deltacam.verification.difference import Difference, difference
from deltacam.verification.verify import verify
from tests.bench import Bench


def between(bench: Bench, one: Program, other: Program) -> Difference:
    reports = (verify(one, drawing=bench.drawing), verify(other, drawing=bench.drawing))
    return difference((one, other), reports)


def test_a_program_does_not_differ_from_itself(bench: Bench, program: Program) -> None:
    found = between(bench, program, program)
    assert (found.settings, found.checks) == ({}, {})
    assert [one.distance for one in found.contours] == [pytest.approx(0.0, abs=1e-12)] * 4
    assert report.to_text(found).splitlines()[2:] == ["  4 contours are cut alike"]


def test_the_largest_distance_of_a_contour_is_that_of_the_setpoint_that_moved(bench: Bench, program: Program) -> None:
    found = between(bench, program, bench.shifted_outwards(program, 50e-6))
    distances = {one.contour: one.distance for one in found.contours}
    assert distances.pop(2) == pytest.approx(50e-6, rel=1e-3)
    assert max(distances.values()) < 1e-12
    assert "deviation at ticks" in found.checks
    assert "contour 2 (layer CUT): 50 um apart" in report.to_text(found)


def test_a_check_whose_worst_value_hardly_differs_has_no_line(bench: Bench, program: Program) -> None:
    found = between(bench, program, replace(program, q=program.q + 1e-10))
    assert "joint range (at least)" in found.checks
    assert "joint range (at least)" not in report.to_text(found)
    assert "joint range (at least)" in {check["name"] for check in report.to_dict(found)["checks"]}


def test_settings_are_named_with_both_values(bench: Bench, program: Program) -> None:
    process = replace(program.process, feed=0.2)
    robot = replace(program.robot, geometry=replace(program.robot.geometry, forearm=0.71))
    found = between(bench, program, replace(program, process=process, robot=robot))
    assert found.settings == {
        "process.feed": (program.process.feed, 0.2),
        "robot.geometry.forearm": (program.robot.geometry.forearm, 0.71),
    }


@pytest.mark.parametrize("mounted_first", [True, False])
def test_a_base_that_is_mounted_in_one_of_them_is_said(bench: Bench, program: Program, mounted_first: bool) -> None:
    geometry = replace(program.robot.geometry, mount=Mount(rotation=1e-3))
    mounted = replace(program, robot=replace(program.robot, geometry=geometry))
    pair = (mounted, program) if mounted_first else (program, mounted)
    shown = between(bench, *pair).settings["robot.geometry.mount"]
    assert shown[mounted_first] is None
    assert shown[not mounted_first]["rotation"] == 1e-3


def test_another_order_and_a_missing_contour_are_said(bench: Bench, program: Program) -> None:
    found = between(bench, program, bench.but(order=(3, 4, 1)).program())
    places = {one.contour: one.places for one in found.contours}
    assert places == {1: (4, 3), 2: (3, None), 3: (2, 1), 4: (1, 2)}
    text = report.to_text(found)
    assert "contour 2 (layer CUT): only in the first program" in text
    assert ", cut as number 2 -> 1" in text
    assert report.to_dict(found)["contours"][1]["time_s"][1] is None


def test_a_program_out_of_reach_is_compared_without_positions(bench: Bench, program: Program) -> None:
    q = program.q.copy()
    q[700] = -3.0
    found = between(bench, program, replace(program, q=q))
    assert {one.distance for one in found.contours} == {None}
    assert "possible poses: ok -> FAIL" in report.to_text(found)
    assert "no positions" in report.to_text(found)
