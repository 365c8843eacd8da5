"""The usable region and the largest regions in it, against points without number."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.errors import RobotError
from deltacam.robot import kinematics, measures
from deltacam.robot.dimensions import Mount
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.region.largest import largest_region
from deltacam.robot.region.margins import margins
from deltacam.robot.region.shapes import Cylinder
from deltacam.robot.region.survey import cut, poses_at, survey
from deltacam.robot.region.usable import Usable, requirements_of, usable_region, whole_reach
from deltacam.robot.robot import Robot

ROBOTS = {name: load_robot(name) for name in profile_names()}
FEW = 30_000


@pytest.fixture(params=["delta-300", "irb360-1600"], scope="module")
def robot(request: pytest.FixtureRequest) -> Robot:
    return ROBOTS[request.param]


@pytest.fixture(scope="module")
def usable(robot: Robot) -> Usable:
    return usable_region(robot.geometry, requirements_of(robot), max_cells=FEW)


def test_the_proved_volumes_hold_that_of_random_points(robot: Robot, usable: Usable) -> None:
    low, high = whole_reach(robot.geometry).bounds
    points = np.random.default_rng(3).uniform(low, high, (200_000, 3))
    kept = (margins(robot.geometry, requirements_of(robot), points) >= 0.0).all(axis=1)
    whole = float((high - low).prod())
    spread = whole * np.sqrt(kept.mean() / len(points))
    assert usable.low < whole * kept.mean() + 4 * spread
    assert whole * kept.mean() - 4 * spread < usable.high
    assert (points[kept] >= usable.bounds[0]).all()
    assert (points[kept] <= usable.bounds[1]).all()
    poses, each = survey(robot.geometry, requirements_of(robot), usable.bounds)
    assert each * poses.kept.sum() == pytest.approx(whole * kept.mean(), rel=0.03)


def test_every_pose_of_a_cell_inside_is_usable(robot: Robot, usable: Usable) -> None:
    shifts = np.clip(np.random.default_rng(5).uniform(-1.5, 1.5, (40, len(usable.inside), 3)), -1.0, 1.0)
    points = (usable.inside + shifts * usable.halves).reshape(-1, 3)
    assert len(points) > 1000
    assert (margins(robot.geometry, requirements_of(robot), points) > 0.0).all()


def test_the_arms_reach_nothing_outside_of_the_whole_reach(robot: Robot) -> None:
    low, high = whole_reach(robot.geometry).bounds
    size = high - low
    points = np.random.default_rng(6).uniform(low - size / 5, high + size / 5, (50_000, 3))
    outside = ((points < low) | (points > high)).any(axis=1) & (points[:, 2] < 0.0)
    assert (kinematics.reach_margin(robot.geometry, points[outside]).min(axis=1) < 0.0).all()


@pytest.mark.parametrize("wish", [{}, {"ratio": 1.0, "height": 0.02}], ids=["cylinder", "flat box"])
def test_the_largest_region_is_certified_and_a_larger_one_is_not_usable(wish: dict[str, float]) -> None:
    robot = ROBOTS["delta-300"]
    wanted = requirements_of(robot)
    usable = usable_region(robot.geometry, wanted, max_cells=FEW)
    found = largest_region(robot.geometry, wanted, usable.bounds, **wish)
    assert found.certificate.certified
    low, high = found.region.bounds
    spread = np.clip(np.random.default_rng(8).uniform(-0.8, 0.8, (200_000, 3)), -0.5, 0.5)
    points = (low + high) / 2.0 + spread * (high - low)
    assert (margins(robot.geometry, wanted, found.region.nearest(points)) >= 0.0).all()
    larger = (low + high) / 2.0 + spread * (high - low) * [1.03, 1.03, 1.0]
    if isinstance(found.region, Cylinder):
        larger = larger[np.hypot(larger[:, 0], larger[:, 1]) <= 1.03 * found.region.radius]
    assert not (margins(robot.geometry, wanted, larger) >= 0.0).all()
    if "height" in wish:
        assert high[2] - low[2] == pytest.approx(wish["height"])


def test_a_region_that_cannot_be_is_refused() -> None:
    robot = ROBOTS["delta-300"]
    usable = usable_region(robot.geometry, requirements_of(robot), max_cells=FEW)
    with pytest.raises(RobotError, match="no cylinder 900 mm high"):
        largest_region(robot.geometry, requirements_of(robot), usable.bounds, height=0.9)


def test_the_poses_are_measured_as_everywhere_else(robot: Robot) -> None:
    points = robot.workspace.grid(9)
    poses = poses_at(robot.geometry, requirements_of(robot), points)
    jacobian = np.linalg.inv(kinematics.inverse_jacobian(robot.geometry, points))
    assert poses.kept.all()
    assert poses.manipulability == pytest.approx(np.abs(np.linalg.det(jacobian)))
    assert poses.tool_error == pytest.approx(np.linalg.norm(jacobian, 2, axis=(1, 2)))
    assert poses.inverse_condition == pytest.approx(measures.inverse_condition(robot.geometry, points))
    assert poses.angles == pytest.approx(robot.inverse(points))


def test_a_slice_knows_its_area(robot: Robot, usable: Usable) -> None:
    one = cut(robot.geometry, requirements_of(robot), usable.bounds, axes=(0, 1), at=robot.workspace.sheet_z)
    rng = np.random.default_rng(9)
    size = usable.bounds[1, :2] - usable.bounds[0, :2]
    xy = usable.bounds[0, :2] + rng.uniform(0.0, 1.0, (50_000, 2)) * size
    points = np.column_stack((xy, np.full(len(xy), robot.workspace.sheet_z)))
    kept = (margins(robot.geometry, requirements_of(robot), points) >= 0.0).all(axis=1)
    assert one.area == pytest.approx(float(size.prod() * kept.mean()), rel=0.03)


def test_a_robot_that_stands_upside_down_elsewhere_has_the_same_volume() -> None:
    robot = ROBOTS["delta-300"]
    moved = replace(robot.geometry, mount=Mount(0.2, -0.1, -1.3, 0.0, upside_down=True))
    ours, theirs = (usable_region(one, requirements_of(robot), max_cells=FEW) for one in (robot.geometry, moved))
    assert (theirs.low, theirs.high) == pytest.approx((ours.low, ours.high), rel=0.02)  # other cells
