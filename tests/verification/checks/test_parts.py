"""What is left of a part is measured from the swept kerf, and compared with closed forms."""

from dataclasses import replace

import numpy as np
import pytest
from shapely import Polygon

from deltacam.geometry import curve as curves
from deltacam.model import BlockKind, Contour, Curve, Size
from deltacam.program.program import Program
from deltacam.verification.sizes import size
from deltacam.verification.verify import verify
from tests.bench import Bench

KERF = 0.4e-3
MICRO = 1e-6


def contour(curve: Curve, *, hole: bool = False) -> Contour:
    return Contour(7, curve, "CUT", ("2F",), int(hole), 1 if hole else None)


def circle(radius: float, count: int = 4000) -> np.ndarray:
    """From its start around to its start again."""
    turn = np.linspace(0.0, 2.0 * np.pi, count + 1)
    return radius * np.column_stack([np.cos(turn), np.sin(turn)])


def left_of_a_circle(*, hole: bool, wrong: float, kerf: float = KERF) -> Size:
    """A circle of 5 mm that is cut ``wrong`` too far out."""
    path = 5e-3 + (-kerf if hole else kerf) / 2.0
    drawn = contour(curves.circle(np.zeros(2), 5e-3), hole=hole)
    return size(drawn, [circle(path)[:-1]], [circle(path + wrong)], kerf=kerf, exact_above=0.0)


@pytest.mark.parametrize("kerf", [KERF, 0.0])
@pytest.mark.parametrize("hole", [False, True])
@pytest.mark.parametrize("wrong", [0.0, 30e-6, -30e-6])
def test_a_circle_is_as_much_larger_as_its_cut(hole: bool, wrong: float, kerf: float) -> None:
    found = left_of_a_circle(hole=hole, wrong=wrong, kerf=kerf)
    assert found.drawn == pytest.approx(np.pi * 25e-6, rel=1e-4)
    assert found.area == pytest.approx(np.pi * (5e-3 + wrong) ** 2, rel=1e-4)
    assert found.offset == pytest.approx(abs(wrong), abs=0.3 * MICRO)
    assert found.edge == pytest.approx(abs(wrong), abs=0.5 * MICRO)
    assert np.hypot(*found.place) == pytest.approx(5e-3, abs=40e-6)


def test_a_cut_through_the_middle_of_a_part_leaves_no_part_there() -> None:
    across = np.vstack([circle(5.2e-3), np.array([[-5.2e-3, 0.0]])])
    found = size(contour(curves.circle(np.zeros(2), 5e-3)), [circle(5.2e-3)[:-1]], [across], kerf=KERF, exact_above=0.0)
    assert found.drawn - found.area == pytest.approx(1e-2 * KERF, rel=1e-2)
    assert found.edge > 1e-3


def test_a_part_that_is_not_cut_out_has_no_size() -> None:
    half = circle(5.2e-3)[:2000]
    found = size(contour(curves.circle(np.zeros(2), 5e-3)), [circle(5.2e-3)[:-1]], [half], kerf=KERF, exact_above=0.0)
    assert found.area == 0.0
    assert found.edge == pytest.approx(np.sqrt(np.pi) * 5e-3, rel=1e-3)


def test_an_inner_corner_that_no_beam_reaches_does_not_count() -> None:
    square = np.array([(0, 0), (1, 0), (1, 1), (0, 1)]) * 1e-2
    inner = np.array([(0.02, 0.02), (0.98, 0.02), (0.98, 0.98), (0.02, 0.98), (0.02, 0.02)]) * 1e-2
    found = size(contour(curves.polygon(square), hole=True), [inner[:-1]], [inner], kerf=KERF, exact_above=0.0)
    assert found.edge < MICRO
    assert found.drawn - found.area == pytest.approx((4.0 - np.pi) * (KERF / 2.0) ** 2, rel=1e-2)


def test_a_tip_whose_sides_are_off_counts_as_far_as_its_sides() -> None:
    """An outline with a corner of 20 degrees, both sides 10 um too far out: the tip is 58 um off."""
    half = np.radians(10.0)
    tip = np.array([(0.0, 0.0), (np.cos(half), -np.sin(half)), (np.cos(half), np.sin(half))]) * 1e-2
    moved = np.asarray(Polygon(tip).buffer(10e-6, join_style="mitre", mitre_limit=20.0).exterior.coords)
    assert np.hypot(*moved.T).min() == pytest.approx(10e-6 / np.sin(half), rel=1e-6)
    found = size(contour(curves.polygon(tip)), [tip], [moved], kerf=0.0, exact_above=0.0)
    assert found.edge == pytest.approx(10e-6, rel=0.05)


def test_a_corner_of_the_path_may_be_rounded_within_the_tolerance_and_no_more() -> None:
    """A triangular hole whose path has corners of 60 degrees, each cut off straight at the distance d from its tip.

    The edge, half a kerf further out, is off by d there, as by a path that is rounded within half of it.
    """
    turn = np.radians([90.0, 210.0, 330.0])
    drawn = 5e-3 * np.column_stack([np.cos(turn), np.sin(turn)])
    path = (5e-3 - KERF) * np.column_stack([np.cos(turn), np.sin(turn)])
    for d in (20e-6, 60e-6):
        cut = []
        for corner, before, after in zip(path, np.roll(path, 1, axis=0), np.roll(path, -1, axis=0), strict=True):
            for other in (before, after):
                side = (other - corner) / np.linalg.norm(other - corner)
                cut.append(corner + side * d / np.cos(np.radians(30.0)))
        found = size(
            contour(curves.polygon(drawn), hole=True), [path], [np.vstack([cut, cut[:1]])], kerf=KERF, exact_above=0.0
        )
        assert found.edge == pytest.approx(d / 2.0, rel=0.1)


def test_the_report_has_the_size_of_every_closed_contour_that_is_cut(bench: Bench, program: Program) -> None:
    report = verify(program, drawing=bench.drawing)
    assert [one.contour for one in report.sizes] == [1, 2, 3, 4]
    assert max(one.edge for one in report.sizes) < 4 * MICRO
    grown = verify(replace(program, process=replace(program.process, kerf=0.3e-3)), drawing=bench.drawing)
    assert bench.check(grown, "part size").worst == pytest.approx(50.0, rel=0.05)


def test_a_pierce_in_a_part_is_found_with_its_depth(bench: Bench, program: Program) -> None:
    """All pierces of contour 2, a hole, are moved outwards along its radius into the part."""
    rows = np.flatnonzero(
        [program.blocks[index].kind is BlockKind.PIERCE for index in program.block]
        & np.array([program.blocks[index].contour == 2 for index in program.block])
    )
    assert bench.check(verify(program, drawing=bench.drawing), "pierce outside the part").passed
    moved = program
    for row in rows.tolist():
        moved = bench.moved_along_the_radius(moved, row, 0.25e-3)
    found = bench.check(verify(moved, drawing=bench.drawing), "pierce outside the part")
    assert not found.passed
    assert found.worst == pytest.approx(250.0, abs=1.0)
    assert (found.contour, found.tick) == (2, rows[0])
