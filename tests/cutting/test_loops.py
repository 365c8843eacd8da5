"""Loops at outer corners, against closed forms and against the kerf swept along them."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from deltacam.cutting import trace
from deltacam.cutting.kerf import offset
from deltacam.cutting.loops import Looped, Side, with_loops
from deltacam.cutting.waste import Waste
from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Contour, Curve, Loops, Stretch
from tests.strategies import contour, rectangle, star_curves

KERF = 2e-4
SHARP = Loops(angle=math.radians(60.0))
L_SHAPE = curves.polygon(np.array([[0, 0], [20, 0], [20, 10], [10, 10], [10, 20], [0, 20]]) * 1e-3)


def opened(curve: Curve) -> Curve:
    """A closed curve as an open one that comes back to its first point."""
    return Curve(points=np.vstack([curve.points, curve.points[:1]]), bulges=curve.bulges, closed=False)


def from_longest(curve: Curve) -> Curve:
    """A closed curve, begun in the middle of its longest segment and opened."""
    lengths = curves.lengths(curve)
    longest = int(np.argmax(lengths))
    return opened(curves.start_at(curve, longest, float(lengths[longest]) / 2.0))


def looped(
    part: Contour,
    *others: Contour,
    kerf: float = KERF,
    radius: float = 1e-3,
    rule: Loops = SHARP,
    room: shapely.Geometry | None = None,
    backwards: bool = False,
) -> Looped:
    (cut,) = offset([part], kerf=kerf).cuts
    curve = from_longest(cut.curve)
    curve = curves.reverse(curve) if backwards else curve
    side: Side = "left" if part.is_hole != backwards else "right"
    way = [Stretch(BlockKind.CUT, curve)]
    free = Waste([part, *others], kerf=kerf, room=room)
    return with_loops(way, part, side=side, kerf=kerf, rule=rule, needed=lambda _: radius, waste=free)


def whole(way: tuple[Stretch, ...]) -> Curve:
    """All stretches as one curve."""
    points = np.vstack([way[0].curve.points[:1], *(stretch.curve.points[1:] for stretch in way)])
    return Curve(points=points, bulges=np.concatenate([stretch.curve.bulges for stretch in way]), closed=False)


def line(curve: Curve) -> shapely.LineString:
    return shapely.LineString(curves.flatten(curve, 1e-7)[0])


def loops(found: Looped) -> list[Curve]:
    return [stretch.curve for stretch in found.way if stretch.kind is BlockKind.LOOP]


def joined(way: tuple[Stretch, ...]) -> bool:
    ends, begins = [stretch.curve.points[-1] for stretch in way[:-1]], [stretch.curve.points[0] for stretch in way[1:]]
    return all((end == begin).all() for end, begin in zip(ends, begins, strict=True))


def test_every_corner_of_a_square_gets_a_loop_of_the_length_that_the_formula_says() -> None:
    found = looped(contour(rectangle(0.02, 0.02)))
    assert [stretch.kind for stretch in found.way] == [BlockKind.CUT, BlockKind.LOOP] * 4 + [BlockKind.CUT]
    assert found.findings == ()
    assert joined(found.way)
    for loop in loops(found):
        assert curves.length(loop) == pytest.approx(2.0 * (KERF / 2 + 1e-3) + 1e-3 * 1.5 * math.pi, rel=1e-9)
        assert np.abs(curves.curvatures(loop)) == pytest.approx([0.0, 1e3, 1e3, 0.0])


def test_a_loop_crosses_itself_once_where_the_offset_sides_meet() -> None:
    found = looped(contour(rectangle(0.02, 0.01)))
    crossings = []
    for loop in loops(found):
        first, last = (shapely.LineString(loop.points[[k, k + 1]]) for k in (0, 3))
        crossings.append(shapely.get_coordinates(first.intersection(last))[0])
    corners = np.array([[0, 0], [0.02, 0], [0.02, 0.01], [0, 0.01]]) + 1e-4 * np.array(
        [[-1, -1], [1, -1], [1, 1], [-1, 1]]
    )
    assert sorted(map(tuple, np.round(crossings, 9))) == sorted(map(tuple, np.round(corners, 9)))


@settings(max_examples=60)
@given(star_curves(), st.floats(5e-5, 5e-4), st.floats(2e-4, 3e-3), st.booleans(), st.booleans())
def test_no_loop_cuts_into_the_part_and_both_sides_are_cut_to_the_corner(
    curve: Curve, kerf: float, radius: float, hole: bool, backwards: bool
) -> None:
    ring = shapely.LinearRing(curves.flatten(curve, 1e-7)[0])
    assume(ring.is_simple and curves.signed_area(curve) > 1e-6)
    part = contour(curve, depth=int(hole))
    assume(shapely.Polygon(ring).buffer(-kerf / 2).geom_type == "Polygon")
    assume(len(offset([part], kerf=kerf).cuts) == 1)
    found = looped(part, kerf=kerf, radius=radius, backwards=backwards)
    assert joined(found.way)
    way = line(whole(found.way))
    assert way.distance(ring) > kerf / 2 - 5e-6
    for loop in loops(found):
        # The whole edge near the corner is exactly half a kerf beside the loop and what is cut before and behind it.
        corner = ring.intersection(line(loop).buffer(kerf / 2 + 1e-6))
        edge = shapely.get_coordinates(shapely.segmentize(corner, 1e-5))
        assert shapely.distance(shapely.points(edge), way).max() < kerf / 2 + 5e-6
        inside = shapely.contains_xy(shapely.Polygon(ring), curves.flatten(loop, 1e-6)[0])
        assert inside.all() if hole else not inside.any()


@settings(max_examples=60)
@given(star_curves(), st.floats(5e-5, 5e-4))
def test_the_direction_never_jumps_at_a_loop(curve: Curve, kerf: float) -> None:
    ring = shapely.LinearRing(curves.flatten(curve, 1e-7)[0])
    assume(ring.is_simple and curves.signed_area(curve) > 1e-6)
    part = contour(curve)
    assume(len(offset([part], kerf=kerf).cuts) == 1)
    found = looped(part, kerf=kerf)
    for before, after in zip(found.way[:-1], found.way[1:], strict=True):
        (_, end), (start, _) = curves.headings(before.curve), curves.headings(after.curve)
        assert math.remainder(start[0] - end[-1], 2.0 * math.pi) == pytest.approx(0.0, abs=1e-7)
    for loop in loops(found):
        assert curves.corner_angles(loop) == pytest.approx(0.0, abs=1e-7)


@settings(max_examples=60)
@given(star_curves(arcs=False), st.floats(0.5, 1.5), st.booleans())
def test_every_outer_corner_that_is_sharp_enough_gets_a_loop_and_no_other(
    curve: Curve, angle: float, backwards: bool
) -> None:
    ring = shapely.LinearRing(curve.points)
    assume(ring.is_simple and curves.signed_area(curve) > 1e-6)
    part = contour(curve)
    turns = curves.corner_angles(part.curve)
    assume(turns.max() < 2.9)  # sharper ones get none, and have sides that the next round may reach
    assume(np.abs(turns - angle).min() > 1e-6)
    (cut, *others) = offset([part], kerf=KERF).cuts
    assume(not others)
    found = looped(part, radius=1e-6, rule=Loops(angle=angle), backwards=backwards)
    path = line(opened(cut.curve))
    tips = part.curve.points[turns >= angle]
    free = path.distance(shapely.points(tips)) < KERF / 2 + 1e-6  # others lie in a bay that the kerf closes
    assert len(loops(found)) == free.sum()


def test_the_corners_of_a_hole_get_none_but_those_of_what_reaches_into_it() -> None:
    assert loops(looped(contour(rectangle(0.02, 0.02), depth=1))) == []
    (loop,) = loops(looped(contour(L_SHAPE, depth=1)))
    assert np.hypot(*(loop.points[0] - [0.01, 0.01])) == pytest.approx(KERF / 2)


def test_a_hollow_corner_of_an_outline_gets_none() -> None:
    assert len(loops(looped(contour(L_SHAPE)))) == 5


def test_without_a_kerf_a_loop_begins_and_ends_in_the_corner() -> None:
    found = looped(contour(rectangle(0.02, 0.02)), kerf=0.0)
    assert len(loops(found)) == 4
    for loop in loops(found):
        assert loop.points[0] == pytest.approx(loop.points[-1])
        assert curves.length(loop) == pytest.approx(1e-3 * (2.0 + 1.5 * math.pi))


def test_a_circle_drawn_as_short_chords_has_no_corner() -> None:
    angle = 2.0 * np.pi * np.arange(20) / 20
    polygon = curves.polygon(0.01 * np.stack([np.cos(angle), np.sin(angle)], axis=1))
    assert loops(looped(contour(polygon))) == []
    assert len(loops(looped(contour(polygon), rule=Loops(angle=math.radians(17.9))))) == 20


def test_a_path_that_could_not_be_traced_gets_the_same_loops(monkeypatch: pytest.MonkeyPatch) -> None:
    part = contour(L_SHAPE)
    traced = loops(looped(part))
    monkeypatch.setattr(trace, "_assemble", lambda *_: None)
    lines = loops(looped(part))
    assert len(lines) == len(traced)
    for one, other in zip(lines, traced, strict=True):
        assert one.points == pytest.approx(other.points, abs=3e-6)


def test_where_there_is_less_room_the_loop_is_smaller_and_that_is_said() -> None:
    part, near = contour(rectangle(0.02, 0.02)), contour(rectangle(0.02, 0.04, at=(0.0215, -0.01)), number=2)
    found = looped(part, near)
    assert len(loops(found)) == 4
    radii = [1.0 / np.abs(curves.curvatures(loop)).max() for loop in loops(found)]
    assert min(radii) == pytest.approx(1e-3 * 0.8**2)
    (finding,) = found.findings
    assert finding.what.startswith("the loops at 2 corners are smaller than the feed needs, down to 64 % of the radius")
    assert finding.kind == "loop"
    assert line(whole(found.way)).distance(line(opened(near.curve))) > KERF / 2 - 1e-6


@settings(max_examples=80)
@given(star_curves(low=2e-3, high=6e-3, arcs=False), st.floats(0.0, 2.0 * math.pi), st.floats(1e-4, 4e-4))
def test_no_loop_cuts_into_a_neighbour(curve: Curve, heading: float, kerf: float) -> None:
    ring = shapely.LinearRing(curve.points)
    assume(ring.is_simple and curves.signed_area(curve) > 1e-6)
    part = contour(rectangle(8e-3, 8e-3))
    shift = 12e-3 * np.array([math.cos(heading), math.sin(heading)]) + 4e-3
    near = contour(curves.transform(curve, shift=(float(shift[0]), float(shift[1]))), number=2)
    edge = line(opened(near.curve))
    assume(edge.distance(shapely.box(0.0, 0.0, 8e-3, 8e-3)) > kerf)
    found = looped(part, near, kerf=kerf)
    assert line(whole(found.way)).distance(edge) > kerf / 2 - 4e-6
    assert len(loops(found)) == 4 or "does not fit" in found.findings[0].what


def test_a_part_beside_the_way_out_of_a_spike_keeps_it_round() -> None:
    tip = np.radians(15.0)
    run_out = 1e-4 * np.tan(np.radians(75.0))
    spike = contour(
        curves.polygon(0.02 * np.array([[0, 0], [-np.cos(tip), np.sin(tip)], [-np.cos(tip), -np.sin(tip)]]))
    )
    along, up = np.array([np.cos(tip), np.sin(tip)]), np.array([-np.sin(tip), np.cos(tip)])
    beside = 1e-4 * np.array([np.sin(tip), -np.cos(tip)]) + 0.5 * run_out * along - 0.9e-4 * up
    needle = curves.polygon(beside + np.array([[0.0, 0.0], [-1e-4, -5e-3], [1e-4, -5e-3]]))
    assert len(loops(looped(spike))) == 3
    found = looped(spike, contour(needle, number=2))
    assert len(loops(found)) == 2
    assert "at 1 corner, kept round" in found.findings[0].what


def test_where_no_loop_fits_the_corner_stays_round_and_that_is_said() -> None:
    part, near = contour(rectangle(0.02, 0.02)), contour(rectangle(0.02, 0.04, at=(0.0204, -0.01)), number=2)
    found = looped(part, near)
    assert len(loops(found)) == 2
    assert line(whole(found.way)).distance(line(opened(near.curve))) > KERF / 2
    (finding,) = found.findings
    assert finding.what.startswith("a loop does not fit at 2 corners, kept round: (20.1")
    assert finding.place is not None


def test_a_loop_never_goes_around_a_part() -> None:
    small = contour(curves.circle(np.array([0.025, 0.025]), 1e-3), number=2)
    part = contour(rectangle(0.02, 0.02))
    (*_, last) = looped(part, radius=6e-3).way
    assert last.kind is BlockKind.CUT
    for loop in loops(looped(part, small, radius=6e-3)):
        area = shapely.Polygon(curves.flatten(loop, 1e-6)[0]).buffer(0)
        assert area.distance(shapely.Point(0.025, 0.025)) > 1e-3


def test_loops_stay_in_the_room_that_is_given() -> None:
    room = shapely.box(-0.005, -0.005, 0.0211, 0.025)
    found = looped(contour(rectangle(0.02, 0.02)), room=room)
    assert room.covers(line(whole(found.way)))
    assert len(loops(found)) == 4
    assert len(found.findings) == 1


def test_a_spike_keeps_its_round() -> None:
    spike = curves.polygon(np.array([[0.0, 0.0], [0.03, 1e-3], [0.0, 2e-3]]))
    found = looped(contour(spike))
    assert len(loops(found)) == 2
    assert "does not fit at 1 corner" in found.findings[0].what


def test_a_given_radius_counts_before_the_one_that_the_feed_needs() -> None:
    found = looped(contour(rectangle(0.02, 0.02)), rule=Loops(radius=2e-3))
    assert np.abs(curves.curvatures(loops(found)[0])).max() == pytest.approx(500.0)


@pytest.mark.parametrize("distance", [0.0, 5e-5])
def test_a_corner_where_the_cut_begins_gets_none_and_that_is_said(distance: float) -> None:
    part = contour(rectangle(0.02, 0.02))
    (cut,) = offset([part], kerf=KERF).cuts
    round_at = int(np.flatnonzero(cut.curve.bulges)[0])
    begun = opened(curves.start_at(cut.curve, round_at, distance))
    way = (Stretch(BlockKind.CUT, begun),)
    found = with_loops(
        way, part, side="right", kerf=KERF, rule=SHARP, needed=lambda _: 1e-3, waste=Waste([part], kerf=KERF)
    )
    assert len(loops(found)) == 3
    (finding,) = found.findings
    assert finding.what.startswith("no loop at a corner where the cut begins: (")


def test_all_other_stretches_stay_as_they_are() -> None:
    part = contour(rectangle(0.02, 0.02))
    (cut,) = offset([part], kerf=KERF).cuts
    curve = from_longest(cut.curve)
    lead = Curve(points=np.array([curve.points[0] - [0.0, 1e-3], curve.points[0]]), bulges=np.zeros(1), closed=False)
    way = (Stretch(BlockKind.LEAD_IN, lead), Stretch(BlockKind.CUT, curve))
    found = with_loops(
        way, part, side="right", kerf=KERF, rule=SHARP, needed=lambda _: 1e-3, waste=Waste([part], kerf=KERF)
    )
    assert found.way[0] is way[0]
    assert len(found.way) == 10
    assert with_loops(
        way[:1], part, side="right", kerf=KERF, rule=SHARP, needed=_never, waste=Waste([part], kerf=KERF)
    ) == (way[:1], ())


def _never(_: Array) -> float:
    raise AssertionError
