"""Whether small holes and bends are cut as slowly as a process wants: planned programs, and those of the bench."""

import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deltacam import pipeline
from deltacam.geometry import curve as curves
from deltacam.model import Curve, PowerLaw, Slower
from deltacam.program.program import Program
from deltacam.verification.verify import verify
from tests.bench import Bench, rounded_rectangle, shapes
from tests.damage import drawings
from tests.damage.example import random_process, random_robot


def ruled(bench: Bench, *rules: Slower) -> Program:
    return replace(bench.program(), process=replace(bench.process, slower=rules))


@pytest.mark.parametrize("seed", [1, 2, 13, 19, 31])
def test_a_program_that_is_planned_by_the_rules_passes(seed: int) -> None:
    chance = np.random.default_rng([7, seed])
    robot, process, content = random_robot(chance), random_process(chance), drawings.drawing(chance)
    rules = [Slower(factor, diameter=size) for factor, size in ((0.5, 5e-3), (0.8, 20e-3))]
    rules += [Slower(factor, radius=size) for factor, size in ((0.3, 1e-3), (0.6, 10e-3))]
    law = PowerLaw(0.3, float(chance.choice([0.5, 1.0, 2.0])), 0.1)
    process = replace(process, slower=tuple(rules), power_law=law, pierce_power=0.5)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "part.dxf"
        path.write_bytes(content)
        planned = pipeline.plan(path, robot=robot, process=process, jobs=1, what_if=False)
    assert [check.name for check in planned.report.checks if not check.passed and not check.warns] == []
    found = Bench.check(planned.report, "reduced feed")
    assert found.worst is not None
    assert found.limit is not None
    assert 0.95 * found.limit < found.worst <= found.limit < process.feed * 1e3


def test_a_hole_at_the_feed_fails_and_a_larger_one_does_not(bench: Bench) -> None:
    report = verify(ruled(bench, Slower(0.5, diameter=12.01e-3)), drawing=bench.drawing)
    assert bench.failed(report) == {"reduced feed"}
    found = bench.check(report, "reduced feed")
    assert (found.contour, found.limit) == (2, pytest.approx(50.05))
    assert found.worst == pytest.approx(100.0, rel=0.01)
    assert bench.failed(verify(ruled(bench, Slower(0.5, diameter=11.99e-3)), drawing=bench.drawing)) == set()


def test_an_outline_is_no_hole(bench: Bench) -> None:
    slow = ruled(bench, Slower(0.5, diameter=1.0))
    assert bench.check(verify(slow, drawing=bench.drawing), "reduced feed").contour in (2, 3)


def test_a_bend_at_the_feed_fails_and_a_larger_one_does_not(bench: Bench) -> None:
    report = verify(ruled(bench, Slower(0.5, radius=3.1e-3)), drawing=bench.drawing)
    assert bench.failed(report) == {"reduced feed"}
    assert bench.check(report, "reduced feed").contour in (3, 4)
    assert bench.failed(verify(ruled(bench, Slower(0.5, radius=2.9e-3)), drawing=bench.drawing)) == set()
    assert bench.failed(verify(ruled(bench, Slower(0.5, radius=5.2e-3)), drawing=bench.drawing)) == {"reduced feed"}


def chorded(offset: float) -> dict[int, Curve]:
    """The plate with an outline of short lines."""
    whole = rounded_rectangle((0.0, 0.0), 0.06 + 2.0 * offset, 0.04 + 2.0 * offset, 5e-3 + offset)
    return shapes(offset) | {1: curves.polygon(curves.flatten(whole, 1e-6)[0])}


def test_bends_of_short_lines_are_bends(bench: Bench) -> None:
    outline = replace(bench.drawing.contours[0], curve=chorded(0.0)[1])
    drawing = replace(bench.drawing, contours=(outline, *bench.drawing.contours[1:]))
    plate = bench.but(drawing=drawing, paths=chorded)
    for radius, failed in ((5.2e-3, {1, 3, 4}), (3.5e-3, {3, 4})):
        rule = Slower(0.5, radius=radius)
        alone = [contour for contour in drawing.contours if contour.number == 1]
        report = verify(ruled(plate, rule), drawing=replace(drawing, contours=tuple(alone)))
        assert ("reduced feed" in plate.failed(report)) == (1 in failed)


def test_engraving_and_processes_without_rules_have_nothing_to_keep(bench: Bench, program: Program) -> None:
    found = bench.check(verify(program, drawing=bench.drawing), "reduced feed")
    assert (found.passed, found.worst, found.limit) == (True, None, None)
