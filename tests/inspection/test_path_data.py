"""The data of paths, decoded by the rules of SVG 1.1 (appendix F.6), draws the curves again."""

import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.inspection.path_data import Grid, path_data
from deltacam.model import Curve
from tests.strategies import slot, star_curves

HALF_A_DIAGONAL = 0.708e-6  # m, of a grain of the grid
MICROMETRE = Grid((0.0, 0.0), 1e-6)
NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?")


def decoded(data: str) -> tuple[np.ndarray, bool]:
    """Points along a path, and whether it ends in z."""
    points: list[complex] = []
    for letter, text in re.findall(r"([Mlaz])([^Mlaz]*)", data):
        numbers = [float(number) for number in NUMBER.findall(text)]
        if letter == "M":
            points.append(complex(*numbers))
        elif letter == "l":
            for x, y in zip(numbers[::2], numbers[1::2], strict=True):
                points += [points[-1] + share * complex(x, y) for share in (0.25, 0.5, 1.0)]
        elif letter == "a":
            for i in range(0, len(numbers), 7):
                points += arc(points[-1], *numbers[i : i + 7])
    return np.array([(point.real, point.imag) for point in points]), data.endswith("z")


def arc(start: complex, rx: float, ry: float, turn: float, large: float, sweep: float, x: float, y: float) -> list:
    """Points along an elliptical arc with rx = ry, by its centre (F.6.5)."""
    assert (rx, turn, large) == (ry, 0.0, 0.0)
    end = start + complex(x, y)
    half = (start - end) / 2.0
    radius = max(rx, abs(half))  # F.6.6: too small radii grow until the ends fit
    rise = np.sqrt(max(radius**2 / abs(half) ** 2 - 1.0, 0.0))
    centre = (start + end) / 2.0 + (1.0 if large != sweep else -1.0) * rise * (half.imag - 1j * half.real)
    first, last = np.angle(start - centre), np.angle(end - centre)
    step = (last - first) % (2.0 * np.pi) if sweep else -((first - last) % (2.0 * np.pi))
    # It ends where it is said to: the centre of a nearly straight arc is too far away to come there by it.
    return [*(centre + radius * np.exp(1j * (first + share * step)) for share in np.linspace(0.0, 1.0, 7)[1:-1]), end]


def check(curve: Curve) -> None:
    points, closed = decoded(path_data(Pack.of([curve]), MICROMETRE)[0])
    assert closed == curve.closed
    along = np.vstack([points, points[:1]]) if closed else points
    for point in along * 1e-6:
        assert curves.nearest(curve, point)[2] < 2e-6
    # Nothing of the curve is left out: its points come in the order of the path.
    for vertex in curve.points:
        assert np.hypot(*(points * 1e-6 - vertex).T).min() < HALF_A_DIAGONAL


@given(star_curves())
def test_closed_curves_are_drawn_within_rounding(curve: Curve) -> None:
    check(curve)


@given(star_curves(), st.floats(-3.0, 3.0))
def test_open_curves_with_arcs_of_any_angle_are_drawn_within_rounding(curve: Curve, bulge: float) -> None:
    bulges = np.where(np.arange(len(curve.bulges) - 1) % 2, bulge, curve.bulges[:-1])
    check(Curve(points=curve.points, bulges=bulges, closed=False))


@pytest.mark.parametrize("radius", [1e-4, 0.05, 1.0])
def test_circles_and_slots_are_arcs(radius: float) -> None:
    check(curves.circle(np.array([0.3, -0.2]), radius))
    check(slot(2.0 * radius, radius))
    assert path_data(Pack.of([curves.circle(np.zeros(2), radius)]), MICROMETRE)[0].count("a") == 1


def test_a_rectangle_needs_three_lines() -> None:
    square = curves.polygon(np.array([[0.0, 0.0], [0.01, 0.0], [0.01, 0.01], [0.0, 0.01]]))
    assert path_data(Pack.of([square]), Grid((-0.001, 0.0), 1e-6)) == ["M1000 0l10000 0 0 10000-10000 0z"]


def test_each_curve_has_its_own_data() -> None:
    drawn = [slot(0.02, 0.01), Curve(np.array([[0.0, 0.0], [0.01, 0.0]]), np.array([1.0]), closed=False)]
    both = path_data(Pack.of(drawn), MICROMETRE)
    assert both == [path_data(Pack.of([one]), MICROMETRE)[0] for one in drawn]
    assert path_data(Pack.of([]), MICROMETRE) == []


@given(star_curves())
def test_a_coarse_grid_leaves_out_what_is_smaller_and_stays_within_it(curve: Curve) -> None:
    grain = 5e-3
    coarse = path_data(Pack.of([curve, curve]), Grid((0.0, 0.0), grain, fine=False))
    assert len(coarse) == 1  # the same twice is drawn once
    points, _ = decoded(coarse[0])
    assert len(points) <= 6 * len(curve.points) + 1
    for point in points * grain:
        assert curves.nearest(curve, point)[2] < 1.5 * grain
    for vertex in curve.points:
        assert np.hypot(*(points * grain - vertex).T).min() < grain


def test_many_specks_on_a_coarse_grid_are_one_dot() -> None:
    specks = [curves.circle(np.array([0.0, 1e-6 * i]), 1e-5) for i in range(50)]
    assert path_data(Pack.of(specks), Grid((0.0, 0.0), 1e-3, fine=False)) == ["M0 0z"]
