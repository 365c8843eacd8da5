"""Joining: shapes taken apart and shuffled come back whole, and nothing is closed by a guess."""

import math
import random

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.drawing.joining import duplicates, tidy
from deltacam.drawing.joining.join import Joined, join
from deltacam.errors import DrawingError
from deltacam.geometry import curve as curves
from deltacam.geometry.pack import Pack
from deltacam.model import Curve, Outcome

MM = 1e-3
BULGES = st.one_of(st.just(0.0), st.floats(0.05, 0.9), st.floats(-0.3, -0.05))


@st.composite
def stars(draw: st.DrawFn) -> Curve:
    """A closed shape around the origin, 20 to 40 mm from it, of lines and arcs that do not cross."""
    count = draw(st.integers(4, 9))
    radii = np.array(draw(st.lists(st.floats(20 * MM, 40 * MM), min_size=count, max_size=count)))
    angles = 2.0 * math.pi * np.arange(count) / count
    points = radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)
    return Curve(points=points, bulges=np.array(draw(st.lists(BULGES, min_size=count, max_size=count))))


def segment(*points: tuple[float, float], bulge: float = 0.0) -> Curve:
    """An open polyline through points in mm."""
    return Curve(points=MM * np.array(points), bulges=np.full(len(points) - 1, bulge), closed=False)


def joined(*shapes: Curve) -> Joined:
    return join(Pack.of(shapes), name=lambda i: f"layer CUT, LINE #{i:X}")


def pieces(curve: Curve) -> list[Curve]:
    """The segments of a closed curve."""
    ends = zip(curve.starts, curve.ends, curve.bulges, strict=True)
    return [Curve(points=np.array([a, b]), bulges=np.array([bulge]), closed=False) for a, b, bulge in ends]


@settings(deadline=None, max_examples=60)
@given(stars(), st.randoms(use_true_random=False), st.floats(0.0, 4e-6))
def test_a_shape_taken_apart_comes_back_with_its_area_and_length(
    shape: Curve, chance: random.Random, noise: float
) -> None:
    parts = [curves.reverse(part) if chance.random() < 0.5 else part for part in pieces(shape)]
    shaken = [
        Curve(
            part.points + noise * np.array([[chance.uniform(-1, 1) for _ in "xy"] for _ in "ab"]),
            part.bulges,
            closed=False,
        )
        for part in parts
    ]
    chance.shuffle(shaken)
    result = joined(*shaken)
    (loop,) = result.loops
    assert sorted(loop.members) == list(range(len(shaken)))
    assert loop.members[0] == 0
    tolerance = 1e-12 if noise == 0.0 else 4.0 * noise
    assert curves.signed_area(loop.curve) == pytest.approx(abs(curves.signed_area(shape)), abs=0.4 * tolerance + 1e-15)
    assert curves.length(loop.curve) == pytest.approx(curves.length(shape), abs=40 * tolerance + 1e-15)
    assert loop.error <= 4.0 * noise
    middles, _ = curves.evaluate(loop.curve, np.arange(len(parts)), 0.5 * curves.lengths(loop.curve))
    for member, middle in zip(loop.members, middles, strict=True):
        assert curves.nearest(shaken[member], middle)[2] <= tolerance + 1e-12
    for point in shape.points:
        assert curves.nearest(loop.curve, point)[2] <= tolerance + 1e-12


@settings(deadline=None, max_examples=20)
@given(stars(), st.randoms(use_true_random=False))
def test_what_is_drawn_twice_is_cut_once(shape: Curve, chance: random.Random) -> None:
    parts = pieces(shape)
    again = [curves.reverse(part) for part in parts]
    mixed = list(enumerate(parts + again))
    chance.shuffle(mixed)
    result = joined(*(part for _, part in mixed), shape)
    (loop,) = result.loops
    assert len(loop.members) in (1, len(parts))
    assert len(result.notes) == 2 * len(parts) + 1 - len(loop.members)
    assert {outcome for outcome, _ in result.notes.values()} == {Outcome.MERGED}
    assert all(reason.startswith("duplicate of layer CUT, LINE #") for _, reason in result.notes.values())


def test_closed_contours_split_differently_are_duplicates() -> None:
    square = curves.polygon(MM * np.array([[0, 0], [10, 0], [10, 10], [0, 10]]))
    split = curves.polygon(MM * np.array([[10, 10], [10, 5], [10, 0], [0, 0], [0, 10], [4, 10]]))
    (loop,) = joined(square, split).loops
    assert loop.members == (0,)
    disc = curves.circle(np.zeros(2), 5 * MM)
    turned = curves.transform(disc, rotation=1.0)
    assert len(joined(disc, turned).loops) == 1
    assert len(joined(disc, curves.circle(np.zeros(2), 5.05 * MM)).loops) == 2


def test_a_line_that_only_covers_part_of_another_is_no_duplicate() -> None:
    whole = segment((0, 10), (0, 0), (10, 0), (10, 10))
    back = segment((0, 10), (0, 0), (10, 0), (0, 0))
    assert not duplicates.same(back, whole)
    assert not duplicates.same(whole, back)
    assert duplicates.same(whole, curves.reverse(whole))


def test_arcs_of_other_bulge_between_the_same_ends_are_no_duplicates() -> None:
    lens = joined(segment((0, 0), (10, 0), bulge=0.2), segment((0, 0), (10, 0), bulge=-0.2))
    assert len(lens.loops) == 1


def test_neighbours_along_a_fine_polyline_are_no_duplicates() -> None:
    angles = np.linspace(0.0, 2.0 * math.pi, 401)[:-1]
    ring = curves.polygon(0.1 * MM * np.stack([np.cos(angles), np.sin(angles)], axis=1))  # segments of 1.6 um
    (loop,) = joined(*pieces(ring)).loops
    assert len(loop.members) == 400
    assert curves.signed_area(loop.curve) == pytest.approx(curves.signed_area(ring), rel=1e-3)


def test_a_chain_of_specks_keeps_its_shape_within_a_micrometre() -> None:
    angles = np.linspace(0.0, 2.0 * math.pi, 2001)[:-1]
    ring = curves.polygon(0.1 * MM * np.stack([np.cos(angles), np.sin(angles)], axis=1))  # segments of 0.3 um
    (loop,) = joined(*pieces(ring)).loops
    assert curves.lengths(loop.curve).min() >= 0.99e-6
    assert max(curves.nearest(loop.curve, point)[2] for point in ring.points) <= 1e-6
    assert 0.0 < loop.error <= 1e-6


def test_a_gap_up_to_the_tolerance_is_bridged_and_a_wider_one_is_named() -> None:
    def outline(gap: float) -> Joined:
        return joined(segment((0, 0), (10, 0), (10, 10), (0, 10)), segment((0, 10), (0, gap)))

    closed = outline(0.0099)
    assert len(closed.loops) == 1
    assert closed.loops[0].error == pytest.approx(9.9e-6)
    opened = outline(0.0101)
    assert opened.loops == []
    (chain,) = opened.chains
    assert chain.members == (0, 1)
    assert chain.reason == "an open chain of 2 entities, gap of 0.0101 mm at (0.000, 0.000) mm"
    assert chain.gap == pytest.approx(1.01e-5)
    assert chain.nearly_closed
    assert not chain.ambiguous
    (finding,) = opened.findings
    assert (finding.kind, finding.where, finding.place) == ("gap", "layer CUT, LINE #0", (0.0, 0.0))
    assert not finding.blocks


def test_the_end_of_a_line_moves_to_that_of_an_arc() -> None:
    arc = segment((0, 0), (10, 0), bulge=1.0)
    line = segment((10.004, 0), (0, 0.004))
    for order in ((arc, line), (line, arc)):
        (loop,) = joined(*order).loops
        assert {tuple(point) for point in loop.curve.points} == {(0.0, 0.0), (0.01, 0.0)}


def test_a_speck_between_two_ends_is_merged() -> None:
    result = joined(
        segment((0, 0), (10, 0), (10, 10)), segment((9.998, 10.003), (9.994, 10.004)), segment((9.992, 10), (0, 0))
    )
    assert len(result.loops) == 1
    assert result.notes == {1: (Outcome.MERGED, "shorter than the joining tolerance of 0.01 mm")}


def test_a_speck_that_sticks_out_does_not_keep_an_outline_open() -> None:
    corners = segment((0.009, 0), (10, 0), (10, 10), (0, 0))
    result = joined(corners, segment((0.0045, 0.001), (0.0045, 0.0105)))
    assert len(result.loops) == 1
    assert set(result.notes) == {1}


def test_a_speck_does_not_bridge_more_than_the_tolerance() -> None:
    corners = segment((0.02, 0), (10, 0), (10, 10), (0, 0.004))
    result = joined(corners, segment((0.007, 0.001), (0.013, 0.001)))
    assert result.loops == []
    assert [chain.members for chain in result.chains] == [(0,)]
    assert result.notes[1] == (Outcome.MERGED, "shorter than the joining tolerance of 0.01 mm")


def test_a_polyline_that_ends_where_it_starts_is_closed() -> None:
    (loop,) = joined(segment((0, 0), (10, 0), (10, 10), (0, 0))).loops
    assert len(loop.curve.points) == 3


def test_a_line_drawn_back_and_forth_is_one_open_line() -> None:
    spike = Curve(points=MM * np.array([[0.0, 0.0], [10.0, 0.0]]), bulges=np.zeros(2))
    result = joined(spike, curves.circle(np.array([0.1, 0.1]), 5 * MM))
    assert len(result.loops) == 1
    (chain,) = result.chains
    assert (chain.members, chain.reason) == ((0,), "a closed line that encloses nothing")
    assert np.array_equal(chain.curve.points, spike.points)
    assert result.notes == {}
    (finding,) = result.findings
    assert (finding.kind, finding.where, finding.place) == ("sliver", "layer CUT, LINE #0", (0.0, 0.0))


def test_a_figure_of_eight_is_no_sliver() -> None:
    eight = curves.polygon(MM * np.array([[0.0, 0.0], [10.0, 10.0], [10.0, 0.0], [0.0, 10.0]]))
    assert len(joined(eight).loops) == 1


def test_an_arc_beside_a_speck_of_a_segment_stays_exact() -> None:
    points = MM * np.array([[0.0, 0.0], [30.0, 0.0], [30.0, 0.0005], [30.0, 10.0], [0.0, 10.0]])
    arcs = Curve(points, np.array([0.0, 0.0, 0.4, 0.0, 0.0]))
    clean, moved = tidy.cleaned(arcs)
    assert clean is not None
    assert moved == pytest.approx(0.5e-6)
    exact = Curve(points[2:4], np.array([0.4]), closed=False)
    segment_of_arc = int(np.flatnonzero(clean.bulges)[0])
    assert clean.starts[segment_of_arc] == pytest.approx(exact.points[0], abs=1e-15)
    assert curves.curvatures(clean)[segment_of_arc] == pytest.approx(curves.curvatures(exact)[0], rel=1e-12)


def test_a_dead_end_does_not_keep_an_outline_open() -> None:
    square = [
        segment((0, 0), (10, 0)),
        segment((10, 0), (10, 10)),
        segment((10, 10), (0, 10)),
        segment((0, 10), (0, 0)),
    ]
    result = joined(*square, segment((10, 10), (15, 15)), segment((0, 0), (-5, -5), (-9, -9)))
    assert [loop.members for loop in result.loops] == [(0, 1, 2, 3)]
    assert [chain.members for chain in result.chains] == [(4,), (5,)]
    branches = [finding for finding in result.findings if finding.kind == "branch"]
    assert sorted(finding.place or () for finding in branches) == [(0.0, 0.0), (0.01, 0.01)]
    assert {finding.where for finding in branches} == {"(0.000, 0.000) mm", "(10.000, 10.000) mm"}
    assert not any(finding.blocks for finding in branches)


def test_contours_that_touch_in_a_corner_are_both_cut() -> None:
    result = joined(
        *pieces(curves.polygon(MM * np.array([[0, 0], [10, 0], [10, 10]]))),
        *pieces(curves.polygon(MM * np.array([[10, 10], [20, 10], [20, 20]]))),
        *pieces(curves.polygon(MM * np.array([[20, 20], [30, 20], [30, 30]]))),
    )
    assert [sorted(loop.members) for loop in result.loops] == [[0, 1, 2], [3, 4, 5], [6, 7, 8]]
    assert [finding.kind for finding in result.findings] == ["branch", "branch"]


def test_parts_with_a_common_edge_stay_open_and_are_reported() -> None:
    left, right = segment((10, 0), (0, 0), (0, 10), (10, 10)), segment((10, 0), (20, 0), (20, 10), (10, 10))
    result = joined(left, segment((10, 0), (10, 10)), right)
    assert result.loops == []
    assert {chain.reason for chain in result.chains} == {"an open line, meets others at a branch point"}
    assert [chain.ambiguous for chain in result.chains] == [True, True, True]
    (finding,) = (finding for finding in result.findings if finding.blocks)
    assert (finding.kind, finding.where) == ("common_edge", "layer CUT, LINE #0")
    assert finding.what == "2 outlines share lines, for one at (10.000, 5.000) mm"
    assert finding.place == pytest.approx((0.01, 0.005))


def test_a_bridge_between_two_outlines_is_an_open_line() -> None:
    left = pieces(curves.polygon(MM * np.array([[0, 0], [10, 0], [10, 10]])))
    right = pieces(curves.polygon(MM * np.array([[30, 0], [40, 0], [40, 10]])))
    result = joined(*left, *right, segment((10, 0), (30, 0)))
    assert len(result.loops) == 2
    assert [(chain.members, chain.ambiguous) for chain in result.chains] == [((6,), False)]
    assert not any(finding.blocks for finding in result.findings)


def test_many_ends_in_one_place_are_refused_and_not_a_hang() -> None:
    rays = [segment((1e-8 * i, 0), (10 + i, 50)) for i in range(2500)]
    with pytest.raises(DrawingError, match="crowd in one place"):
        joined(*rays)


@pytest.mark.parametrize("step", [5e-5, 8e-3])
def test_a_row_of_ends_never_closes_a_gap_wider_than_the_tolerance(step: float) -> None:
    outline = segment((0, 0), (10, 0), (10, 10), (-0.03, 0))
    rays = [segment((-step * i, 0), (-10, -20 - i)) for i in range(1, math.ceil(0.03 / step))]
    try:
        result = joined(outline, *rays)
    except DrawingError as error:
        assert "crowd" in error.what  # noqa: PT017
        return
    assert result.loops == []
    assert result.chains[0].reason == "an open line, gap of 0.03 mm at (0.000, 0.000) mm"


def test_ten_thousand_lines_are_joined_in_linear_time() -> None:
    corners = MM * np.array([[0, 0], [10, 0], [10, 10], [0, 10]])
    parts = [part for i in range(500) for part in pieces(curves.polygon(corners + 0.012 * np.array([i % 25, i // 25])))]
    random.Random(1).shuffle(parts)  # noqa: S311
    assert len(joined(*parts).loops) == 500


@settings(deadline=None)
@given(stars(), st.integers(1, 8), st.floats(1e-9, 0.9e-6))
def test_specks_of_segments_are_dropped_and_arcs_stay_exact(shape: Curve, at: int, short: float) -> None:
    at = at % len(shape.points)
    away = shape.points[at] + short * np.array([0.6, 0.8])
    speckled = Curve(np.insert(shape.points, at, away, axis=0), np.insert(shape.bulges, at, 0.0))
    clean, moved = tidy.cleaned(speckled)
    assert clean is not None
    assert len(clean.points) == len(shape.points)
    assert moved == pytest.approx(short, rel=1e-6)
    assert max(curves.nearest(clean, point)[2] for point in shape.points) <= short * (1 + 1e-9)


@pytest.mark.parametrize("turn", [False, True])
@pytest.mark.parametrize("arc", [0.0, 0.4])
def test_a_line_that_runs_past_the_start_is_shortened(turn: bool, arc: float) -> None:
    over = segment((0.0, 8.0), (0.0, -0.15))
    last = curves.reverse(over) if turn else over
    bottom = Curve(MM * np.array([(0.0, 0.0), (9.0, 0.0)]), np.array([arc]), closed=False)
    result = join(Pack.of([bottom, segment((9, 0), (9, 8)), segment((9, 8), (0, 8)), last]), joining=2e-4, name=str)
    (loop,) = result.loops
    assert len(loop.curve.points) == 4
    assert loop.error == 0.0
    assert {tuple(np.round(point / MM, 9)) for point in loop.curve.points} == {(0, 0), (9, 0), (9, 8), (0, 8)}
