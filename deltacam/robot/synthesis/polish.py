"""From a good candidate to the bottom: linear programs over the points where a demand is closest to its limit.

The optimum of a dimensional synthesis lies where several demands bind at once, each at some point of the surface, and
near it every one of them is nearly linear in the four unknowns. A step is the linear program of those points within a
region of trust; it is taken if the size plus a price for the worst excess over a fine grid becomes smaller, and the
region shrinks if not (the exact penalty method; Fletcher, "Practical methods of optimization", 1987, 14.4).
"""

from __future__ import annotations

from typing import Final

import numpy as np
from scipy.optimize import linprog

from deltacam.model import Array
from deltacam.robot.synthesis.demands import Demand, bounds_excess, excesses
from deltacam.robot.synthesis.search import Problem
from deltacam.robot.synthesis.shape import grid, surface
from deltacam.robot.synthesis.wish import Wish

_SIDE: Final = 21  # points along a side of the surface
_CLOSEST: Final = 8  # points per demand that enter the linear program
_PRICE: Final = 1e3  # of an excess, in diagonals; more than a demand is worth at any optimum
_TRUST: Final = 0.02  # of every unknown at first, in diagonals
_LEAST_TRUST: Final = 1e-8  # then it is the bottom
_STEPS: Final = 80
_STEP: Final = 1e-6  # of the differences, in diagonals
_HALVINGS: Final = 14  # of the step between grid points, when a worst point is refined
_AROUND: Final = grid(3) * 2.0 - 1.0


def polish(problem: Problem, candidate: Array) -> Array:
    """The smallest candidate (4,) near this one that meets the demands at every point that was looked at."""
    wish, demands = problem.wish, problem.demands
    cube = fine_cube()
    for _ in range(3):
        cube = np.unique(np.vstack((cube, worst_places(wish, demands, candidate, cube))), axis=0)
        candidate = _descend(problem, candidate, wish.shape.place(cube))
    return candidate


def fine_cube() -> Array:
    """Points of the unit cube: its surface finely, and some inside, (N, 3)."""
    return np.vstack((surface(_SIDE), grid(5)[(np.abs(grid(5) - 0.5) < 0.5).all(axis=1)]))


def worst_places(wish: Wish, demands: tuple[Demand, ...], candidate: Array, cube: Array) -> Array:
    """For every demand the worst of the unit-cube points, moved to the nearest worst place of all: (K * n, 3)."""
    values = excesses(demands, candidate[np.newaxis], wish.shape.place(cube))[:, 0]
    best = np.argsort(-values, axis=1, kind="stable")[:, :_CLOSEST]
    at = cube[best]  # (K, n, 3)
    step = 1.0 / (_SIDE - 1)
    for _ in range(_HALVINGS):
        step /= 2.0
        near = np.clip(at[:, :, np.newaxis] + step * _AROUND, 0.0, 1.0)
        found = excesses(demands, candidate[np.newaxis], wish.shape.place(near.reshape(-1, 3)))[:, 0]
        own = found.reshape(len(demands), *near.shape[:3])[np.arange(len(demands)), np.arange(len(demands))]
        at = np.take_along_axis(near, own.argmax(axis=2)[:, :, np.newaxis, np.newaxis], axis=2)[:, :, 0]
    return np.asarray(at.reshape(-1, 3))


def _descend(problem: Problem, candidate: Array, points: Array) -> Array:
    """Linear programs, one after another, from a candidate down."""
    unit = problem.wish.shape.diagonal
    trust = _TRUST
    value = _merit(problem, candidate[np.newaxis], points)[0]
    for _ in range(_STEPS):
        step = _program(problem, candidate, points, trust * unit)
        tried = [] if step is None else [candidate + step]
        merit = _merit(problem, np.array(tried), points)[0] if tried else np.inf
        if merit < value - 1e-12 * unit:
            candidate, value, trust = tried[0], merit, trust * 1.5
        else:
            trust /= 4.0
        if trust < _LEAST_TRUST:
            break
    return candidate


def _merit(problem: Problem, candidates: Array, points: Array) -> Array:
    worst = problem.violations(candidates, points).max(axis=1)
    return np.asarray(candidates[:, :3].sum(axis=1) + _PRICE * problem.wish.shape.diagonal * worst)


def _program(problem: Problem, candidate: Array, points: Array, trust: float) -> Array | None:
    """The best step of at most ``trust`` m if the closest demands were linear, (4,) m."""
    wish, unit = problem.wish, problem.wish.shape.diagonal
    excess = excesses(problem.demands, candidate[np.newaxis], points)[:, 0] + problem.margin
    closest = np.argsort(-excess, axis=1, kind="stable")[:, :_CLOSEST]
    used, place = np.unique(closest, return_inverse=True)
    slope = _slopes(problem, candidate, points[used])  # (4, K, U)
    place = place.reshape(closest.shape)
    rows = np.take_along_axis(slope, np.broadcast_to(place, (4, *place.shape)), axis=2).reshape(4, -1).T
    values = np.take_along_axis(excess, closest, axis=1).ravel()
    bounds = bounds_excess(wish, np.vstack((candidate, candidate + unit * np.eye(4)))) / unit
    rows, values = np.vstack((rows, (bounds[1:] - bounds[0]).T / unit)), np.concatenate((values, bounds[0]))
    # The last unknown is the worst excess that remains, in diagonals' worth of size.
    solved = linprog(
        [1.0, 1.0, 1.0, 0.0, _PRICE],
        A_ub=np.column_stack((rows * unit, np.full(len(rows), -1.0))),
        b_ub=-values,
        bounds=[(-trust / unit, trust / unit)] * 4 + [(0.0, None)],
        method="highs",
    )
    return solved.x[:4] * unit if solved.status == 0 else None


def _slopes(problem: Problem, candidate: Array, points: Array) -> Array:
    """The excess of every demand differentiated by the four unknowns, (4, K, N) per m, by central differences."""
    step = _STEP * problem.wish.shape.diagonal
    moved = np.vstack((candidate + step * np.eye(4), candidate - step * np.eye(4)))
    found = excesses(problem.demands, moved, points).transpose(1, 0, 2)
    return np.asarray((found[:4] - found[4:]) / (2.0 * step))
