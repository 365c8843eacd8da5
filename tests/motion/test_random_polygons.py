"""A thousand random polygons: every corner is passed, or stopped at, within the limits of the machine."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.geometry import curve as curves
from deltacam.model import Corner, Curve
from deltacam.motion.corners import Pace, pieces
from deltacam.motion.jerk import limited
from deltacam.motion.parametrize import parametrize
from deltacam.motion.route import Grid, Limits, Route
from deltacam.motion.rows import Rows
from deltacam.robot.reader import load_robot
from tests.motion.shares import at_ticks, of_law, of_tempo

JOINTS = replace(load_robot("delta-300").joints, max_jerk=None)
STRONG = replace(load_robot("delta-300"), joints=JOINTS)
WEAK = replace(STRONG, joints=replace(JOINTS, max_acceleration=tuple(0.3 * a for a in JOINTS.max_acceleration)))
CAP = 23.0
BATCH = 125
BATCHES = 4
SHEET = 0.29


def random_polygon(rng: np.random.Generator) -> Curve:
    """Three to eight edges of 0.05 to 100 mm and corners of 1 to 179 degrees, somewhere on the sheet."""
    count = int(rng.integers(2, 8))
    turn = np.radians(rng.uniform(1.0, 179.0, count)) * rng.choice([-1.0, 1.0], count)
    edges = 5e-5 * 2000.0 ** rng.uniform(size=count)
    way = edges * np.exp(1j * np.cumsum(turn))
    corners = np.concatenate([[0.0], np.cumsum(way)])
    points = np.stack([corners.real, corners.imag], axis=1)
    low, across = points.min(axis=0), np.ptp(points, axis=0)
    scale = min(1.0, SHEET / across.max())
    place = rng.uniform(-0.5, 0.5, 2) * (SHEET - scale * across) - 0.5 * scale * across
    return curves.polygon((points - low) * scale + place)


@pytest.mark.parametrize("corner", ["round", "stop"])
@pytest.mark.parametrize("batch", range(BATCHES))
def test_no_corner_is_passed_faster_than_the_limits_allow(batch: int, corner: Corner) -> None:
    rng = np.random.default_rng([batch, corner == "stop"])
    robot = (STRONG, WEAK, WEAK, STRONG)[batch]
    limits = Limits([0.05, 0.1, 0.3, 1.0][batch], CAP)
    moves = []
    for _ in range(BATCH):
        parts = pieces(random_polygon(rng), corner=corner, deviation=18e-6, ramps=False, z=robot.workspace.sheet_z)
        moves += [(part, limits) for part in parts]
    route = Route.of(moves)
    law = parametrize(route, robot)
    assert max(of_law(route, law, robot, (0.0, 0.25, 0.75, 1.0))) <= 1.001
    assert max(at_ticks(route, law, robot)) <= 1.001


@pytest.mark.parametrize("jerk", [6388.0, 1500.0])
@pytest.mark.parametrize("corner", ["round", "stop"])
def test_no_corner_is_passed_with_more_jerk_than_the_limit(corner: Corner, jerk: float) -> None:
    robot = replace(STRONG, joints=replace(JOINTS, max_jerk=(jerk,) * 3))
    pace = Pace(0.3, CAP, jerk / 3.0, 1.0 / robot.controller.rate_hz)
    rng = np.random.default_rng(7)
    moves = []
    for _ in range(40):
        parts = pieces(
            random_polygon(rng), corner=corner, deviation=18e-6, ramps=True, z=robot.workspace.sheet_z, pace=pace
        )
        moves += [(part, Limits(pace.feed, CAP)) for part in parts]
    route = Route.of(moves)
    grid = Grid.over(route, robot)
    tempo = limited(route, grid, Rows.over(route, grid, robot), robot, np.ones(len(grid.segment)))
    assert max(of_tempo(route, tempo, robot, np.linspace(0.0, 1.0, 11))) <= 1.001
    assert max(at_ticks(route, tempo, robot)) <= 1.001
