"""Outlines drawn twice, split at other vertices: each is found once, from whole curves where that is possible."""

import math
import random

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st

from deltacam.drawing.joining.join import Joined, join
from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Curve, Outcome
from tests.strategies import slot, star_curves

MM = 1e-3
CHANCE = random.Random(1)  # noqa: S311


def joined(*shapes: Curve) -> Joined:
    return join(Pack.of(shapes), name=lambda i: f"LINE #{i:X}")


def line(*points: tuple[float, float]) -> Curve:
    """An open polyline through points in mm."""
    return Curve(points=MM * np.array(points), bulges=np.zeros(len(points) - 1), closed=False)


def bent(bulge: float) -> Curve:
    """A triangle with one edge that is hardly, or somewhat, bent."""
    return Curve(MM * np.array([(0, 0), (9, 0), (0, 9)]), np.array([bulge, 0.0, 0.0]))


def pieces(shape: Curve, cuts: list[float]) -> list[Curve]:
    """A closed curve in single segments, each cut at the given shares of its length."""
    parts = []
    for a, b, bulge in zip(shape.starts, shape.ends, shape.bulges, strict=True):
        whole = Curve(np.array([a, b]), np.array([bulge]), closed=False)
        shares = [0.0, *cuts, 1.0]
        places, _ = curves.evaluate(
            whole, np.zeros(len(shares), dtype=np.int64), curves.length(whole) * np.array(shares)
        )
        places[0], places[-1] = a, b
        for k in range(len(shares) - 1):
            part = math.tan(math.atan(bulge) * (shares[k + 1] - shares[k]))
            parts.append(Curve(places[k : k + 2], np.array([part]), closed=False))
    return parts


SQUARE = curves.polygon(MM * np.array([[0, 0], [10, 0], [10, 10], [0, 10]]))


@pytest.mark.parametrize("first_is_whole", [True, False])
def test_a_contour_exported_twice_with_other_cuts_is_found_once(first_is_whole: bool) -> None:
    whole, split = pieces(SQUARE, []), pieces(SQUARE, [0.3, 0.55])
    shapes = [*whole, *split] if first_is_whole else [*split, *whole]
    result = joined(*shapes)
    (loop,) = result.loops
    assert result.chains == []
    count = 4 if first_is_whole else 12
    assert sorted(loop.members) == list(range(count))
    assert len(loop.curve.points) == count
    assert curves.signed_area(loop.curve) == pytest.approx(1e-4)
    assert {result.notes[i][0] for i in range(count, 16)} == {Outcome.MERGED}
    assert set(result.copies) == set(range(count, 16))


def test_what_is_left_of_whole_curves_keeps_its_numbers() -> None:
    result = joined(*pieces(SQUARE, []), *pieces(SQUARE, [1.0 / 3.0]))
    assert result.loops[0].curve.points.tobytes() == SQUARE.points.tobytes()


def test_edges_cut_at_other_places_in_both_copies_are_found_once() -> None:
    result = joined(*pieces(SQUARE, [0.4]), *pieces(SQUARE, [0.7]))
    (loop,) = result.loops
    assert sorted(loop.members) == list(range(8))
    assert result.chains == []


def test_a_polyline_over_three_of_four_lines_is_a_copy() -> None:
    bracket = line((10, 0), (10, 10), (0, 10), (0, 0))
    result = joined(*pieces(SQUARE, []), bracket)
    (loop,) = result.loops
    assert loop.members == (0, 1, 2, 3)
    assert result.notes == {4: (Outcome.MERGED, "duplicate of LINE #1")}


def test_a_vertex_that_is_written_twice_changes_nothing() -> None:
    bracket = line((10, 0), (10, 10), (10, 10), (0, 10), (0, 0))
    result = joined(bracket, *pieces(SQUARE, []))
    (loop,) = result.loops
    assert curves.signed_area(loop.curve) == pytest.approx(1e-4)
    assert result.chains == []


def test_arcs_cut_at_other_places_are_found_once() -> None:
    shape = slot(30 * MM, 10 * MM)
    whole = pieces(shape, [])
    (loop,) = joined(*whole, *pieces(shape, [0.2, 0.6])).loops
    assert loop.members == (0, 1, 2, 3)
    assert loop.curve.bulges.tolist() == [float(part.bulges[0]) for part in whole]


def test_a_circle_and_two_arcs_are_one_contour() -> None:
    circle = curves.circle(np.zeros(2), 5 * MM)
    turned = curves.transform(circle, rotation=1.0)
    (loop,) = joined(circle, *pieces(turned, [])).loops
    assert loop.members == (0,)


def test_lines_that_overlap_only_in_part_are_kept_whole_or_as_pieces() -> None:
    bottom = [line((0, 0), (6, 0)), line((4, 0), (10, 0))]
    rest = [line((10, 0), (10, 10), (0, 10), (0, 0))]
    stubs = [line((6, 0), (10, 0)), line((0, 0), (4, 0))]
    (loop,) = joined(*bottom, *rest, *stubs).loops
    assert curves.signed_area(loop.curve) == pytest.approx(1e-4)


def test_an_overlap_that_ends_in_nothing_is_left_to_a_person() -> None:
    result = joined(line((1, 0), (2, 0)), line((2, 0), (2, 4), (0, 4), (0, 0)), line((0, 0), (1.1, 0)))
    assert result.loops == []
    (chain,) = result.chains
    assert chain.gap == pytest.approx(1e-4)


def test_an_open_line_on_an_edge_is_named() -> None:
    result = joined(*pieces(SQUARE, []), line((2, 0), (7, 0)), line((2, 3), (7, 3)))
    assert len(result.loops) == 1
    assert [chain.reason for chain in result.chains] == [
        "lies along contour of LINE #0",
        "an open line, from (2.000, 3.000) to (7.000, 3.000) mm",
    ]
    (finding,) = result.findings
    assert (finding.kind, finding.where, finding.place) == ("duplicate", "LINE #4", (0.002, 0.0))


def test_a_whole_line_is_split_where_another_outline_needs_its_middle() -> None:
    # The long edge is drawn twice, the second time in two; a second triangle stands on its right half only.
    long, halves = line((0, 0), (20, 0)), [line((0, 0), (10, 0)), line((10, 0), (20, 0))]
    below = line((20, 0), (10, -9), (0, 0))
    above = line((20, 0), (15, 9), (10, 0))
    result = joined(long, *halves, below, above)
    assert result.loops == []
    (finding,) = (finding for finding in result.findings if finding.blocks)
    assert finding.what.startswith("2 outlines share lines")


def test_an_open_line_that_leaves_the_edge_lies_on_nothing() -> None:
    leaving = line((2, 0), (5, 0), (5, 5))
    result = joined(*pieces(SQUARE, []), leaving)
    assert result.chains[0].reason == "an open line, from (2.000, 0.000) to (5.000, 5.000) mm"


@settings(deadline=None, max_examples=40)
@example(bent(2e-12), [], [0.5], CHANCE)
@example(bent(1e-6), [], [0.2], CHANCE)
@example(bent(0.06), [0.5], [0.3], CHANCE)
@given(
    star_curves(),
    st.lists(st.floats(0.1, 0.9), max_size=3),
    st.lists(st.floats(0.1, 0.9), max_size=3),
    st.randoms(use_true_random=False),
)
def test_any_two_ways_to_split_a_shape_give_the_shape_once(
    shape: Curve, cuts: list[float], others: list[float], chance: random.Random
) -> None:
    def apart(shares: list[float]) -> list[float]:
        grid = sorted({round(share, 1) for share in shares})
        return [share for share in grid if 0.0 < share < 1.0]

    parts = pieces(shape, apart(cuts)) + pieces(shape, apart(others))
    mixed = [curves.reverse(part) if chance.random() < 0.5 else part for part in parts]
    chance.shuffle(mixed)
    result = joined(*mixed)
    (loop,) = result.loops
    assert result.chains == []
    assert set(loop.members).isdisjoint(result.copies)
    assert {*loop.members, *result.copies} == set(range(len(mixed)))
    assert curves.signed_area(loop.curve) == pytest.approx(abs(curves.signed_area(shape)), rel=1e-9)
    assert max(curves.nearest(loop.curve, point)[2] for point in shape.points) <= 1e-9
