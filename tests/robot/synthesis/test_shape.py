"""The part of a workspace that stands for the whole."""

import numpy as np
import pytest

from deltacam.errors import RobotError
from deltacam.robot.synthesis.demands import demands, excesses
from deltacam.robot.synthesis.shape import BoxShape, CylinderShape, grid, surface
from deltacam.robot.synthesis.wish import Wish

RNG = np.random.default_rng(8)
ROBOT = np.array([[0.05, 0.22, 0.36, -0.3]])


@pytest.mark.parametrize("shape", [BoxShape(0.2, 0.16, 0.1), CylinderShape(0.2, 0.1)])
def test_the_part_has_the_worst_of_the_whole(shape: BoxShape | CylinderShape) -> None:
    found = demands(Wish(shape))
    sides = (0.2, 0.16, 0.1) if isinstance(shape, BoxShape) else (0.2, 0.2, 0.1)
    whole = RNG.uniform(-0.5, 0.5, (40_000, 3)) * sides
    if isinstance(shape, CylinderShape):
        whole = whole[np.hypot(whole[:, 0], whole[:, 1]) <= 0.1]
    part = shape.place(np.vstack((RNG.uniform(0.0, 1.0, (40_000, 3)), grid(9))))
    worst, of_part = (excesses(found, ROBOT, points)[:, 0].max(axis=1) for points in (whole, part))
    assert (worst <= of_part + 1e-3).all()  # the sampled worst of the whole is not missed by the part
    assert (of_part - worst < 0.06).all()  # and the part has no worse places: those of the whole are sampled coarsely


def test_the_surface_has_the_corners_and_no_inner_point() -> None:
    cube = surface(5)
    assert len(cube) == 5**3 - 3**3
    assert {tuple(row) for row in np.ndindex(2, 2, 2)} <= {tuple(row) for row in cube}


@pytest.mark.parametrize("sides", [(0.0, 0.1, 0.1), (0.1, float("nan"), 0.1), (0.1, 0.1, 11.0)])
def test_a_side_that_cannot_be_is_refused(sides: tuple[float, float, float]) -> None:
    with pytest.raises(RobotError, match="is outside 1 to 10000 mm"):
        BoxShape(*sides)
