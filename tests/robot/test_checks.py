"""A robot is refused when it cannot do over its whole sheet what its file says."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from deltacam.errors import RobotError
from deltacam.robot.checks import check_workspace
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.robot import Robot

ROBOT = load_robot("delta-300")


def with_sheet(robot: Robot = ROBOT, **changes: Any) -> Robot:
    return replace(robot, workspace=replace(robot.workspace, **changes))


def test_the_built_in_robots_keep_a_margin_everywhere() -> None:
    for name in profile_names():
        robot = load_robot(name)
        points = robot.workspace.grid()
        room = np.radians(5.0)
        assert robot.inverse(points).min() > robot.joints.min[0] + room
        assert robot.inverse(points).max() < robot.joints.max[0] - room
        assert max(mu.max() for mu in robot.pressure_angles(points)) < robot.workspace.max_pressure_angle - 2 * room
        assert robot.reach_margin(points).min() > 1.0


def test_a_sheet_out_of_reach_is_refused_with_the_missing_length() -> None:
    """Beneath the middle the missing length follows from one triangle; a tiny sheet is all middle."""
    missing_mm = 1e3 * (np.hypot(0.095, 1.1) - 1.0)
    with pytest.raises(RobotError, match="does not reach its whole sheet: 1 of 1 points") as caught:
        check_workspace(with_sheet(width=0.001, depth=0.001, sheet_z=-1.1))
    told = float(caught.value.what.split(" mm too far")[0].rsplit(" ", 1)[1])
    assert told == pytest.approx(missing_mm, abs=0.5)
    assert "sheet_z_mm" in caught.value.hint


def test_a_sheet_whose_corners_alone_are_out_of_reach_is_refused() -> None:
    with pytest.raises(RobotError, match=r"the worst is \(-?450\.000, -?450\.000, -800\.000\) mm"):
        check_workspace(with_sheet(width=0.9, depth=0.9, sheet_z=-0.8))


def test_a_place_between_the_corners_is_found() -> None:
    """All four corners are within the joint range, the middle of the sheet is not."""
    angles = ROBOT.inverse([[0.15 * x, 0.15 * y, -0.65] for x in (-1, 1) for y in (-1, 1)])
    sheet = ROBOT.inverse(ROBOT.workspace.grid(201))
    low = np.minimum(angles.min(axis=0), sheet.min(axis=0) + 1e-4)
    assert (angles.min(axis=0) > sheet.min(axis=0) + 1e-3).any()
    with pytest.raises(RobotError, match="min_deg"):
        check_workspace(replace(ROBOT, joints=replace(ROBOT.joints, min=tuple(low.tolist()))))


@pytest.mark.parametrize(("which", "sign"), [("max", 1), ("min", -1)])
def test_a_joint_range_is_held_to_a_hundredth_of_a_degree(which: str, sign: int) -> None:
    angles = sign * ROBOT.inverse(ROBOT.workspace.grid(301))
    worst = float(angles.max())
    enough, short = (sign * (worst + margin) for margin in (1e-5, -np.radians(0.01)))
    check_workspace(replace(ROBOT, joints=replace(ROBOT.joints, **{which: (enough,) * 3})))
    with pytest.raises(RobotError, match=rf"joint \d: {which}_deg .* is exceeded by 0\.01") as caught:
        check_workspace(replace(ROBOT, joints=replace(ROBOT.joints, **{which: (short,) * 3})))
    assert "with the tool at (" in caught.value.what
    assert caught.value.where == "workspace"


def test_each_joint_is_held_to_its_own_range() -> None:
    worst = ROBOT.inverse(ROBOT.workspace.grid(301)).max(axis=0)
    limits = (1.6, float(worst[1]) - 1e-3, 1.6)
    with pytest.raises(RobotError, match=r"joint 2: max_deg"):
        check_workspace(replace(ROBOT, joints=replace(ROBOT.joints, max=limits)))


def test_the_pressure_angles_are_held() -> None:
    mu1, mu2 = (mu.max() for mu in ROBOT.pressure_angles(ROBOT.workspace.grid(301)))
    check_workspace(with_sheet(max_pressure_angle=float(max(mu1, mu2)) + 1e-4))
    with pytest.raises(RobotError, match=r"max_pressure_angle_deg \(mu2\)"):
        check_workspace(with_sheet(max_pressure_angle=float(mu2) - 1e-4))
    irb_high_up = with_sheet(load_robot("irb360-1600"), sheet_z=-0.85, max_pressure_angle=np.radians(55.0))
    open_range = replace(irb_high_up, joints=replace(irb_high_up.joints, min=(-1.5,) * 3))
    with pytest.raises(RobotError, match=r"max_pressure_angle_deg \(mu1\)"):
        check_workspace(open_range)


def test_the_forearm_swing_is_held_where_it_is_limited() -> None:
    worst = float(ROBOT.forearm_swing(ROBOT.workspace.grid(301)).max())
    check_workspace(with_sheet(max_forearm_swing=worst + 1e-4))
    with pytest.raises(RobotError, match="max_forearm_swing_deg"):
        check_workspace(with_sheet(max_forearm_swing=worst - 1e-3))
