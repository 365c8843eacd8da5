"""Clothoids, against the Fresnel integrals and against arcs."""

import numpy as np
import pytest
from scipy.special import fresnel

from deltacam.geometry import clothoid
from deltacam.geometry import curve as curves


@pytest.mark.parametrize("sharpness", [-900.0, 3.0, 5e5])
def test_a_clothoid_from_a_line_is_where_the_fresnel_integrals_say(sharpness: float) -> None:
    turn = np.array([0.0, 0.1, 0.8, 1.5, 3.0])
    distance = np.sqrt(2.0 * turn / abs(sharpness))
    nothing = np.zeros(5)
    points, heading = clothoid.advance(np.zeros((5, 2)), nothing, nothing, np.full(5, sharpness), distance)
    unit = np.sqrt(np.pi / abs(sharpness))
    sine, cosine = fresnel(distance / unit)
    assert points == pytest.approx(unit * np.column_stack([cosine, np.sign(sharpness) * sine]), rel=1e-12, abs=1e-15)
    assert heading == pytest.approx(np.sign(sharpness) * turn)


def test_without_sharpness_it_is_an_arc() -> None:
    rng = np.random.default_rng(5)
    start, (heading, distance) = rng.normal(size=(9, 2)), rng.normal(size=(2, 9))
    curvature = np.append(rng.normal(size=8), 0.0)
    points, end = clothoid.advance(start, heading, curvature, np.zeros(9), distance)
    exact, direction = curves.advance(start, heading, curvature, distance)
    assert np.array_equal(points, exact)
    assert np.array_equal(end, direction)


def test_going_on_from_half_way_ends_at_the_same_place() -> None:
    rng = np.random.default_rng(6)
    start, heading, curvature, sharpness = rng.normal(size=(50, 2)), *rng.normal(size=(3, 50))
    half = rng.uniform(-0.7, 0.7, 50)
    middle, turned = clothoid.advance(start, heading, curvature, sharpness, half)
    there, end = clothoid.advance(middle, turned, curvature + sharpness * half, sharpness, half)
    direct, direction = clothoid.advance(start, heading, curvature, sharpness, 2.0 * half)
    assert there == pytest.approx(direct, abs=1e-12)
    assert end == pytest.approx(direction)
