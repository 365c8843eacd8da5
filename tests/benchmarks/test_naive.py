"""The contours and the measures by which naive use of toppra is compared with deltacam, and a short part of it."""

import numpy as np
import pytest

from benchmarks.naive import cases, distances, results, setpoints, shares
from benchmarks.ways import deltacam, joints_on_grid, opened
from deltacam.geometry import curve as curves

CASES = list(cases(8, 3))


def test_the_smooth_contours_have_no_corners_and_lie_inside_the_sharp_ones() -> None:
    for case in CASES:
        assert np.abs(curves.corner_angles(case.smooth)).max() < 1e-9
        assert 0.5 < curves.length(case.smooth) / curves.length(case.sharp) < 1.0
        assert curves.length(opened(case.smooth)) == pytest.approx(curves.length(case.smooth), rel=1e-12)


def test_distances_are_those_to_the_nearest_segment() -> None:
    curve = CASES[0].smooth
    points, _ = curves.evaluate(curve, np.arange(len(curve.bulges)), 0.3 * curves.lengths(curve))
    assert distances(points, curve) == pytest.approx(np.zeros(len(points)), abs=1e-12)
    off = distances(points + np.array([1e-6, 0.0]), curve)
    assert (off < 1.001e-6).all()
    assert off.max() > 5e-7


def test_differences_of_setpoints_see_no_more_than_there_is_at_any_time() -> None:
    for case in CASES:
        plan = joints_on_grid(case)
        assert plan is not None
        change = np.diff(setpoints(plan, case.robot), n=2, axis=0) * case.robot.controller.rate_hz**2
        always = shares(plan, case.robot)[1].max()
        assert (np.abs(change) / case.robot.joints.max_acceleration).max() <= always * (1.0 + 1e-6)


def test_deltacam_exceeds_no_limit_where_naive_ways_do() -> None:
    found = results(["joints on the grid", "deltacam", "corners", "deltacam, corners"], CASES)
    for way in ("deltacam", "deltacam, corners"):
        assert all(one is not None and max(one.always, one.ticks) < 1.001 for one in found[way])
    assert all(one is not None and one.ticks > 5.0 for one in found["corners"])
    assert np.mean([one is not None and one.always > 1.01 for one in found["joints on the grid"]]) > 0.7


def test_the_same_path_takes_no_longer_with_deltacam() -> None:
    for case in CASES:
        plan, other = deltacam(case), joints_on_grid(case)
        assert other is not None
        assert plan.duration < 1.001 * other.duration
