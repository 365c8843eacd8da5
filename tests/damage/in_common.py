"""Damage to programs in which one cut serves the edges of two outlines."""

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np

from deltacam.model import BlockKind
from deltacam.program.program import Program
from tests.damage.stretches import Job, Stretch, along, jobs, together

Damage = Callable[[Program, int], Program]
"""Damages what is done to a contour, by its number."""


def number_of(job: Job) -> int | None:
    """The contour that a job works on."""
    return job[-1].block.contour


def left_out(program: Program, contour: int) -> Program:
    """The last cut of a contour is not there."""
    todo = jobs(program)
    del todo[_of(todo, contour)[-1]]
    return together(program, todo)


def made_first(program: Program, contour: int) -> Program:
    """The cuts of a contour come before all others."""
    todo = jobs(program)
    mine = _of(todo, contour)
    others = [job for index, job in enumerate(todo) if index not in mine]
    return together(program, [*(todo[index] for index in mine), *others])


def made_again(program: Program, contour: int) -> Program:
    """The last cut of a contour is made twice."""
    todo = jobs(program)
    return together(program, [*todo, todo[_of(todo, contour)[-1]]])


def made_partly_again(program: Program, contour: int, place: tuple[float, float]) -> Program:
    """What the last cut of a contour does within 4 mm of a place, (x, y) m, is done again at the end."""
    todo = jobs(program)
    *before, cut = todo[_of(todo, contour)[-1]]
    points = program.robot.forward(cut.q)
    way = replace(cut, q=along(program, points[np.hypot(*(points[:, :2] - place).T) < 4e-3], program.process.feed))
    return together(program, [*todo, (*(_moved(stretch, way.q[0]) for stretch in before), way)])


def begun_late(program: Program, contour: int) -> Program:
    """The last cut of a contour begins 0.4 mm late."""
    return _with_way(program, contour, lambda points: points[_distance(points) >= 0.4e-3])


def ended_early(program: Program, contour: int) -> Program:
    """The last cut of a contour ends 0.4 mm early."""
    return _with_way(program, contour, lambda points: points[_distance(points[::-1])[::-1] >= 0.4e-3])


def partly_back(program: Program, contour: int) -> Program:
    """The last cut of a contour goes back by a third at its end."""
    return _with_way(program, contour, lambda points: np.concatenate([points, points[: 2 * len(points) // 3 : -1]]))


def bridged(program: Program, contour: int, place: tuple[float, float]) -> Program:
    """The laser is off within 0.7 mm of a place on the first cut of a contour, (x, y) m; that is said to be a tab."""
    blocks, power = list(program.blocks), program.power.copy()
    index = next(i for i, one in enumerate(blocks) if one.kind is BlockKind.CUT and one.contour == contour)
    cut = blocks[index]
    tool = program.robot.forward(program.q[cut.first : cut.last + 1])[:, :2]
    near = cut.first + np.flatnonzero(np.hypot(*(tool - place).T) < 0.7e-3)
    first, last = int(near[0]), int(near[-1])
    tab = replace(cut, kind=BlockKind.TAB, first=first, last=last)
    blocks[index : index + 1] = [replace(cut, last=first - 1), tab, replace(cut, first=last + 1)]
    power[first : last + 1] = 0.0
    column = np.repeat(np.arange(len(blocks)), [one.last - one.first + 1 for one in blocks])
    return replace(program, blocks=tuple(blocks), power=power, block=column)


def not_asked_for(program: Program, _: int) -> Program:
    """The process says nothing of common edges."""
    return replace(program, process=replace(program.process, common_edges=False))


def _of(todo: Sequence[Job], contour: int) -> list[int]:
    return [index for index, job in enumerate(todo) if number_of(job) == contour]


def _with_way(program: Program, contour: int, change: Callable[[np.ndarray], np.ndarray]) -> Program:
    """The program with the points along the last cut of a contour changed, (N, 3) m."""
    todo = jobs(program)
    index = _of(todo, contour)[-1]
    *before, cut = todo[index]
    points = change(program.robot.forward(cut.q))
    way = replace(cut, q=along(program, points, 0.2 * program.process.feed))
    pierces = [_moved(stretch, way.q[0]) for stretch in before]
    return together(program, [*todo[:index], (*pierces, way), *todo[index + 1 :]])


def _moved(stretch: Stretch, q: np.ndarray) -> Stretch:
    """A rest at another place."""
    return replace(stretch, q=np.repeat(q[None], len(stretch.q), axis=0))


def _distance(points: np.ndarray) -> np.ndarray:
    """How far along a line its points are, (N,) m."""
    return np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
