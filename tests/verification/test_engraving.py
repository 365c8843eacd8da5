"""What is engraved, and what is cut without being closed, is checked on the line itself; every fault is found."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from deltacam.geometry import curve as curves
from deltacam.model import BlockKind, Contour, Curve, Drawing, Mode, Operation, Rule, Selection
from deltacam.program.program import Program
from deltacam.report.text import to_text
from deltacam.verification.verify import verify
from tests.bench import Bench

RING, SWEEP, SLIT = 5, 6, 7
LINES = {
    RING: curves.circle(np.array([0.0, 0.0]), 4e-3),  # crosses contours 2 and 3
    SWEEP: Curve(points=np.array([(-0.04, -0.01), (0.04, -0.01)]), bulges=np.array([0.2]), closed=False),
    SLIT: Curve(points=np.array([(-0.025, 0.012), (-0.01, 0.012)]), bulges=np.zeros(1), closed=False),
}
OPERATIONS = {RING: Operation.ENGRAVE, SWEEP: Operation.ENGRAVE, SLIT: Operation.CUT}
RIGHT_ORDER = (RING, SWEEP, SLIT, 4, 3, 2, 1)


def marked(bench: Bench, **changes: Any) -> Bench:
    """The test plate with a ring and a sweep to engrave and an open slit to cut."""
    lines = [
        Contour(number, line, "MARK", (f"{number}A",), operation=OPERATIONS[number]) for number, line in LINES.items()
    ]
    drawing = replace(bench.drawing, contours=(*bench.drawing.contours, *lines))
    values = {"paths": lambda half: bench.paths(half) | LINES, "order": RIGHT_ORDER, "drawing": drawing} | changes
    return bench.but(**values)


def with_parent(drawing: Drawing, number: int, parent: int) -> Drawing:
    contours = tuple(replace(c, parent=parent, depth=1) if c.number == number else c for c in drawing.contours)
    return replace(drawing, contours=contours)


def with_line(bench: Bench, number: int, line: Curve) -> Program:
    """The program with one line run along another curve than the drawn one."""
    program: Program = marked(bench, paths=lambda half: bench.paths(half) | LINES | {number: line}).program()
    return program


def cut_back(line: Curve, start: float, end: float) -> Curve:
    """A line of one segment, ``start`` m later and ``end`` m earlier than it is; negative makes it longer."""
    reach = curves.length(line)
    points, _ = curves.evaluate(line, np.array([0, 0]), np.array([start, reach - end]))
    share = (reach - start - end) / reach
    return Curve(points=points, bulges=np.tan(np.arctan(line.bulges) * share), closed=False)


def with_power(program: Program, kind: BlockKind, power: float) -> Program:
    of_kind = np.array([block.kind is kind for block in program.blocks])[program.block]
    return replace(program, power=np.where(of_kind, power, program.power))


def with_process(program: Program, **values: object) -> Program:
    return replace(program, process=replace(program.process, **values))


def renamed(program: Program, contour: int, kind: BlockKind) -> Program:
    """The program with the blocks of a contour, but for its pierce, said to be of another kind."""
    blocks = [
        replace(b, kind=kind) if b.contour == contour and b.kind is not BlockKind.PIERCE else b for b in program.blocks
    ]
    return replace(program, blocks=tuple(blocks))


def pierced(program: Program) -> Program:
    """The program with the first ticks of every engraved line said to be a pierce, with the power of one."""
    blocks, power = [], program.power.copy()
    for block in program.blocks:
        if block.kind is BlockKind.ENGRAVE:
            blocks += [replace(block, kind=BlockKind.PIERCE, last=block.first), replace(block, first=block.first + 1)]
            power[block.first] = program.process.power
        else:
            blocks.append(block)
    column = np.repeat(np.arange(len(blocks)), [b.last - b.first + 1 for b in blocks])
    return replace(program, blocks=tuple(blocks), block=column, power=power)


def test_a_program_that_engraves_and_cuts_open_lines_passes(bench: Bench) -> None:
    bench = marked(bench)
    report = verify(bench.program(), drawing=bench.drawing)
    assert bench.failed(report) == set()
    assert bench.check(report, "uncut length").worst == 0.0


VALID: dict[str, Callable[[Bench], Bench]] = {
    "backwards": lambda b: marked(
        b, paths=lambda half: b.paths(half) | {number: curves.reverse(line) for number, line in LINES.items()}
    ),
    "a dry run": lambda b: marked(b, mode=Mode.DRY_RUN),
    "another order of what is engraved": lambda b: marked(b, order=(SWEEP, RING, SLIT, 4, 3, 2, 1)),
    "a wide kerf, which is for closed cuts alone": lambda b: marked(b, process=replace(b.process, kerf=1e-3)),
    "a slit in an engraved ring": lambda b: marked(b, drawing=with_parent(marked(b).drawing, SLIT, RING)),
    "within the tolerance": lambda b: marked(
        b, paths=lambda half: b.paths(half) | LINES | {SLIT: curves.transform(LINES[SLIT], shift=(0.0, 19e-6))}
    ),
}


@pytest.mark.parametrize("kind", VALID)
def test_other_ways_to_do_it_pass(bench: Bench, kind: str) -> None:
    bench = VALID[kind](bench)
    assert bench.failed(verify(bench.program(), drawing=bench.drawing)) == set()


FAULTS: dict[str, tuple[Callable[[Bench], Program], str]] = {
    "engraved with the power of a cut": (
        lambda b: with_power(marked(b).program(), BlockKind.ENGRAVE, 0.85),
        "laser on in all cuts",
    ),
    "cut with the power of engraving": (
        lambda b: with_power(marked(b).program(), BlockKind.CUT, 0.15),
        "laser on in all cuts",
    ),
    "engraved a little too weakly": (
        lambda b: with_power(marked(b).program(), BlockKind.ENGRAVE, 0.149),
        "laser on in all cuts",
    ),
    "engraved with the laser off": (
        lambda b: with_power(marked(b).program(), BlockKind.ENGRAVE, 0.0),
        "laser on in all cuts",
    ),
    "a process without a power for engraving": (
        lambda b: with_process(marked(b).program(), engrave_power=None),
        "laser on in all cuts",
    ),
    "a process without a feed for engraving": (
        lambda b: with_process(marked(b).program(), engrave_feed=None),
        "feed while cutting",
    ),
    "engraved 1 % too fast": (lambda b: with_process(marked(b).program(), engrave_feed=0.198), "feed while cutting"),
    "cut at the feed of engraving": (
        lambda b: marked(b, process=replace(b.process, engrave_feed=0.5), feed=0.2).program(),
        "feed while cutting",
    ),
    "a ring not engraved": (lambda b: marked(b, order=(SWEEP, SLIT, 4, 3, 2, 1)).program(), "every contour cut once"),
    "a sweep not engraved": (lambda b: marked(b, order=(RING, SLIT, 4, 3, 2, 1)).program(), "uncut length"),
    "a slit not cut": (lambda b: marked(b, order=(RING, SWEEP, 4, 3, 2, 1)).program(), "every contour cut once"),
    "engraved twice": (
        lambda b: marked(b, order=(RING, SWEEP, RING, SLIT, 4, 3, 2, 1)).program(),
        "every contour cut once",
    ),
    "engraved twice in one go": (lambda b: marked(b, order=(RING, *RIGHT_ORDER)).program(), "cut length"),
    "cut instead of engraved": (
        lambda b: renamed(marked(b).program(), RING, BlockKind.CUT),
        "cuts of drawn contours only",
    ),
    "engraved instead of cut": (
        lambda b: renamed(marked(b).program(), 2, BlockKind.ENGRAVE),
        "every contour cut once",
    ),
    "pierced before engraving": (lambda b: pierced(marked(b).program()), "cut after every pierce"),
    "an open cut 0.1 mm short": (
        lambda b: with_line(b, SLIT, cut_back(LINES[SLIT], 0.0, 1e-4)),
        "uncut length",
    ),
    "an open cut begun 0.1 mm late": (lambda b: with_line(b, SLIT, cut_back(LINES[SLIT], 1e-4, 0.0)), "uncut length"),
    "an engraved line 0.1 mm short": (
        lambda b: with_line(b, SWEEP, cut_back(LINES[SWEEP], 0.0, 1e-4)),
        "uncut length",
    ),
    "an open cut 0.1 mm too long": (
        lambda b: with_line(b, SLIT, cut_back(LINES[SLIT], 0.0, -1e-4)),
        "deviation at ticks",
    ),
    "an open cut half a kerf beside its line": (
        lambda b: with_line(b, SLIT, curves.transform(LINES[SLIT], shift=(0.0, 1e-4))),
        "deviation at ticks",
    ),
    "an engraved ring beside its line, as if it were cut": (
        lambda b: with_line(b, RING, curves.circle(np.zeros(2), 4.1e-3)),
        "deviation at ticks",
    ),
    "an engraved arc run along its chord": (
        lambda b: with_line(b, SWEEP, replace(LINES[SWEEP], bulges=np.zeros(1))),
        "deviation at ticks",
    ),
    "engraved after a cut": (lambda b: marked(b, order=(RING, SLIT, SWEEP, 4, 3, 2, 1)).program(), "contours cut last"),
    "a slit after the outline": (
        lambda b: marked(b, order=(RING, SWEEP, 4, 3, 2, 1, SLIT)).program(),
        "contours cut last",
    ),
    "read with other layers": (
        lambda b: replace(marked(b).program(), drawing=replace(marked(b).program().drawing, layers=("CUT",))),
        "drawing",
    ),
    "read with other rules": (lambda b: with_process(marked(b).program(), rules=(Rule(Operation.CUT),)), "drawing"),
    "read with other ends joined": (
        lambda b: replace(marked(b).program(), drawing=replace(marked(b).program().drawing, joining=1e-4)),
        "drawing",
    ),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found_by_its_check(bench: Bench, fault: str) -> None:
    make, name = FAULTS[fault]
    assert name in bench.failed(verify(make(bench), drawing=marked(bench).drawing))


def test_a_line_run_there_and_back_is_too_long(bench: Bench) -> None:
    line = LINES[SLIT]
    there_and_back = Curve(points=line.points[[0, 1, 0]], bulges=np.zeros(2), closed=False)
    assert "cut length" in bench.failed(verify(with_line(bench, SLIT, there_and_back), drawing=marked(bench).drawing))


def test_a_program_may_be_read_by_the_selection_that_it_holds(bench: Bench) -> None:
    selection = Selection(rules=(), open=Operation.CUT, layers=("*",), joining=3e-5)
    bench = marked(bench, process=replace(bench.process, rules=(), open=Operation.CUT))
    bench = bench.but(drawing=replace(bench.drawing, selection=selection))
    program = bench.program()
    assert program.selection == selection
    assert bench.failed(verify(program, drawing=bench.drawing)) == set()


def test_the_uncut_length_of_a_line_that_was_left_out_is_all_of_it(bench: Bench) -> None:
    program = marked(bench, order=(RING, SLIT, 4, 3, 2, 1)).program()
    found = bench.check(verify(program, drawing=marked(bench).drawing), "uncut length")
    assert found.worst == pytest.approx(1e3 * curves.length(LINES[SWEEP]), rel=1e-6)
    assert "contour 6" in found.where


def test_the_summary_tells_cutting_from_engraving(bench: Bench) -> None:
    bench = marked(bench, drawing=replace(marked(bench).drawing, conversion_error=1.5e-6))
    report = verify(bench.program(), drawing=bench.drawing)
    summary = report.summary
    engraved = sum(curves.length(LINES[number]) for number in (RING, SWEEP))
    cut = sum(curves.length(path) for path in bench.paths(bench.process.kerf / 2).values()) - engraved
    assert summary["engraved_length_mm"] == pytest.approx(1e3 * engraved, rel=1e-3)
    assert summary["cut_length_mm"] == pytest.approx(1e3 * cut, rel=1e-3)
    assert (summary["contours_cut"], summary["contours_engraved"], summary["contours_drawn"]) == (5, 2, 7)
    assert summary["time_s"]["engrave"] > 0.0
    assert summary["conversion_error_um"] == pytest.approx(1.5)
    assert summary["part_size_mm"] == pytest.approx([80.0, 40.0])
    lines = to_text(report).splitlines()
    assert lines[1] == "  drawing  part 80.00 x 40.00 mm, unit mm (header), read to within 1.5 um"
    assert lines[3].startswith(f"  path     {1e3 * cut:.1f} mm cut, {1e3 * engraved:.1f} mm engraved, ")
    assert lines[3].endswith(" mm rapid, 5 contours, 2 engraved")
