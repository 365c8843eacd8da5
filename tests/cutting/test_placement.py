"""Where the drawing comes to lie."""

import math

import numpy as np
import pytest

from deltacam.cutting.kerf import offset
from deltacam.cutting.placement import bounding_box, place, refuse_outside
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
    refuse_outside(cuts, robot=ROBOT, placement=fits, unit="mm")
    with pytest.raises(InfeasibleError) as caught:
        refuse_outside(cuts, robot=ROBOT, placement=place([part], robot=ROBOT, at=(0.01, 0.0), rotation=0.0), unit="mm")
    assert "5.000 mm" in caught.value.what
    assert "contour 4" in caught.value.where
    assert "--at" in caught.value.hint
