"""Damage to the drawing, to how it is read, to where it lies, and to what the process in the file asks for."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import shapely

from deltacam.geometry import curve as curves
from deltacam.model import Array, Contour, Curve, Drawing, IntArray, Placement
from deltacam.program.program import Program
from tests.damage.aim import NoPlaceError, aim
from tests.damage.example import WORKING, Example, beam_path, to_sheet
from tests.damage.kind import Mutant

SAMPLES = 40  # rows


def other_bytes(case: Example, amount: float, _: np.random.Generator) -> Mutant:
    """Another file of the same lines: so many digits of its hash differ."""
    digest = case.drawing.sha256
    changed = "".join(f"{15 - int(digit, 16):x}" for digit in digest[: int(amount)]) + digest[int(amount) :]
    return Mutant(case.program, drawing=replace(case.drawing, sha256=changed))


def other_unit(case: Example, amount: float, _: np.random.Generator) -> Mutant:
    """The same file read at another scale, by so much."""
    scale = case.drawing.metres_per_unit * (1.0 + amount)
    return Mutant(case.program, drawing=replace(case.drawing, metres_per_unit=scale))


def other_joining(case: Example, amount: float, _: np.random.Generator) -> Program:
    """Said to be read with ends joined that are further from each other, by this share."""
    joining = case.program.drawing.joining * (1.0 + amount)
    return replace(case.program, drawing=replace(case.program.drawing, joining=joining))


def other_layers(case: Example, amount: float, _: np.random.Generator) -> Program:
    """Said to be read without so many layers that the drawing need not even have."""
    ignored = tuple(f"LAYER{index}" for index in range(int(amount)))
    return replace(case.program, drawing=replace(case.program.drawing, ignored_layers=ignored))


def contour_moved(case: Example, amount: float, chance: np.random.Generator) -> Mutant:
    """One contour elsewhere in the drawing, so that a tick is so many tolerances from its path."""
    row = int(chance.choice(case.rows(*WORKING)))
    angle = chance.uniform(0.0, 2.0 * np.pi)
    way = np.array([np.cos(angle), np.sin(angle)])
    number = case.contour(row).number

    def changed(size: float) -> Drawing:
        return _redrawn(case, lambda curve: curves.transform(curve, shift=tuple(size * way)), {number})

    rows = _samples(case, chance, number)
    size = aim(lambda size: _off(case, case.program, changed(size), rows), amount, start=1e-6)
    return Mutant(case.program, drawing=changed(size))


def scaled(case: Example, amount: float, chance: np.random.Generator) -> Mutant:
    """Everything in the drawing larger by a share, so that a tick is so many tolerances from its path."""
    rows = _samples(case, chance)

    def changed(size: float) -> Drawing:
        return _redrawn(case, lambda curve: curves.transform(curve, scale=1.0 + size))

    size = aim(lambda size: _off(case, case.program, changed(size), rows), amount, start=1e-5)
    return Mutant(case.program, drawing=changed(size))


def mirrored(case: Example, amount: float, chance: np.random.Generator) -> Mutant:
    """One contour (1) or all of them mirrored, where that puts a tick of a cut beside its path."""
    centre = float(
        np.mean([curves.bounds(one.curve)[0] + curves.bounds(one.curve)[2] for one in case.drawing.contours])
    )
    for number in chance.permutation([contour.number for contour in case.drawing.contours]).tolist():
        only = {number} if amount <= 1.0 else None
        left, _, right, _ = curves.bounds(next(one.curve for one in case.drawing.contours if one.number == number))
        axis = left + right if only else centre
        drawing = _redrawn(case, lambda curve, axis=axis: _mirrored(curve, axis), only)
        rows = _samples(case, chance, number)
        if _off(case, case.program, drawing, rows) > 1.1:
            return Mutant(case.program, drawing=drawing)
    raise NoPlaceError


def line_added(case: Example, amount: float, _: np.random.Generator) -> Mutant:
    """A circle in the drawing that the program knows nothing of; its radius in micrometres."""
    edge = max(curves.bounds(contour.curve)[2] for contour in case.drawing.contours)
    number = max(contour.number for contour in case.drawing.contours) + 1
    circle = Contour(number, curves.circle(np.array([edge + 0.05, 0.0]), amount * 1e-6), "CUT", ("FFFF",))
    return Mutant(case.program, drawing=replace(case.drawing, contours=(*case.drawing.contours, circle)))


def line_removed(case: Example, amount: float, chance: np.random.Generator) -> Mutant:
    """So many contours not in the drawing that the program cuts; at least one is left."""
    contours = case.drawing.contours
    if len(contours) < 2:
        raise NoPlaceError
    lost = chance.permutation(len(contours))[: min(int(amount), len(contours) - 1)]
    left = tuple(contour for index, contour in enumerate(contours) if index not in lost)
    return Mutant(case.program, drawing=replace(case.drawing, contours=left))


def other_kerf(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """Another kerf in the process, so that a tick is so many tolerances from its path."""
    rows = np.array([row for row in _samples(case, chance).tolist() if case.contour(row).has_kerf], dtype=np.int64)
    if not len(rows):
        raise NoPlaceError

    def changed(size: float) -> Program:
        process = case.program.process
        return replace(case.program, process=replace(process, kerf=process.kerf + size))

    return changed(aim(lambda size: _off(case, changed(size), case.drawing, rows), amount, start=1e-6))


def finer_tolerance(case: Example, amount: float, _: np.random.Generator) -> Program:
    """A process that asks for a tolerance that the same rows exceed by this factor."""
    rows = case.rows(*WORKING)
    worst = float(case.off_path(rows, case.tool[rows]).max())
    if worst < 3e-6:
        raise NoPlaceError
    return replace(case.program, process=replace(case.program.process, tolerance=worst / amount))


def wider_tolerance(case: Example, amount: float, _: np.random.Generator) -> Mutant:
    """A tolerance in the meta object that is larger than that of the process at hand, by this share."""
    process = case.program.process
    wider = replace(process, tolerance=process.tolerance * (1.0 + amount))
    return Mutant(replace(case.program, process=wider), process=process)


def placement_shifted(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """Another place of the drawing in the meta object, so that a tick is so many tolerances from its path."""
    angle = chance.uniform(0.0, 2.0 * np.pi)
    return _placed(
        case, amount, chance, lambda p, size: replace(p, x=p.x + size * np.cos(angle), y=p.y + size * np.sin(angle))
    )


def placement_turned(case: Example, amount: float, chance: np.random.Generator) -> Program:
    """Another rotation of the drawing in the meta object, likewise."""
    return _placed(case, amount, chance, lambda p, size: replace(p, rotation=p.rotation + size))


def _placed(
    case: Example, amount: float, chance: np.random.Generator, change: Callable[[Placement, float], Placement]
) -> Program:
    rows = _samples(case, chance)

    def changed(size: float) -> Program:
        return replace(case.program, placement=change(case.program.placement, size))

    return changed(aim(lambda size: _off(case, changed(size), case.drawing, rows), amount, start=1e-7))


def _samples(case: Example, chance: np.random.Generator, contour: int | None = None) -> IntArray:
    """Some rows of cuts and engraving, of one contour where it is given."""
    rows = case.rows(*WORKING)
    if contour is not None:
        numbers = np.array([block.contour or 0 for block in case.program.blocks])[case.program.block[rows]]
        rows = rows[numbers == contour]
    return chance.choice(rows, SAMPLES)


def _off(case: Example, program: Program, drawing: Drawing, rows: IntArray) -> float:
    """How many tolerances the tool is off the paths of a drawing at some rows, as a program places it."""
    contours = {contour.number: contour for contour in drawing.contours}
    sheet: Array = to_sheet(program, case.tool[rows])
    numbers = np.array([block.contour or 0 for block in program.blocks])[program.block[rows]]
    far = 0.0
    for number in np.unique(numbers).tolist():
        line = beam_path(contours[number], program.process.kerf)
        far = max(far, float(shapely.distance(shapely.points(sheet[numbers == number]), line).max()))
    return far / program.process.tolerance


def _redrawn(case: Example, change: Callable[[Curve], Curve], only: set[int] | None = None) -> Drawing:
    """The drawing with all contours changed, or only some; its bytes are not looked at again."""
    contours = tuple(
        replace(contour, curve=change(contour.curve)) if only is None or contour.number in only else contour
        for contour in case.drawing.contours
    )
    return replace(case.drawing, contours=contours)


def _mirrored(curve: Curve, twice_x: float) -> Curve:
    """The curve mirrored at a vertical line, run the other way so that it stays counter-clockwise."""
    points = np.stack([twice_x - curve.points[:, 0], curve.points[:, 1]], axis=1)
    return curves.reverse(replace(curve, points=points, bulges=-curve.bulges))
