"""Moves in a row, and the grid over them."""

import numpy as np
import pytest

from deltacam.geometry import curve as curves
from deltacam.motion.corners import pieces
from deltacam.motion.path import straight
from deltacam.motion.route import INTERVALS, RAMP_INTERVALS, SPACING, STEP, Grid, Limits, Route
from deltacam.robot.reader import load_robot
from tests.strategies import rectangle, slot

ROBOT = load_robot("delta-300")
Z = ROBOT.workspace.sheet_z


def route() -> Route:
    shapes = curves.start_at(rectangle(0.06, 0.04), 0, 0.03), slot(0.03, 0.01)
    paths = [path for one in shapes for path in pieces(one, corner="round", deviation=1e-5, ramps=True, z=Z)]
    away = straight(np.array([0.03, 0.0]), np.array([0.05, 0.02]), Z)
    return Route.of([*[(path, Limits(0.1, 23.0, 20e-6)) for path in paths], (away, Limits(1.0, 23.0))])


def test_the_end_of_a_move_is_found_in_it_and_not_in_the_next() -> None:
    moves = route()
    edges = np.concatenate([[0.0], np.cumsum(moves.path.length)])[moves.first]
    every = np.arange(len(moves.first) - 1)
    segment, inside = moves.locate(every, edges[1:])
    assert segment.tolist() == (moves.first[1:] - 1).tolist()
    assert inside == pytest.approx(moves.path.length[segment])
    segment, inside = moves.locate(every, edges[:-1])
    assert segment.tolist() == moves.first[:-1].tolist()
    assert inside == pytest.approx(0.0, abs=1e-12)


def test_the_grid_covers_every_segment_as_finely_as_it_must() -> None:
    moves = route()
    grid, path = Grid.over(moves, ROBOT), moves.path
    width = grid.end - grid.start
    assert width.min() > 0.0
    assert grid.distance[grid.rest] == pytest.approx(np.concatenate([[0.0], np.cumsum(path.length)])[moves.first])
    for segment, length in enumerate(path.length.tolist()):
        own = grid.segment == segment
        assert width[own].sum() == pytest.approx(length)
        assert np.count_nonzero(own) >= (INTERVALS if path.sharpness[segment] == 0.0 else RAMP_INTERVALS)
    assert (width <= SPACING * 1.001).all()
    assert (width * path.sharpest[grid.segment] <= STEP * 1.001).all()
