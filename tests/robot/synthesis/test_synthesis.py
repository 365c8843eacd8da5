"""Designs for prescribed workspaces: as small as published ones, and true."""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from benchmarks.design import BOXES, classic_inverse, sample
from deltacam.errors import RobotError
from deltacam.robot import kinematics
from deltacam.robot.reader import load_robot
from deltacam.robot.region.certify import certify
from deltacam.robot.synthesis.demands import demands, excesses
from deltacam.robot.synthesis.front import front
from deltacam.robot.synthesis.machine import machine
from deltacam.robot.synthesis.polish import fine_cube, polish
from deltacam.robot.synthesis.search import Problem, decode, encode, search
from deltacam.robot.synthesis.shape import BoxShape, CylinderShape
from deltacam.robot.synthesis.synthesis import Design, design, geometry_of, region_of, requirements_of
from deltacam.robot.synthesis.wish import Wish
from deltacam.robot.writer import to_toml

CUBE, BOUND = BOXES["cube, 200 mm"]
ROUND = Wish(
    CylinderShape(0.3, 0.05),
    base_radius_min=0.12,
    head_radius=0.04,
    speed=1.0,
    acceleration=23.0,
    max_joint_acceleration=150.0,
    max_error=1e-4,
    encoder_step=2e-4,
)


@pytest.fixture(scope="module")
def cube() -> Design:
    return design(Wish(CUBE), seed=1)


@pytest.fixture(scope="module")
def disc() -> Design:
    return design(ROUND)


def test_the_cube_takes_no_larger_robot_than_published(cube: Design) -> None:
    assert cube.size <= BOUND
    assert cube.certificate.certified


def test_other_formulas_find_no_point_of_the_cube_that_misses_a_demand(cube: Design) -> None:
    found = sample(cube, 40_000)
    assert found.keeps(cube.wish)
    assert found.inverse_condition == pytest.approx(0.33, abs=2e-3)  # and the demand is really at its limit


def test_the_other_formulas_are_those_of_the_robot(cube: Design) -> None:
    points = np.random.default_rng(2).uniform(-0.1, 0.1, (500, 3)) + np.array([0.0, 0.0, cube.middle])
    lengths = tuple(float(value) for value in cube.candidate[:3])
    found = classic_inverse((lengths[0], lengths[1], lengths[2]), points)
    assert found == pytest.approx(kinematics.inverse(cube.geometry, points), abs=1e-9)


def test_corners_alone_accept_a_design_that_is_refused_here() -> None:
    """The smallest joint angle near the best robot for the cube is on a face, between the corners."""
    wish = Wish(CUBE)
    found = demands(wish)
    corners = np.stack(np.meshgrid([-0.1, 0.1], [-0.1, 0.1], [-0.1, 0.1]), axis=-1).reshape(-1, 3)
    start = np.array([-0.0413, 0.2042, 0.2317, -0.1753])
    near = start + np.random.default_rng(3).normal(0.0, 0.002, (2000, 4))
    accepted = near[excesses(found, near, corners).max(axis=(0, 2)) <= 0.0]
    everywhere = excesses(found, accepted, CUBE.place(fine_cube())).max(axis=(0, 2))
    row = accepted[everywhere.argmax()]
    assert (everywhere > 1e-3).sum() > 5
    assert certify(geometry_of(wish, row), region_of(wish, row[3]), requirements_of(wish)).verdict == "refuted"


def test_no_demand_of_a_design_is_missed_and_one_binds(cube: Design, disc: Design) -> None:
    for found in (cube, disc):
        assert any(finding.binding for finding in found.findings)
        for finding in found.findings:
            limit, value = finding.demand.limit, finding.value
            assert value >= limit if finding.demand.at_least else value <= limit


def test_motors_and_head_have_their_room(disc: Design) -> None:
    assert disc.geometry.effector_radius == pytest.approx(0.04)
    assert disc.geometry.base_radius == pytest.approx(0.12)
    assert "the base is as small as its motors allow" in disc.bounds


def test_the_same_seed_gives_the_same_robot() -> None:
    wish = Wish(BoxShape(0.1, 0.1, 0.02))
    problem = Problem(wish, demands(wish))
    one, two = (polish(problem, search(problem, seed=4)) for _ in range(2))
    assert one.tolist() == two.tolist()


def test_a_design_is_a_robot_that_loads(disc: Design, tmp_path: Path) -> None:
    robot = machine(disc, name="disc")
    file = tmp_path / "disc.toml"
    file.write_text(to_toml(robot))
    loaded = load_robot(file)
    assert loaded.geometry == robot.geometry
    assert loaded.workspace == robot.workspace
    assert loaded.joints.max_acceleration == pytest.approx((150.0,) * 3)
    with pytest.raises(RobotError, match="is not within the workspace"):
        machine(disc, name="disc", sheet_z=disc.middle + 0.03)


def test_an_impossible_wish_says_what_and_how_near() -> None:
    wish = Wish(CUBE, min_inverse_condition=0.95, max_transmission_angle=math.radians(5.0))
    with pytest.raises(RobotError, match=r"no robot up to 1732 mm .*1/cond >= 0.95: 0.94\d* at best") as refused:
        design(wish)
    assert "--max-size" in refused.value.hint


def test_more_dexterity_takes_a_larger_robot() -> None:
    wish = Wish(BoxShape(0.1, 0.1, 0.02))
    found = front(wish, row=(0.6, 0.3))
    assert [one.wish.min_inverse_condition for one in found.designs] == [0.3, 0.6]
    assert found.designs[0].size < found.designs[1].size
    harder = replace(wish, min_inverse_condition=0.6)
    problem = Problem(harder, demands(harder))
    alone = polish(problem, search(problem, seed=7))
    assert found.designs[1].size == pytest.approx(alone[:3].sum(), rel=2e-3)


def test_unknowns_and_dimensions_are_one_to_one() -> None:
    rows = np.array([[0.03, 0.2, 0.4, -0.3], [-0.05, 0.2, 0.25, -0.1]])
    assert decode(encode(rows)) == pytest.approx(rows)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"min_inverse_condition": 1.0}, "min_inverse_condition = 1 is outside 0.001 to 0.999"),
        ({"joint_min": 1.6}, "is not below joint_max 90 deg"),
        ({"max_error": 1e-4}, "max_error is given without encoder_step"),
        ({"head_radius": float("nan")}, "head_radius = nan mm is outside"),
    ],
)
def test_a_wish_that_makes_no_sense_is_refused(given: dict[str, float], message: str) -> None:
    with pytest.raises(RobotError, match=message):
        Wish(CUBE, **given)
