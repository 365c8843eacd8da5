"""The global search: differential evolution over robots of any size, without a gradient and with a seed.

The unknowns are the shape of the robot and its size apart: the logarithm of La + Lb, La and R - r and the depth of the
workspace as parts of La + Lb. A shape that cannot do what is asked at one size is soon found out at every size.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np
from scipy.optimize import OptimizeResult, differential_evolution

from deltacam.model import Array
from deltacam.robot.synthesis.demands import Demand, bounds_excess, excesses
from deltacam.robot.synthesis.shape import grid, surface
from deltacam.robot.synthesis.wish import Wish

Progress = Callable[[int, int], None]
"""Called with how many rounds are done, and of how many at most."""

_PARTS: Final = ((0.05, 0.95), (-1.0, 1.5), (0.0, 1.0))  # La, R - r and depth, of La + Lb
_SMALLEST: Final = 0.3  # La + Lb at least, in diagonals: no shorter arms reach from end to end
_POPULATION: Final = 20  # per unknown
_ROUNDS: Final = 300
_CONVERGED: Final = 1e-4  # spread of the population's sizes, relative
_HARDNESS: Final = 10.0  # of the bounds on the dimensions beside the demands, which are what an impossible wish misses
_SIDE: Final = 7  # points along a side of the surface


@dataclass(frozen=True, slots=True)
class Problem:
    """A wish made ready for a search.

    Attributes:
        wish: what is asked.
        demands: those of the wish that hold at every point.
        margin: by how much every one of them is tightened, in its excess.
        relaxed: the index of the demand whose excess is made small instead of the size; None for the size.
    """

    wish: Wish
    demands: tuple[Demand, ...]
    margin: float = 0.0
    relaxed: int | None = None

    def violations(self, candidates: Array, points: Array) -> Array:
        """What every demand misses, 0 where it is met: (C, K), and in the last column the bounds."""
        missed = excesses(self.demands, candidates, points).max(axis=2).T + self.margin
        outside = _HARDNESS * bounds_excess(self.wish, candidates) / self.wish.shape.diagonal
        return np.asarray(np.maximum(np.column_stack((missed, outside.max(axis=1))), 0.0))

    def objective(self, candidates: Array, points: Array) -> Array:
        """What is to be small, (C,): the size where all is met, and above every size where something is missed."""
        violations = self.violations(candidates, points)
        if self.relaxed is not None:
            wanted = excesses(self.demands[self.relaxed : self.relaxed + 1], candidates, points)[0].max(axis=1)
            others = np.delete(violations, self.relaxed, axis=1).sum(axis=1)
            return np.asarray(np.where(others > 0.0, 10.0 + others, wanted))
        missed = violations.sum(axis=1)
        limit = self.wish.size_limit
        return np.asarray(
            np.where(missed > 0.0, limit + self.wish.shape.diagonal * missed, candidates[:, :3].sum(axis=1))
        )


def search_points(wish: Wish) -> Array:
    """Where the search looks: the surface of the workspace, and a few points inside, (N, 3) m."""
    return wish.shape.place(np.unique(np.vstack((surface(_SIDE), grid(3))), axis=0))


def search(problem: Problem, *, seed: int, progress: Progress | None = None, start: Array | None = None) -> Array:
    """The best candidate (4,) m that differential evolution finds; it may miss demands.

    Args:
        problem: what is searched for.
        seed: of the random numbers; the same seed gives the same candidate.
        progress: called after every round.
        start: a candidate (4,) to begin near.
    """
    wish = problem.wish
    points = search_points(wish)
    limits = _limits(wish)
    rounds = [0]

    def objective(unknowns: Array) -> Array:
        return problem.objective(decode(unknowns.T), points)

    def count(intermediate_result: OptimizeResult) -> None:  # noqa: ARG001 - scipy looks at this name
        rounds[0] += 1
        if progress is not None:
            progress(rounds[0], _ROUNDS)

    found = differential_evolution(
        objective,
        limits,
        init="sobol" if start is None else _near(start, limits, seed),
        popsize=_POPULATION,
        maxiter=_ROUNDS,
        tol=0.0,
        atol=_CONVERGED * wish.shape.diagonal,
        rng=seed,
        polish=False,
        vectorized=True,
        updating="deferred",
        callback=count,
    )
    return np.asarray(decode(found.x[np.newaxis])[0])


def decode(unknowns: Array) -> Array:
    """The candidates (C, 4) of unknowns (C, 4)."""
    arms = np.exp(unknowns[:, 0])
    upper, offset, depth = unknowns[:, 1] * arms, unknowns[:, 2] * arms, unknowns[:, 3] * arms
    return np.asarray(np.column_stack((offset, upper, arms - upper, -depth)))


def encode(candidates: Array) -> Array:
    """The unknowns (C, 4) of candidates (C, 4)."""
    offset, La, Lb, middle = candidates.T
    arms = La + Lb
    return np.asarray(np.column_stack((np.log(arms), La / arms, offset / arms, -middle / arms)))


def _limits(wish: Wish) -> list[tuple[float, float]]:
    shortest = _SMALLEST * wish.shape.diagonal
    return [(float(np.log(shortest)), float(np.log(max(2.0 * wish.size_limit, 2.0 * shortest)))), *_PARTS]


def _near(start: Array, limits: list[tuple[float, float]], seed: int) -> Array:
    """A first population: a third close about the start, the others anywhere, and the start itself."""
    random = np.random.default_rng([seed, 1])
    low, high = np.array(limits).T
    count = _POPULATION * len(limits)
    anywhere = random.uniform(low, high, (count, len(limits)))
    middle = encode(start[np.newaxis])[0]
    close = middle + 0.05 * random.standard_normal((count // 3, len(limits))) * (high - low)
    anywhere[: len(close)] = close
    anywhere[0] = middle
    return np.clip(anywhere, low, high)
