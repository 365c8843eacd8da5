"""The kerf path, against distances and areas that need no offsetting."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from deltacam.cutting import trace
from deltacam.cutting.kerf import offset
from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.model import Contour, Curve, Operation
from tests.strategies import contour, rectangle, slot, star_curves


def line(curve: Curve) -> shapely.LinearRing:
    return shapely.LinearRing(curves.flatten(curve, 1e-7)[0])


def simple(curve: Curve) -> bool:
    return bool(line(curve).is_simple) and curves.signed_area(curve) > 1e-7


@settings(max_examples=150)
@given(star_curves(), st.floats(5e-5, 1.5e-3), st.booleans())
def test_the_cut_runs_half_a_kerf_beside_the_drawn_line_on_the_waste_side(
    curve: Curve, kerf: float, hole: bool
) -> None:
    assume(simple(curve))
    drawn = line(curve)
    try:
        cuts = offset([contour(curve, depth=int(hole))], kerf=kerf).cuts
    except InfeasibleError:
        assert hole
        assert shapely.Polygon(drawn).buffer(-kerf / 2).length < 1e-4
        return
    for cut in cuts:
        points, _ = curves.flatten(cut.curve, 1e-7)
        distance = shapely.distance(shapely.points(points), drawn)
        assert np.abs(distance - kerf / 2).max() < 2.5e-6
        inside = shapely.contains_xy(shapely.Polygon(drawn), points)
        assert inside.all() if hole else not inside.any()


@settings(max_examples=100)
@given(star_curves(), st.floats(5e-5, 1.5e-3))
def test_the_cut_goes_all_the_way_around(curve: Curve, kerf: float) -> None:
    assume(simple(curve))
    (cut, *rest) = offset([contour(curve)], kerf=kerf).cuts
    region = shapely.Polygon(line(curve)).buffer(kerf / 2, quad_segs=200)
    total = sum(curves.length(c.curve) for c in (cut, *rest))
    assert total == pytest.approx(region.length, rel=2e-4)


@settings(max_examples=100)
@given(star_curves(), st.floats(5e-5, 5e-4), st.booleans())
def test_every_path_is_traced_back_to_the_lines_and_arcs_of_the_drawing(curve: Curve, kerf: float, hole: bool) -> None:
    assume(simple(curve))
    try:
        cuts = offset([contour(curve, depth=int(hole))], kerf=kerf).cuts
    except InfeasibleError:
        assume(False)
    # At most the segments, a round at each corner, and a split of each where it turns by more than half.
    assert all(len(cut.curve.points) <= 4 * len(curve.points) + 4 for cut in cuts)


def test_a_convex_outline_grows_as_steiner_says() -> None:
    square = rectangle(0.06, 0.04)
    (cut,) = offset([contour(square)], kerf=2e-4).cuts
    assert curves.signed_area(cut.curve) == pytest.approx(0.06 * 0.04 + 0.2 * 1e-4 + math.pi * 1e-8, rel=1e-9)
    assert curves.length(cut.curve) == pytest.approx(0.2 + 2 * math.pi * 1e-4, rel=1e-9)


def test_a_circle_stays_a_circle() -> None:
    ring = curves.circle(np.array([0.1, -0.05]), 0.02)
    for depth, radius in ((0, 0.0201), (1, 0.0199)):
        (cut,) = offset([contour(ring, depth=depth)], kerf=2e-4).cuts
        assert len(cut.curve.points) == 2
        assert np.hypot(*(cut.curve.points - [0.1, -0.05]).T) == pytest.approx(radius, abs=1e-12)
        assert cut.curve.bulges == pytest.approx([1.0, 1.0])


def test_tangent_lines_and_arcs_stay_tangent() -> None:
    for depth in (0, 1):
        (cut,) = offset([contour(slot(0.04, 0.01), depth=depth)], kerf=2e-4).cuts
        assert len(cut.curve.points) == 4
        assert curves.corner_angles(cut.curve) == pytest.approx(0.0, abs=1e-9)


def test_shallow_corners_are_rounded_too() -> None:
    angle = 2.0 * np.pi * np.arange(100) / 100
    polygon = curves.polygon(0.05 * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    (cut,) = offset([contour(polygon)], kerf=4e-4).cuts
    assert len(cut.curve.points) == 200
    assert curves.corner_angles(cut.curve) == pytest.approx(0.0, abs=1e-9)


def test_an_arc_of_more_than_half_a_turn_comes_in_two() -> None:
    keyhole = Curve(
        points=np.array([[0.03, -0.002], [0.03, 0.002], [0.00995, 0.001], [0.00995, -0.001]]),
        bulges=np.array([0, 0, 1 / np.tan(0.0501), 0]),
    )
    for depth in (0, 1):
        (cut,) = offset([contour(keyhole, depth=depth)], kerf=2e-4).cuts
        assert np.abs(cut.curve.bulges).max() <= 1.01
        assert len(cut.curve.points) >= 5


def test_no_kerf_means_the_drawn_line() -> None:
    drawn = contour(slot(0.04, 0.01))
    assert offset([drawn], kerf=0.0).cuts[0].curve is drawn.curve


def test_a_swallowed_hole_is_refused_with_its_place() -> None:
    hole = contour(curves.circle(np.array([0.01, 0.02]), 1e-4), number=7, depth=1)
    with pytest.raises(InfeasibleError) as caught:
        offset([hole], kerf=3e-4)
    assert "swallows" in caught.value.what
    assert "contour 7" in caught.value.where
    assert "(10.000, 20.000) mm" in caught.value.where
    assert "--kerf" in caught.value.hint


def test_all_swallowed_holes_are_named_at_once() -> None:
    holes = [contour(curves.circle(np.array([0.01 * n, 0.0]), 1e-4), number=n, depth=1) for n in (1, 2, 3)]
    with pytest.raises(InfeasibleError, match=r"also contours 2 at \(20.000, 0.000\) mm, 3 at \(30.000, 0.000\) mm"):
        offset(holes, kerf=3e-4)


def test_a_hole_with_a_narrow_neck_becomes_two_cuts_and_a_finding() -> None:
    points = [
        (0, 0),
        (10, 0),
        (10, 4.9),
        (20, 4.9),
        (20, 0),
        (30, 0),
        (30, 10),
        (20, 10),
        (20, 5.1),
        (10, 5.1),
        (10, 10),
        (0, 10),
    ]
    result = offset([contour(curves.polygon(np.array(points) / 1e3), depth=1)], kerf=3e-4)
    assert len(result.cuts) == 2
    (finding,) = result.findings
    assert "splits into 2 cuts" in finding.what
    assert "(5.00" in finding.what
    assert "(24.99" in finding.what


def test_a_slit_narrower_than_the_kerf_is_reported() -> None:
    points = [
        (0, 0),
        (30, 0),
        (30, 9.95),
        (10, 9.95),
        (10, 5),
        (5, 5),
        (5, 15),
        (10, 15),
        (10, 10.05),
        (30, 10.05),
        (30, 20),
        (0, 20),
    ]
    result = offset([contour(curves.polygon(np.array(points) / 1e3))], kerf=3e-4)
    assert len(result.cuts) == 2
    assert "splits" in result.findings[0].what


def test_parts_nearer_than_the_kerf_are_refused_with_the_place() -> None:
    left, right = rectangle(0.01, 0.01), rectangle(0.01, 0.01, at=(0.0101, 0.0))
    with pytest.raises(InfeasibleError) as caught:
        offset([contour(left, number=1), contour(right, number=2)], kerf=2.5e-4)
    assert "contour 2" in caught.value.what + caught.value.where
    assert "(10." in caught.value.where
    assert offset([contour(left, number=1), contour(right, number=2)], kerf=0.9e-4).findings == ()


def test_an_island_nearer_than_the_kerf_to_its_hole_is_refused() -> None:
    hole = contour(curves.circle(np.zeros(2), 0.01005), number=1, depth=1)
    island = contour(curves.circle(np.zeros(2), 0.01), number=2, depth=2, parent=1)
    with pytest.raises(InfeasibleError, match="wider than the gap"):
        offset([hole, island], kerf=2e-4)


def straight(start: tuple[float, float], end: tuple[float, float]) -> Curve:
    return Curve(points=np.array([start, end]), bulges=np.zeros(1), closed=False)


def line_of(curve: Curve, number: int, operation: Operation) -> Contour:
    return Contour(number=number, curve=curve, layer="LINES", handles=(f"{number:X}",), operation=operation)


@pytest.mark.parametrize("operation", [Operation.CUT, Operation.ENGRAVE])
def test_an_open_line_is_followed_itself(operation: Operation) -> None:
    drawn = straight((0.0, 0.0), (0.01, 0.0))
    (cut,) = offset([line_of(drawn, 3, operation)], kerf=2e-4).cuts
    assert cut.curve is drawn
    assert (cut.contour, cut.layer, cut.handles, cut.operation) == (3, "LINES", ("3",), operation)


def test_engraving_may_touch_and_cross_anything_and_is_never_swallowed() -> None:
    part = contour(rectangle(0.02, 0.02), number=1)
    lines = [
        line_of(rectangle(0.02, 0.02), 2, Operation.ENGRAVE),
        line_of(curves.circle(np.array([0.02, 0.02]), 5e-5), 3, Operation.ENGRAVE),
        line_of(straight((-0.01, 0.01), (0.03, 0.01)), 4, Operation.ENGRAVE),
    ]
    result = offset([part, *lines], kerf=3e-4)
    assert result.findings == ()
    assert [cut.curve is line.curve for cut, line in zip(result.cuts[1:], lines, strict=True)] == [True] * 3
    assert curves.signed_area(result.cuts[0].curve) > 0.02**2


@pytest.mark.parametrize(
    ("end", "meets"), [((0.03, 0.01), True), ((0.02, 0.01), True), ((0.01992, 0.01), True), ((0.01988, 0.01), False)]
)
def test_a_slot_that_opens_the_edge_of_a_part_is_reported(end: tuple[float, float], meets: bool) -> None:
    part = contour(rectangle(0.02, 0.02), number=1)
    slit = line_of(straight((0.01, 0.01), end), 2, Operation.CUT)
    findings = offset([part, slit], kerf=2e-4).findings
    assert len(findings) == int(meets)
    if meets:
        (finding,) = findings
        assert "contour 1 (layer CUT, #1) at (20.000, 10.000) mm" in finding.what
        assert finding.where == "contour 2 (layer LINES, #2)"
        assert (finding.kind, finding.blocks) == ("touching", False)
        assert finding.place == pytest.approx((0.02, 0.01))


def test_many_slots_that_open_edges_are_one_finding() -> None:
    part = contour(rectangle(0.02, 0.02), number=1)
    slits = [line_of(straight((0.01, y), (0.025, y)), n, Operation.CUT) for n, y in enumerate((4e-3, 8e-3), start=2)]
    (finding,) = offset([part, *slits], kerf=2e-4).findings
    assert finding.what.startswith("2 open lines that are cut meet the edge of a part")


def test_a_ring_that_cannot_be_traced_falls_back_to_its_own_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(trace, "_assemble", lambda *_: None)
    corners = np.array([[0, 0], [20, 0], [20, 10], [10, 10], [10, 20], [0, 20]]) * 1e-3
    (cut,) = offset([contour(curves.polygon(corners))], kerf=2e-4).cuts
    assert len(cut.curve.points) > 50
    assert not cut.curve.bulges.any()
    away = shapely.distance(shapely.points(cut.curve.points), shapely.LinearRing(corners))
    assert away == pytest.approx(1e-4, abs=2e-6)
