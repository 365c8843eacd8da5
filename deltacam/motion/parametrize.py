"""The fastest time law along a route within every limit, by toppra (Pham and Pham 2018).

toppra goes along the grid backwards for the largest speed from which the rest of the way can be driven, then forwards
for the largest speed that stays below it; every step is a linear program in two variables. Its own loop around these
programs costs five times the programs, so the loop here calls its compiled solver; where that cannot be had, its public
interface does the same.

The variables of a step are x, the squared speed at the start of an interval, and w, its change over the interval. With
d the length of the interval the path acceleration is u = w / 2d, and the squared speed after the share f of it x + f w.
So a quantity a u + b x there is (a / 2d + f b) w + b x.
"""

from __future__ import annotations

import logging
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Final, NamedTuple

import numpy as np

from deltacam.errors import InfeasibleError
from deltacam.model import Array, IntArray
from deltacam.motion.law import TimeLaw
from deltacam.motion.route import Grid, Route
from deltacam.motion.rows import SIDES, STATIONS, Rows

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

_STEPS_BACK: Final = tuple(1e-8 * 2.0**power for power in range(27))  # the last is most of the way to a stop
_SLICE: Final = 4096  # steps for one solver, which keeps 1.7 kB for each
_SLICES_KEPT: Final = 16
_BACKWARDS: Final = np.array([1e-9, -1.0])
_FORWARDS: Final = np.array([-1.0, -1.0])


def parametrize(route: Route, robot: Robot) -> TimeLaw:
    """The fastest motion along every move of a route from rest to rest.

    Raises:
        UndrivableError: a move has none; says which, and where it stops being drivable.
        RobotError: the path leaves the reach of the robot.
    """
    grid = Grid.over(route, robot)
    return solve(grid, Rows.over(route, grid, robot))


def solve(grid: Grid, rows: Rows, slowness: Array | None = None) -> TimeLaw:
    """The fastest motion within the rows.

    Args:
        grid: of the route.
        rows: the limits on its intervals.
        slowness: (I,) in 0 to 1; as if the clock ran so much slower there: the speeds are lower by this factor and the
            accelerations by its square.

    Raises:
        UndrivableError: there is none.
    """
    program = _Program.of(grid, rows, np.ones(len(rows.width)) if slowness is None else slowness**2)
    squared = program.unit * _profile(program)
    squared[grid.rest] = 0.0
    return TimeLaw.of(grid.distance, squared, grid.rest)


class UndrivableError(InfeasibleError):
    """A move has no motion within the limits.

    Attributes:
        move: its number in the route.
        place: where it stops being drivable, m from its start.
    """

    def __init__(self, move: int, place: float, length: float) -> None:
        super().__init__(
            f"no motion within the limits passes {place * 1e3:.3f} mm of {length * 1e3:.3f} mm along this path",
            hint="this is likely a fault of deltacam: please report it with the drawing",
        )
        self.move = move


class _Block(NamedTuple):
    """Rows of every step: F (a w + b x + c) <= 0 with a, b and c (I + 1, m) and F (k, m); the last point has none."""

    a: Array
    b: Array
    c: Array
    F: Array


class _Program(NamedTuple):
    """The linear programs of all steps of a grid, in numbers near 1, because toppra has absolute tolerances.

    Attributes:
        blocks: the rows.
        highest: (I + 1,) largest x.
        unit: (I + 1,) m2/s2, what 1 stands for in x and w: the largest squared speed of the move.
        distance: (I + 1,) m, the gridpoints, for messages.
        rest: (K + 1,) those at which moves begin, and the last.
    """

    blocks: list[_Block]
    highest: Array
    unit: Array
    distance: Array
    rest: IntArray

    @classmethod
    def of(cls, grid: Grid, rows: Rows, share: Array) -> _Program:
        """The programs within ``share`` (I,) of every limit."""
        fastest = np.maximum.reduceat(rows.bound.max(axis=0), grid.rest[:-1])
        unit = np.repeat(fastest, np.diff(grid.rest))
        scale, steep = (unit / share)[:, None], (unit / share / (2.0 * rows.width))[:, None]
        blocks = []
        for station, passed in enumerate(STATIONS):
            x = rows.joint_b[station] * scale
            blocks.append(_block(rows.joint_a[station] * steep + passed * x, x, _JOINTS))
            x = rows.across[station][:, None] * scale * _TOOL_X
            blocks.append(_block(rows.along[:, None] * steep * _TOOL_W + passed * x, x, _TOOL))
            if 0.0 < passed < 1.0:  # the ends are bounded by `highest`
                x = scale / rows.bound[station][:, None]
                blocks.append(_block(passed * x, x, np.array([[1.0, 1.0]])))
        bound = share * np.stack([rows.bound[0], rows.bound[-1]]) / unit
        highest = np.minimum(np.append(bound[0], np.inf), np.insert(bound[1], 0, np.inf))
        highest[grid.rest] = 0.0
        return cls(blocks, highest, np.append(unit, unit[-1]), grid.distance, grid.rest)

    def part(self, number: int) -> _Program:
        """The steps of one slice."""
        points = slice(number * _SLICE, (number + 1) * _SLICE + 1)
        blocks = [_Block(block.a[points], block.b[points], block.c[points], block.F) for block in self.blocks]
        return self._replace(blocks=blocks, highest=self.highest[points])

    def undrivable(self, point: int) -> UndrivableError:
        """The error for a gridpoint that cannot be passed."""
        move = min(int(np.searchsorted(self.rest, point, side="right")), len(self.rest) - 1) - 1
        start, end = self.distance[self.rest[move : move + 2]]
        return UndrivableError(move, float(self.distance[point] - start), float(end - start))


_JOINTS: Final = np.hstack([np.concatenate([np.eye(3), -np.eye(3)]), np.ones((6, 1))])
_ANGLE: Final = (np.arange(SIDES) + 0.5) * np.pi / SIDES
_TOOL: Final = np.column_stack([np.cos(_ANGLE), np.sin(_ANGLE), np.full(SIDES, np.cos(0.5 * np.pi / SIDES))])
_TOOL_W: Final = np.array([1.0, 0.0])
_TOOL_X: Final = np.array([0.0, 1.0])


def _block(w: Array, x: Array, F: Array) -> _Block:
    """The rows F (w W + x X) <= the last column of F, scaled so that no factor of a step is above 1."""
    size = 1.0 / np.maximum(1.0, np.maximum(np.abs(w), np.abs(x)).max(axis=1, keepdims=True))
    none = np.zeros_like(size)
    parts = [np.hstack([w * size, none]), np.hstack([x * size, none]), np.hstack([np.zeros_like(w), -size])]
    last = np.zeros((1, F.shape[1]))
    a, b, c = (np.concatenate([part, last]) for part in parts)
    c[-1, -1] = -1.0
    return _Block(a, b, c, F)


def load_solver() -> None:
    """Import toppra, which takes about a second, because it loads matplotlib."""
    import toppra  # noqa: F401


def _profile(program: _Program) -> Array:
    """The largest x at every gridpoint, (I + 1,), by toppra's compiled solver or else by its public interface."""
    try:
        from toppra.solverwrapper.cy_seidel_solverwrapper import seidelWrapper
    except ImportError:
        return _by_public_interface(program)
    return _by_compiled_solver(program, seidelWrapper)


def _by_compiled_solver(program: _Program, wrapper: Any) -> Array:
    count, nan = len(program.highest) - 1, float("nan")

    @lru_cache(maxsize=_SLICES_KEPT)
    def steps(part: int) -> Any:
        return wrapper(*_for_toppra(program.part(part))).solve_stagewise_optim

    starts = range(0, count, _SLICE)
    highest, after = [0.0] * (count + 1), 0.0
    for start in reversed(starts):
        step = steps(start // _SLICE)
        for inside in range(min(_SLICE, count - start) - 1, -1, -1):
            # x = 0 is always drivable: the lower end of the controllable set needs no program.
            after = step(inside, None, _BACKWARDS, nan, nan, 0.0, after)[1]
            if after != after:
                raise program.undrivable(start + inside)
            highest[start + inside] = after
    x, squared = 0.0, [0.0] * (count + 1)
    for start in starts:
        step = steps(start // _SLICE)
        for point in range(start, min(start + _SLICE, count)):
            after = highest[point + 1]
            change = step(point - start, None, _FORWARDS, x, x, 0.0, after)[0]
            if change != change:
                x, change = _step_back(step, point - start, x, after)
                if change != change:
                    raise program.undrivable(point)
                squared[point] = x
            x += change
            squared[point + 1] = x = 0.0 if x < 0.0 else after if x > after else x
    return np.array(squared)


def _step_back(step: Any, inside: int, x: float, after: float) -> tuple[float, float]:
    """An x a little below, and its change: at the very edge of the controllable set rounding may leave no solution."""
    change = float("nan")
    for back in _STEPS_BACK:
        x *= 1.0 - back
        change = step(inside, None, _FORWARDS, x, x, 0.0, after)[0]
        if change == change:
            break
    return x, change


def _by_public_interface(program: _Program) -> Array:
    from toppra.algorithm import TOPPRA

    logging.getLogger("toppra").setLevel(logging.ERROR)  # what it warns of is found out, and said, below
    constraints, path, grid = _for_toppra(program)
    solver = TOPPRA(constraints, path, grid, solver_wrapper="seidel", parametrizer="ParametrizeConstAccel")
    _, speed, _, controllable = solver.compute_parameterization(0.0, 0.0, return_data=True)
    if speed is None or not np.isfinite(speed).all():
        lost = np.flatnonzero(np.isnan(controllable).any(axis=1) | ~np.isfinite(0.0 if speed is None else speed))
        raise program.undrivable(int(lost[-1]) if len(lost) else 0)
    return np.asarray(speed, dtype=np.float64) ** 2


def _for_toppra(program: _Program) -> tuple[list[Any], Any, Array]:
    """The constraints, the path and the gridpoints; those are half apart, so that its u, (x' - x) / 2 d, is w."""
    from toppra.constraint import LinearConstraint

    class Rows(LinearConstraint):  # type: ignore[misc]
        """One block of rows; the bounds of the variables come with one of them, because reading them takes long."""

        def __init__(self, block: _Block, bounds: tuple[Array, Array] | tuple[None, None]) -> None:
            super().__init__()
            self.identical = True
            self.parameters = *block, np.zeros(len(block.F)), *bounds

        def compute_constraint_params(self, *_: object) -> tuple[Any, ...]:
            return self.parameters

    # x is at most 1, and so is its change: without that bound, rows with tiny factors would matter to the solver.
    change = np.tile([-1.0, 1.0], (len(program.highest), 1))
    bounds = change, np.column_stack([np.zeros_like(program.highest), program.highest])
    grid = np.linspace(0.0, 0.5 * (len(program.highest) - 1), len(program.highest))
    constraints = [Rows(block, bounds if block is program.blocks[0] else (None, None)) for block in program.blocks]
    return constraints, _Interval(grid), grid


class _Interval:
    """What toppra asks of a geometric path when the constraints bring their own derivatives."""

    def __init__(self, grid: Array) -> None:
        self.path_interval = np.array([grid[0], grid[-1]])
        self.duration = float(grid[-1] - grid[0])
        self.dof = 3

    def get_duration(self) -> float:
        """The old name of ``duration``, which the compiled solver uses."""
        return self.duration
