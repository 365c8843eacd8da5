"""What happens between the ticks, against scipy's Hermite curves."""

import numpy as np
import pytest
from scipy.interpolate import CubicHermiteSpline

from deltacam.robot.robot import Controller
from deltacam.verification.interpolate import between, peaks

RATE = 400.0
CUBIC, LINEAR = Controller(RATE, "cubic"), Controller(RATE, "linear")
ROWS = np.random.default_rng(3).normal(size=(40, 3)).cumsum(axis=0) * 1e-3


def spline(q: np.ndarray) -> CubicHermiteSpline:
    held = np.concatenate([q[:1], q, q[-1:]])
    return CubicHermiteSpline(np.arange(len(q)) / RATE, q, (held[2:] - held[:-2]) / 2.0 * RATE)


@pytest.mark.parametrize("share", [0.0, 0.25, 0.5, 0.9])
def test_cubic_interpolation_is_hermite_with_central_differences(share: float) -> None:
    rows = np.arange(len(ROWS) - 1)
    found = between(CUBIC, ROWS, rows, share)
    np.testing.assert_allclose(found, spline(ROWS)((rows + share) / RATE), atol=1e-15)


def test_linear_interpolation_is_straight() -> None:
    rows = np.array([0, 7, 38])
    np.testing.assert_allclose(between(LINEAR, ROWS, rows, 0.25), 0.75 * ROWS[rows] + 0.25 * ROWS[rows + 1], atol=1e-15)


def test_the_peaks_of_cubic_interpolation_are_those_of_a_fine_sampling() -> None:
    speed, acceleration = peaks(CUBIC, ROWS)
    fine = np.arange(len(ROWS) - 1)[:, np.newaxis] + np.linspace(1e-9, 1.0 - 1e-9, 2001)
    curve = spline(ROWS)
    for found, order, tolerance in ((speed, 1, 1e-5), (acceleration, 2, 1e-6)):
        sampled = np.abs(curve.derivative(order)(fine / RATE)).max(axis=1)
        np.testing.assert_allclose(found, sampled, rtol=tolerance, atol=tolerance)
        assert (found >= sampled * (1.0 - 1e-9)).all()
