"""The laser at rest, and how much energy a millimetre gets."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.model import BlockKind
from deltacam.program.program import Program
from deltacam.verification.verify import verify
from tests.bench import Bench


def with_a_rest(program: Program, ticks: int, kind: BlockKind = BlockKind.CUT) -> Program:
    """The tool rests for some ticks in the middle of the first block of a kind; everything else stays as it is."""
    index, block = next((i, b) for i, b in enumerate(program.blocks) if b.kind is kind)
    row = (block.first + block.last) // 2
    rows = np.insert(np.arange(len(program.q)), row, np.repeat(row, ticks))
    blocks = [
        replace(b, first=b.first + ticks * (i > index), last=b.last + ticks * (i >= index))
        for i, b in enumerate(program.blocks)
    ]
    return replace(
        program, q=program.q[rows], power=program.power[rows], block=program.block[rows], blocks=tuple(blocks)
    )


@pytest.mark.parametrize(("ticks", "passes"), [(0, True), (8, True), (9, False), (400, False)])
def test_the_laser_rests_no_longer_than_20_ms(bench: Bench, program: Program, ticks: int, passes: bool) -> None:
    found = bench.check(verify(with_a_rest(program, ticks), drawing=None), "laser on at rest")
    slow_start = 4  # ticks, of the test's own time law
    assert (found.passed, found.worst) == (passes, pytest.approx(max(ticks, slow_start) * 2.5))
    assert found.unit == "ms beyond the pierce"


@pytest.mark.parametrize(("ticks", "passes"), [(6, True), (40, False)])
def test_a_pierce_may_take_its_time_and_no_more(bench: Bench, program: Program, ticks: int, passes: bool) -> None:
    found = bench.check(verify(with_a_rest(program, ticks, BlockKind.PIERCE), drawing=None), "laser on at rest")
    assert found.passed == passes
    assert found.worst == pytest.approx(ticks * 2.5, abs=3 * 2.5)  # and the first ticks of the cut, which are slow


def test_at_its_feed_a_millimetre_gets_the_energy_of_the_process(bench: Bench) -> None:
    program = bench.program()
    found = bench.check(verify(program, drawing=None), "energy per mm")
    assert (found.passed, found.limit) == (True, None)
    # The slowest millimetre is the first or the last of a cut, of a quintic law from rest: s = 10 L u^3 nearly.
    cuts = [b for b in program.blocks if b.kind is BlockKind.CUT]
    tool = program.robot.forward(program.q)
    expected = 0.0
    for cut in cuts:
        way = np.cumsum(np.linalg.norm(np.diff(tool[cut.first : cut.last + 2], axis=0), axis=1))
        ticks = np.interp(1e-3, np.concatenate([[0.0], way]), np.arange(len(way) + 1))
        expected = max(expected, ticks / program.rate_hz * bench.process.feed / 1e-3)
    assert found.worst == pytest.approx(expected, rel=1e-3)


def test_a_rest_of_some_ticks_adds_its_energy(bench: Bench, program: Program) -> None:
    rested = with_a_rest(program, 200)
    found = bench.check(verify(rested, drawing=None), "energy per mm")
    assert found.worst == pytest.approx(200 / 400.0 * bench.process.feed / 1e-3 + 1.0, rel=0.1)


def test_a_process_without_power_is_no_fault(bench: Bench, program: Program) -> None:
    report = verify(replace(program, process=replace(program.process, power=0.0)), drawing=bench.drawing)
    assert bench.failed(report) == {"laser on in all cuts"}
    assert bench.check(report, "energy per mm").worst == 0.0
