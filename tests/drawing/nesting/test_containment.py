"""Nesting of contours, against shapely's own predicates and by hand."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.drawing.nesting import containment
from deltacam.drawing.nesting.containment import nest
from deltacam.errors import DrawingError
from deltacam.geometry import curve as curves
from deltacam.model import Contour, Curve, Finding

MM = 1e-3


def contours(*shapes: Curve) -> list[Contour]:
    return [Contour(i, curve, layer="CUT", handles=(f"{i:X}",)) for i, curve in enumerate(shapes, start=1)]


def disc(x: float, y: float, radius: float) -> Curve:
    return curves.circle(MM * np.array([x, y]), MM * radius)


def box(x: float, y: float, width: float, height: float) -> Curve:
    return curves.polygon(MM * np.array([[x, y], [x + width, y], [x + width, y + height], [x, y + height]]))


def kinds(findings: Sequence[Finding]) -> list[tuple[str, bool]]:
    return [(finding.kind, finding.blocks) for finding in findings]


def nested(*shapes: Curve, **options: Any) -> list[tuple[int, int | None]]:
    found, _ = nest(contours(*shapes), **options)
    return [(contour.depth, contour.parent) for contour in found]


def test_rings_in_rings_alternate() -> None:
    order = [3.0, 1.0, 4.0, 2.0]
    assert nested(*(disc(0, 0, radius) for radius in order)) == [(1, 3), (3, 4), (0, None), (2, 1)]


def test_the_parent_is_the_nearest_around() -> None:
    order = [5.0, 1.0, 9.0, 3.0, 7.0, 2.0, 8.0, 4.0, 6.0]
    expected = {radius: order.index(radius + 1.0) + 1 if radius < 9.0 else None for radius in order}
    assert nested(*(disc(0.3 * radius, 0, radius) for radius in order)) == [(9 - r, expected[r]) for r in order]


def test_neighbours_are_not_nested() -> None:
    assert nested(disc(0, 0, 5), disc(20, 0, 5), disc(20, 0, 2)) == [(0, None), (0, None), (1, 2)]


@settings(deadline=None, max_examples=30)
@given(
    st.lists(st.tuples(st.integers(0, 5), st.integers(0, 5), st.integers(1, 9)), min_size=1, max_size=25, unique=True)
)
def test_depth_counts_the_circles_around_each(circles: list[tuple[int, int, int]]) -> None:
    shapes = [disc(20 * x, 20 * y, radius) for x, y, radius in circles]
    expected = [sum((x, y) == (u, v) and r < s for u, v, s in circles) for x, y, r in circles]
    found, findings = nest(contours(*shapes))
    assert [contour.depth for contour in found] == expected
    assert findings == []
    for contour, (x, y, radius) in zip(found, circles, strict=True):
        larger = [(s, i) for i, (u, v, s) in enumerate(circles, start=1) if (u, v) == (x, y) and s > radius]
        assert contour.parent == (min(larger)[1] if larger else None)


def test_contours_that_cross_are_named_with_their_place() -> None:
    found, (finding,) = nest(contours(disc(0, 0, 10), disc(16, 0, 10)))
    assert finding.what == "it crosses contour 2 (layer CUT, #2) at (8.000, 6.000) mm"
    assert (finding.kind, finding.where, finding.blocks) == ("crossing", "contour 1 (layer CUT, #1)", True)
    assert finding.place == pytest.approx((8e-3, 6e-3), abs=1e-6)
    assert finding.hint
    assert [contour.depth for contour in found] == [0, 0]


@pytest.mark.parametrize("hole", [disc(50, 25, 5), disc(45.05, 25, 5)])
def test_a_hole_that_breaks_through_the_edge_crosses_it(hole: Curve) -> None:
    found, findings = nest(contours(box(0, 0, 50, 50), disc(20, 20, 3), hole))
    assert kinds(findings) == [("crossing", True)]
    assert [(contour.depth, contour.parent) for contour in found] == [(0, None), (1, 1), (0, None)]


def test_holes_that_cross_on_a_plate_are_one_hole_and_what_lies_in_them_too() -> None:
    plate, bore, pocket, step = box(0, 0, 60, 40), disc(20, 20, 8), disc(32, 20, 8), disc(34, 20, 2)
    found, findings = nest(contours(plate, bore, pocket, step))
    assert kinds(findings) == [("crossing", True)]
    assert [(contour.depth, contour.parent) for contour in found] == [(0, None), (1, 1), (1, 1), (1, 1)]


def test_no_more_crossings_are_listed_than_a_person_reads() -> None:
    row = [disc(8 * i, 0, 5) for i in range(300)]
    _, findings = nest(contours(*row))
    assert len(findings) == 201
    assert findings[-1].what == "and 99 more like this"
    assert all(finding.blocks and finding.kind == "crossing" for finding in findings)


def test_a_heap_of_contours_that_all_cross_is_no_hang() -> None:
    heap = [disc(0.01 * i, 0, 5) for i in range(250)]
    found, findings = nest(contours(*heap))
    assert len(found) == 250
    assert findings[-1].what.endswith("pairs of contours meet, too many to tell how")
    assert findings[-1].blocks


@pytest.mark.parametrize("turn", [0.0, 0.3, 1.0])
def test_contours_that_touch_in_a_point_are_nested_with_a_finding(turn: float) -> None:
    def turned(shape: Curve) -> Curve:
        return curves.transform(shape, rotation=turn)

    found, findings = nest(contours(turned(box(0, 0, 10, 10)), turned(box(10, 10, 5, 5)), turned(disc(5, 5, 5))))
    assert [(contour.depth, contour.parent) for contour in found] == [(0, None), (0, None), (1, 1)]
    assert {finding.what.split(" (")[0] for finding in findings} <= {"it touches contour 2", "it touches contour 3"}
    assert set(kinds(findings)) <= {("touching", False)}


@pytest.mark.parametrize(
    ("other", "shared", "middle"),
    [
        (box(10, 0, 10, 10), 10, (10, 5)),
        (box(10 + 1e-7, 2, 3, 4), 4, (10, 4)),
        (box(0, 3, 4, 4), 4, (0, 5)),
    ],
)
def test_contours_that_share_a_line_are_named(other: Curve, shared: float, middle: tuple[float, float]) -> None:
    _, (finding,) = nest(contours(box(0, 0, 10, 10), other))
    assert (finding.kind, finding.blocks) == ("common_edge", True)
    assert finding.what.startswith(f"it shares {shared} mm of line with contour 2 (layer CUT, #2) at ")
    assert finding.place == pytest.approx(tuple(MM * x for x in middle), abs=2e-6)


@pytest.mark.parametrize(
    ("corners", "place"),
    [
        ([(0, 0), (10, 10), (10, 0), (0, 10)], "(5.000, 5.000)"),  # a figure of eight
        ([(0, 0), (10, 0), (5, 5), (10, 10), (0, 10), (5, 5)], "(5.000, 5.000)"),  # touches itself
        ([(0, 0), (10, 0), (10, 10), (10, 20), (10, 10), (0, 10)], ""),  # runs out and back
    ],
)
def test_a_contour_that_meets_itself_is_named(corners: list[tuple[float, float]], place: str) -> None:
    found, (finding,) = nest(contours(curves.polygon(MM * np.array(corners, dtype=float))))
    assert "crosses or touches itself at " + place in finding.what
    assert (finding.kind, finding.blocks) == ("self_crossing", True)
    assert finding.where == "contour 1 (layer CUT, #1)"
    assert finding.place is not None
    assert [contour.depth for contour in found] == [0]


def test_a_scribble_of_thousands_of_lines_is_no_hang() -> None:
    corners = np.random.default_rng(1).uniform(0.0, 0.1, (5000, 2))
    _, (finding,) = nest(contours(curves.polygon(corners)))
    assert finding.kind == "self_crossing"


def test_a_crescent_with_a_tip_of_tangent_arcs_is_no_crossing() -> None:
    # Two arcs that leave the tip in nearly the same direction.
    crescent = Curve(points=MM * np.array([[0.0, 0.0], [20.0, 0.0]]), bulges=np.array([0.5, -0.499]))
    assert nested(crescent) == [(0, None)]


def test_holes_in_an_outline_that_is_open_but_for_a_tab_are_holes() -> None:
    outline = Curve(MM * np.array([[0, 0], [50, 0], [50, 50], [0, 50], [0, 1]]), np.zeros(4), closed=False)
    found, findings = nest(contours(disc(20, 20, 5), disc(80, 20, 5)), outlines=[outline])
    assert [(contour.depth, contour.is_hole) for contour in found] == [(1, True), (0, False)]
    assert findings[0].what == "1 contour lies in an outline that is open: cut as its holes"


def test_an_open_engraving_around_a_hole_does_not_turn_it_inside_out() -> None:
    ring = Curve(MM * np.array([[10, 10], [30, 10], [30, 30], [10, 30], [10, 11]]), np.zeros(4), closed=False)
    assert nested(box(0, 0, 50, 50), disc(20, 20, 5), outlines=[ring]) == [(0, None), (1, 1)]


def test_a_contour_among_lines_that_could_close_in_several_ways_has_no_known_side() -> None:
    tangles = [
        Curve(MM * np.array(points, dtype=float), np.zeros(len(points) - 1), closed=False)
        for points in (
            [(25, 0), (0, 0), (0, 50), (25, 50)],
            [(25, 0), (25, 50)],
            [(25, 0), (50, 0), (50, 50), (25, 50)],
        )
    ]
    _, (finding,) = nest(contours(disc(10, 10, 3)), tangles=tangles)
    assert finding.what.endswith("its side is unknown")
    assert (finding.kind, finding.where, finding.blocks) == ("branch", "contour 1 (layer CUT, #1)", True)
    assert nested(disc(80, 10, 3), tangles=tangles) == [(0, None)]
    assert nested(box(-10, -10, 70, 70), disc(10, 10, 3), tangles=tangles) == [(0, None), (1, 1)]


def test_a_thousand_holes_are_nested_quickly() -> None:
    holes = [disc(10 * (i % 32), 10 * (i // 32), 4) for i in range(1000)]
    depths = nested(box(-10, -10, 400, 400), *holes)
    assert depths == [(0, None)] + [(1, 1)] * 1000


def test_contours_nested_by_the_thousands_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(containment, "MOST_NESTED", 0)
    discs = contours(*(disc(0.0, 0.0, 10.0 + i) for i in range(110)))
    assert max(one.depth for one in nest(discs[:40])[0]) == 39
    with pytest.raises(DrawingError, match="thousands of contours lie in each other"):
        nest(discs)
