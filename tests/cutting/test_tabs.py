"""Tabs, against what is left of a sheet when the kerf has been swept along the way."""

import math
from itertools import pairwise

import numpy as np
import pytest
import shapely
from hypothesis import assume, given, settings
from hypothesis import strategies as st

from deltacam.cutting.kerf import offset
from deltacam.cutting.loops import with_loops
from deltacam.cutting.tabs import Tabbed, with_tabs
from deltacam.cutting.waste import Waste
from deltacam.geometry import curve as curves
from deltacam.model import BlockKind, Contour, Curve, Loops, Stretch, Tabs
from tests.strategies import contour, rectangle, slot, star_curves

KERF = 2e-4
FOUR = Tabs(width=5e-4, count=4)


def begun(curve: Curve, share: float = 0.5) -> Curve:
    """A closed curve, begun on its longest segment and opened."""
    lengths = curves.lengths(curve)
    longest = int(np.argmax(lengths))
    return curves.opened(curves.start_at(curve, longest, share * float(lengths[longest])))


def line(curve: Curve) -> shapely.LineString:
    return shapely.LineString(curves.flatten(curve, 1e-7)[0])


def tree(*others: Curve) -> shapely.STRtree:
    return shapely.STRtree([line(other) for other in others])


def tabbed(part: Contour, rule: Tabs, *, kerf: float = KERF, others: shapely.STRtree | None = None) -> Tabbed:
    (cut,) = offset([part], kerf=kerf).cuts
    way = (Stretch(BlockKind.CUT, begun(cut.curve)),)
    side = "left" if part.is_hole else "right"
    return with_tabs(way, part, side=side, kerf=kerf, rule=rule, others=others or tree())  # type: ignore[arg-type]


def tabs(found: Tabbed) -> list[Curve]:
    return [stretch.curve for stretch in found.way if stretch.kind is BlockKind.TAB]


def middles(found: Tabbed) -> list[tuple[float, float]]:
    return [tuple(np.mean([tab.points[0], tab.points[-1]], axis=0).tolist()) for tab in tabs(found)]


def swept(found: Tabbed, kerf: float) -> shapely.Geometry:
    """What the beam takes away."""
    lit = [line(stretch.curve) for stretch in found.way if stretch.kind not in (BlockKind.TAB, BlockKind.LEAD_OUT)]
    return shapely.union_all(shapely.buffer(lit, kerf / 2, quad_segs=64))


def pieces(sheet: shapely.Geometry) -> int:
    return sum(piece.area > 1e-7 for piece in shapely.get_parts(sheet))


@pytest.mark.parametrize("count", [1, 2, 3, 4, 7])
def test_a_circle_gets_its_tabs_at_even_distances(count: int) -> None:
    part = contour(curves.circle(np.zeros(2), 0.02))
    found = tabbed(part, Tabs(width=5e-4, count=count))
    assert found.findings == ()
    kinds = [BlockKind.CUT, *[BlockKind.TAB, BlockKind.CUT] * count]
    assert [stretch.kind for stretch in found.way] == kinds
    angles = np.sort([math.atan2(y, x) for x, y in middles(found)])
    between = np.diff(angles, append=angles[0] + 2.0 * math.pi)
    assert between == pytest.approx(2.0 * math.pi / count)


def test_the_gap_is_the_width_and_the_kerf_from_end_to_end() -> None:
    for part in (contour(curves.circle(np.zeros(2), 0.005)), contour(rectangle(0.03, 0.02))):
        for tab in tabs(tabbed(part, FOUR)):
            assert np.hypot(*(tab.points[-1] - tab.points[0])) == pytest.approx(7e-4, abs=1e-12)


@settings(max_examples=60)
@given(star_curves(low=8e-3), st.floats(0.0, 5e-4), st.floats(1e-4, 8e-4), st.integers(1, 5), st.booleans())
def test_the_bridges_are_exactly_as_wide_as_asked_for(
    curve: Curve, kerf: float, width: float, count: int, hole: bool
) -> None:
    ring = shapely.LinearRing(curves.flatten(curve, 1e-7)[0])
    assume(ring.is_simple and curves.signed_area(curve) > 1e-6 and kerf > 1e-5)
    part = contour(curve, depth=int(hole))
    assume(shapely.Polygon(ring).buffer(-3 * kerf).geom_type == "Polygon")
    assume(len(offset([part], kerf=kerf).cuts) == 1)
    found = tabbed(part, Tabs(width=width, count=count, corner=5e-4, holes=True), kerf=kerf)
    assume(tabs(found))
    whole = shapely.box(*ring.bounds).buffer(0.01)
    cut = swept(found, kerf)
    for x, y in middles(found):
        near = shapely.Point(x, y).buffer(1.2 * (width + kerf) / 2 + kerf)
        around = cut.intersection(near)
        sides = sorted(shapely.get_parts(around), key=lambda piece: -piece.area)[:2]
        assert len(sides) == 2
        assert sides[0].distance(sides[1]) == pytest.approx(width, abs=2e-6)
    # A bridge stands when all but half its width has been taken from its sides, and none stands after that.
    assert pieces(whole.difference(cut.buffer(width / 2 + 4e-6))) > pieces(
        whole.difference(cut.buffer(width / 2 - 4e-6))
    )


@settings(max_examples=80)
@given(star_curves(), st.integers(1, 8), st.floats(0.0, 3e-3))
def test_tabs_keep_clear_of_corners_of_the_beginning_and_of_each_other(curve: Curve, count: int, corner: float) -> None:
    ring = shapely.LinearRing(curves.flatten(curve, 1e-7)[0])
    assume(ring.is_simple and curves.signed_area(curve) > 1e-6)
    part = contour(curve)
    assume(len(offset([part], kerf=KERF).cuts) == 1)
    found = tabbed(part, Tabs(width=4e-4, count=count, corner=corner))
    path = curves.chain([stretch.curve for stretch in found.way])
    turns, length = curves.corner_angles(part.curve), curves.length(path)
    travelled = np.concatenate([[0.0], np.cumsum(curves.lengths(path))])
    spans, at = [], 0.0
    for stretch in found.way:
        spans.append((stretch.kind, at, at + curves.length(stretch.curve)))
        at = spans[-1][2]
    gaps = [(begin, end) for kind, begin, end in spans if kind is BlockKind.TAB]
    assert len(gaps) <= count
    assert (len(gaps) < count) == bool(found.findings)
    for begin, end in gaps:
        assert begin >= corner
        assert end <= length - corner
        round_the_corner = np.abs(curves.curvatures(path)) > 1.0 / (KERF * 0.51)
        for first, last in zip(travelled[:-1][round_the_corner], travelled[1:][round_the_corner], strict=True):
            if (last - first) / (KERF / 2) > math.radians(10.1):
                assert last <= begin - corner + 1e-9 or first >= end + corner - 1e-9
    for tip in part.curve.points[np.abs(turns) > math.radians(10.1)]:
        for tab in tabs(found):
            assert line(tab).distance(shapely.Point(tip)) > min(corner, 4e-4) * 0.05
    for (_, end), (begin, _) in pairwise(gaps):
        assert begin - end > 5e-4


def test_a_rectangle_gets_its_tabs_in_the_straight_and_away_from_the_beginning() -> None:
    found = tabbed(contour(rectangle(0.04, 0.02)), Tabs(width=5e-4, count=4, corner=3e-3))
    assert len(tabs(found)) == 4
    for x, y in middles(found):
        side = min(abs(x + 1e-4), abs(x - 0.0401), abs(y + 1e-4), abs(y - 0.0201))
        assert side == pytest.approx(0.0, abs=1e-9)
        corner = min(math.hypot(x - a, y - b) for a in (0.0, 0.04) for b in (0.0, 0.02))
        assert corner > 3.3e-3


def test_a_spacing_is_kept_though_corners_push_tabs_apart() -> None:
    rule = Tabs(width=5e-4, spacing=0.02)
    found = tabbed(contour(rectangle(0.05, 0.03)), rule)
    assert found.findings == ()
    path = curves.chain([stretch.curve for stretch in found.way])
    places = [curves.nearest(path, np.array(middle)) for middle in middles(found)]
    reach = np.concatenate([[0.0], np.cumsum(curves.lengths(path))])
    along = np.array([reach[segment] + distance for segment, distance, _ in places])
    assert np.diff(along, append=along[0] + reach[-1]).max() <= 0.02 + 1e-9
    assert len(along) <= 11


def test_a_spacing_that_no_places_allow_is_said() -> None:
    found = tabbed(contour(rectangle(0.05, 0.03)), Tabs(width=5e-4, spacing=0.01, corner=8e-3))
    (finding,) = found.findings
    assert "tabs of 0.5 mm" in finding.what


@pytest.mark.parametrize("size", [1e-3, 3e-3])
def test_an_outline_without_room_gets_none_and_that_is_said(size: float) -> None:
    found = tabbed(contour(rectangle(size, size)), FOUR)
    assert [stretch.kind for stretch in found.way] == [BlockKind.CUT]
    (finding,) = found.findings
    assert finding.what == "4 tabs of 0.5 mm asked for, none fits"
    assert (finding.kind, finding.where) == ("tab", "contour 1 (layer CUT, #1)")


def test_an_outline_with_less_room_gets_fewer() -> None:
    found = tabbed(contour(rectangle(0.03, 1.5e-3)), Tabs(width=5e-4, count=60, corner=3e-3))
    assert 10 < len(tabs(found)) < 60
    assert found.findings[0].what == f"60 tabs of 0.5 mm asked for, only {len(tabs(found))} fit"


def test_holes_get_tabs_only_where_the_rule_says_so() -> None:
    hole = contour(rectangle(0.03, 0.03), depth=1)
    assert tabs(tabbed(hole, FOUR)) == []
    assert tabbed(hole, FOUR).findings == ()
    assert len(tabs(tabbed(hole, Tabs(width=5e-4, count=4, holes=True)))) == 4


def test_small_round_ends_get_none() -> None:
    for x, _ in middles(tabbed(contour(slot(0.03, 2e-3)), Tabs(width=5e-4, count=6, corner=1e-3))):
        assert abs(x) < 0.015 - 1e-3


def test_there_is_no_tab_where_another_cut_leaves_nothing_to_hold_on_to() -> None:
    part = contour(rectangle(0.03, 0.03))
    beside = curves.polygon(np.array([[0.0304, -0.01], [0.05, -0.01], [0.05, 0.05], [0.0304, 0.05]]))
    rule = Tabs(width=5e-4, count=8)
    assert any(x > 0.03 for x, _ in middles(tabbed(part, rule)))
    found = tabbed(part, rule, others=tree(curves.opened(beside)))
    assert not any(x > 0.03 for x, _ in middles(found))
    assert len(tabs(found)) < 8
    far = curves.transform(beside, shift=(5e-4, 0.0))
    assert middles(tabbed(part, rule, others=tree(curves.opened(far)))) == middles(tabbed(part, rule))


def test_there_is_no_tab_in_a_narrow_bay_of_the_outline_itself() -> None:
    bay = np.array([[0, 0], [30, 0], [30, 14.6], [10, 14.6], [10, 15.4], [30, 15.4], [30, 30], [0, 30]]) * 1e-3
    for x, y in middles(tabbed(contour(curves.polygon(bay)), Tabs(width=5e-4, count=12))):
        assert not (0.01 < x < 0.0295 and 0.0142 < y < 0.0158)


def test_an_overcut_and_a_lead_burn_no_bridge_away() -> None:
    part = contour(curves.circle(np.zeros(2), 0.01))
    (cut,) = offset([part], kerf=KERF).cuts
    curve = begun(cut.curve)
    over = curves.part(curve, 0.0, 0.02)
    far = curve.points[0] * 1.2
    lead = Curve(points=np.array([far, curve.points[0]]), bulges=np.zeros(1), closed=False)
    way = (Stretch(BlockKind.LEAD_IN, lead), Stretch(BlockKind.CUT, curve), Stretch(BlockKind.OVERCUT, over))
    found = with_tabs(way, part, side="right", kerf=KERF, rule=FOUR, others=tree())
    assert len(tabs(found)) >= 3
    for tab in tabs(found):
        assert line(tab).distance(line(over)) >= KERF - 1e-6
    assert (found.way[0], found.way[-1]) == (way[0], way[-1])


def test_no_tab_is_on_an_edge_that_is_to_be_kept_clear() -> None:
    part = contour(rectangle(0.03, 0.03))
    (cut,) = offset([part], kerf=KERF).cuts
    way = (Stretch(BlockKind.CUT, begun(cut.curve)),)
    edge = Curve(points=np.array([[0.0301, 0.0], [0.0301, 0.02]]), bulges=np.zeros(1), closed=False)
    found = with_tabs(way, part, side="right", kerf=KERF, rule=FOUR, others=tree(), clear=[edge])
    assert len(tabs(found)) == 4
    assert all(x < 0.03 or y > 0.02 + KERF for x, y in middles(found))


def test_tabs_keep_clear_of_loops() -> None:
    part = contour(rectangle(0.03, 0.03))
    (cut,) = offset([part], kerf=KERF).cuts
    free = Waste([part], kerf=KERF)
    way = (Stretch(BlockKind.CUT, begun(cut.curve)),)
    looped = with_loops(way, part, side="right", kerf=KERF, rule=Loops(), needed=lambda _: 2e-3, waste=free).way
    found = with_tabs(looped, part, side="right", kerf=KERF, rule=FOUR, others=tree())
    assert len(tabs(found)) == 4
    assert len(found.way) == len(looped) + 8
    ends = [stretch.curve.points[-1] for stretch in found.way[:-1]]
    begins = [stretch.curve.points[0] for stretch in found.way[1:]]
    assert np.array(ends) == pytest.approx(np.array(begins), abs=1e-12)
