"""A certificate means what it says."""

import math
from dataclasses import replace

import numpy as np
import pytest

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot.dimensions import DeltaGeometry, Mount
from deltacam.robot.reader import load_robot
from deltacam.robot.region.certify import Certificate, certify
from deltacam.robot.region.margins import margins
from deltacam.robot.region.requirements import Requirements
from deltacam.robot.region.shapes import Box, Cylinder, Region

DELTA_300 = load_robot("delta-300").geometry
BED = Box((-0.15, -0.15, -0.66), (0.15, 0.15, -0.64))
DRUM = Cylinder((0.02, -0.01), 0.2, -0.75, -0.6)
EASY = Requirements(-0.9, 1.7, 1.2, 1.2, 1.0, 0.1)


def inside(region: Region, count: int, seed: int = 1) -> Array:
    """Points all over a region, many on its surface."""
    rng = np.random.default_rng(seed)
    low, high = region.bounds
    wide = 1.3 * np.clip(rng.uniform(-1.3, 1.3, (count, 3)), -1.0, 1.0)
    return region.nearest((low + high) / 2.0 + wide * (high - low) / 2.0)


@pytest.mark.parametrize("region", [BED, DRUM, Box((-0.15, -0.15, -0.65), (0.15, 0.15, -0.65))])
def test_no_point_of_the_region_has_less_than_the_proved_margin(region: Region) -> None:
    certificate = certify(DELTA_300, region, EASY, tightness=0.9)
    assert certificate.certified
    found = margins(DELTA_300, EASY, inside(region, 50_000)).min(axis=0)
    for margin, least in zip(certificate.margins, found, strict=True):
        assert margin.low <= least
        assert 0.9 * margin.sampled <= margin.low <= margin.sampled


@pytest.mark.parametrize("region", [BED, DRUM])
def test_the_sampled_margin_is_that_of_its_point_which_is_in_the_region(region: Region) -> None:
    certificate = certify(DELTA_300, region, EASY)
    for column, margin in enumerate(certificate.margins):
        point = np.array([margin.point])
        assert region.nearest(point) == pytest.approx(point, abs=1e-15)
        assert margins(DELTA_300, EASY, point)[0, column] == margin.sampled


@pytest.mark.parametrize("name", ["joint_min", "joint_max", "max_mu1", "max_mu2", "max_swing", "min_inverse_condition"])
def test_a_requirement_is_certified_a_little_short_of_the_worst_and_refuted_a_little_beyond(name: str) -> None:
    column = {"max_mu1": "mu1", "max_mu2": "mu2", "max_swing": "swing"}.get(name, name.removeprefix("min_"))
    region, sense = BED, 1.0 if name in ("joint_min", "min_inverse_condition") else -1.0
    at = EASY.names.index(column)
    worst = getattr(EASY, name) + sense * margins(DELTA_300, EASY, inside(region, 50_000))[:, at].min()
    short, beyond = (replace(EASY, **{name: worst - sense * 1e-3 * side}) for side in (1.0, -1.0))
    assert certify(DELTA_300, region, short).verdict == "certified"
    refuted = certify(DELTA_300, region, beyond)
    assert (refuted.verdict, refuted.worst.name) == ("refuted", column)
    assert margins(DELTA_300, beyond, np.array([refuted.worst.point]))[0, at] < 0.0


def test_robots_that_pass_at_the_corners_are_refuted_where_they_fail_between_them() -> None:
    """The reason for all of this: of random robots that pass at the eight corners, some fail elsewhere."""
    rng = np.random.default_rng(7)
    box = Box((-0.1, -0.1, -0.1), (0.1, 0.1, 0.1))
    wanted = Requirements(math.radians(-50), math.radians(90), None, math.radians(60), None, 0.25)
    passed, refuted = 0, []
    for _ in range(160):
        base, upper, fore, height = rng.uniform((0.0, 0.1, 0.15, 0.2), (0.2, 0.35, 0.6, 0.6))
        geometry = DeltaGeometry(base, 0.0, upper, fore, mount=Mount(z=height))
        at_corners = margins(geometry, wanted, box.corners())
        if np.isnan(at_corners).any() or at_corners.min() < 0.0:
            continue
        passed += 1
        certificate = certify(geometry, box, wanted)
        truth = margins(geometry, wanted, inside(box, 2000))
        fails = bool(np.isnan(truth).any() or truth.min() < 0.0)
        assert not (certificate.certified and fails)
        if certificate.verdict == "refuted":
            worst = certificate.worst
            assert margins(geometry, wanted, np.array([worst.point])).min() < 0.0
            refuted.append(worst)
    assert len(refuted) >= 2
    assert len(refuted) < passed / 4


def test_a_region_out_of_reach_is_refuted_by_reach() -> None:
    certificate = certify(DELTA_300, Box((-0.15, -0.15, -1.2), (0.15, 0.15, -0.9)), EASY)
    assert certificate.verdict == "refuted"
    assert certificate.worst.name == "reach"


def test_a_region_that_reaches_the_base_is_refuted() -> None:
    assert certify(DELTA_300, Box((-0.05, -0.05, -0.6), (0.05, 0.05, 0.01)), Requirements()).verdict == "refuted"


def test_too_few_cells_leave_it_undecided() -> None:
    certificate = certify(DELTA_300, BED, EASY, tightness=0.999999, max_cells=200)
    assert certificate.verdict in ("certified", "undecided")
    hard = replace(EASY, min_inverse_condition=certificate.margins[-1].sampled + 0.1 - 1e-7)
    assert certify(DELTA_300, BED, hard, max_cells=200).verdict == "undecided"


def test_the_certificate_of_a_turned_and_moved_robot_is_that_of_the_robot() -> None:
    moved = replace(DELTA_300, mount=Mount(0.3, -0.2, 0.9, math.pi / 2, upside_down=False))
    there = Box((0.15, -0.35, 0.24), (0.45, -0.05, 0.26))
    lows = [[margin.low for margin in one.margins] for one in both(moved, there)]
    assert lows[0] == pytest.approx(lows[1], abs=1e-9)


def both(geometry: DeltaGeometry, region: Region) -> tuple[Certificate, Certificate]:
    return certify(DELTA_300, BED, EASY), certify(geometry, region, EASY)


def test_a_region_or_a_requirement_that_makes_no_sense_is_refused() -> None:
    with pytest.raises(RobotError, match="no box"):
        Box((0.1, 0.0, 0.0), (0.0, 0.0, 0.0))
    with pytest.raises(RobotError, match="no cylinder"):
        Cylinder((0.0, 0.0), 0.0, -1.0, -0.5)
    with pytest.raises(RobotError, match="not finite"):
        Requirements(max_mu1=math.nan)
    with pytest.raises(RobotError, match="not below"):
        Requirements(joint_min=1.0, joint_max=(2.0, 1.0, 2.0))
