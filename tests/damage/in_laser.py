"""Damage to the laser's power and to the pierces."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from deltacam.model import Block, BlockKind, IntArray, Mode, PowerLaw
from deltacam.program.program import Program
from tests.damage.aim import NoPlaceError
from tests.damage.example import WORKING, Example
from tests.damage.in_motion import longest_rest
from tests.damage.rows import gathered, with_power
from tests.damage.stretches import Stretch, jobs, together

Make = Callable[[Example, float, np.random.Generator], Program]


def on_in_rapid(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """For so many ticks."""
    rows = _stretch(case, (BlockKind.RAPID,), amount, chance)
    return with_power(case.program, rows, case.program.process.power)


def off_in(*kinds: BlockKind) -> Make:
    """The laser off for so many ticks of a block of these kinds."""

    def make(case: Example, amount: float, chance: np.random.Generator) -> Program:
        return with_power(case.program, _stretch(case, kinds, amount, chance), 0.0)

    return make


def weaker(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A power that is less by this share, for a tick."""
    row = _stretch(case, (*WORKING, BlockKind.PIERCE), 1, chance)
    return with_power(case.program, row, case.program.power[row] * (1.0 - amount))


def beside_the_law(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """Powers that follow the speed by a law, but for a tick that has so many thousandths of the rated power less."""
    process = case.program.process
    way = np.linalg.norm(case.middles - case.tool[:-1], axis=1) + np.linalg.norm(case.tool[1:] - case.middles, axis=1)
    speed = np.append(way * case.rate, 0.0)
    power = case.program.power.copy()
    cutting = (BlockKind.LEAD_IN, BlockKind.CUT, BlockKind.LOOP, BlockKind.OVERCUT)
    feeds = {**dict.fromkeys(cutting, process.feed), BlockKind.ENGRAVE: process.engrave_feed or 1.0}
    for kind, feed in feeds.items():
        rows = case.rows(kind)
        power[rows] *= 0.5 + 0.5 * np.minimum(speed[rows] / feed, 1.0)
    power[_stretch(case, WORKING, 1, chance)] -= amount * 1e-3
    return replace(case.program, power=power, process=replace(process, power_law=PowerLaw(at_rest=0.5)))


def too_strong(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A power of more than 1 by so much."""
    return with_power(case.program, _stretch(case, WORKING, 1, chance), 1.0 + amount)


def negative(case: Example, amount: float, chance: np.random.Generator) -> Program:
    return with_power(case.program, _stretch(case, (BlockKind.RAPID,), 1, chance), -amount)


def other_power_in_meta(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The process asks for less by this share."""
    process = case.program.process
    return replace(case.program, process=replace(process, power=process.power * (1.0 - amount)))


def other_mode(mode: Mode) -> Make:
    """A program that cuts, said to be of another mode; so many ticks with the laser on are left."""

    def make(case: Example, amount: float, chance: np.random.Generator) -> Program:
        rows = _stretch(case, WORKING, amount, chance)
        power = np.zeros(len(case.program.power))
        power[rows] = case.program.power[rows]
        return replace(case.program, mode=mode, power=power)

    return make


def dry_run_said_to_cut(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """The laser off in this share of all rows, from the first tick at which it is on."""
    on = np.flatnonzero(case.program.power)
    return with_power(case.program, on[: max(int(amount * len(on)), 1)], 0.0)


def pierce_shortened(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """By the fewest ticks of which more than so many half ticks are missing, at most by all."""
    block = _block(case, (BlockKind.PIERCE,), chance)
    spare = block.last - block.first + 1 - case.program.process.pierce_time * case.rate
    count = min(int(np.floor(0.5 * amount + spare)) + 1, block.last - block.first + 1)
    return _without(case, slice(block.first, block.first + count))


def pierced_too_long(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A pierce that takes longer than the process says, by so many times what a corner may take."""
    block = _block(case, (BlockKind.PIERCE,), chance)
    needed = int((case.program.process.pierce_time + amount * longest_rest(case)) * case.rate) + 1
    more = needed - (block.last - block.first + 1)
    return gathered(case.program, np.insert(np.arange(len(case.program.q)), block.first, [block.first] * more))


def not_pierced(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """So many cuts without their pierces."""
    pierces = [block for block in case.program.blocks if block.kind is BlockKind.PIERCE]
    if not pierces:
        raise NoPlaceError
    chosen = chance.permutation(len(pierces))[: int(amount)].tolist()
    keep = np.ones(len(case.program.q), dtype=bool)
    for index in chosen:
        keep[pierces[index].first : pierces[index].last + 1] = False
    return gathered(case.program, np.flatnonzero(keep))


def longer_pierce_in_meta(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The process asks for a pierce that is longer than that in the rows by so many ticks."""
    lengths = [block.last - block.first + 1 for block in case.program.blocks if block.kind is BlockKind.PIERCE]
    if not any(block.kind is BlockKind.CUT for block in case.program.blocks):
        raise NoPlaceError
    needed = (min(lengths, default=0) + amount) / case.rate
    return replace(case.program, process=replace(case.program.process, pierce_time=needed))


def pierced_for_another(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """So many pierces that are said to be of another contour."""
    blocks = list(case.program.blocks)
    pierces = [index for index, block in enumerate(blocks) if block.kind is BlockKind.PIERCE]
    if not pierces or case.program.process.pierce_time * case.rate < 1.0:
        raise NoPlaceError
    for index in chance.permutation(pierces)[: int(amount)].tolist():
        blocks[index] = replace(blocks[index], contour=999)
    return replace(case.program, blocks=tuple(blocks))


def hole_burnt(case: Example, amount: float, _: np.random.Generator) -> Program:
    """A pierce of so many ticks at the park position, before the program ends there."""
    todo = jobs(case.program)
    last = todo[-1][-1].block
    burn = Stretch(replace(last, kind=BlockKind.PIERCE), np.repeat(case.program.q[-1:], int(amount) + 1, axis=0), 0.0)
    return together(case.program, [*todo, (replace(burn, power=case.program.process.power),)])


def rest_before_rapid(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A hole burnt for so many ticks where a cut has ended, said to be a pierce of its contour."""
    todo = jobs(case.program)
    index = int(chance.integers(len(todo)))
    end = todo[index][-1]
    block = replace(end.block, kind=BlockKind.PIERCE)
    burn = Stretch(block, np.repeat(end.q[-1:], int(amount) + 1, axis=0), case.program.process.power)
    todo[index] = (*todo[index], burn)
    return together(case.program, todo)


def _block(case: Example, kinds: tuple[BlockKind, ...], chance: np.random.Generator) -> Block:
    blocks = [block for block in case.program.blocks if block.kind in kinds]
    if not blocks:
        raise NoPlaceError
    return blocks[int(chance.integers(len(blocks)))]


def _stretch(case: Example, kinds: tuple[BlockKind, ...], amount: float, chance: np.random.Generator) -> IntArray:
    """So many rows of one block, at most all, but for the last row of the program, which holds for no time."""
    block = _block(case, kinds, chance)
    last = min(block.last, len(case.program.q) - 2)
    count = min(int(amount), last - block.first + 1)
    return int(chance.integers(block.first, last - count + 2)) + np.arange(count)


def _without(case: Example, rows: slice) -> Program:
    return gathered(case.program, np.delete(np.arange(len(case.program.q)), rows))
