"""Blends: where they begin and end, and how far they go, against shapely."""

import numpy as np
import pytest
import shapely

from deltacam.geometry import clothoid
from deltacam.geometry import curve as curves
from deltacam.motion.blends import PIECES, RAMP, Blends, Joints, blend


def random_joints(seed: int, count: int = 200) -> tuple[Joints, np.ndarray]:
    rng = np.random.default_rng(seed)
    reach = 10.0 ** rng.uniform(-5.0, -3.0, count)
    angle = np.radians(rng.uniform(0.0, 150.0, count)) * rng.choice([-1.0, 1.0], count)
    angle[:40] = 0.0
    bends = np.where(rng.random((2, count)) < 0.5, 0.0, rng.uniform(-0.6, 0.6, (2, count)) / reach)
    return Joints(rng.normal(size=(count, 2)), rng.uniform(-3.0, 3.0, count), angle, *bends), reach


def along(blends: Blends, piece: int, share: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    start, heading, curvature, sharpness, length = (column[:, piece] for column in blends[:5])
    points, direction = clothoid.advance(start, heading, curvature, sharpness, share * length)
    return points, direction, curvature + sharpness * share * length


@pytest.mark.parametrize("seed", range(5))
def test_a_blend_continues_both_segments_in_place_direction_and_curvature(seed: int) -> None:
    joints, reach = random_joints(seed)
    blends = blend(joints, reach)
    assert np.isfinite(blends.deviation).all()
    begin, heading = curves.advance(joints.place, joints.heading, joints.before, -reach)
    end, direction = curves.advance(joints.place, joints.heading + joints.angle, joints.behind, reach)
    for piece in range(1, PIECES):
        for before, behind in zip(along(blends, piece - 1, 1.0), along(blends, piece, 0.0), strict=True):
            assert before == pytest.approx(behind, abs=1e-12, rel=1e-9)
    for found, wanted in zip(along(blends, 0, 0.0), (begin, heading, joints.before), strict=True):
        assert found == pytest.approx(wanted, abs=1e-13)
    for found, wanted in zip(along(blends, PIECES - 1, 1.0), (end, direction, joints.behind), strict=True):
        assert found == pytest.approx(wanted, abs=1e-9, rel=1e-9)
    assert blends.length[:, 0] / blends.length.sum(axis=1) == pytest.approx(RAMP)


@pytest.mark.parametrize("seed", range(5))
def test_the_deviation_is_the_distance_between_the_blend_and_the_drawn_line(seed: int) -> None:
    joints, reach = random_joints(10 + seed, 60)
    blends = blend(joints, reach)
    points = np.stack([along(blends, piece, share)[0] for piece in range(PIECES) for share in np.linspace(0, 1, 400)])
    way = np.linspace(0.0, 1.3, 3000)
    for joint in range(60):
        every = np.full(3000, joint)
        place, bends = joints.place[every], (joints.before[every], joints.behind[every])
        before, _ = curves.advance(place, joints.heading[every], bends[0], -reach[joint] * way[::-1])
        behind, _ = curves.advance(place, (joints.heading + joints.angle)[every], bends[1], reach[joint] * way)
        drawn = shapely.LineString(np.concatenate([before, behind[1:]]))
        off = shapely.distance(shapely.points(points[:, joint]), drawn).max()
        off = max(off, shapely.distance(shapely.points(joints.place[joint]), shapely.LineString(points[:, joint])))
        assert off * 0.998 - 1e-10 <= blends.deviation[joint] <= off * 1.02 + 1e-10


def test_a_joint_that_turns_back_has_no_blend() -> None:
    joints = Joints(np.zeros((1, 2)), np.zeros(1), np.array([np.pi]), np.zeros(1), np.zeros(1))
    assert not np.isfinite(blend(joints, np.array([1e-4])).deviation).any()
