"""The best place of a part, and the estimate that finds it."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deltacam.errors import InfeasibleError
from deltacam.pipeline import best_places, plan
from deltacam.placing.find import Found
from deltacam.robot.measures import tool_error_per_joint_error_in_plane
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot

DXF = Path(__file__).parents[1] / "data" / "dxf"
PART = DXF / "wrench-inch.dxf"


@pytest.fixture(scope="module")
def robot() -> Robot:
    """A robot with weak joints that waits in a corner of its sheet: there the place matters."""
    whole = load_robot("irb360-1600")
    joints = replace(whole.joints, max_acceleration=(20.0,) * 3, max_speed=(1.0,) * 3)
    return replace(whole, joints=joints, workspace=replace(whole.workspace, park=(0.4, 0.3)))


@pytest.fixture(scope="module")
def found(robot: Robot) -> Found:
    return best_places(PART, robot=robot)[0]


def test_the_planned_time_and_error_of_the_best_place_are_those_of_its_program(robot: Robot, found: Found) -> None:
    best = found.best[0]
    planned = plan(PART, robot=robot, at=best.spot.at, rotation=best.spot.rotation)
    assert planned.report.passed
    assert planned.program.duration == pytest.approx(best.time, abs=1e-9)
    program = planned.program
    tool = robot.forward(program.q[program.power > 0.0])
    assert tool_error_per_joint_error_in_plane(robot.geometry, tool).max() == pytest.approx(best.worst, rel=2e-3)


def test_a_robot_that_waits_in_a_corner_cuts_faster_nearer_to_it(robot: Robot) -> None:
    found, _ = best_places(PART, robot=robot, by="time")
    gain = found.gain(found.best[0])
    assert gain is not None
    assert gain[0] > 0.05
    assert np.dot(found.best[0].spot.at, robot.workspace.park) > 0.0


@pytest.mark.parametrize(("by", "name"), [("time", "time"), ("accuracy", "worst")])
def test_nothing_that_was_planned_beats_the_best_by_what_was_asked_for(robot: Robot, by: str, name: str) -> None:
    found, _ = best_places(PART, robot=robot, by=by)  # type: ignore[arg-type]
    values = [getattr(one, name) for one in found.best]
    assert values == sorted(values)
    assert found.centre in found.best


def test_the_estimate_ranks_places_as_planning_does(robot: Robot, found: Found) -> None:
    maps = found.maps
    rows, columns = np.nonzero(np.isfinite(maps.time))
    some = np.argsort(maps.time[rows, columns])[[0, len(rows) // 2, -1]]
    times = []
    for k in some:
        at = float(maps.x[columns[k]]), float(maps.y[rows[k]])
        times.append(plan(PART, robot=robot, at=at).program.duration)
    assert times == sorted(times)
    assert times[-1] > 1.2 * times[0]


def test_planning_with_auto_is_planning_at_the_best_place_byte_for_byte(robot: Robot, found: Found) -> None:
    best = found.best[0].spot
    auto = plan(PART, robot=robot, place="both")
    assert auto.content == plan(PART, robot=robot, at=best.at, rotation=best.rotation).content
    assert any(best.options in finding.what for finding in auto.report.findings)


def test_a_part_that_fits_only_turned_is_turned() -> None:
    whole = load_robot("delta-300")
    sheet = replace(whole.workspace, width=0.07, depth=0.07)
    small = replace(whole, workspace=sheet, joints=replace(whole.joints, max_jerk=None))
    with pytest.raises(InfeasibleError, match="leaves the sheet") as caught:
        plan(PART, robot=small)
    assert "turn it: --rotate" in caught.value.hint
    found, _ = best_places(PART, robot=small)
    assert found.excess > 5e-3
    assert found.centre is not None
    assert found.centre.spot.rotation > 0.0
    assert (found.maps.excess_by_turn > 0.0).any()
    assert plan(PART, robot=small, place="time").report.passed


def test_a_part_that_fits_nowhere_is_refused_by_how_much() -> None:
    whole = load_robot("delta-300")
    small = replace(whole, workspace=replace(whole.workspace, width=0.05, depth=0.05))
    with pytest.raises(InfeasibleError, match=r"fits nowhere .* mm, and that turned by") as caught:
        best_places(PART, robot=small)
    assert "--robot" in caught.value.hint
