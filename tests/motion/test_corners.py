"""Corners, against distances measured by shapely."""

import itertools

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.model import Curve
from deltacam.motion.corners import pieces
from deltacam.motion.path import Path
from tests.strategies import rectangle, slot, star_curves

DEVIATION = 17e-6


def flat(curve: Curve) -> np.ndarray:
    points, _ = curves.flatten(curve, 1e-8)
    return np.concatenate([points, points[:1]]) if curve.closed else points


def smooth(
    curve: Curve, *, corner: str = "round", deviation: float = DEVIATION, ramps: bool = False
) -> tuple[Path, ...]:
    return pieces(curve, corner=corner, deviation=deviation, ramps=ramps, z=-0.65)


def driven(path: Path) -> np.ndarray:
    """Points on the path, close enough to each other that chords leave it by less than 10 nm."""
    steps = np.maximum(2, np.ceil(path.length * np.sqrt(path.sharpest / 8e-8)).astype(int) + 1)
    segment = np.repeat(np.arange(len(steps)), steps)
    share = np.concatenate([np.linspace(0.0, 1.0, count) for count in steps])
    return path.evaluate(segment, share * path.length[segment])[0][:, :2]


def ends(path: Path) -> tuple[np.ndarray, ...]:
    """Position, direction and curvature at the end of every segment but the last, and at the start of the next."""
    segment = np.arange(len(path.length) - 1)
    before, behind = path.evaluate(segment, path.length[:-1]), path.evaluate(segment + 1, np.zeros(len(segment)))
    return tuple(np.linalg.norm(one - other, axis=1) for one, other in zip(before, behind, strict=True))


def worst_kink(path: Path) -> float:
    place, kink, _, _ = ends(path)
    assert place.max(initial=0.0) < 1e-11
    return float(kink.max(initial=0.0))


def sharpest(path: Path) -> float:
    return float(path.sharpest.max())


@settings(max_examples=150)
@given(star_curves(low=1e-3, high=40e-3), st.floats(1e-6, 1e-4), st.booleans())
def test_rounded_corners_leave_a_smooth_path_within_the_deviation(curve: Curve, deviation: float, ramps: bool) -> None:
    assume(curves.lengths(curve).min() > 1e-5)
    parts = smooth(curve, deviation=deviation, ramps=ramps)
    drawn = shapely.LineString(flat(curve))
    line = np.concatenate([driven(part) for part in parts])
    assert shapely.distance(shapely.points(line), drawn).max() <= deviation + 2e-8
    assert shapely.distance(shapely.points(flat(curve)), shapely.LineString(line)).max() <= deviation + 2e-8
    assert max(worst_kink(part) for part in parts) < 1e-5
    assert line[0] == pytest.approx(curve.points[0])
    assert line[-1] == pytest.approx(curve.points[0])
    if ramps:
        jumps = np.concatenate([ends(part)[2] for part in parts])
        assert jumps.max(initial=0.0) < 2e-3


@pytest.mark.parametrize("seed", range(40))
def test_polygons_of_every_angle_and_size_become_drivable(seed: int) -> None:
    rng = np.random.default_rng(seed)
    turns = np.radians(rng.uniform(1.0, 179.0, 25)) * rng.choice([-1.0, 1.0], 25)
    edges = 10.0 ** rng.uniform(np.log10(5e-5), -1.0, 25)
    heading = np.cumsum(turns)
    points = np.cumsum(edges[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=1), axis=0)
    parts = smooth(curves.polygon(points))
    assert sum(part.total for part in parts) <= edges.sum() + float(np.hypot(*(points[-1] - points[0])))
    assert all(worst_kink(part) < 1e-5 and part.length.min() > 0.0 for part in parts)
    for before, after in itertools.pairwise(parts):
        assert driven(before)[-1] == pytest.approx(driven(after)[0], abs=1e-12)


def test_a_right_angle_gets_the_largest_blend_that_the_deviation_allows() -> None:
    square = curves.start_at(rectangle(0.06, 0.04), 0, 0.03)
    (part,) = smooth(square)
    line = shapely.LineString(driven(part))
    assert shapely.distance(shapely.points(square.points[1:]), line) == pytest.approx(DEVIATION, rel=0.02)
    assert np.count_nonzero(part.sharpness) == 12 - 4  # four blends of three clothoids, the middle one an arc


def test_a_blend_rises_to_one_curvature_and_falls_again() -> None:
    (part,) = smooth(curves.start_at(rectangle(0.06, 0.04), 0, 0.03))
    before, plateau, end_of_plateau, behind = part.curvature[1:5]
    assert (before, behind) == pytest.approx((0.0, 0.0), abs=1e-6)
    assert plateau == pytest.approx(end_of_plateau, rel=1e-6)
    assert plateau > 1e4


def test_stopping_keeps_the_corner_and_ends_a_piece_there() -> None:
    square = curves.start_at(rectangle(0.06, 0.04), 0, 0.03)
    parts = smooth(square, corner="stop")
    assert [driven(part)[[0, -1]] for part in parts][1:4] == [
        pytest.approx(np.array(edge), abs=1e-12)
        for edge in ([[0.06, 0.0], [0.06, 0.04]], [[0.06, 0.04], [0.0, 0.04]], [[0.0, 0.04], [0.0, 0.0]])
    ]


def test_stopping_passes_what_is_no_corner() -> None:
    polygon = curves.polygon(np.array([[np.cos(a), np.sin(a)] for a in np.radians(np.arange(360))]) * 0.03)
    assert len(smooth(polygon, corner="stop")) == 1
    assert len(smooth(slot(0.04, 0.01), corner="stop")) == 1


def test_a_path_that_turns_back_on_itself_stops_there() -> None:
    spike = curves.polygon(np.array([[0.0, 0.0], [0.02, 0.0], [0.0, 1e-9], [-0.01, 0.01]]))
    assert len(smooth(spike)) == 3  # it turns back at two corners


def test_no_deviation_means_a_stop_at_every_corner() -> None:
    assert len(smooth(rectangle(0.06, 0.04), deviation=0.0)) == 4


def test_slivers_are_left_out() -> None:
    points = np.array([[0.0, 0.0], [0.03, 0.0], [0.03, 2e-7], [0.03, 0.03], [0.0, 0.03], [-3e-7, 1e-7]])
    (part,) = smooth(curves.polygon(points))
    assert part.length.min() > 1e-5
    assert len(part.length) == 4 + 3 * 3


@pytest.mark.parametrize("kink", [1e-9, 1e-7, 1e-6, 1e-5, 1e-4, 1.74e-3, 1e-2])
@pytest.mark.parametrize("radius", [0.075e-3, 0.0088, 0.2])
@pytest.mark.parametrize("turn", [-1.5, 1.5])
def test_a_line_that_almost_touches_an_arc_is_no_stop(kink: float, radius: float, turn: float) -> None:
    bend = curves.advance(np.zeros((1, 2)), np.zeros(1), np.array([np.sign(turn) / radius]), np.array([1.5 * radius]))
    for side in (-1.0, 1.0):
        heading = float(bend[1][0]) + side * kink
        end = bend[0][0] + 0.13 * np.array([np.cos(heading), np.sin(heading)])
        points = np.array([[-0.1, 0.0], [0.0, 0.0], bend[0][0], end])
        curve = Curve(points=points, bulges=np.array([0.0, np.tan(turn / 4.0), 0.0, 0.0]))
        for ramps in (False, True):
            parts = smooth(curve, corner="stop", ramps=ramps)
            assert driven(parts[0])[-1] == pytest.approx(end)  # the first stop is the sharp corner
            assert worst_kink(parts[0]) < 1e-5
            assert sharpest(parts[0]) < 1.5 / radius


@settings(max_examples=100)
@given(star_curves(low=1e-3, high=40e-3), st.floats(1e-6, 1e-4))
def test_an_open_line_is_driven_from_end_to_end(closed: Curve, deviation: float) -> None:
    curve = Curve(points=closed.points, bulges=closed.bulges[:-1], closed=False)
    assume(curves.lengths(curve).min() > 1e-5)
    parts = smooth(curve, deviation=deviation)
    line = np.concatenate([driven(part) for part in parts])
    assert shapely.distance(shapely.points(line), shapely.LineString(flat(curve))).max() <= deviation + 2e-8
    assert shapely.distance(shapely.points(flat(curve)), shapely.LineString(line)).max() <= deviation + 2e-8
    assert max(worst_kink(part) for part in parts) < 1e-5
    assert line[[0, -1]] == pytest.approx(curve.points[[0, -1]])
    stopped = smooth(curve, corner="stop", deviation=deviation)
    assert len(stopped) <= len(curve.points) - 1
    assert sum(part.total for part in stopped) == pytest.approx(curves.length(curve), rel=1e-3)


@pytest.mark.parametrize("sliver", [0, 1, 2])
def test_slivers_of_an_open_line_are_left_out_but_not_its_ends(sliver: int) -> None:
    x = np.insert([0.0, 0.01, 0.02], sliver + 1, [0.0, 0.01, 0.02][sliver] + 2e-7)
    curve = Curve(points=np.column_stack([np.sort(x), np.zeros(4)]), bulges=np.zeros(3), closed=False)
    (part,) = smooth(curve, corner="stop")
    assert driven(part)[[0, -1], 0] == pytest.approx(curve.points[[0, -1], 0], abs=1e-12)
    assert part.length.min() > 1e-3


def test_a_line_of_one_segment_stays_as_it_is() -> None:
    curve = Curve(points=np.array([[0.0, 0.0], [0.01, 0.0]]), bulges=np.array([0.4]), closed=False)
    (part,) = smooth(curve)
    assert driven(part)[[0, -1]] == pytest.approx(curve.points)
    assert part.curvature == pytest.approx(curves.curvatures(curve))
    assert part.sharpness.tolist() == [0.0]
