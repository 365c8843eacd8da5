"""A valid program passes; every kind of damage is found by the check that is there for it."""

import ast
import json
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import pytest

import deltacam
from deltacam.geometry import curve as curves
from deltacam.model import Block, BlockKind, Check, Contour, Curve, Drawing, Mode, Placement, Report
from deltacam.program.program import Program
from deltacam.verification.checks import OF_CONTOURS, OF_POSITIONS, OF_SETPOINTS
from deltacam.verification.report_json import to_json
from deltacam.verification.report_text import to_text
from deltacam.verification.verify import verify

Bench = Any  # the class in conftest.py


def failed(report: Report) -> set[str]:
    """The names of the failed checks; the reports must be writable whatever was found."""
    assert report.passed == (not any(not check.passed for check in report.checks))
    json.loads(to_json(report))
    assert to_text(report).isascii()
    return {check.name for check in report.checks if not check.passed}


def check(report: Report, name: str) -> Check:
    return next(check for check in report.checks if check.name == name)


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
    return replace(set_blocks_of(program, keep), blocks=tuple(blocks))


def set_blocks_of(program: Program, keep: np.ndarray) -> Program:
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


def test_a_valid_program_passes_every_check(bench: Bench, program: Program) -> None:
    report = verify(program, drawing=bench.drawing, robot=bench.robot)
    assert failed(report) == set()
    assert report.passed
    assert len(report.checks) == len(OF_SETPOINTS) + len(OF_POSITIONS) + len(OF_CONTOURS) + 1
    assert check(report, "deviation at ticks").worst == pytest.approx(0.0, abs=0.3)
    assert check(report, "uncut length").worst == 0.0


VALID: dict[str, Callable[[Bench], Bench]] = {
    "reversed": lambda b: b.but(paths=lambda h: {n: curves.reverse(c) for n, c in b.paths(h).items()}),
    "started elsewhere": lambda b: b.but(
        paths=lambda h: {n: curves.start_at(c, 1, 1e-3) for n, c in b.paths(h).items()}
    ),
    "at the origin": lambda b: b.but(placement=Placement(0.0, 0.0, 0.0, -0.65)),
    "turned over": lambda b: b.but(placement=Placement(-0.02, 0.01, -3.0, -0.65)),
    "another order of holes": lambda b: b.but(order=(2, 4, 3, 1)),
    "no kerf": lambda b: b.but(process=replace(b.process, kerf=0.0)),
    "a wide kerf": lambda b: b.but(process=replace(b.process, kerf=1e-3)),
    "a dry run": lambda b: b.but(mode=Mode.DRY_RUN),
    "another rate": lambda b: b.but(
        robot=replace(b.robot, controller=replace(b.robot.controller, rate_hz=1000.0)), pierce_ticks=50
    ),
    "no pierce": lambda b: b.but(process=replace(b.process, pierce_time=0.0), pierce_ticks=0),
}


@pytest.mark.parametrize("kind", VALID)
def test_other_valid_programs_pass(bench: Bench, kind: str) -> None:
    bench = VALID[kind](bench)
    assert failed(verify(bench.program(), drawing=bench.drawing)) == set()


def powered(kind: BlockKind, power: float) -> "Mutation":
    """One tick in the middle of the first block of a kind has another power."""
    return lambda c: set_power(c.program, first_row(c.program, kind), power)


class Case(NamedTuple):
    """What a mutation starts from."""

    bench: Bench
    program: Program


Mutation = Callable[[Case], Program | tuple[Program, Drawing]]

MUTATIONS: dict[str, tuple[Mutation, str]] = {
    "a setpoint moved by 1.1 tolerances": (
        lambda c: shifted_outwards(c.bench, c.program, 22e-6),
        "deviation at ticks",
    ),
    "a contour moved by 1.1 tolerances": (
        lambda c: (c.program, moved(c.bench.drawing, 2, 22e-6)),
        "deviation at ticks",
    ),
    "a row lost, the file repaired": (
        lambda c: without_rows(
            c.program, slice(first_row(c.program, BlockKind.CUT), first_row(c.program, BlockKind.CUT) + 1)
        ),
        "feed while cutting",
    ),
    "a row lost in the block table only": (
        lambda c: set_blocks_of(c.program, np.arange(len(c.program.q)) != 500),
        "block table",
    ),
    "laser on for a tick of a rapid": (
        powered(BlockKind.RAPID, 0.85),
        "laser off outside cuts",
    ),
    "laser on after the last cut": (
        lambda c: set_power(c.program, c.program.blocks[-1].first, 0.85),
        "laser off outside cuts",
    ),
    "laser off for a tick of a cut": (
        powered(BlockKind.CUT, 0.0),
        "laser on in all cuts",
    ),
    "laser weak for a tick": (
        powered(BlockKind.CUT, 0.8),
        "laser on in all cuts",
    ),
    "laser off in a pierce": (
        powered(BlockKind.PIERCE, 0.0),
        "laser on in all cuts",
    ),
    "power 1.2": (powered(BlockKind.CUT, 1.2), "laser power from 0 to 1"),
    "power -0.1": (lambda c: set_power(c.program, 0, -0.1), "laser power from 0 to 1"),
    "laser on in a dry run": (lambda c: replace(c.program, mode=Mode.DRY_RUN), "laser off outside cuts"),
    "laser on in a frame": (lambda c: replace(c.program, mode=Mode.FRAME), "laser off outside cuts"),
    "a contour missing": (lambda c: c.bench.but(order=(4, 3, 1)).program(), "every contour cut once"),
    "a contour missing, its length": (lambda c: c.bench.but(order=(4, 3, 1)).program(), "uncut length"),
    "a contour doubled": (lambda c: c.bench.but(order=(4, 3, 2, 2, 1)).program(), "every contour cut once"),
    "a contour cut twice in one go": (lambda c: c.bench.but(turns=1.5).program(), "cut length"),
    "a contour 1 % too long": (lambda c: c.bench.but(turns=0.98).program(), "uncut length"),
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
    "rapids too fast for the joints": (
        lambda c: c.bench.but(rapid_speed=3.0, rapid_acceleration=1e3).program(),
        "joint speed",
    ),
    "rapids too hard for the joints": (lambda c: c.bench.but(rapid_acceleration=60.0).program(), "joint acceleration"),
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
    "pierced too short": (lambda c: c.bench.but(pierce_ticks=19).program(), "pierce before every cut"),
    "not pierced": (lambda c: c.bench.but(pierce_ticks=0).program(), "pierce before every cut"),
    "pierced for another contour": (
        lambda c: set_blocks(
            c.program, [replace(x, contour=9) if x.kind is BlockKind.PIERCE else x for x in c.program.blocks]
        ),
        "pierce before every cut",
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
    "arms 1 mm longer in the meta": (
        lambda c: with_geometry(c.program, upper_arm=0.301),
        "sheet plane",
    ),
    "radius 1 mm larger in the meta": (lambda c: with_geometry(c.program, base_radius=0.131), "sheet plane"),
    "a joint turned by 0.01 degrees": (
        lambda c: turned(c.program, np.radians(0.01)),
        "deviation at ticks",
    ),
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


def shifted_outwards(bench: Bench, program: Program, distance: float) -> Program:
    """A setpoint in the first circle moved along its radius."""
    row = first_row(program, BlockKind.CUT, 2)
    cos, sin = np.cos(bench.placement.rotation), np.sin(bench.placement.rotation)
    x, y = bench.robot.forward(program.q[row : row + 1])[0, :2] - (bench.placement.x, bench.placement.y)
    arm = np.array([cos * x + sin * y + 0.015, cos * y - sin * x])
    arm *= distance / np.hypot(*arm)
    return bench.shifted(program, row, cos * arm[0] - sin * arm[1], sin * arm[0] + cos * arm[1])


def extra_contour() -> Contour:
    return Contour(5, curves.circle(np.array([0.1, 0.0]), 1e-3), "CUT", ("5A",))


def swapped_contours(program: Program) -> Program:
    swap = {2: 4, 4: 2}
    return set_blocks(program, [replace(b, contour=swap.get(b.contour or 0, b.contour)) for b in program.blocks])


def with_geometry(program: Program, **values: float) -> Program:
    robot = replace(program.robot, geometry=replace(program.robot.geometry, **values))
    return replace(program, robot=robot)


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
    found = failed(report) if changed.mode is not Mode.FRAME else failed(verify(changed, drawing=None))
    assert name in found


def test_every_check_fails_for_some_damage(bench: Bench, program: Program) -> None:
    covered = {name for _, name in MUTATIONS.values()} | set(LIMITS) | {"joint range", "robot"}
    made = {check.name for check in verify(program, drawing=bench.drawing).checks}
    assert made - covered == {"reach margin (at least)"}  # without reach there is no pose, and that check comes first


@dataclass(frozen=True)
class Limit:
    """How to set a limit of the robot to ``value`` in the unit of the report."""

    section: str
    field: str
    convert: Callable[[float], Any]


def three_radians(value: float) -> tuple[float, float, float]:
    return (np.radians(value),) * 3


LIMITS: dict[str, Limit] = {
    "joint speed": Limit("joints", "max_speed", three_radians),
    "joint acceleration": Limit("joints", "max_acceleration", three_radians),
    "tool speed": Limit("tool", "max_speed", float),
    "tool acceleration": Limit("tool", "max_acceleration", float),
    "pressure angle": Limit("workspace", "max_pressure_angle", np.radians),
    "forearm swing": Limit("workspace", "max_forearm_swing", np.radians),
}


@pytest.mark.parametrize("name", LIMITS)
def test_a_limit_just_above_the_worst_value_passes_and_just_below_fails(
    bench: Bench, program: Program, name: str
) -> None:
    limit = LIMITS[name]
    worst = check(verify(program, drawing=None), name).worst
    assert worst is not None
    for share, passes in ((1.0005, True), (0.998, False)):
        section = replace(getattr(program.robot, limit.section), **{limit.field: limit.convert(share * worst)})
        robot = replace(program.robot, **{limit.section: section})
        assert check(verify(replace(program, robot=robot), drawing=None), name).passed is passes


@pytest.mark.parametrize("side", ["min", "max"])
def test_the_joint_range_is_checked_on_both_sides(bench: Bench, program: Program, side: str) -> None:
    extreme = program.q[:, 1].min() if side == "min" else program.q[:, 1].max()
    for change, passes in ((1e-6, True), (-1e-6, False)):
        value = list(getattr(program.robot.joints, side))
        value[1] = float(extreme - change if side == "min" else extreme + change)
        robot = replace(program.robot, joints=replace(program.robot.joints, **{side: tuple(value)}))
        found = check(verify(replace(program, robot=robot), drawing=None), "joint range")
        assert found.passed is passes
        assert passes or "joint 2" in found.where


def test_the_worst_tick_is_named_with_its_contour_layer_handle_and_place(bench: Bench, program: Program) -> None:
    row = first_row(program, BlockKind.CUT, 2)
    found = check(verify(shifted_outwards(bench, program, 40e-6), drawing=bench.drawing), "deviation at ticks")
    assert found.tick == row
    assert found.worst == pytest.approx(40.0, abs=0.3)
    assert found.limit == pytest.approx(20.3)
    assert found.where.endswith("mm, contour 2 (layer CUT, #2A)")
    x, y = (float(word) for word in found.where.split()[1:4:2])
    assert np.hypot(x + 15.0, y) == pytest.approx(6.0 - 0.1 + 0.04, abs=1e-3)


def test_an_impossible_pose_is_named_and_nothing_about_positions_is_claimed(bench: Bench, program: Program) -> None:
    report = verify(replace(program, q=set_row(program.q, 700, -3.0)), drawing=bench.drawing)
    assert check(report, "possible poses").tick == 700
    names = {found.name for found in report.checks}
    assert not names & {"tool speed", "deviation at ticks", "sheet plane"}
    assert any("nothing about positions" in finding.what for finding in report.findings)


def test_a_given_robot_must_be_the_one_in_the_program(bench: Bench, program: Program) -> None:
    other = replace(bench.robot, tool=replace(bench.robot.tool, max_speed=0.99))
    assert failed(verify(program, drawing=None, robot=other)) == {"robot"}
    slow = replace(bench.robot, tool=replace(bench.robot.tool, max_speed=0.1))
    assert failed(verify(program, drawing=None, robot=slow)) == {"robot", "tool speed"}


def test_without_a_drawing_the_report_says_what_was_not_checked(program: Program) -> None:
    report = verify(program, drawing=None)
    assert report.passed
    assert len(report.checks) == len(OF_SETPOINTS) + len(OF_POSITIONS)
    assert [finding for finding in report.findings if "not checked without the drawing" in finding.what]


def test_a_frame_program_is_not_compared_with_the_contours(bench: Bench, program: Program) -> None:
    frame = replace(program, mode=Mode.FRAME, power=np.zeros(len(program.q)))
    report = verify(frame, drawing=bench.drawing)
    assert report.passed
    assert [finding for finding in report.findings if "frame" in finding.what]
    assert not [found for found in report.checks if found.name == "deviation at ticks"]


def test_cubic_interpolation_follows_an_arc_where_chords_cut_it(bench: Bench) -> None:
    fine = replace(bench.process, tolerance=0.3e-6, chord_tolerance=0.3e-6)
    linear = bench.but(process=fine)
    cubic = linear.but(robot=replace(bench.robot, controller=replace(bench.robot.controller, interpolation="cubic")))
    assert failed(verify(linear.program(), drawing=bench.drawing)) == {"deviation between ticks", "uncut length"}
    assert failed(verify(cubic.program(), drawing=bench.drawing)) == set()


def test_the_uncut_length_is_as_long_as_the_gap(bench: Bench, program: Program) -> None:
    changed = ending_early(program, 1, 120)
    row = next(block.last for block in changed.blocks if block.kind is BlockKind.CUT and block.contour == 1)
    tool = bench.robot.forward(changed.q[row + 1 : row + 122])
    gap = float(np.linalg.norm(np.diff(tool, axis=0), axis=1).sum())
    found = check(verify(changed, drawing=bench.drawing), "uncut length")
    assert found.worst == pytest.approx(gap * 1e3 - 2 * 0.04, abs=0.1)
    assert "contour 1" in found.where


def dumbbell() -> Drawing:
    """A hole of two chambers, joined by a neck that is narrower than the kerf."""
    points = [(-10, -3), (-4, -3), (-4, -0.05), (4, -0.05), (4, -3), (10, -3), (10, 3), (4, 3), (4, 0.05), (-4, 0.05)]
    outline = Contour(1, curves.polygon(np.array([(-20, -8), (20, -8), (20, 8), (-20, 8)]) * 1e-3), "CUT", ("1A",))
    hole = Contour(2, curves.polygon(np.array([*points, (-4, 3), (-10, 3)]) * 1e-3), "CUT", ("2A",), 1, 1)
    return Drawing("dumbbell.dxf", "ab" * 32, 1e-3, "mm (header)", (outline, hole), ())


def rectangle(left: float, bottom: float, right: float, top: float) -> Curve:
    return curves.polygon(np.array([(left, bottom), (right, bottom), (right, top), (left, top)]))


CONTOUR_CHECKS = {"every contour cut once", "deviation at ticks", "uncut length", "cut length"}


@pytest.mark.parametrize(("chambers", "expected"), [((2, 3), set()), ((2,), CONTOUR_CHECKS - {"deviation at ticks"})])
def test_every_ring_of_a_path_that_falls_apart_must_be_cut(
    bench: Bench, chambers: tuple[int, ...], expected: set[str]
) -> None:
    inner = (4e-3, -3e-3, 10e-3, 3e-3)

    def paths(half: float) -> dict[int, Curve]:
        left, bottom, right, top = np.array(inner) + half * np.array([1, 1, -1, -1])
        outline = rounded_outline(half)
        return {1: outline, 2: rectangle(left, bottom, right, top), 3: rectangle(-right, bottom, -left, top)}

    process = replace(bench.process, feed=4e-3)  # so slow that a tick at a corner is within the tolerance
    slow = bench.but(process=process, drawing=dumbbell(), paths=paths, order=(*chambers, 1))
    program = slow.program()
    blocks = [replace(b, contour=2) if b.contour == 3 else b for b in program.blocks]
    report = verify(set_blocks(program, blocks), drawing=slow.drawing)
    assert failed(report) & CONTOUR_CHECKS == expected
    # At the neck the path bulges between two arcs about its corners, which the rectangle misses by this much.
    missed = np.hypot(0.1, 0.05) - 0.1
    assert check(report, "deviation at ticks").worst == pytest.approx(1e3 * missed, abs=0.6)


def rounded_outline(half: float) -> Curve:
    """The 40 x 16 mm rectangle grown by ``half``: round corners."""
    x, y = 0.02, 0.008
    bulge = np.tan(np.pi / 8)
    points = [(x, -y - half), (x + half, -y), (x + half, y), (x, y + half)]
    points += [(-x, y + half), (-x - half, y), (-x - half, -y), (-x, -y - half)]
    return Curve(points=np.array(points), bulges=np.array([bulge, 0.0] * 4))


def test_a_sharp_corner_rounded_within_the_tolerance_is_complete_but_a_gap_of_the_same_size_is_not(
    bench: Bench,
) -> None:
    process = replace(bench.process, feed=4e-3)
    corners = np.array([(0.0, 0.0), (8e-3, 0.0), (0.0, 2e-3)])
    hole = Contour(1, curves.polygon(corners), "CUT", ("1A",), 1)
    drawing = replace(bench.drawing, contours=(hole,))
    exact = inset(corners, process.kerf / 2)
    half_angles = angles(exact) / 2
    radius = 0.9 * process.tolerance / (1 - np.sin(half_angles))
    path = filleted(exact, radius)
    cutter = bench.but(process=process, drawing=drawing, paths=lambda _: {1: path}, order=(1,))
    report = verify(cutter.program(), drawing=drawing)
    tip = radius.max() / np.sin(half_angles.min()) - radius.max()
    assert tip > process.tolerance + process.chord_tolerance + 1e-6
    assert not failed(report) & CONTOUR_CHECKS
    gap = cutter.but(turns=1.0 - 0.3e-3 / curves.length(path))
    assert "uncut length" in failed(verify(gap.program(), drawing=drawing))


def inset(corners: np.ndarray, distance: float) -> np.ndarray:
    """A convex counter-clockwise polygon with its sides moved inwards."""
    along = np.roll(corners, -1, axis=0) - corners
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1) / np.hypot(*along.T)[:, np.newaxis]
    level = np.sum(normal * corners, axis=1) + distance
    pairs = [(normal[[i - 1, i]], level[[i - 1, i]]) for i in range(len(corners))]
    return np.array([np.linalg.solve(n, c) for n, c in pairs])


def angles(corners: np.ndarray) -> np.ndarray:
    """The inner angles of a convex polygon."""
    before, after = np.roll(corners, 1, axis=0) - corners, np.roll(corners, -1, axis=0) - corners
    return np.arccos(np.sum(before * after, axis=1) / np.hypot(*before.T) / np.hypot(*after.T))


def filleted(corners: np.ndarray, radius: np.ndarray) -> Curve:
    half = angles(corners) / 2
    trim = (radius / np.tan(half))[:, np.newaxis]
    before, after = np.roll(corners, 1, axis=0) - corners, np.roll(corners, -1, axis=0) - corners
    starts = corners + trim * before / np.hypot(*before.T)[:, np.newaxis]
    ends = corners + trim * after / np.hypot(*after.T)[:, np.newaxis]
    points = np.stack([starts, ends], axis=1).reshape(-1, 2)
    bulges = np.stack([np.tan((np.pi - 2 * half) / 4), np.zeros(len(half))], axis=1).ravel()
    return Curve(points=points, bulges=bulges)


def test_the_summary_is_measured_from_the_setpoints(bench: Bench, program: Program) -> None:
    summary = verify(program, drawing=bench.drawing).summary
    length = sum(curves.length(path) for path in bench.paths(bench.process.kerf / 2).values())
    assert summary["cut_length_mm"] == pytest.approx(length * 1e3, rel=1e-3)
    assert summary["program"]["rows"] == len(program.q)
    assert sum(summary["time_s"].values()) == pytest.approx(program.duration)
    assert summary["time_s"]["pierce"] == pytest.approx(4 * 20 / 400)
    assert summary["part_size_mm"] == pytest.approx([60.0, 40.0])
    assert summary["path_size_mm"] == pytest.approx([60.2, 40.2], abs=1e-2)
    assert summary["contours_cut"] == summary["contours_drawn"] == 4
    assert summary["share_of_limit"]["feed while cutting"] == pytest.approx(1.0, abs=2e-3)


def test_one_row_is_enough_for_a_report(bench: Bench, program: Program) -> None:
    one = replace(
        program,
        q=program.q[:1],
        power=np.zeros(1),
        block=np.zeros(1, dtype=int),
        blocks=(Block(BlockKind.RAPID, 0, 0),),
    )
    assert failed(verify(one, drawing=None)) == set()
    assert failed(verify(one, drawing=bench.drawing)) == {"every contour cut once", "uncut length"}
    burning = replace(one, power=np.full(1, 0.85), blocks=(Block(BlockKind.CUT, 0, 0, 1),))
    assert "uncut length" in failed(verify(burning, drawing=bench.drawing))


def test_verification_never_imports_the_planner() -> None:
    folder = Path(deltacam.__file__).parent / "verification"
    for path in folder.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text())):
            names = [node.module or ""] if isinstance(node, ast.ImportFrom) else []
            names += [alias.name for alias in node.names] if isinstance(node, ast.Import) else []
            assert not [name for name in names if name.startswith(("deltacam.cutting", "deltacam.motion"))], path.name
