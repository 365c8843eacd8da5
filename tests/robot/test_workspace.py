"""The sheet: its edge, its points, and the worst of anything over it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import Point, box

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot.workspace import Workspace

RECTANGLE = Workspace(sheet_z=-0.6, width=0.4, depth=0.2)
DISC = Workspace(sheet_z=-0.6, radius=0.25)
coordinate = st.floats(-1, 1)


@given(coordinate, coordinate)
def test_excess_is_the_distance_from_a_rectangle(x: float, y: float) -> None:
    assert RECTANGLE.excess([[x, y]])[0] == pytest.approx(box(-0.2, -0.1, 0.2, 0.1).distance(Point(x, y)), abs=1e-15)


@given(coordinate, coordinate)
def test_excess_is_the_distance_from_a_disc(x: float, y: float) -> None:
    assert DISC.excess([[x, y]])[0] == pytest.approx(max(Point(0, 0).distance(Point(x, y)) - 0.25, 0.0), abs=1e-15)


@pytest.mark.parametrize("sheet", [RECTANGLE, DISC])
def test_the_grid_covers_the_sheet_and_its_edge(sheet: Workspace) -> None:
    points = sheet.grid(61)
    assert np.unique(points[:, 2]) == [-0.6]
    assert sheet.excess(points[:, :2]).max() < 1e-15
    half = [0.2, 0.1] if sheet is RECTANGLE else [0.25, 0.25]
    assert np.abs(points[:, :2]).max(axis=0) == pytest.approx(half)


@given(st.floats(-0.2, 0.2), st.floats(-0.1, 0.1), st.sampled_from([RECTANGLE, DISC]))
def test_the_worst_is_found_between_the_points_of_the_grid(x: float, y: float, sheet: Workspace) -> None:
    def hill(points: Array) -> Array:
        return 3.0 - (points[:, 0] - x) ** 2 - 2.0 * (points[:, 1] - y) ** 2

    value, point = sheet.worst(hill)
    assert value == pytest.approx(3.0, abs=1e-11)
    assert point == pytest.approx([x, y, -0.6], abs=1e-5)


def test_the_worst_of_a_slope_is_on_the_edge() -> None:
    assert RECTANGLE.worst(lambda p: p[:, 0] - p[:, 1])[1] == pytest.approx([0.2, -0.1, -0.6])
    value, point = DISC.worst(lambda p: p @ np.array([3.0, 4.0, 0.0]))
    assert value == pytest.approx(5.0 * 0.25, rel=1e-11)
    assert point == pytest.approx([0.15, 0.2, -0.6], abs=1e-5)


@pytest.mark.parametrize(
    "shape",
    [{}, {"width": 0.1}, {"depth": 0.1}, {"radius": 0.1, "width": 0.1}, {"radius": 1.0, "width": 1, "depth": 1}],
)
def test_a_sheet_is_either_a_rectangle_or_a_disc(shape: dict[str, float]) -> None:
    with pytest.raises(RobotError, match="either width and depth, or a radius"):
        Workspace(sheet_z=-0.6, **shape)


def test_park_beside_the_sheet_is_refused_with_the_distance() -> None:
    with pytest.raises(RobotError, match=r"park is 50\.000 mm outside the sheet"):
        Workspace(sheet_z=-0.6, width=0.4, depth=0.2, park=(0.23, -0.14))


@pytest.mark.parametrize("bad", [float("nan"), float("inf"), -1e9])
def test_a_sheet_at_no_possible_height_is_refused(bad: float) -> None:
    with pytest.raises(RobotError, match="sheet_z = "):
        Workspace(sheet_z=bad, radius=0.1)
