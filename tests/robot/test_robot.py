"""The robot's values: bounds hold however it is built, and the fingerprint follows every value that moves it."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.errors import RobotError
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Controller, JointLimits, Robot, ToolRating

ROBOT = load_robot("delta-300")


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -0.1, 11.0])
@pytest.mark.parametrize("name", ["base_radius", "effector_radius", "upper_arm", "forearm"])
def test_a_dimension_out_of_bounds_is_refused(name: str, bad: float) -> None:
    with pytest.raises(RobotError, match=rf"{name} = .* m is outside 0.* to 10") as caught:
        replace(ROBOT.geometry, **{name: bad})
    assert caught.value.where == "geometry"


@pytest.mark.parametrize("name", ["min", "max", "max_speed", "max_acceleration", "max_jerk"])
def test_a_joint_limit_that_is_not_finite_is_refused(name: str) -> None:
    with pytest.raises(RobotError, match=f"{name} = nan"):
        replace(ROBOT.joints, **{name: (1.0, float("nan"), 1.0)})


def test_a_joint_without_range_is_refused() -> None:
    with pytest.raises(RobotError, match="joint 2: min 90 deg is not below max 90 deg"):
        JointLimits((0.0, np.pi / 2, 0.0), (np.pi / 2,) * 3, (1.0,) * 3, (1.0,) * 3)


@pytest.mark.parametrize(("speed", "acceleration"), [(0.0, 1.0), (1.0, float("inf")), (17.0, 1.0), (1.0, 10_001.0)])
def test_a_rating_out_of_bounds_is_refused(speed: float, acceleration: float) -> None:
    with pytest.raises(RobotError, match="is outside"):
        ToolRating(speed, acceleration)


def test_a_controller_has_a_rate_and_a_known_interpolation() -> None:
    assert Controller(1000.0, "cubic").interpolation == "cubic"
    with pytest.raises(RobotError, match="rate_hz"):
        Controller(0.0)
    with pytest.raises(RobotError, match="is not linear or cubic"):
        Controller(400.0, "quintic")  # type: ignore[arg-type]


@pytest.mark.parametrize("name", ["", "two\nlines", "x" * 201])
def test_a_name_is_one_line(name: str) -> None:
    with pytest.raises(RobotError, match="name must be one line"):
        replace(ROBOT, name=name)


def changed_by_a_micrometre() -> list[Robot]:
    geometry, sheet = ROBOT.geometry, ROBOT.workspace
    return [
        replace(ROBOT, geometry=replace(geometry, **{name: getattr(geometry, name) + 1e-6}))
        for name in ("base_radius", "effector_radius", "upper_arm", "forearm")
    ] + [
        replace(ROBOT, workspace=replace(sheet, **{name: getattr(sheet, name) + 1e-6}))
        for name in ("sheet_z", "width", "depth")
    ]


def test_the_fingerprint_changes_when_anything_changes_by_a_micrometre() -> None:
    robots = [ROBOT, *changed_by_a_micrometre()]
    robots.append(replace(ROBOT, tool=replace(ROBOT.tool, max_speed=1.0 + 1e-9)))
    robots.append(replace(ROBOT, joints=replace(ROBOT.joints, max_jerk=(1e5, 1e5, 1e5))))
    robots.append(replace(ROBOT, controller=replace(ROBOT.controller, interpolation="cubic")))
    prints = {robot.fingerprint for robot in robots}
    assert len(prints) == len(robots)
    assert all(len(text) == 64 and int(text, 16) for text in prints)


def test_the_fingerprint_does_not_change_with_what_does_not_move_the_robot() -> None:
    named = replace(ROBOT, name="other", description="other", source="other", joints=replace(ROBOT.joints, derived=()))
    assert named.fingerprint == ROBOT.fingerprint
    minus_zero = replace(ROBOT, workspace=replace(ROBOT.workspace, park=(-0.0, 0.0)))
    assert minus_zero.fingerprint == ROBOT.fingerprint


def test_robots_that_move_alike_are_equal() -> None:
    assert replace(ROBOT, source="other", joints=replace(ROBOT.joints, derived=())) == ROBOT
    assert replace(ROBOT, geometry=DeltaGeometry(0.13, 0.035, 0.3, 0.7)) == ROBOT
    assert changed_by_a_micrometre()[0] != ROBOT
