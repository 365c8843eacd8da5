"""Common edges, against the kerf swept along the closed cuts of all parts."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.cutting.kerf import offset
from deltacam.cutting.shared import Shared, share_edges
from deltacam.geometry import curve as curves
from deltacam.model import Contour, Curve, Cut
from tests.strategies import contour, rectangle

KERF = 2e-4


def shared(contours: list[Contour], *, kerf: float = KERF, tolerance: float = 5e-6) -> tuple[tuple[Cut, ...], Shared]:
    cuts = offset(contours, kerf=kerf).cuts
    return cuts, share_edges(cuts, contours, kerf=kerf, tolerance=tolerance)


def swept(cuts: tuple[Cut, ...], kerf: float = KERF) -> shapely.Geometry:
    lines = [curves.opened(cut.curve) if cut.curve.closed else cut.curve for cut in cuts]
    flat = [shapely.LineString(curves.flatten(line, 1e-7)[0]) for line in lines]
    return shapely.union_all(shapely.buffer(flat, kerf / 2, quad_segs=48))


def length(cuts: tuple[Cut, ...]) -> float:
    return sum(curves.length(cut.curve) for cut in cuts)


def of(cuts: tuple[Cut, ...], number: int) -> list[Curve]:
    return [cut.curve for cut in cuts if cut.contour == number]


def grid(columns: int, rows: int, size: float = 0.01) -> list[Contour]:
    pitch = size + KERF
    places = [(pitch * column, pitch * row) for row in range(rows) for column in range(columns)]
    return [contour(rectangle(size, size, at=at), number=number) for number, at in enumerate(places, start=1)]


def all_free(contours: list[Contour], cuts: tuple[Cut, ...]) -> bool:
    """Whether every part is cut all around, along its whole edge, and not cut into."""
    cut = swept(cuts)
    parts = [shapely.Polygon(curves.flatten(one.curve, 1e-7)[0]) for one in contours]
    sheet = shapely.box(*shapely.union_all(parts).bounds).buffer(0.01)
    left = shapely.get_parts(sheet.difference(cut.buffer(1e-6)))
    for part in parts:
        (piece,) = [piece for piece in left if piece.contains(part.representative_point())]
        if piece.symmetric_difference(part).area > 3e-6 * part.length:
            return False
        edge = shapely.points(shapely.get_coordinates(part.exterior.segmentize(5e-4)))
        if shapely.distance(edge, cut).max() > 1e-6:
            return False
    return True


def test_the_edge_between_two_parts_is_cut_once() -> None:
    contours = grid(2, 1)
    cuts, found = shared(contours)
    first, second = found.cuts
    assert first is cuts[0]
    assert not second.curve.closed
    assert length(found.cuts) == pytest.approx(length(cuts) - 0.01, abs=1e-9)
    assert all_free(contours, found.cuts)
    assert found.after == {2: (1,)}
    (edge,) = found.edges[1]
    assert np.sort(edge.points[:, 1]) == pytest.approx([0.0, 0.01])
    assert edge.points[:, 0] == pytest.approx(0.0101)
    assert found.findings[0].what == "10.0 mm of common edges are cut once: contours 2 with 1"


@pytest.mark.parametrize(("columns", "rows"), [(3, 3), (4, 2), (1, 5)])
def test_of_a_grid_every_inner_edge_is_cut_once(columns: int, rows: int) -> None:
    contours = grid(columns, rows)
    cuts, found = shared(contours)
    inner = (columns - 1) * rows + columns * (rows - 1)
    saved = length(cuts) - length(found.cuts) - 0.01 * inner
    rounds = (columns - 1) * (rows - 1) * math.pi * KERF / 4.0
    assert saved == pytest.approx(rounds, abs=1e-8)
    assert len(found.cuts) == columns * rows
    assert all_free(contours, found.cuts)
    assert {cut.contour for cut in found.cuts} == {one.number for one in contours}


def grounded(after: dict[int, tuple[int, ...]], number: int, seen: tuple[int, ...] = ()) -> bool:
    assert number not in seen
    return all(grounded(after, other, (*seen, number)) for other in after.get(number, ()))


@settings(max_examples=20)
@given(
    st.lists(st.lists(st.floats(3e-3, 15e-3), min_size=1, max_size=4), min_size=1, max_size=4),
    st.floats(0.0, 6.0),
    st.floats(0.0, 5e-3),
)
def test_of_a_wall_of_bricks_nothing_stays_uncut_and_nobody_waits_for_himself(
    rows: list[list[float]], turn: float, shift: float
) -> None:
    contours, number = [], 0
    for row, widths in enumerate(rows):
        x = shift * row
        for width in widths:
            number += 1
            brick = rectangle(width, 8e-3, at=(x, row * (8e-3 + KERF)))
            contours.append(contour(curves.transform(brick, rotation=turn), number=number))
            x += width + KERF
    cuts, found = shared(contours)
    assert all_free(contours, found.cuts)
    assert {cut.contour for cut in found.cuts} == {one.number for one in contours}
    assert all(grounded(dict(found.after), one.number) for one in contours)
    lines = shapely.union_all([shapely.LineString(curves.flatten(curves.opened(cut.curve), 1e-7)[0]) for cut in cuts])
    once = lines.buffer(2e-6, cap_style="flat").area / 4e-6
    assert length(found.cuts) - once < 2e-3 * 2 * len(cuts) + 1e-4
    assert length(found.cuts) > once - 1e-4 - 2.0 * len(cuts) * math.pi * KERF / 4.0  # rounds that are not needed


def test_a_part_whose_whole_path_is_shared_keeps_its_cut() -> None:
    long, short, thick = 0.02, 0.01, 0.01 - KERF
    shapes = [
        rectangle(long, thick, at=(0.0, -KERF - thick)),
        rectangle(thick, long, at=(short + KERF, 0.0)),
        rectangle(short, short),
        rectangle(long, thick, at=(short - long, short + KERF)),
        rectangle(thick, long, at=(-thick - KERF, short - long)),
    ]
    contours = [contour(shape, number=number) for number, shape in enumerate(shapes, start=1)]
    cuts, found = shared(contours)
    (middle,) = of(found.cuts, 3)
    assert middle.closed
    assert 3 not in found.after
    assert length(found.cuts) <= length(cuts) - 4 * short + 1e-8
    assert all_free(contours, found.cuts)


def test_a_long_edge_beside_short_ones_is_cut_in_one_go() -> None:
    long = contour(rectangle(0.01, 0.02 + KERF, at=(0.01 + KERF, 0.0)), number=3)
    contours = [*grid(1, 2), long]
    _, found = shared(contours)
    (whole,) = of(found.cuts, 3)
    assert whole.closed
    assert found.after == {1: (3,), 2: (1, 3)}
    assert all_free(contours, found.cuts)


def test_a_fillet_of_one_kerf_around_the_corner_of_another_part_is_shared_with_its_sides() -> None:
    notched = Curve(
        points=np.array([[0, 0], [20, 0], [20, 20], [10, 20], [10, 10.2], [9.8, 10], [0, 10]]) * 1e-3,
        bulges=np.array([0, 0, 0, 0, -math.tan(math.pi / 8), 0, 0]),
    )
    inside = contour(rectangle(0.0098, 0.0098, at=(0.0, 0.0102)), number=1)
    contours = [inside, contour(notched, number=2)]
    cuts, found = shared(contours)
    assert all_free(contours, found.cuts)
    assert length(found.cuts) < length(cuts) - 0.0195


def test_shared_arcs_are_cut_once_too() -> None:
    inner = Curve(points=np.array([[0, 0], [0.01, 0], [0.01, 0.01], [0, 0.01]]), bulges=np.array([0, 0.4, 0, 0.0]))
    (path,) = offset([contour(inner)], kerf=2 * KERF).cuts
    bent = int(
        np.argmax(curves.lengths(path.curve) * (np.abs(curves.curvatures(path.curve)) < 1e3) * path.curve.bulges)
    )
    a, b = path.curve.points[bent], path.curve.points[bent + 1]
    outer = Curve(
        points=np.array([a, [0.025, a[1]], [0.025, b[1]], b]),
        bulges=np.array([0.0, 0.0, 0.0, -path.curve.bulges[bent]]),
    )
    contours = [contour(inner, number=1), contour(outer, number=2)]
    cuts, found = shared(contours)
    assert length(cuts) - length(found.cuts) == pytest.approx(curves.lengths(inner)[1], rel=0.05)
    assert all_free(contours, found.cuts)


@pytest.mark.parametrize("segment", range(8))
def test_it_does_not_matter_where_a_path_begins(segment: int) -> None:
    contours = grid(2, 1)
    cuts, found = shared(contours)
    moved = (cuts[0], Cut(2, "CUT", ("2",), curves.start_at(cuts[1].curve, segment, 1e-5)))
    again = share_edges(moved, contours, kerf=KERF, tolerance=5e-6)
    assert len(again.cuts) == 2
    ends = [cut.curve.points[[0, -1]] for cut in (found.cuts[1], again.cuts[1])]
    assert ends[0] == pytest.approx(ends[1], abs=1e-12)


@pytest.mark.parametrize(("gap", "once"), [(KERF - 2e-6, True), (KERF + 4e-6, True), (KERF + 6e-6, False)])
def test_the_paths_may_be_as_far_apart_as_the_tolerance(gap: float, once: bool) -> None:
    contours = [contour(rectangle(0.01, 0.01), number=1), contour(rectangle(0.01, 0.01, at=(0.01 + gap, 0)), number=2)]
    _, found = shared(contours)
    assert (len(found.after) == 1) is once
    if once:
        second = found.cuts[1].curve
        assert np.abs(second.points[[0, -1], 0] - (0.01 + gap - KERF / 2)).max() < 1e-9


def test_a_short_common_edge_is_not_worth_it() -> None:
    contours = [contour(rectangle(0.01, 0.01), number=1)]
    contours.append(contour(rectangle(0.01, 0.01, at=(0.01 + KERF, 0.0085)), number=2))
    cuts, found = shared(contours)
    assert found == (cuts, {}, {}, ())


def test_holes_and_what_lies_elsewhere_share_nothing() -> None:
    outer = contour(rectangle(0.03, 0.03), number=1)
    hole = contour(rectangle(0.01 + 2 * KERF, 0.01 + 2 * KERF, at=(0.01, 0.01)), number=2, depth=1, parent=1)
    island = contour(rectangle(0.01, 0.01, at=(0.01 + KERF, 0.01 + KERF)), number=3, depth=2, parent=2)
    cuts, found = shared([outer, hole, island])
    assert found == (cuts, {}, {}, ())


def test_without_a_kerf_a_line_that_is_drawn_twice_is_cut_once() -> None:
    contours = [contour(rectangle(0.01, 0.01), number=1), contour(rectangle(0.01, 0.01, at=(0.01, 0.0)), number=2)]
    cuts, found = shared(contours, kerf=0.0)
    assert length(found.cuts) == pytest.approx(length(cuts) - 0.01)


def test_edges_that_only_cross_or_touch_are_not_shared() -> None:
    turned = curves.transform(rectangle(0.01, 0.01), rotation=math.radians(45.0), shift=(0.017 + 1.5e-3, 0.005))
    _, found = shared([contour(rectangle(0.01, 0.01), number=1), contour(turned, number=2)])
    assert found.after == {}
