"""Leads, loops, overcuts and tabs, put by hand on the cuts of the bench's plate, whose measures are known."""

from dataclasses import replace

import numpy as np
import pytest
import shapely

from deltacam.model import BlockKind, Drawing, Tabs
from deltacam.program.program import Program
from deltacam.verification.comparison import finished_parts
from deltacam.verification.verify import verify
from tests.bench import Bench, plate

LEAD_IN, LEAD_OUT, LOOP = BlockKind.LEAD_IN, BlockKind.LEAD_OUT, BlockKind.LOOP
CUT, TAB, OVERCUT = BlockKind.CUT, BlockKind.TAB, BlockKind.OVERCUT
UM = 1e6


def alone() -> Drawing:
    """Contour 2 of the plate, a hole, whose outline is not cut."""
    return replace(plate(), contours=(replace(plate().contours[1], parent=None),))


def way(bench: Bench, program: Program, contour: int) -> np.ndarray:
    """Where the tool is at the rows of a cut and at the one behind them, (N, 2) m in the machine frame."""
    cut = next(block for block in program.blocks if block.kind is CUT and block.contour == contour)
    return bench.robot.forward(program.q[cut.first : cut.last + 2])[:, :2]


@pytest.mark.parametrize(
    ("kinds", "in_place"),
    [
        ([LEAD_IN, CUT], True),
        ([LEAD_IN, CUT, OVERCUT, LEAD_OUT], True),
        ([CUT, LOOP, CUT, LEAD_OUT], True),
        ([CUT, TAB, CUT], True),
        ([LEAD_IN, LOOP, CUT], False),
        ([LEAD_IN, OVERCUT], False),
        ([CUT, LOOP], False),
        ([CUT, LOOP, OVERCUT], False),
        ([LOOP, CUT], False),
        ([CUT, TAB], False),
        ([CUT, TAB, LOOP, CUT], False),
        ([OVERCUT, CUT], False),
        ([LEAD_OUT, CUT], False),
        ([CUT, OVERCUT, TAB, CUT], False),
    ],
)
def test_every_stretch_has_its_place(bench: Bench, program: Program, kinds: list[BlockKind], in_place: bool) -> None:
    report = verify(bench.said(program, 2, kinds), drawing=bench.drawing)
    assert bench.check(report, "leads, loops and tabs in their place").passed is in_place


@pytest.mark.parametrize("kind", [LEAD_IN, LOOP, LEAD_OUT])
def test_a_way_beside_the_cut_that_burns_the_part_is_found_with_its_depth(
    bench: Bench, program: Program, kind: BlockKind
) -> None:
    changed = bench.said(program, 2, [CUT, kind, CUT] if kind is LOOP else [kind, CUT])
    block = next(block for block in changed.blocks if block.kind is kind)
    assert bench.check(verify(changed, drawing=bench.drawing), "leads outside the part").passed
    moved = bench.moved_along_the_radius(changed, (block.first + block.last) // 2, 0.25e-3)
    found = bench.check(verify(moved, drawing=bench.drawing), "leads outside the part")
    assert not found.passed
    assert found.worst == pytest.approx(250.0, abs=2.0)


def test_around_a_hole_whose_outline_is_not_cut_there_is_material() -> None:
    (rim,) = finished_parts(alone())
    places = shapely.points([(radius - 15e-3, 0.0) for radius in (0.0, 5.99e-3, 6.01e-3, 7e-3)])
    assert shapely.intersects(rim, places).tolist() == [False, False, True, True]


def test_a_lead_out_of_a_hole_whose_outline_is_not_cut_is_found(bench: Bench) -> None:
    own = bench.but(drawing=alone(), order=(2,))
    changed = own.said(own.program(), 2, [LEAD_IN, CUT])
    lead = next(block for block in changed.blocks if block.kind is LEAD_IN)
    assert own.check(verify(changed, drawing=own.drawing), "leads outside the part").passed
    moved = own.moved_along_the_radius(changed, (lead.first + lead.last) // 2, 0.25e-3)
    found = own.check(verify(moved, drawing=own.drawing), "leads outside the part")
    assert found.worst == pytest.approx(250.0, abs=2.0)


@pytest.mark.parametrize("more", [0.0, 0.6e-3, -0.8e-3])
def test_the_overcut_is_as_long_as_the_process_says(bench: Bench, more: float) -> None:
    """What is too long is measured from what ticks allow: the way of one at the feed, and of one where it ends."""
    around = 2.0 * np.pi * (6e-3 - bench.process.kerf / 2.0)
    own = bench.but(drawing=alone(), order=(2,), turns=1.0 + 1e-3 / around)
    program = own.program()
    steps = np.hypot(*np.diff(way(own, program, 2), axis=0).T)
    first = int(np.searchsorted(np.cumsum(steps), around)) + 1
    beyond, step = float(steps[first:].sum()), float(steps[first - 1 :].max())
    changed = bench.said(program, 2, [CUT, OVERCUT], rows=[first])
    changed = replace(changed, process=replace(changed.process, overcut=beyond + more))
    found = own.check(verify(changed, drawing=own.drawing), "overcut")
    allowed = step if more >= 0.0 else max(step, own.process.feed / own.robot.controller.rate_hz) + step
    assert found.worst / UM == pytest.approx(max(abs(more) - allowed, 0.0), abs=2e-6)
    assert found.passed is (more == 0.0)


def test_a_tab_is_as_wide_as_the_process_says(bench: Bench, program: Program) -> None:
    count = len(way(bench, program, 2)) - 1
    first, end = count // 2, count // 2 + 8
    changed = bench.said(program, 2, [CUT, TAB, CUT], rows=[first, end])
    points = way(bench, program, 2)
    width = float(np.hypot(*np.diff(points[first : end + 1], axis=0).T).sum()) - program.process.kerf
    for asked, off in ((width, 0.0), (width + 0.1e-3, 100.0), (width - 0.15e-3, 150.0)):
        own = replace(changed, process=replace(changed.process, tabs=Tabs(asked, count=1)))
        found = bench.check(verify(own, drawing=bench.drawing), "tab width")
        assert found.worst == pytest.approx(off, abs=0.5)
        assert found.passed is (off == 0.0)


def test_a_tab_that_nobody_asked_for_is_found(bench: Bench, program: Program) -> None:
    changed = bench.said(program, 2, [CUT, TAB, CUT])
    assert not bench.check(verify(changed, drawing=bench.drawing), "tab width").passed
