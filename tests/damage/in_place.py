"""Damage to where the tool is: beside its path, above the sheet, off the sheet, not at rest where it should be."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, IntArray
from deltacam.program.program import Program
from tests.damage.aim import NoPlaceError, aim
from tests.damage.example import SAGITTA, WORKING, Example
from tests.damage.kind import Mutant
from tests.damage.rows import at_points, gathered

MICROMETRE = 1e-6
BUMP = 20  # ticks
TRIES = 100  # of places for one

Make = Callable[[Example, float, np.random.Generator], Program]


def beside_path(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """One setpoint of a cut or of engraving moved in the sheet's plane, to so many tolerances from its path."""
    row = int(chance.choice(case.rows(*WORKING)))
    angle = chance.uniform(0.0, 2.0 * np.pi)
    way = np.array([[np.cos(angle), np.sin(angle), 0.0]])
    return _moved(case, np.array([row]), way, amount)


def hidden_by_tolerance(case: Example, amount: float, chance: np.random.Generator) -> Mutant:
    """The same where the tolerance in the meta object is a thousand times as large, checked against the real one."""
    moved, process = beside_path(case, amount, chance), case.program.process
    return Mutant(replace(moved, process=replace(process, tolerance=1e3 * process.tolerance)), process=process)


def bulge(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """Twenty setpoints moved smoothly to one side, to so many tolerances from the path."""
    rows, way = _bump(case, chance)
    return _moved(case, rows, way, amount)


def into_the_part(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """The same towards the finished part, to so many times what the edge of a part may be off."""
    for _ in range(TRIES):
        rows, way = _bump(case, chance)
        if case.contour(int(rows[0])).has_kerf and _straight(case, rows):
            break
    else:
        raise NoPlaceError  # at a corner of the path the edge may be off by more
    here = rows[[BUMP // 2]]
    sign = np.sign(float(np.dot(_to_line(case, here)[0], way[BUMP // 2]))) or 1.0
    size = amount * _edge_limit(case) + float(case.off_path(here, case.tool[here])[0])
    return at_points(case.program, rows, case.tool[rows] + size * sign * way)


def too_near_to_line(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """All cuts moved towards the drawn line, until one of their ticks is so many tolerances from its path."""
    rows = _beside_line(case)
    steps = _to_line(case, rows)
    steps /= np.linalg.norm(steps, axis=1, keepdims=True)
    one = int(chance.integers(len(rows)))
    tolerance = case.program.process.tolerance

    def distance(size: float) -> float:
        return float(case.off_path(rows[[one]], case.tool[rows[[one]]] + size * steps[[one]])[0]) / tolerance

    return at_points(case.program, rows, case.tool[rows] + aim(distance, amount, start=1e-6) * steps)


def kerf_side(case: Example, amount: float, _: np.random.Generator) -> Program:
    """All cuts moved across the drawn line by so many half kerfs: 1 is on the line, 2 on the wrong side."""
    rows = _beside_line(case)
    return at_points(case.program, rows, case.tool[rows] + amount * _to_line(case, rows))


def parts_too_small(case: Example, amount: float, _: np.random.Generator) -> Program:
    """All cuts moved towards the drawn line by so many times what the edge of a part may be off."""
    rows = _beside_line(case)
    step = _to_line(case, rows)
    # Rounded corners may have shifted the mean of the edge the other way, by no more than the tolerance.
    distance = amount * _edge_limit(case) + case.program.process.tolerance
    return at_points(
        case.program, rows, case.tool[rows] + distance * step / np.linalg.norm(step, axis=1, keepdims=True)
    )


def above_sheet(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """One setpoint above or below the sheet by so many micrometres."""
    row = np.array([int(chance.integers(len(case.tool)))])
    height = np.array([0.0, 0.0, chance.choice([-1.0, 1.0]) * amount * MICROMETRE])
    return at_points(case.program, row, case.tool[row] + height)


def beside_park(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """The first or the last setpoint beside the park position by so many micrometres."""
    row = np.array([int(chance.choice([0, len(case.tool) - 1]))])
    return at_points(case.program, row, case.tool[row] + amount * MICROMETRE * _sideways(chance))


def moved_in_pierce(last: bool) -> Make:
    """The tool moves by so many micrometres for a tick of a pierce, or in its last tick."""

    def make(case: Example, amount: float, chance: np.random.Generator) -> Program:
        pierces = [block for block in case.program.blocks if block.kind is BlockKind.PIERCE]
        if not pierces or case.program.process.pierce_time * case.rate < 2.0:
            raise NoPlaceError
        block = pierces[int(chance.integers(len(pierces)))]
        row = np.array([block.last + 1 if last else int(chance.integers(block.first, block.last)) + 1])
        return at_points(case.program, row, case.tool[block.first] + amount * MICROMETRE * _sideways(chance))

    return make


def off_the_sheet(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """Everything but the park position shifted with its placement, until it is so many micrometres off the sheet."""
    workspace = case.robot.workspace
    rows = np.arange(1, len(case.tool) - 1)
    way = _sideways(chance)[0]

    def excess(size: float) -> float:
        return float(workspace.excess((case.tool[rows] + size * way)[:, :2]).max()) / MICROMETRE

    shift = aim(excess, amount, start=1e-2) * way
    where = case.program.placement
    moved = replace(case.program, placement=replace(where, x=where.x + shift[0], y=where.y + shift[1]))
    return at_points(moved, rows, case.tool[rows] + shift)


def fewer_rows(above_sheet: bool) -> Make:
    """Every n-th row alone, at a lower rate, so that the way between them is so many times off what it may be.

    That is the path, for the sum of both tolerances, or the plane of the sheet, for the tolerance of the chords.
    """

    def make(case: Example, amount: float, _: np.random.Generator) -> Program:
        limit = amount * (_edge_limit(case) - (case.program.process.tolerance if above_sheet else 0.0))
        for step in range(2, len(case.tool) // 8):
            index = np.arange(0, len(case.tool), step)
            if _off_between(case, index, above_sheet) > limit:
                controller = replace(case.robot.controller, rate_hz=case.rate / step, interpolation="linear")
                return replace(gathered(case.program, index), robot=replace(case.robot, controller=controller))
        raise NoPlaceError

    return make


def off_sheet_of_robot(case: Example, amount: float, chance: np.random.Generator) -> Mutant:
    """Checked against a robot whose sheet ends so many micrometres before the program does."""
    return _on_smaller_sheet(case, case.tool, amount * MICROMETRE, chance)


def off_sheet_between(case: Example, amount: float, chance: np.random.Generator) -> Mutant:
    """The same between two ticks, by so many tolerances of the chords."""
    return _on_smaller_sheet(case, case.middles, amount * (case.program.process.chord_tolerance + MICROMETRE), chance)


def _on_smaller_sheet(case: Example, tool: Array, distance: float, chance: np.random.Generator) -> Mutant:
    """Checked against a robot whose sheet ends so far before the furthest of some points."""
    axis = int(chance.integers(2))
    size = [10.0, 10.0]
    size[axis] = 2.0 * (float(np.abs(tool[:, axis]).max()) - distance)
    workspace = replace(case.robot.workspace, width=size[0], depth=size[1], radius=None)
    return Mutant(case.program, robot=replace(case.robot, workspace=workspace))


def _edge_limit(case: Example) -> float:
    """How far the way of the beam may be off between the ticks, m."""
    return case.program.process.tolerance + case.program.process.chord_tolerance + MICROMETRE


def _off_between(case: Example, index: IntArray, above_sheet: bool) -> float:
    """How far the way straight from row to row, of those in ``index``, is off the sheet's plane or off its path, m."""
    start, end, block = index[:-1], index[1:], case.program.block
    if not above_sheet:
        working = np.isin(case.kind[start].astype(str), WORKING) & (block[start] == block[end])
        start, end = start[working], end[working]
    middles = case.robot.forward(0.5 * (case.program.q[start] + case.program.q[end]))
    off = np.abs(middles[:, 2] - case.program.placement.z) if above_sheet else case.off_path(start, middles)
    return float(off.max(initial=0.0))


def _moved(case: Example, rows: IntArray, way: Array, amount: float) -> Program:
    """The rows moved along ``way``, so far that the furthest of them is ``amount`` tolerances from its path."""
    start, limit = case.tool[rows], case.program.process.tolerance

    def distance(size: float) -> float:
        return float(case.off_path(rows, start + size * way).max()) / limit

    return at_points(case.program, rows, start + aim(distance, amount, start=1e-8) * way)


def _bump(case: Example, chance: np.random.Generator) -> tuple[IntArray, Array]:
    """Rows inside one cut, and a smooth way to one side for them, 1 m in their middle."""
    blocks = [block for block in case.program.blocks if block.kind is BlockKind.CUT and block.last - block.first > BUMP]
    if not blocks:
        raise NoPlaceError
    block = blocks[int(chance.integers(len(blocks)))]
    rows = int(chance.integers(block.first, block.last - BUMP + 1)) + np.arange(BUMP + 1)
    along = case.tool[rows[BUMP // 2 + 1]] - case.tool[rows[BUMP // 2 - 1]]
    side = np.array([-along[1], along[0], 0.0]) / np.hypot(along[0], along[1]) * chance.choice([-1.0, 1.0])
    return rows, np.sin(np.pi * np.arange(BUMP + 1) / BUMP)[:, np.newaxis] ** 2 * side


def _straight(case: Example, rows: IntArray) -> bool:
    """Whether the way has no sharp corner at these rows, and at as many before and after them."""
    way = case.tool[max(rows[0] - BUMP, 0) : rows[-1] + BUMP + 1, :2]
    length = float(np.hypot(*np.diff(way, axis=0).T).sum())
    return bool(np.hypot(*(way[-1] - way[0])) >= 0.97 * length)


def _beside_line(case: Example) -> IntArray:
    """The rows of cuts that are half a kerf beside their line."""
    cuts = [block for block in case.program.blocks if block.kind is BlockKind.CUT]
    rows = [np.arange(block.first, block.last + 1) for block in cuts if case.contour(block.first).has_kerf]
    if not rows or case.program.process.kerf == 0.0:
        raise NoPlaceError
    return np.concatenate(rows)


def _to_line(case: Example, rows: IntArray) -> Array:
    """The way from the tool to the nearest point of the drawn line at some rows, (M, 3) m in the base frame."""
    where = case.program.placement
    cos, sin = np.cos(where.rotation), np.sin(where.rotation)
    sheet = case.sheet(case.tool[rows])
    found = np.zeros((len(rows), 3))
    numbers = case.program.block[rows]
    for number in np.unique(numbers).tolist():
        mine = np.flatnonzero(numbers == number)
        ring = shapely.LinearRing(curves.flatten(case.contour(int(rows[mine[0]])).curve, SAGITTA)[0])
        points = shapely.points(sheet[mine])
        nearest = shapely.line_interpolate_point(ring, shapely.line_locate_point(ring, points))
        found[mine, :2] = (shapely.get_coordinates(nearest) - sheet[mine]) @ np.array([[cos, sin], [-sin, cos]])
    return found


def _sideways(chance: np.random.Generator) -> Array:
    angle = chance.uniform(0.0, 2.0 * np.pi)
    return np.array([[np.cos(angle), np.sin(angle), 0.0]])
