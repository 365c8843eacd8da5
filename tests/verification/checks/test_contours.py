"""Completeness and closeness where it is hard: rings that fall apart, sharp corners, curved interpolation."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.geometry import curve as curves
from deltacam.model import BlockKind, Contour, Curve, Drawing
from deltacam.program.program import Program
from deltacam.verification.verify import verify
from tests.bench import Bench


def test_cubic_interpolation_follows_an_arc_where_chords_cut_it(bench: Bench) -> None:
    fine = replace(bench.process, tolerance=0.3e-6, chord_tolerance=0.3e-6)
    linear = bench.but(process=fine)
    cubic = linear.but(robot=replace(bench.robot, controller=replace(bench.robot.controller, interpolation="cubic")))
    chords = {"deviation between ticks", "uncut length", "part edge"}
    assert bench.failed(verify(linear.program(), drawing=bench.drawing)) == chords
    assert bench.failed(verify(cubic.program(), drawing=bench.drawing)) == set()


def dumbbell() -> Drawing:
    """A hole of two chambers, joined by a neck that is narrower than the kerf."""
    points = [(-10, -3), (-4, -3), (-4, -0.05), (4, -0.05), (4, -3), (10, -3), (10, 3), (4, 3), (4, 0.05), (-4, 0.05)]
    outline = Contour(1, curves.polygon(np.array([(-20, -8), (20, -8), (20, 8), (-20, 8)]) * 1e-3), "CUT", ("1A",))
    hole = Contour(2, curves.polygon(np.array([*points, (-4, 3), (-10, 3)]) * 1e-3), "CUT", ("2A",), 1, 1)
    return Drawing("dumbbell.dxf", "ab" * 32, 1e-3, "mm", "header", (outline, hole), ())


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
    report = verify(replace(program, blocks=blocks), drawing=slow.drawing)
    assert bench.failed(report) & CONTOUR_CHECKS == expected
    # At the neck the path bulges between two arcs about its corners, which the rectangle misses by this much.
    missed = np.hypot(0.1, 0.05) - 0.1
    assert bench.check(report, "deviation at ticks").worst == pytest.approx(1e3 * missed, abs=0.6)


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
    assert not bench.failed(report) & CONTOUR_CHECKS
    gap = cutter.but(turns=1.0 - 0.3e-3 / curves.length(path))
    assert "uncut length" in bench.failed(verify(gap.program(), drawing=drawing))


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


def test_the_worst_tick_is_named_with_its_contour_layer_handle_and_place(bench: Bench, program: Program) -> None:
    block = next(b for b in program.blocks if b.kind is BlockKind.CUT and b.contour == 2)
    found = bench.check(verify(bench.shifted_outwards(program, 40e-6), drawing=bench.drawing), "deviation at ticks")
    assert found.tick == (block.first + block.last) // 2
    assert found.worst == pytest.approx(40.0, abs=0.3)
    assert found.limit == pytest.approx(20.3)
    assert found.where.endswith("mm, contour 2 (layer CUT, #2A)")
    x, y = (float(word) for word in found.where.split()[1:4:2])
    assert np.hypot(x + 15.0, y) == pytest.approx(6.0 - 0.1 + 0.04, abs=1e-3)


def test_the_tick_at_which_the_laser_goes_off_must_be_on_the_path_too(bench: Bench, program: Program) -> None:
    last = next(block.last for block in program.blocks if block.kind is BlockKind.CUT and block.contour == 2)
    found = verify(bench.shifted(program, last + 1, 30e-6, 30e-6), drawing=bench.drawing)
    assert "deviation at ticks" in bench.failed(found)
    assert bench.check(found, "deviation at ticks").tick == last + 1


def test_a_lead_in_may_stand_between_a_pierce_and_its_cut(bench: Bench, program: Program) -> None:
    blocks = list(program.blocks)
    index = next(i for i, block in enumerate(blocks) if block.kind is BlockKind.CUT)
    cut = blocks[index]
    lead = replace(cut, kind=BlockKind.LEAD_IN, last=cut.first + 4)
    blocks[index : index + 1] = [lead, replace(cut, first=cut.first + 5)]
    column = np.repeat(np.arange(len(blocks)), [block.last - block.first + 1 for block in blocks])
    report = verify(replace(program, blocks=tuple(blocks), block=column), drawing=bench.drawing)
    assert bench.failed(report) == set()
    assert report.summary["time_s"]["lead_in"] == pytest.approx(5 / 400)
