"""Leads on contours of all kinds: they touch what they should, keep away from every part, and close the way."""

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from deltacam.cutting import kerf
from deltacam.cutting.leads.approaches import approaches, begun
from deltacam.cutting.leads.sizes import Ability
from deltacam.cutting.waste import Waste
from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Contour, Curve, Cut, Finding, Lead, Operation, Process, StartRule
from tests.strategies import contour, rectangle, slot, star_curves

KERF = 0.2e-3
TICK = 2.5e-3
ORDER = [BlockKind.LEAD_IN, BlockKind.CUT, BlockKind.OVERCUT, BlockKind.LEAD_OUT]
PROCESS = Process(
    name="a trial",
    source="",
    material="",
    thickness=1e-3,
    kerf=KERF,
    feed=0.1,
    power=1.0,
    pierce_time=0.05,
    lead_in=Lead("arc"),
    lead_out=Lead("arc"),
    overcut=0.3e-3,
)
SHAPES = st.sampled_from(["line", "arc", "line+arc"])


def able(points: Array) -> Ability:
    return Ability(np.full(len(points), 15.0), np.full(len(points), 1000.0))


def led(contours: list[Contour], process: Process = PROCESS) -> tuple[list[list[Cut]], tuple[Finding, ...]]:
    """Every cut in all the ways in which it may begin."""
    cuts = kerf.offset(contours, kerf=process.kerf).cuts
    waste = Waste(contours, kerf=process.kerf)
    found, findings = approaches(cuts, contours, process=process, waste=waste, able=able, tick=TICK)
    ways = [
        [begun(cut, choice, process=process, tick=TICK) for choice in choices]
        for cut, choices in zip(cuts, found, strict=True)
    ]
    return ways, findings


def line(curve: Curve) -> shapely.LineString:
    return shapely.LineString(curves.flatten(curve, 1e-7)[0])


def in_a_plate(hole: Curve) -> list[Contour]:
    return [contour(rectangle(0.1, 0.1, at=(-0.05, -0.05)), number=1), contour(hole, number=2, depth=1, parent=1)]


@settings(max_examples=40, deadline=None)
@given(star_curves(low=2e-3), st.booleans(), SHAPES, st.floats(0.02, 0.3), st.sampled_from(["best", "edge", "corner"]))
def test_no_lead_comes_nearer_than_half_a_kerf_to_a_part(
    curve: Curve, hole: bool, shape: str, feed: float, start: StartRule
) -> None:
    process = replace(PROCESS, lead_in=Lead(shape), lead_out=Lead(shape), feed=feed, start=start)
    contours = in_a_plate(curve) if hole else [contour(curve)]
    own = shapely.Polygon(curves.flatten(contours[-1].curve, 1e-7)[0])
    part = shapely.Polygon(contours[0].curve.points).difference(own) if hole else own
    for cut in (cut for ways in led(contours, process)[0] for cut in ways if cut.contour == contours[-1].number):
        for stretch in cut.way:
            if stretch.kind in (BlockKind.LEAD_IN, BlockKind.LEAD_OUT):
                assert line(stretch.curve).distance(part) > KERF / 2.0 - 5e-6


@settings(max_examples=40, deadline=None)
@given(star_curves(low=2e-3), SHAPES)
def test_the_way_is_one_line_in_order_and_goes_around_once(curve: Curve, shape: str) -> None:
    for cut in led([contour(curve)], replace(PROCESS, lead_in=Lead(shape), lead_out=Lead(shape)))[0][0]:
        kinds = [stretch.kind for stretch in cut.way]
        assert kinds == [kind for kind in ORDER if kind in kinds]
        for before, behind in zip(cut.way, cut.way[1:], strict=False):
            assert before.curve.points[-1] == pytest.approx(behind.curve.points[0], abs=1e-9)
        around = next(stretch.curve for stretch in cut.way if stretch.kind is BlockKind.CUT)
        assert around.points[0] == pytest.approx(around.points[-1], abs=1e-12)
        assert curves.length(around) == pytest.approx(curves.length(cut.curve))


@settings(max_examples=40, deadline=None)
@given(star_curves(), st.sampled_from(["arc", "line+arc"]))
def test_arcs_touch_the_contour(curve: Curve, shape: str) -> None:
    for cut in led([contour(curve)], replace(PROCESS, lead_in=Lead(shape), lead_out=Lead(shape)))[0][0]:
        way = {stretch.kind: stretch.curve for stretch in cut.way}
        for before, behind in ((BlockKind.LEAD_IN, BlockKind.CUT), (BlockKind.OVERCUT, BlockKind.LEAD_OUT)):
            if before in way and behind in way:
                joint = curves.headings(way[before])[1][-1] - curves.headings(way[behind])[0][0]
                assert np.cos(joint) == pytest.approx(1.0, abs=1e-9)


@pytest.mark.parametrize("angle", [30.0, 60.0, 90.0])
def test_a_line_meets_the_edge_at_its_angle(angle: float) -> None:
    process = replace(PROCESS, lead_in=Lead("line", length=2e-3, angle=np.radians(angle)), start="edge")
    (cut,) = led([contour(rectangle(0.03, 0.02))], process)[0][0]
    lead, around = cut.way[0].curve, cut.way[1].curve
    turn = curves.headings(around)[0][0] - curves.headings(lead)[1][-1]
    assert np.degrees(np.arccos(np.cos(turn))) == pytest.approx(angle)
    assert curves.length(lead) == pytest.approx(2e-3)


def test_the_edge_rule_begins_in_the_middle_of_the_longest_edge() -> None:
    (cut,) = led([contour(rectangle(0.03, 0.02))], replace(PROCESS, start="edge"))[0][0]
    assert cut.curve.points[0][0] == pytest.approx(0.015)


def test_the_corner_rule_begins_at_a_corner() -> None:
    for cut in led([contour(rectangle(0.03, 0.02))], replace(PROCESS, start="corner", lead_in=Lead("line")))[0][0]:
        x, y = cut.curve.points[0]
        assert min(abs(x), abs(x - 0.03)) + min(abs(y), abs(y - 0.02)) <= KERF


def test_the_overcut_goes_on_along_the_beginning_and_is_longer_by_a_tick() -> None:
    for cut in led([contour(slot(0.02, 0.01))])[0][0]:
        way = {stretch.kind: stretch.curve for stretch in cut.way}
        beyond = way[BlockKind.OVERCUT]
        assert curves.length(beyond) == pytest.approx(PROCESS.overcut + PROCESS.feed * TICK)
        assert line(way[BlockKind.CUT]).hausdorff_distance(line(cut.curve)) < 1.0
        assert shapely.distance(shapely.points(beyond.points), line(way[BlockKind.CUT])).max() < 1e-6


def test_a_tiny_hole_is_pierced_inside_of_it() -> None:
    ways, _ = led(in_a_plate(curves.circle(np.zeros(2), 0.4e-3)))
    assert ways[1]
    for cut in ways[1]:
        assert np.hypot(*cut.way[0].curve.points[0]) < 0.3e-3 - 0.02e-3


def test_where_there_is_no_room_at_all_the_contour_is_pierced_and_that_is_said() -> None:
    # A frame of waste around a part that is hardly wider than the beam.
    contours = [
        contour(rectangle(0.04, 0.04, at=(-0.02, -0.02)), number=1),
        contour(rectangle(0.02, 0.02, at=(-0.01, -0.01)), number=2, depth=1, parent=1),
        contour(rectangle(0.0196, 0.0196, at=(-0.0098, -0.0098)), number=3, depth=2, parent=2),
    ]
    ways, findings = led(contours, replace(PROCESS, lead_in=Lead("line"), lead_out=Lead("line")))
    assert all(cut.way[0].kind is BlockKind.CUT for cut in ways[2])
    assert any("pierced on the contour" in finding.what and "contour 3" in finding.what for finding in findings)


def test_a_full_lead_elsewhere_is_better_than_a_short_one() -> None:
    # Another part lies beside the left edge, which is the longest.
    near = contour(rectangle(0.01, 0.06, at=(-0.0104, -0.01)), number=2)
    ways, findings = led([contour(rectangle(0.03, 0.04), number=1), near])
    assert findings == ()
    assert all(cut.curve.points[0][0] > 1e-3 for cut in ways[0])


def test_leads_stay_where_the_robot_may_go() -> None:
    contours = [contour(rectangle(0.03, 0.02))]
    cuts = kerf.offset(contours, kerf=KERF).cuts
    waste = Waste(contours, kerf=KERF, room=shapely.box(-1.0, -0.2e-3, 1.0, 1.0))
    found, _ = approaches(cuts, contours, process=PROCESS, waste=waste, able=able, tick=TICK)
    for choice in found[0]:
        assert choice.lead_in is not None
        assert curves.bounds(choice.lead_in)[1] > -0.2e-3


def test_what_is_open_or_engraved_has_no_leads() -> None:
    engraved = replace(contour(rectangle(0.03, 0.02)), operation=Operation.ENGRAVE)
    ways, findings = led([engraved])
    assert ways == [[]]
    assert findings == ()


def test_a_slower_cut_has_shorter_leads() -> None:
    contours = [contour(rectangle(0.03, 0.02))]
    (cut,) = kerf.offset(contours, kerf=KERF).cuts
    lengths = []
    for feed in (0.05, 0.2):
        own = replace(cut, feed=feed)
        waste = Waste(contours, kerf=KERF)
        found, _ = approaches([own], contours, process=PROCESS, waste=waste, able=able, tick=TICK)
        lead = found[0][0].lead_in
        assert lead is not None
        lengths.append(curves.length(lead))
    assert lengths[0] < 0.5 * lengths[1]
