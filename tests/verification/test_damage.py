"""What the campaign of damages has no place for: special cases of the contours, and the size of what is left uncut."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from deltacam.model import Block, BlockKind, Drawing
from deltacam.program.program import Program
from deltacam.verification.verify import verify
from tests.bench import Bench


def ending_early(program: Program, contour: int, rows: int) -> Program:
    """The last rows of a cut become part of the rapid after it, the laser off."""
    blocks = list(program.blocks)
    index = next(i for i, b in enumerate(blocks) if b.kind is BlockKind.CUT and b.contour == contour)
    end = blocks[index].last
    blocks[index] = replace(blocks[index], last=end - rows)
    blocks[index + 1] = replace(blocks[index + 1], first=end - rows + 1)
    power = program.power.copy()
    power[end - rows + 1 : end + 1] = 0.0
    column = np.repeat(np.arange(len(blocks)), [b.last - b.first + 1 for b in blocks])
    return replace(program, blocks=tuple(blocks), block=column, power=power)


def of_no_contour(block: Block) -> Block:
    return replace(block, contour=None) if block.contour == 2 else block


MUTATIONS: dict[str, tuple[Callable[[Program, Drawing], tuple[Program, Drawing]], str]] = {
    "a cut of no contour": (
        lambda p, d: (replace(p, blocks=tuple(of_no_contour(block) for block in p.blocks)), d),
        "cuts of drawn contours only",
    ),
    "a kerf that swallows a hole": (
        lambda p, d: (replace(p, process=replace(p.process, kerf=13e-3)), d),
        "every contour cut once",
    ),
    "a finer tolerance between the ticks": (
        lambda p, d: (replace(p, process=replace(p.process, tolerance=0.3e-6, chord_tolerance=0.3e-6)), d),
        "deviation between ticks",
    ),
    "a drawing that was read inexactly": (
        lambda p, d: (p, replace(d, conversion_error=21e-6)),
        "deviation at ticks",
    ),
}


@pytest.mark.parametrize("damage", MUTATIONS)
def test_damage_is_found_by_its_check(bench: Bench, program: Program, damage: str) -> None:
    mutate, name = MUTATIONS[damage]
    changed, drawing = mutate(program, bench.drawing)
    assert name in bench.failed(verify(changed, drawing=drawing))


def test_the_uncut_length_is_as_long_as_the_gap(bench: Bench, program: Program) -> None:
    changed = ending_early(program, 1, 120)
    row = next(block.last for block in changed.blocks if block.kind is BlockKind.CUT and block.contour == 1)
    tool = bench.robot.forward(changed.q[row + 1 : row + 122])
    gap = float(np.linalg.norm(np.diff(tool, axis=0), axis=1).sum())
    found = bench.check(verify(changed, drawing=bench.drawing), "uncut length")
    assert found.worst == pytest.approx(gap * 1e3 - 2 * 0.04, abs=0.1)
    assert "contour 1" in found.where
