"""What is said of a whole cell is true of every pose in it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot import kinematics, measures
from deltacam.robot.dimensions import DeltaGeometry, Mount
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.region.margins import cell_margins, margins
from deltacam.robot.region.pose_bounds import STEADY, pose_bounds
from deltacam.robot.region.requirements import Requirements

ALL = Requirements(-1.0, (1.2, 1.3, 1.4), 1.0, 1.1, 0.6, 0.3)
QUANTITIES = ("angle", "along", "aside", "mu2", "inverse_condition")


@st.composite
def geometries(draw: st.DrawFn) -> DeltaGeometry:
    """Robots of many proportions, some with unlike arms, turned, moved or upside down."""
    lengths = st.floats(0.1, 0.5)
    upper = draw(lengths)
    fore = draw(st.tuples(*[st.floats(1.0, 3.0)] * 3))
    base = draw(st.floats(0.0, 0.4))
    mount = Mount(
        draw(st.floats(-0.1, 0.1)), 0.05, draw(st.floats(0.0, 1.0)), draw(st.floats(-3.0, 3.0)), draw(st.booleans())
    )
    azimuths = draw(st.sampled_from([(-1.5, 0.5, 2.6), (2.6, 0.5, -1.5), (0.0, 1.8, 3.4)]))
    same = draw(st.booleans())
    forearm = upper * fore[0] if same else tuple(upper * ratio for ratio in fore)
    return DeltaGeometry(base, 0.1, upper, forearm, azimuths, mount)


def cells_of(geometry: DeltaGeometry, seed: int, count: int = 40) -> tuple[Array, Array, Array]:
    """Middles, a half side, and poses of each cell, many on its faces and corners: (N, 3), (3,), (M, N, 3)."""
    rng = np.random.default_rng(seed)
    size = float(geometry.forearms.max())
    depth = rng.uniform(0.2, 1.5, count) * size
    wide = rng.uniform(-0.8, 0.8, (count, 2)) * size
    middles = geometry.centre + np.column_stack((wide, -geometry.up * depth))
    half = size * 10.0 ** rng.uniform(-3.5, -0.8) * rng.uniform(0.0, 1.0, 3) ** 2
    within = np.clip(rng.uniform(-1.6, 1.6, (60, 1, 3)), -1.0, 1.0)
    return middles, half, middles + within * half


@given(geometries(), st.integers(0, 10_000))
@settings(max_examples=60, deadline=None)
def test_no_pose_of_a_cell_leaves_its_bounds(geometry: DeltaGeometry, seed: int) -> None:
    middles, half, poses = cells_of(geometry, seed)
    bounds = pose_bounds(geometry, middles, half)
    at = pose_bounds(geometry, poses.reshape(-1, 3), np.zeros(3))
    assert_within(bounds.reach, at.reach.at.reshape(len(poses), len(middles), -1))
    for name in QUANTITIES:
        values = getattr(at, name).at.reshape(len(poses), len(middles), -1)[:, bounds.steady]
        assert_within(type(bounds.reach)(*(part[bounds.steady] for part in getattr(bounds, name))), values)
    assert (at.along.at.reshape(len(poses), len(middles), 3)[:, bounds.steady] > STEADY).all()


def assert_within(interval: tuple[Array, Array, Array], values: Array) -> None:
    _, low, high = (part.reshape(len(part), values.shape[2]) for part in interval)
    slack = 1e-12 * (1.0 + np.abs(values))
    assert (values >= low - slack).all()
    assert (values <= high + slack).all()


@given(geometries(), st.integers(0, 10_000))
@settings(max_examples=30, deadline=None)
def test_no_pose_of_a_cell_leaves_the_bounds_of_its_margins(geometry: DeltaGeometry, seed: int) -> None:
    middles, half, poses = cells_of(geometry, seed)
    _, low, high = cell_margins(geometry, ALL, middles, half)
    found = margins(geometry, ALL, poses.reshape(-1, 3)).reshape(len(poses), *low.shape)
    assert not (found < low).any()
    assert not (found[..., 1:] > high[:, 1:]).any()


@pytest.mark.parametrize("name", profile_names())
def test_a_cell_without_size_is_the_pose_itself(name: str) -> None:
    robot = load_robot(name)
    points = robot.workspace.grid(11) + robot.geometry.up * np.array([0.0, 0.0, -0.02])
    bounds = pose_bounds(robot.geometry, points, np.zeros(3))
    mu1, mu2 = measures.pressure_angles(robot.geometry, points)
    truth = {
        "reach": kinematics.reach_margin(robot.geometry, points),
        "angle": kinematics.inverse(robot.geometry, points),
        "along": np.cos(mu1),
        "aside": np.sin(measures.forearm_swing(robot.geometry, points)),
        "mu2": mu2,
        "inverse_condition": measures.inverse_condition(robot.geometry, points),
    }
    for quantity, values in truth.items():
        for part in getattr(bounds, quantity):
            shown = part[:, :3] if quantity == "reach" else part
            assert shown.ravel() == pytest.approx(values.ravel(), abs=1e-12), quantity


def test_small_cells_are_bounded_closely() -> None:
    """To second order, but the sizes of matrices and the turns of planes, which are bounded by their norms."""
    robot = load_robot("delta-300")
    middles, half = robot.workspace.grid(5) + np.array([0.011, 0.007, 0.0]), np.full(3, 1e-4)
    corners = np.stack(np.meshgrid(*[[-1.0, 1.0]] * 3), axis=-1).reshape(-1, 1, 3) * half + middles
    bounds = pose_bounds(robot.geometry, middles, half)
    at = pose_bounds(robot.geometry, corners.reshape(-1, 3), np.zeros(3))
    for name in ("reach", "angle", "along", "aside"):
        _, low, high = getattr(bounds, name)
        found = getattr(at, name).at.reshape(8, *low.shape)
        assert (found.min(axis=0) - low).max() < 1e-3 * (high - low).max(), name


def test_mu2_is_above_90_degrees_where_the_forward_kinematics_gives_another_pose() -> None:
    """There the tool is above the plane of the elbows, where no motion leads from below."""
    geometry = DeltaGeometry(0.12, 0.05, 0.3, 0.32)
    points = np.random.default_rng(4).uniform([-0.1, -0.1, -0.5], [0.1, 0.1, -0.01], (4000, 3))
    bounds = pose_bounds(geometry, points, np.zeros(3))
    usual = bounds.steady & (np.abs(bounds.angle.at) < np.pi / 2).all(axis=1)  # the elbows go round as the base does
    points, mu2 = points[usual], bounds.mu2.at[usual]
    beyond = mu2.max(axis=1) > np.pi / 2
    assert 100 < beyond.sum() < len(points) - 100
    assert np.allclose(kinematics.forward(geometry, kinematics.inverse(geometry, points[~beyond])), points[~beyond])
    for point in points[beyond]:
        try:
            other = kinematics.forward(geometry, kinematics.inverse(geometry, point[np.newaxis]))[0]
        except RobotError:
            continue
        assert np.linalg.norm(other - point) > 1e-9
