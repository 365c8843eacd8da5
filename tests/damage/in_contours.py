"""Damage to what is cut and in which order, with rapids that the machine can follow in between."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, Block, BlockKind, Contour
from deltacam.program.program import Program
from tests.damage.aim import NoPlaceError, aim
from tests.damage.example import SAGITTA, Example, beam_path
from tests.damage.stretches import Job, Stretch, along, jobs, plain_jobs, together

Make = Callable[[Example, float, np.random.Generator], Program]

LENGTH = 0.02  # of its path that a cut may be longer
SPACING = 0.1e-3  # m, between the places of a path at which a cut is looked for


def missing(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The shortest contours missing, so many; at least one is left where there are several."""
    todo = jobs(case.program)
    count = min(int(amount), max(len(todo) - 1, 1))
    lost = sorted(range(len(todo)), key=lambda index: len(todo[index][-1].q))[:count]
    return together(case.program, [job for index, job in enumerate(todo) if index not in lost])


def doubled(case: Example, amount: float, _: np.random.Generator) -> Program:
    """The shortest contours done again at once, so many."""
    todo = jobs(case.program)
    again = sorted(range(len(todo)), key=lambda index: len(todo[index][-1].q))[: int(amount)]
    return together(case.program, [job for i, job in enumerate(todo) for _ in range(1 + (i in again))])


def outline_too_early(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """An outline just before something that lies in it (1), or everything in the reverse order."""
    todo = plain_jobs(case.program)
    parents = {contour.number: contour.parent for contour in case.drawing.contours}
    numbers = [job[-1].block.contour for job in todo]
    cut = [job[-1].block.kind is BlockKind.CUT for job in todo]
    inside = [i for i, number in enumerate(numbers) if cut[i] and number and parents[number] in numbers]
    if not inside:
        raise NoPlaceError
    index = int(chance.choice(inside))
    around = numbers.index(parents[numbers[index] or 0])
    if not cut[around]:
        raise NoPlaceError
    if amount > 1.0:
        return together(case.program, todo[::-1])
    return together(
        case.program, [*todo[:index], todo[around], *(job for i, job in enumerate(todo) if i >= index and i != around)]
    )


def engraved_late(case: Example, amount: float, _: np.random.Generator) -> Program:
    """Engraving after the first cut (1), or after all of them."""
    todo = plain_jobs(case.program)
    engraved = [job for job in todo if job[-1].block.kind is BlockKind.ENGRAVE]
    cuts = [job for job in todo if job[-1].block.kind is BlockKind.CUT]
    if not engraved or not cuts:
        raise NoPlaceError
    count = 1 if amount <= 1.0 else len(cuts)
    return together(case.program, [*engraved[1:], *cuts[:count], engraved[0], *cuts[count:]])


def unknown_number(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """So many contours said to be of numbers that are not drawn."""
    chosen = chance.permutation([job[-1].block.contour for job in jobs(case.program)])[: int(amount)].tolist()
    return _renumbered(case, {number: 1000 + number for number in chosen})


def numbers_swapped(case: Example, amount: float, _: np.random.Generator) -> Program:
    """Two contours (1), or all of an operation, said to be each other."""
    groups: dict[object, list[int]] = {}
    for contour in case.drawing.contours:
        groups.setdefault((contour.operation, contour.curve.closed), []).append(contour.number)
    numbers = max(groups.values(), key=len)
    if len(numbers) < 2:
        raise NoPlaceError
    some = numbers[:2] if amount <= 1.0 else numbers
    return _renumbered(case, dict(zip(some, [*some[1:], some[0]], strict=True)))


def cut_said_to_be(kind: BlockKind) -> Make:
    """The cuts of so many contours said to be blocks of another kind."""

    def make(case: Example, amount: float, chance: np.random.Generator) -> Program:
        blocks = list(case.program.blocks)
        cuts = [index for index, block in enumerate(blocks) if block.kind is BlockKind.CUT]
        for index in chance.permutation(cuts)[: int(amount)].tolist():
            blocks[index] = replace(blocks[index], kind=kind)
        return replace(case.program, blocks=tuple(blocks))

    return make


def ended_early(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A cut around a contour ended before its start, so that this many times what may be left of it is not cut."""
    process = case.program.process
    return _with_gap(case, amount * (2.0 * (process.tolerance + process.chord_tolerance) + 2.0 * SPACING), chance)


def end_beside_start(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """The same, so many tolerances before its start."""
    return _with_gap(case, amount * case.program.process.tolerance, chance)


def there_and_back(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A cut that turns back after a half of the way, and by so many shares of its length later."""
    todo, index, cut = _some_cut(case, chance)
    turn = len(cut.q) // 2 + int(amount * len(cut.q))
    way = np.concatenate([cut.q[:turn], cut.q[: turn - 1][::-1]])
    return _with_cut(case, todo, index, replace(cut, q=way))


def too_long(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A cut that goes on and comes back, by so many times what its length may be off."""
    todo, index, cut = _some_cut(case, chance)
    contour, process = _contour(case, cut.block), case.program.process
    nominal = float(beam_path(contour, process.kerf).length)
    # A path within a distance d of another is at most so much longer or shorter for its turns and its corners.
    slack = (2.0 * np.pi + 2.0 * len(contour.curve.bulges)) * (process.tolerance + process.chord_tolerance)
    return _with_cut(case, todo, index, _gone_on(case, cut, 0.5 * (amount * LENGTH * nominal + 2.0 * slack)))


def cut_again(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A cut that goes on and comes back for so many millimetres."""
    todo, index, cut = _some_cut(case, chance)
    return _with_cut(case, todo, index, _gone_on(case, cut, amount * 1e-3))


def pierced_in_part(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """A pierce so many tolerances nearer to the part than the beam belongs, and a lead-in from there."""
    todo, index, cut = _some_cut(case, chance)
    if case.program.process.pierce_time == 0.0:
        raise NoPlaceError
    lead = replace(cut, block=replace(cut.block, kind=BlockKind.LEAD_IN), q=_into_part(case, cut, amount)[::-1])
    pierce = todo[index][0]
    todo[index] = (replace(pierce, q=np.repeat(lead.q[:1], len(pierce.q), axis=0)), lead, cut)
    return together(case.program, todo)


def lead_through_part(kind: BlockKind, *, of_line: bool = False) -> Make:
    """A lead before or after a cut that comes nearer to the part than the beam belongs, and back.

    It does so by so many times the sum of both tolerances.

    It is said to be of the contour that is cut, or of a line that has no kerf beside it.
    """

    def make(case: Example, amount: float, chance: np.random.Generator) -> Program:
        todo, index, cut = _some_cut(case, chance)
        numbers = [one.number for one in case.drawing.contours if not one.has_kerf] if of_line else [cut.block.contour]
        if not numbers:
            raise NoPlaceError
        process = case.program.process
        way = _into_part(case, cut, amount * (1.0 + process.chord_tolerance / process.tolerance))
        block = replace(cut.block, kind=kind, contour=numbers[0])
        lead = replace(cut, block=block, q=np.concatenate([way, way[-2::-1]]))
        job = todo[index]
        todo[index] = (*job, lead) if kind is BlockKind.LEAD_OUT else (*job[:-1], lead, cut)
        return together(case.program, todo)

    return make


def _some_cut(case: Example, chance: np.random.Generator) -> tuple[list[Job], int, Stretch]:
    """What a program does, and one cut around a contour that ends where it starts: its job, and itself."""
    todo = plain_jobs(case.program)
    closed = {contour.number for contour in case.drawing.contours if contour.has_kerf}
    cuts = [index for index, job in enumerate(todo) if job[-1].block.contour in closed]
    if not cuts:
        raise NoPlaceError
    index = int(chance.choice(cuts))
    return todo, index, todo[index][-1]


def _with_cut(case: Example, todo: list[Job], index: int, cut: Stretch) -> Program:
    return together(case.program, [*todo[:index], (*todo[index][:-1], cut), *todo[index + 1 :]])


def _with_gap(case: Example, gap: float, chance: np.random.Generator) -> Program:
    """The last tick of a cut around a contour that is at least so far from its start is where it ends."""
    todo, index, cut = _some_cut(case, chance)
    points = case.robot.forward(cut.q)
    away = np.flatnonzero(np.linalg.norm(points - points[-1], axis=1) >= gap)
    if not len(away) or away[-1] < len(points) // 2:
        raise NoPlaceError
    way = along(case.program, points[: int(away[-1]) + 1], 0.5 * case.program.process.feed)
    return _with_cut(case, todo, index, replace(cut, q=way))


def _gone_on(case: Example, cut: Stretch, distance: float) -> Stretch:
    """The cut with a way along its beginning and back after its end."""
    points = case.robot.forward(cut.q)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    if distance > way[-1]:
        raise NoPlaceError
    samples = np.append(way[way < distance], distance)
    onwards = np.stack([np.interp(samples, way, column) for column in points.T], axis=1)
    extra = along(case.program, np.concatenate([onwards, onwards[-2::-1]]), 0.2 * case.program.process.feed)
    return replace(cut, q=np.concatenate([cut.q, extra[1:]]))


def _into_part(case: Example, cut: Stretch, amount: float) -> Array:
    """Joint angles on a straight way from the start of a cut so many tolerances into the finished part, (n, 3) rad."""
    contour, process = _contour(case, cut.block), case.program.process
    start = case.tool[[cut.block.first]]
    outline = shapely.Polygon(curves.flatten(contour.curve, SAGITTA)[0])
    angles = np.linspace(0.0, 2.0 * np.pi, 73)[:-1]
    ways = np.stack([np.cos(angles), np.sin(angles), np.zeros(len(angles))], axis=1)

    def depth(points: Array) -> Array:
        """How much nearer than half a kerf the tool is to the material inside an outline, or outside a hole, m."""
        places = shapely.points(case.sheet(points))
        sign = np.where(shapely.contains(outline, places) != contour.is_hole, 1.0, -1.0)
        return np.asarray(process.kerf / 2.0 + sign * shapely.distance(places, outline.boundary))

    way = ways[[int(np.argmax(depth(start + (process.kerf / 2.0 + 0.2e-3) * ways)))]]
    distance = aim(lambda size: float(depth(start + size * way)[0]), amount * process.tolerance, start=1e-6)
    return along(case.program, np.concatenate([start, start + distance * way]), 0.5 * process.feed)


def _contour(case: Example, block: Block) -> Contour:
    return next(contour for contour in case.drawing.contours if contour.number == block.contour)


def _renumbered(case: Example, numbers: dict[int, int]) -> Program:
    blocks = tuple(
        replace(block, contour=numbers.get(block.contour, block.contour)) if block.contour else block
        for block in case.program.blocks
    )
    return replace(case.program, blocks=blocks)
