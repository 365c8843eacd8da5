"""Offsets of convex contours, by the closed forms that hold for them (Steiner 1840)."""

import numpy as np
import pytest
import shapely

from deltacam.cutting import kerf
from deltacam.cutting.convex import offset_convex
from deltacam.geometry import curve as curves
from deltacam.model import Contour, Curve

SEEDS = range(40)


def convex(seed: int) -> Curve:
    """A circle, a polygon about a circle of 10 mm, a polygon in one, or one whose sides bulge outwards."""
    rng = np.random.default_rng(seed)
    if seed % 4 == 0:
        return curves.circle(rng.uniform(-0.1, 0.1, 2), rng.uniform(1e-3, 2e-2))
    count = int(rng.integers(3, 12))
    angle = 2.0 * np.pi * (np.arange(count) + rng.uniform(-0.2, 0.2, count)) / count
    half = 0.5 * np.mod(np.roll(angle, -1) - angle, 2.0 * np.pi)
    radius = 0.01 / np.cos(half) if seed % 4 == 1 else np.full(count, 0.01)
    middle = angle + half if seed % 4 == 1 else angle
    bulges = np.zeros(count) if seed % 4 < 3 else rng.uniform(0.0, 0.9, count) * np.tan(0.5 * half)
    return Curve(points=radius[:, None] * np.stack([np.cos(middle), np.sin(middle)], axis=1), bulges=bulges)


@pytest.mark.parametrize("seed", SEEDS)
def test_outside_area_and_length_grow_as_steiner_says(seed: int) -> None:
    curve, shift = convex(seed), 10.0 ** np.random.default_rng(seed).uniform(-5, -2)
    found = offset_convex(curve, shift)
    assert found is not None
    length = curves.length(curve)
    assert curves.length(found) == pytest.approx(length + 2.0 * np.pi * shift, abs=1e-10)
    area = curves.signed_area(curve) + length * shift + np.pi * shift**2
    assert curves.signed_area(found) == pytest.approx(area, rel=1e-10)


@pytest.mark.parametrize("seed", SEEDS)
def test_going_in_undoes_going_out(seed: int) -> None:
    curve, shift = convex(seed), 10.0 ** np.random.default_rng(seed).uniform(-5, -2.5)
    outside = offset_convex(curve, shift)
    assert outside is not None
    traced = kerf.offset([contour(outside, depth=1)], kerf=2.0 * shift).cuts[0].curve  # rounds have no part inside
    assert curves.signed_area(traced) == pytest.approx(curves.signed_area(curve), rel=1e-5)


@pytest.mark.parametrize("seed", SEEDS)
def test_inside_it_is_what_the_search_finds(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    curve, width = convex(seed), 10.0 ** np.random.default_rng(seed).uniform(-5, -3)
    found = offset_convex(curve, -width / 2.0)
    assert found is not None
    monkeypatch.setattr(kerf, "offset_convex", lambda *_: None)
    (searched,) = kerf.offset([contour(curve, depth=1)], kerf=width).cuts
    assert curves.signed_area(found) == pytest.approx(curves.signed_area(searched.curve), rel=1e-6)
    assert curves.length(found) == pytest.approx(curves.length(searched.curve), abs=2e-6)
    drawn = shapely.LinearRing(curves.flatten(curve, 1e-8)[0])
    away = shapely.distance(shapely.points(curves.flatten(found, 1e-6)[0]), drawn)
    assert away == pytest.approx(width / 2.0, abs=2e-8)


def test_a_polygon_about_a_circle_shrinks_to_one_about_a_smaller_circle() -> None:
    curve = convex(1)
    found = offset_convex(curve, -4e-3)
    assert found is not None
    assert found.points == pytest.approx(0.6 * curve.points, abs=1e-12)


@pytest.mark.parametrize("shift", [1e-4, -1e-4])
def test_what_is_not_convex_is_left_to_the_search(shift: float) -> None:
    corners = np.array([[0, 0], [20, 0], [20, 10], [10, 10], [10, 20], [0, 20]]) * 1e-3
    assert offset_convex(curves.polygon(corners), shift) is None
    hollow = Curve(points=np.array([[0, 0], [0.01, 0], [0.01, 0.01]]), bulges=np.array([0.0, -0.1, 0.0]))
    assert offset_convex(hollow, shift) is None
    turns = np.linspace(0.0, 4.0 * np.pi, 12, endpoint=False)  # twice round
    twice = np.linspace(1.0, 1.1, 12)[:, None] * np.stack([np.cos(turns), np.sin(turns)], axis=1)
    assert offset_convex(curves.polygon(twice * 1e-2), shift) is None


def test_a_side_without_a_part_inside_is_left_to_the_search() -> None:
    chamfered = np.array([[0, 0], [10, 0], [10, 9.99], [9.99, 10], [0, 10]]) * 1e-3
    assert offset_convex(curves.polygon(chamfered), -1e-3) is None
    assert offset_convex(curves.polygon(chamfered), -1e-6) is not None
    assert offset_convex(curves.circle(np.zeros(2), 1e-3), -1e-3) is None


def contour(curve: Curve, depth: int = 0) -> Contour:
    return Contour(number=1, curve=curve, layer="0", handles=("1",), depth=depth)
