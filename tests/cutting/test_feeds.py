"""Reduced feeds: which holes and which bends, beside what is known of their shapes."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.cutting.feeds import in_bends, in_holes, radii
from deltacam.cutting.kerf import offset
from deltacam.cutting.process import load_process
from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Contour, Curve, Cut, Operation, Process, Slower, Stretch
from tests.strategies import contour, rectangle

STEEL = replace(load_process("steel-1mm-fibre"), feed=0.1, kerf=0.2e-3)
QUARTER = np.tan(np.pi / 8.0)


def with_rules(*rules: Slower) -> Process:
    return replace(STEEL, slower=rules)


def plate(*holes: Curve) -> tuple[Contour, ...]:
    inside = [replace(contour(hole, number=n), depth=1, parent=1) for n, hole in enumerate(holes, start=2)]
    return (contour(rectangle(0.1, 0.08), number=1), *inside)


def rounded(radius: float, size: float = 0.02) -> Curve:
    """A square with rounded corners, counter-clockwise."""
    a, b = radius, size - radius
    points = [(a, 0), (b, 0), (size, a), (size, b), (b, size), (a, size), (0, b), (0, a)]
    return Curve(points=np.array(points, dtype=float), bulges=np.array([0.0, QUARTER] * 4))


def chorded(curve: Curve, sagitta: float) -> Curve:
    return curves.polygon(curves.flatten(curve, sagitta)[0])


def cuts(*contours: Contour) -> tuple[Cut, ...]:
    return offset(contours, kerf=STEEL.kerf).cuts


def slow_length(way: tuple[Stretch, ...], feed: float) -> float:
    return sum(curves.length(stretch.curve) for stretch in way if stretch.feed == pytest.approx(feed))


def ends(way: tuple[Stretch, ...]) -> Array:
    return np.array([[stretch.curve.points[0], stretch.curve.points[-1]] for stretch in way])


def test_a_hole_is_slower_up_to_the_size_of_the_rule() -> None:
    drawn = plate(curves.circle(np.array([0.01, 0.01]), 1.5e-3), curves.circle(np.array([0.02, 0.01]), 1.6e-3))
    found = in_holes(cuts(*drawn), drawn, process=with_rules(Slower(0.5, diameter=3e-3)))
    assert [cut.feed for cut in found] == [None, 0.05, None]


def test_a_square_hole_is_as_large_as_the_circle_of_its_area() -> None:
    drawn = plate(rectangle(2e-3, 2e-3, at=(0.01, 0.01)))
    same = 2.0 * 2e-3 / np.sqrt(np.pi)
    for diameter, feed in ((same + 2e-6, 0.05), (same - 2e-6, None)):
        found = in_holes(cuts(*drawn), drawn, process=with_rules(Slower(0.5, diameter=diameter)))
        assert found[1].feed == feed


def test_of_several_rules_the_smallest_factor_counts() -> None:
    sizes = ((0.3, 2e-3), (0.5, 9e-3), (0.8, 5e-3))
    rules = (*(Slower(factor, diameter=size) for factor, size in sizes), Slower(0.2, radius=1.0))
    drawn = plate(*(curves.circle(np.array([0.01 * n, 0.01]), r) for n, r in enumerate((1e-3, 2e-3, 4e-3), start=1)))
    found = in_holes(cuts(*drawn), drawn, process=with_rules(*rules))
    assert [cut.feed for cut in found] == [None, pytest.approx(0.03), 0.05, 0.05]


def test_only_holes_that_are_cut_are_slower() -> None:
    circle = curves.circle(np.array([0.01, 0.01]), 1e-3)
    alone = (contour(circle, number=1),)
    process = with_rules(Slower(0.5, diameter=1.0))
    assert in_holes(cuts(*alone), alone, process=process)[0].feed is None
    engraved = (*plate(), replace(plate(circle)[1], operation=Operation.ENGRAVE))
    assert in_holes(cuts(*engraved), engraved, process=process)[1].feed is None


@pytest.mark.parametrize("hole", [False, True])
def test_bends_are_stretches_of_their_own(hole: bool) -> None:
    drawn = plate(rounded(1e-3)) if hole else (contour(rounded(1e-3), number=1),)
    (cut,) = cuts(*drawn)[-1:]
    (found,) = in_bends([cut], drawn, process=with_rules(Slower(0.4, radius=1e-3)))
    radius = 1e-3 + (-0.1e-3 if hole else 0.1e-3)
    assert slow_length(found.way, 0.04) == pytest.approx(2.0 * np.pi * radius)
    assert sum(curves.length(stretch.curve) for stretch in found.way) == pytest.approx(curves.length(cut.curve))
    places = ends(found.way)
    assert (places[1:, 0] == places[:-1, 1]).all()
    assert (places[0, 0] == cut.curve.points[0]).all()
    assert (places[-1, 1] == cut.curve.points[0]).all()


def test_the_radius_is_that_of_the_drawn_line() -> None:
    drawn = (contour(rounded(1e-3), number=1),)
    (cut,) = cuts(*drawn)
    assert in_bends([cut], drawn, process=with_rules(Slower(0.4, radius=0.99e-3))) == (cut,)
    (found,) = in_bends([cut], drawn, process=with_rules(Slower(0.4, radius=1.01e-3)))
    assert len(found.way) == 8


def test_a_slow_hole_is_no_faster_in_its_bends() -> None:
    drawn = plate(rounded(1e-3, 4e-3))
    cut = replace(cuts(*drawn)[1], feed=0.03)
    (found,) = in_bends([cut], drawn, process=with_rules(Slower(0.4, radius=2e-3)))
    assert {stretch.feed for stretch in found.way} == {None}


def test_leads_loops_and_tabs_keep_their_feed() -> None:
    drawn = (contour(rounded(1e-3), number=1),)
    (cut,) = cuts(*drawn)
    whole = curves.opened(cut.curve)
    arc = Curve(np.array([[1e-3, -3e-3], whole.points[0]]), np.array([0.3]), closed=False)
    kinds = (BlockKind.LEAD_IN, BlockKind.CUT, BlockKind.LOOP, BlockKind.OVERCUT, BlockKind.TAB)
    way = tuple(Stretch(kind, arc if kind is BlockKind.LEAD_IN else whole) for kind in kinds)
    (found,) = in_bends([replace(cut, way=way)], drawn, process=with_rules(Slower(0.4, radius=1e-3)))
    slow = {stretch.kind for stretch in found.way if stretch.feed is not None}
    assert slow == {BlockKind.CUT, BlockKind.OVERCUT}
    assert {stretch.kind for stretch in found.way} == set(kinds)


def test_a_way_that_begins_within_a_bend_or_runs_backwards_has_the_same_bends() -> None:
    drawn = (contour(rounded(1e-3), number=1),)
    (cut,) = cuts(*drawn)
    arc = int(np.argmax(cut.curve.bulges))
    for curve in (curves.start_at(cut.curve, arc, 0.3e-3), curves.reverse(cut.curve)):
        (found,) = in_bends([replace(cut, curve=curve)], drawn, process=with_rules(Slower(0.4, radius=1e-3)))
        assert slow_length(found.way, 0.04) == pytest.approx(2.0 * np.pi * 1.1e-3)


@pytest.mark.parametrize("sagitta", [0.2e-6, 2e-6, 10e-6])
def test_a_bend_of_short_lines_is_a_bend(sagitta: float) -> None:
    drawn = (contour(chorded(rounded(1e-3), sagitta), number=1),)
    (cut,) = cuts(*drawn)
    (found,) = in_bends([cut], drawn, process=with_rules(Slower(0.4, radius=1.05e-3)))
    assert slow_length(found.way, 0.04) == pytest.approx(2.0 * np.pi * 1.1e-3, rel=0.01)
    assert in_bends([cut], drawn, process=with_rules(Slower(0.4, radius=0.9e-3))) == (cut,)


def test_corners_are_no_bends() -> None:
    shapes = [rectangle(0.02, 0.01), curves.polygon(1e-3 * np.array([[0, 0], [9, 0], [9.3, 0.3], [9.3, 9], [0, 9]]))]
    for shape in shapes:
        assert np.isinf(radii(shape)).all()


def test_open_lines_that_are_cut_have_bends_and_engraved_ones_do_not() -> None:
    points = np.array([[0.0, 0.0], [0.01, 0.0], [0.011, 1e-3], [0.011, 0.01]])
    line = Curve(points, np.array([0.0, QUARTER, 0.0]), closed=False)
    process = with_rules(Slower(0.4, radius=1e-3))
    drawn = (contour(line, number=1),)
    (found,) = in_bends([Cut(1, "CUT", ("2F",), line)], drawn, process=process)
    assert [stretch.feed for stretch in found.way] == [None, pytest.approx(0.04), None]
    engraved = Cut(1, "CUT", ("2F",), line, Operation.ENGRAVE)
    assert in_bends([engraved], drawn, process=process) == (engraved,)
