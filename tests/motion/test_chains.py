"""Chains of short segments, against the curves that they were made from."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.model import Curve
from deltacam.motion.chains import fit
from tests.strategies import rectangle, slot, star_curves

ALLOWANCE = 9e-6


def chords(radius: float, count: int, *, sign: float = 1.0) -> Curve:
    angle = sign * 2.0 * np.pi * np.arange(count) / count
    return curves.polygon(radius * np.column_stack([np.cos(angle), np.sin(angle)]))


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("count", [90, 720, 5000])
def test_a_circle_of_chords_becomes_three_arcs_of_its_radius(count: int, sign: float) -> None:
    fitted, off, _ = fit(chords(0.025, count, sign=sign), allowance=20e-6)
    assert len(fitted.bulges) == 3
    assert curves.curvatures(fitted) * sign * 0.025 == pytest.approx(1.0, rel=3e-3)
    assert off.max() <= 0.025 * (1.0 - np.cos(np.pi / count)) * 1.2 + 1e-12
    assert np.abs(curves.corner_angles(fitted)).max() < 5e-3


@pytest.mark.parametrize("curve", [rectangle(0.06, 0.04), slot(0.05, 0.02), curves.circle(np.zeros(2), 0.02)])
def test_lines_and_arcs_stay_as_they_are(curve: Curve) -> None:
    fitted, off, _ = fit(curve, allowance=ALLOWANCE)
    assert fitted is curve
    assert not off.any()


def test_corners_in_a_chain_are_kept() -> None:
    arc = 0.02 * np.column_stack([np.cos(angle := np.linspace(0.0, 1.5, 200)), np.sin(angle)])
    curve = curves.polygon(np.concatenate([arc, [[0.0, 0.0]]]))
    fitted, _, _ = fit(curve, allowance=ALLOWANCE)
    assert len(fitted.bulges) == 3
    assert fitted.points == pytest.approx(np.array([arc[0], arc[-1], [0.0, 0.0]]))


def test_a_straight_chain_becomes_a_line() -> None:
    x = np.linspace(0.0, 0.03, 400)
    line = Curve(points=np.column_stack([x, 2e-6 * (-1.0) ** np.arange(400)]), bulges=np.zeros(399), closed=False)
    fitted, off, _ = fit(line, allowance=ALLOWANCE)
    assert len(fitted.bulges) == 1
    assert abs(fitted.bulges[0]) < 1e-3
    assert 1e-6 < off[0] <= 5e-6


def test_without_an_allowance_nothing_changes() -> None:
    curve = chords(0.025, 720)
    assert fit(curve, allowance=0.0)[0] is curve


@given(star_curves(low=1e-3, high=20e-3), st.floats(1e-6, 5e-5), st.integers(10, 400))
def test_what_is_fitted_lies_within_what_it_says(curve: Curve, allowance: float, parts: int) -> None:
    points, _ = curves.flatten(curve, 2e-6)
    chain = curves.polygon(points[:: max(1, len(points) // parts)])
    fitted, off, _ = fit(chain, allowance=allowance)
    assert off.max(initial=0.0) <= allowance
    drawn = shapely.LinearRing(chain.points)
    line = shapely.LinearRing(curves.flatten(fitted, 1e-9)[0])
    assert shapely.hausdorff_distance(line, drawn, densify=0.2) <= off.max(initial=0.0) * 1.2 + 1e-7
