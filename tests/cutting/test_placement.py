"""Where the drawing comes to lie."""

import math

import numpy as np
import pytest

from deltacam.cutting.kerf import offset
from deltacam.cutting.placement import bounding_box, footprint, place, refuse_everywhere, refuse_outside
from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.robot.reader import load_robot
from tests.strategies import contour, rectangle

ROBOT = load_robot("delta-300")


@pytest.mark.parametrize("rotation", [0.0, 0.5, math.pi / 2, -2.0])
def test_the_centre_of_the_part_comes_to_lie_where_asked(rotation: float) -> None:
    part = contour(rectangle(0.1, 0.04, at=(3.0, -7.0)))
    where = place([part], robot=ROBOT, at=(0.02, -0.03), rotation=rotation)
    placed = curves.transform(part.curve, rotation=where.rotation, shift=(where.x, where.y))
    assert placed.points.mean(axis=0) == pytest.approx([0.02, -0.03], abs=1e-12)
    side = placed.points[1] - placed.points[0]
    assert np.arctan2(side[1], side[0]) == pytest.approx(rotation)
    assert where.z == ROBOT.workspace.sheet_z


def test_the_box_holds_arcs() -> None:
    box = bounding_box([contour(curves.circle(np.array([0.1, 0.2]), 0.03))])
    assert box == pytest.approx(np.array([[0.07, 0.17], [0.13, 0.23]]))


def test_a_part_that_leaves_the_sheet_is_refused_by_how_much_and_which() -> None:
    part = contour(rectangle(0.29, 0.02), number=4)
    cuts = offset([part], kerf=0.0).cuts
    fits = place([part], robot=ROBOT, at=(0.0, 0.0), rotation=0.0)
    refuse_outside(cuts, contours=[part], robot=ROBOT, placement=fits, unit="mm", metres_per_unit=1e-3)
    aside = place([part], robot=ROBOT, at=(0.01, 0.0), rotation=0.0)
    with pytest.raises(InfeasibleError) as caught:
        refuse_outside(cuts, contours=[part], robot=ROBOT, placement=aside, unit="mm", metres_per_unit=1e-3)
    assert "5.000 mm" in caught.value.what
    assert "contour 4" in caught.value.where
    assert "move it: --at 0,0, or --place auto" in caught.value.hint


def hint(width: float, height: float, metres: float, *, at: tuple[float, float] = (0.0, 0.0)) -> str:
    """What to do about a part of so many units that leaves the sheet."""
    part = contour(rectangle(width * metres, height * metres, at=(5.0, -3.0)))
    where = place([part], robot=ROBOT, at=at, rotation=0.3)
    cuts = offset([part], kerf=0.0).cuts
    with pytest.raises(InfeasibleError) as caught:
        refuse_outside(cuts, contours=[part], robot=ROBOT, placement=where, unit="x", metres_per_unit=metres)
    return caught.value.hint


@pytest.mark.parametrize(
    ("width", "height", "metres", "unit", "size"),
    [
        (41.0, 21.0, 25.4e-3, "mm", "41.0 x 21.0 mm"),
        (9.0, 5.0, 0.3048, "in", "228.6 x 127.0 mm"),
        (595.28, 300.0, 1e-3, "pt", "210.0 x 105.8 mm"),
    ],
)
def test_a_part_that_would_fit_in_another_unit_is_refused_with_that_unit(
    width: float, height: float, metres: float, unit: str, size: str
) -> None:
    assert f"in {unit} it would be {size} and fit: --units {unit}, or" in hint(width, height, metres)


@pytest.mark.parametrize(
    ("width", "height", "metres", "at", "says"),
    [
        (500.0, 300.0, 1e-3, (0.0, 0.0), "leaves the sheet by 100.000 mm"),  # only smaller units than mm would do
        (1.0, 1000.0, 25.4e-3, (0.0, 0.0), "take a larger robot (--robot)"),  # does not fit in mm either
        (10.0, 4.0, 25.4e-3, (0.1, 0.0), "move it: --at 0,0"),  # the place is wrong, not the size
        (400.0, 1.0, 1e-3, (0.0, 0.0), "turn it: --rotate 45"),
        (400.0, 1.0, 1e-3, (0.05, 0.0), "move and turn it: --at 0,0 --rotate 45"),
    ],
)
def test_what_helps_is_said_and_no_unit_that_does_not(
    width: float, height: float, metres: float, at: tuple[float, float], says: str
) -> None:
    assert "and fit" not in hint(width, height, metres, at=at)
    assert says in hint(width, height, metres, at=at)


def test_a_part_that_fits_nowhere_is_refused_by_how_much_and_how_turned() -> None:
    part = contour(rectangle(0.5, 0.01))
    with pytest.raises(InfeasibleError) as caught:
        refuse_everywhere(footprint(offset([part], kerf=0.0).cuts, [part]), robot=ROBOT)
    least = (0.5 + 0.01) * math.sqrt(0.5) / 2.0 - 0.15  # on a square sheet a rectangle is best at 45 degrees
    assert f"by {least * 1e3:.3f} mm" in caught.value.what
    assert "turned by 45.00 deg" in caught.value.what or "turned by 135.00 deg" in caught.value.what
