"""Where a part fits on the sheet."""

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st

from deltacam.cutting.fitting import Footprint
from deltacam.cutting.kerf import offset
from deltacam.cutting.placement import footprint
from deltacam.geometry import curve as curves
from deltacam.robot.workspace import Workspace
from tests.strategies import contour, rectangle

DENSE = np.radians(np.arange(0.0, 180.0, 0.25)).tolist()


@st.composite
def parts(draw: st.DrawFn) -> Footprint:
    rng = np.random.default_rng(draw(st.integers(0, 10**6)))
    points = rng.normal(size=(int(rng.integers(3, 25)), 2)) * [rng.uniform(0.02, 0.2), 0.1]
    hull = shapely.MultiPoint(points).convex_hull
    return Footprint(shapely.get_coordinates(shapely.geometry.polygon.orient(hull).exterior)[:-1])


@st.composite
def rectangles(draw: st.DrawFn) -> Workspace:
    return Workspace(sheet_z=-0.6, width=draw(st.floats(0.1, 0.8)), depth=draw(st.floats(0.1, 0.8)))


@given(parts(), rectangles())
def test_no_turn_leaves_more_room_than_the_best(part: Footprint, sheet: Workspace) -> None:
    turn, excess = part.best_turn(sheet)
    assert part.places(sheet, turn).excess == pytest.approx(excess, abs=1e-12)
    assert excess <= min(part.places(sheet, one).excess for one in DENSE) + 1e-12


@given(parts(), rectangles(), st.floats(0.0, 6.0))
def test_the_places_on_a_rectangle_are_those_where_no_corner_leaves_it(
    part: Footprint, sheet: Workspace, turn: float
) -> None:
    rng = np.random.default_rng(1)
    at = rng.uniform(-0.4, 0.4, (50, 2))
    truth = [sheet.excess(part.turned(turn) + place).max() == 0.0 for place in at]
    assert part.holds(sheet, turn, at).tolist() == truth


@given(parts(), st.floats(0.1, 0.6), st.floats(0.0, 6.0))
def test_a_part_fits_on_a_disc_where_the_circle_around_it_does(part: Footprint, radius: float, turn: float) -> None:
    sheet = Workspace(sheet_z=-0.6, radius=radius)
    places = part.places(sheet, turn)
    at = np.array([places.centre])
    assert sheet.excess(part.turned(turn) + at).max() == pytest.approx(max(places.excess, 0.0), abs=1e-9)
    nearby = np.random.default_rng(2).normal(scale=0.02, size=(60, 2)) + at
    assert min(sheet.excess(part.turned(turn) + place).max() for place in nearby) >= places.excess
    held = nearby[part.holds(sheet, turn, nearby)]
    assert ((held >= places.low - 1e-9) & (held <= places.high + 1e-9)).all()


def test_arcs_count_as_far_as_they_reach() -> None:
    part = contour(curves.circle(np.array([3.0, -2.0]), 0.1))
    found = footprint(offset([part], kerf=2e-3).cuts, [part])
    places = found.places(Workspace(sheet_z=-0.6, width=0.3, depth=0.25), 0.4)
    assert places.high == pytest.approx([0.049, 0.024], abs=2e-6)


def test_a_place_is_written_with_as_few_digits_as_fit() -> None:
    sheet = Workspace(sheet_z=-0.6, width=0.3, depth=0.3)
    part = footprint(offset([contour(rectangle(0.1, 0.1))], kerf=0.0).cuts, [contour(rectangle(0.1, 0.1))])
    assert part.spot(sheet, (0.0123456, -1e-9), 0.0) == ("12.35", "0", "0")
    edge = part.spot(sheet, (0.0999996, 0.1), 0.0)
    assert edge is not None
    assert part.holds(sheet, edge.rotation, np.array([edge.at]))[0]
    tight = Workspace(sheet_z=-0.6, width=0.100001, depth=0.3)
    assert part.spot(tight, (0.0, 0.0), np.radians(3.0)) is None
