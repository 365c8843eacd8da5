"""Damage to what is beside the cut itself: leads, loops, tabs and the overcut."""

from dataclasses import replace

import numpy as np

from deltacam.cutting.kerf import offset
from deltacam.geometry import curve as curves
from deltacam.model import Block, BlockKind, Heat
from deltacam.program.program import Program
from tests.damage.aim import NoPlaceError
from tests.damage.example import Example


def lead_said_to_be_loop(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """So many lead-ins said to be loops, before which nothing was cut."""
    return _renamed(case, BlockKind.LEAD_IN, BlockKind.LOOP, amount, chance)


def lead_out_said_to_be_tab(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """So many lead-outs said to be tabs, behind which nothing is cut."""
    return _renamed(case, BlockKind.LEAD_OUT, BlockKind.TAB, amount, chance)


def longer_overcut_in_meta(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The process asks for an overcut that is longer than the shortest there is by so many limits."""
    process = case.program.process
    reached = [length + step for length, step in _overcuts(case)]
    if not reached:
        raise NoPlaceError
    return replace(case.program, process=replace(process, overcut=min(reached) + amount * _limit(case)))


def shorter_overcut_in_meta(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The process asks for an overcut that is shorter than the longest there is by so many limits."""
    process = case.program.process
    tick = process.feed / case.rate
    over = [length - max(step, tick) - step for length, step in _overcuts(case)]
    if not over or max(over) - amount * _limit(case) < 0.0:
        raise NoPlaceError
    return replace(case.program, process=replace(process, overcut=max(over) - amount * _limit(case)))


def wider_tabs_in_meta(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The process asks for tabs that are wider than the narrowest there is by so many limits."""
    process = case.program.process
    tabs = [block for block in case.program.blocks if block.kind is BlockKind.TAB]
    if not tabs or process.tabs is None:
        raise NoPlaceError
    narrowest = min(_length(case, slice(block.first, block.last + 1)) for block in tabs) - process.kerf
    wider = replace(process.tabs, width=narrowest + amount * _limit(case))
    return replace(case.program, process=replace(process, tabs=wider))


def tabs_nobody_asked_for(case: Example, _: float, __: np.random.Generator) -> Program:
    """The process says nothing of tabs."""
    if case.program.process.tabs is None or not len(case.rows(BlockKind.TAB)):
        raise NoPlaceError
    return replace(case.program, process=replace(case.program.process, tabs=None))


def heat_in_meta(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The process asks for a time between cuts that is longer than the shortest there is by so many half ticks."""
    blocks = case.program.blocks
    ways = [
        block.last - block.first + 1
        for before, block, after in zip(blocks, blocks[1:], blocks[2:], strict=False)
        if block.kind is BlockKind.RAPID and before.contour is not None and after.contour is not None
    ]
    if not ways:
        raise NoPlaceError
    time = (min(ways) + 0.5 * amount) / case.rate
    return replace(case.program, process=replace(case.program.process, heat=Heat(distance=10.0, time=time)))


def begun_elsewhere_in_meta(case: Example, _: float, __: np.random.Generator) -> Program:
    """The program is said to go on with a contour that it does not begin with."""
    first = next(block.contour for block in case.program.blocks if block.contour is not None)
    others = [one.number for one in case.drawing.contours if one.number != first]
    if not others:
        raise NoPlaceError
    return replace(case.program, from_contour=others[-1])


def _renamed(case: Example, old: BlockKind, new: BlockKind, amount: float, chance: np.random.Generator) -> Program:
    """The program with so many blocks of one kind said to be of another."""
    blocks = list(case.program.blocks)
    chosen = [index for index, block in enumerate(blocks) if block.kind is old]
    if not chosen:
        raise NoPlaceError
    for index in chance.permutation(chosen)[: int(amount)].tolist():
        blocks[index] = replace(blocks[index], kind=new)
    return replace(case.program, blocks=tuple(blocks))


def _overcuts(case: Example) -> list[tuple[float, float]]:
    """How long every overcut is along its contour, and the longest step of the tool about it, m."""
    found = []
    for block in case.program.blocks:
        if block.kind is BlockKind.OVERCUT:
            about = np.linalg.norm(np.diff(case.tool[block.first - 1 : block.last + 3], axis=0), axis=1)
            found.append((_along(case, block), float(about[: block.last - block.first + 3].max())))
    return found


def _along(case: Example, block: Block) -> float:
    """How far the rows of a block go along the exact path of their contour, m; the tool itself cuts its corners."""
    contour = next(one for one in case.drawing.contours if one.number == block.contour)
    way = _length(case, slice(block.first, block.last + 1))
    ends = case.sheet(case.tool[[block.first, block.last + 1]])
    path = min(
        (cut.curve for cut in offset([contour], kerf=case.program.process.kerf).cuts),
        key=lambda curve: curves.nearest(curve, ends[0])[2],
    )
    before = np.concatenate([[0.0], np.cumsum(curves.lengths(path))])
    places = [before[segment] + inside for segment, inside, _ in (curves.nearest(path, one) for one in ends)]
    around = float(before[-1])
    ahead = float(places[1] - places[0]) % around
    rounds = around * np.arange(int(way / around) + 2)
    lengths = np.concatenate([ahead + rounds, around - ahead + rounds])
    return float(lengths[np.argmin(np.abs(lengths - way))])


def _length(case: Example, rows: slice) -> float:
    """The way of the tool in some rows, each up to the next one, m."""
    return float(np.linalg.norm(np.diff(case.tool[rows.start : rows.stop + 1], axis=0), axis=1).sum())


def _limit(case: Example) -> float:
    """By how much a length may be off, m."""
    return case.program.process.tolerance + case.program.process.chord_tolerance
