"""Every kind of damage to a valid program is found by the check that is there for it."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
import pytest

from deltacam.geometry import curve as curves
from deltacam.model import Block, BlockKind, Contour, Drawing, Mode, Placement
from deltacam.program.program import Program
from deltacam.verification.verify import verify
from tests.bench import Bench


def first_row(program: Program, kind: BlockKind, contour: int | None = None, share: float = 0.5) -> int:
    block = next(b for b in program.blocks if b.kind is kind and contour in (None, b.contour))
    return block.first + int(share * (block.last - block.first))


def set_power(program: Program, rows: Any, power: float) -> Program:
    changed = program.power.copy()
    changed[rows] = power
    return replace(program, power=changed)


def set_blocks(program: Program, blocks: list[Block]) -> Program:
    """Other blocks, with a column that agrees."""
    column = np.repeat(np.arange(len(blocks)), [b.last - b.first + 1 for b in blocks])
    return replace(program, blocks=tuple(blocks), block=column)


def without_rows(program: Program, rows: slice) -> Program:
    """Rows removed, and everything that counts them repaired."""
    keep = np.ones(len(program.q), dtype=bool)
    keep[rows] = False
    blocks, first = [], 0
    for index, block in enumerate(program.blocks):
        count = int((program.block[keep] == index).sum())
        assert count
        blocks.append(replace(block, first=first, last=first + count - 1))
        first += count
    return replace(keep_rows(program, keep), blocks=tuple(blocks))


def keep_rows(program: Program, keep: np.ndarray) -> Program:
    return replace(program, q=program.q[keep], power=program.power[keep], block=program.block[keep])


def moved(drawing: Drawing, number: int, dx: float) -> Drawing:
    contours = tuple(
        replace(c, curve=curves.transform(c.curve, shift=(dx, 0.0))) if c.number == number else c
        for c in drawing.contours
    )
    return replace(drawing, contours=contours)


def ending_early(program: Program, contour: int, rows: int) -> Program:
    """The last rows of a cut become part of the rapid after it, the laser off."""
    blocks = list(program.blocks)
    index = next(i for i, b in enumerate(blocks) if b.kind is BlockKind.CUT and b.contour == contour)
    end = blocks[index].last
    blocks[index] = replace(blocks[index], last=end - rows)
    blocks[index + 1] = replace(blocks[index + 1], first=end - rows + 1)
    return set_power(set_blocks(program, blocks), slice(end - rows + 1, end + 1), 0.0)


def powered(kind: BlockKind, power: float) -> "Mutation":
    """One tick in the middle of the first block of a kind has another power."""
    return lambda c: set_power(c.program, first_row(c.program, kind), power)


class Case(NamedTuple):
    """What a mutation starts from."""

    bench: Bench
    program: Program


Mutation = Callable[[Case], Program | tuple[Program, Drawing]]


MUTATIONS: dict[str, tuple[Mutation, str]] = {
    "a setpoint moved by 1.1 tolerances": (lambda c: c.bench.shifted_outwards(c.program, 22e-6), "deviation at ticks"),
    "a contour moved by 1.1 tolerances": (
        lambda c: (c.program, moved(c.bench.drawing, 2, 22e-6)),
        "deviation at ticks",
    ),
    "a row lost, the file repaired": (lambda c: without_a_row(c.program), "feed while cutting"),
    "a row lost in the rows only": (lambda c: keep_rows(c.program, np.arange(len(c.program.q)) != 500), "block table"),
    "laser on for a tick of a rapid": (powered(BlockKind.RAPID, 0.85), "laser off outside cuts"),
    "laser on after the last cut": (
        lambda c: set_power(c.program, c.program.blocks[-1].first, 0.85),
        "laser off outside cuts",
    ),
    "laser off for a tick of a cut": (powered(BlockKind.CUT, 0.0), "laser on in all cuts"),
    "laser weak for a tick": (powered(BlockKind.CUT, 0.8), "laser on in all cuts"),
    "laser off in a pierce": (powered(BlockKind.PIERCE, 0.0), "laser on in all cuts"),
    "power 1.2": (powered(BlockKind.CUT, 1.2), "laser power from 0 to 1"),
    "power -0.1": (lambda c: set_power(c.program, 0, -0.1), "laser power from 0 to 1"),
    "laser on in a dry run": (lambda c: replace(c.program, mode=Mode.DRY_RUN), "laser off outside cuts"),
    "laser on in a frame": (lambda c: replace(c.program, mode=Mode.FRAME), "laser off outside cuts"),
    "a contour missing": (lambda c: c.bench.but(order=(4, 3, 1)).program(), "every contour cut once"),
    "a contour doubled": (lambda c: c.bench.but(order=(4, 3, 2, 2, 1)).program(), "every contour cut once"),
    "a contour cut twice in one go": (lambda c: c.bench.but(turns=1.5).program(), "cut length"),
    "contours cut 3 % too far": (lambda c: c.bench.but(turns=1.03).program(), "cut length"),
    "contours cut 2 % too little": (lambda c: c.bench.but(turns=0.98).program(), "uncut length"),
    "an unknown contour": (
        lambda c: (c.program, replace(c.bench.drawing, contours=c.bench.drawing.contours[:3])),
        "cuts of drawn contours only",
    ),
    "a cut of no contour": (
        lambda c: set_blocks(c.program, [replace(x, contour=None) if x.contour == 2 else x for x in c.program.blocks]),
        "cuts of drawn contours only",
    ),
    "another contour drawn": (
        lambda c: (c.program, replace(c.bench.drawing, contours=(*c.bench.drawing.contours, extra_contour()))),
        "every contour cut once",
    ),
    "the outline before a hole": (lambda c: c.bench.but(order=(4, 3, 1, 2)).program(), "inner contours first"),
    "a hole before its island": (lambda c: c.bench.but(order=(3, 4, 2, 1)).program(), "inner contours first"),
    "two contours swapped": (lambda c: swapped_contours(c.program), "deviation at ticks"),
    "kerf on the wrong side": (
        lambda c: c.bench.but(paths=lambda h: c.bench.paths(-h)).program(),
        "deviation at ticks",
    ),
    "no kerf at all": (lambda c: c.bench.but(paths=lambda _: c.bench.paths(0.0)).program(), "deviation at ticks"),
    "another kerf in the meta": (
        lambda c: replace(c.program, process=replace(c.program.process, kerf=0.3e-3)),
        "deviation at ticks",
    ),
    "a kerf that swallows a hole": (
        lambda c: replace(c.program, process=replace(c.program.process, kerf=13e-3)),
        "every contour cut once",
    ),
    "a finer tolerance between the ticks": (
        lambda c: replace(c.program, process=replace(c.program.process, tolerance=0.3e-6, chord_tolerance=0.3e-6)),
        "deviation between ticks",
    ),
    "a cut that ends 1 mm early": (lambda c: ending_early(c.program, 1, 120), "uncut length"),
    "feed 1 % too fast": (lambda c: c.bench.but(feed=0.101).program(), "feed while cutting"),
    "time scaled": (
        lambda c: c.bench.but(feed=0.4, rapid_speed=3.0, rapid_acceleration=50.0).program(),
        "tool acceleration",
    ),
    "rapids too fast": (lambda c: c.bench.but(rapid_speed=3.0, rapid_acceleration=1e3).program(), "tool speed"),
    "rapids too hard for the joints": (lambda c: c.bench.but(rapid_acceleration=60.0).program(), "joint acceleration"),
    "a jolt where the robot limits jerk": (
        lambda c: c.bench.shifted(jerk_limited(c.program), first_row(c.program, BlockKind.RAPID), 10e-6),
        "joint jerk",
    ),
    "a start at speed": (lambda c: without_rows(c.program, slice(0, 20)), "rest at both ends"),
    "a start beside the park position": (lambda c: without_rows(c.program, slice(0, 20)), "park position"),
    "an end at speed": (lambda c: without_rows(c.program, slice(len(c.program.q) - 20, None)), "rest at both ends"),
    "an end 2 um beside the park position": (lambda c: c.bench.shifted(c.program, -1, 2e-6), "park position"),
    "2 um above the sheet": (lambda c: c.bench.but(z=-0.65 + 2e-6).program(), "sheet plane"),
    "another plane in the meta": (
        lambda c: replace(c.program, placement=replace(c.program.placement, z=-0.64)),
        "sheet plane",
    ),
    "beside the sheet": (lambda c: c.bench.but(placement=Placement(0.13, 0.0, 0.0, -0.65)).program(), "sheet area"),
    "moved while piercing": (
        lambda c: c.bench.shifted(c.program, first_row(c.program, BlockKind.PIERCE), 2e-6),
        "rest while piercing",
    ),
    "moved at the end of a pierce": (
        lambda c: c.bench.shifted(c.program, first_row(c.program, BlockKind.CUT, share=0.0), 2e-6),
        "rest while piercing",
    ),
    "pierced too short": (lambda c: c.bench.but(pierce_ticks=19).program(), "pierce before every cut"),
    "not pierced": (lambda c: c.bench.but(pierce_ticks=0).program(), "pierce before every cut"),
    "pierced for another contour": (
        lambda c: set_blocks(
            c.program, [replace(x, contour=9) if x.kind is BlockKind.PIERCE else x for x in c.program.blocks]
        ),
        "pierce before every cut",
    ),
    "a pierce without its cut": (
        lambda c: set_blocks(
            c.program, [replace(x, contour=9) if x.kind is BlockKind.PIERCE else x for x in c.program.blocks]
        ),
        "cut after every pierce",
    ),
    "a block index out of the table": (
        lambda c: replace(c.program, block=np.append(c.program.block[:-1], 99)),
        "block table",
    ),
    "a negative block index": (lambda c: in_block(c.program, -1), "block table"),
    "blocks that overlap": (
        lambda c: replace(
            c.program, blocks=(replace(c.program.blocks[0], last=c.program.blocks[0].last + 1), *c.program.blocks[1:])
        ),
        "block table",
    ),
    "blocks that end early": (lambda c: replace(c.program, blocks=c.program.blocks[:-1]), "block table"),
    "a cut said to be a rapid": (
        lambda c: replace(c.program, blocks=tuple(replace(x, kind=BlockKind.RAPID) for x in c.program.blocks)),
        "laser off outside cuts",
    ),
    "arms 1 mm longer in the meta": (lambda c: with_geometry(c.program, upper_arm=0.301), "sheet plane"),
    "radius 1 mm larger in the meta": (lambda c: with_geometry(c.program, base_radius=0.131), "sheet plane"),
    "a joint turned by 0.01 degrees": (lambda c: turned(c.program, np.radians(0.01)), "deviation at ticks"),
    "two joints swapped": (lambda c: replace(c.program, q=c.program.q[:, [1, 0, 2]]), "deviation at ticks"),
    "an arm folded inwards": (lambda c: replace(c.program, q=set_row(c.program.q, 700, -3.0)), "possible poses"),
    "another drawing": (lambda c: (c.program, replace(c.bench.drawing, sha256="cd" * 32)), "drawing"),
    "another scale": (lambda c: (c.program, replace(c.bench.drawing, metres_per_unit=25.4e-3)), "drawing"),
    "a drawing that was read inexactly": (
        lambda c: (c.program, replace(c.bench.drawing, conversion_error=21e-6)),
        "deviation at ticks",
    ),
    "a problem of the file": (lambda c: replace(c.program, integrity=("the rows are not those",)), "file integrity"),
    "a lost tick": (lambda c: replace(c.program, integrity=("tick column: expected 3",)), "tick continuity"),
}


def extra_contour() -> Contour:
    return Contour(5, curves.circle(np.array([0.1, 0.0]), 1e-3), "CUT", ("5A",))


def swapped_contours(program: Program) -> Program:
    swap = {2: 4, 4: 2}
    return set_blocks(program, [replace(b, contour=swap.get(b.contour or 0, b.contour)) for b in program.blocks])


def with_geometry(program: Program, **values: float) -> Program:
    robot = replace(program.robot, geometry=replace(program.robot.geometry, **values))
    return replace(program, robot=robot)


def jerk_limited(program: Program) -> Program:
    """The program on a robot that has just the limit of jerk that it needs."""
    worst = np.abs(np.diff(program.q, n=3, axis=0)).max() * program.robot.controller.rate_hz**3
    joints = replace(program.robot.joints, max_jerk=(float(worst),) * 3)
    return replace(program, robot=replace(program.robot, joints=joints))


def turned(program: Program, angle: float) -> Program:
    """Joint 1 turned by ``angle`` in every row."""
    return replace(program, q=program.q + np.array([angle, 0.0, 0.0]))


def in_block(program: Program, index: int) -> Program:
    """The last row in another block."""
    return replace(program, block=np.append(program.block[:-1], index))


def is_pierce(block: Block) -> bool:
    return block.kind is BlockKind.PIERCE


def without_a_row(program: Program) -> Program:
    row = first_row(program, BlockKind.CUT)
    return without_rows(program, slice(row, row + 1))


def set_row(q: np.ndarray, row: int, angle: float) -> np.ndarray:
    changed = q.copy()
    changed[row] = angle
    return changed


@pytest.mark.parametrize("damage", MUTATIONS)
def test_damage_is_found_by_its_check(bench: Bench, program: Program, damage: str) -> None:
    mutate, name = MUTATIONS[damage]
    mutant = mutate(Case(bench, program))
    changed, drawing = mutant if isinstance(mutant, tuple) else (mutant, bench.drawing)
    report = verify(changed, drawing=drawing)
    found = bench.failed(report) if changed.mode is not Mode.FRAME else bench.failed(verify(changed, drawing=None))
    assert name in found


# In test_verify.py, the last one in test_engraving.py.
ELSEWHERE = {
    "joint range (at least)",
    "joint speed",
    "joint acceleration",
    "pressure angle",
    "forearm swing",
    "robot",
    "contours cut last",
    "joint speed between ticks",
    "joint acceleration between ticks",
    "sheet plane between ticks",
    "sheet area between ticks",
    "laser on at rest",
    "energy per mm",
    "material cut twice",
    "part size",
    "part edge",
    "pierce outside the part",
    "gap at the end of a cut",
}


def test_every_check_fails_for_some_damage(bench: Bench, program: Program) -> None:
    covered = {name for _, name in MUTATIONS.values()} | ELSEWHERE
    made = {check.name for check in verify(program, drawing=bench.drawing).checks}
    assert made - covered == {"reach margin (at least)"}  # without reach there is no pose, and that check comes first


def test_the_uncut_length_is_as_long_as_the_gap(bench: Bench, program: Program) -> None:
    changed = ending_early(program, 1, 120)
    row = next(block.last for block in changed.blocks if block.kind is BlockKind.CUT and block.contour == 1)
    tool = bench.robot.forward(changed.q[row + 1 : row + 122])
    gap = float(np.linalg.norm(np.diff(tool, axis=0), axis=1).sum())
    found = bench.check(verify(changed, drawing=bench.drawing), "uncut length")
    assert found.worst == pytest.approx(gap * 1e3 - 2 * 0.04, abs=0.1)
    assert "contour 1" in found.where
