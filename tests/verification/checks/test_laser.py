"""The laser at rest, and how much energy a millimetre gets."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.model import BlockKind, PowerLaw
from deltacam.program.program import Program
from deltacam.verification.energy import line_energy
from deltacam.verification.evidence import gather
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
    assert bench.check(report, "energy per mm").worst is None


LAW = PowerLaw(at_rest=0.2, exponent=1.0)


def by_law(bench: Bench, law: PowerLaw, step: float = 0.0) -> Program:
    """The program of the bench with powers of a law, a step more than that; the speed is that of finer ways."""
    plain = bench.program()
    fine = [plain.robot.forward(plain.q[:-1] + u * np.diff(plain.q, axis=0)) for u in np.linspace(0.0, 1.0, 9)]
    speed = np.linalg.norm(np.diff(fine, axis=0), axis=2).sum(axis=0) * plain.rate_hz
    power = plain.power.copy()
    cut = np.array([block.kind is BlockKind.CUT for block in plain.blocks])[plain.block]
    share = np.append(np.minimum(speed / bench.process.feed, 1.0), 0.0)[cut]
    full = bench.process.power
    power[cut] = np.clip(full * (law.at_rest + (1.0 - law.at_rest) * share**law.exponent) + step, law.lowest, full)
    return replace(plain, power=power, process=replace(plain.process, power_law=law))


@pytest.mark.parametrize("law", [LAW, PowerLaw(0.0, 0.01), PowerLaw(0.3, 2.0, 0.5), PowerLaw(0.1, 1.0, 0.9)], ids=str)
def test_power_by_the_law_passes_and_more_or_less_of_it_does_not(bench: Bench, law: PowerLaw) -> None:
    for step in (0.0, 0.9e-3, -0.9e-3):
        assert bench.failed(verify(by_law(bench, law, step), drawing=bench.drawing)) == set()
    program = by_law(bench, law)
    row = next(block.first for block in program.blocks if block.kind is BlockKind.CUT) + 30
    for step in (2e-3, -2e-3):
        power = program.power.copy()
        power[row] += step
        found = bench.check(verify(replace(program, power=power), drawing=None), "laser on in all cuts")
        assert (found.passed, found.tick) == (False, row)


def test_constant_power_is_wrong_where_a_law_is_asked_for(bench: Bench, program: Program) -> None:
    changed = replace(program, process=replace(program.process, power_law=LAW))
    assert bench.failed(verify(changed, drawing=bench.drawing)) == {"laser on in all cuts"}


def test_a_pierce_has_the_power_that_is_for_it(bench: Bench, program: Program) -> None:
    pierces = np.array([block.kind is BlockKind.PIERCE for block in program.blocks])[program.block]
    asked = replace(program, process=replace(program.process, pierce_power=0.6))
    assert bench.failed(verify(asked, drawing=None)) == {"laser on in all cuts"}
    assert bench.failed(verify(replace(asked, power=np.where(pierces, 0.6, program.power)), drawing=None)) == set()


def test_where_the_arms_cannot_close_any_power_of_the_law_may_be_right(bench: Bench) -> None:
    program = by_law(bench, LAW)
    q = program.q.copy()
    q[3] = 3.0
    found = bench.check(verify(replace(program, q=q), drawing=None), "laser on in all cuts")
    assert found.passed


def test_a_law_in_proportion_to_the_speed_gives_every_millimetre_the_same(bench: Bench) -> None:
    found = line_energy(gather(by_law(bench, PowerLaw(0.0, 1.0)), bench.robot))
    assert np.nanmin(found) == pytest.approx(1.0, rel=2e-3)
    assert np.nanmax(found) == pytest.approx(1.0, rel=2e-3)


def test_the_energy_of_a_millimetre_is_the_time_that_it_takes(bench: Bench, program: Program) -> None:
    evidence = gather(program, program.robot)
    found = line_energy(evidence)
    for run in evidence.runs:
        way = np.cumsum(np.linalg.norm(np.diff(evidence.tool[run.first : run.end + 1], axis=0), axis=1))
        way = np.concatenate([[0.0], way])
        for tick in range(run.first, run.end, 7):
            start = min(max(way[tick - run.first] - 0.5e-3, 0.0), way[-1] - 1e-3)
            ticks = np.interp([start, start + 1e-3], way, np.arange(len(way)))
            expected = (ticks[1] - ticks[0]) / program.rate_hz * bench.process.feed / 1e-3
            assert found[tick] == pytest.approx(expected, rel=2e-3)
    assert np.isfinite(found).sum() == sum(run.end - run.first for run in evidence.runs)
