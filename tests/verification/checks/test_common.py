"""Programs in which one cut serves the edges of two outlines: the planned ones pass, and every fault is found."""

from dataclasses import replace
from functools import lru_cache
from typing import Any

import numpy as np
import pytest

from deltacam.errors import DeltacamError
from deltacam.model import BlockKind, Lead, Process, Report, Search, Slower, Tabs
from deltacam.pipeline import Planned, plan
from deltacam.robot.reader import load_robot
from deltacam.verification.checks.table import OF_COMMON_EDGES
from deltacam.verification.verify import COMMON_EDGE_CHECKS, verify
from tests.damage import in_common
from tests.sheets import Box, drawn, rows

PROCESS = Process(
    name="test steel",
    source="",
    material="steel",
    thickness=1e-3,
    kerf=0.15e-3,
    feed=0.2,
    power=0.85,
    pierce_time=0.02,
    common_edges=True,
)
ROBOT = replace(load_robot("delta-300"), joints=replace(load_robot("delta-300").joints, max_jerk=None))

GRID = tuple(rows(3, 3))
HOLES = tuple((x + 3.0, y + 3.0, 1.5) for x, y, _, _ in GRID)
BETWEEN: tuple[Box, ...] = ((0.0, 0.0, 14.0, 9.0), (14.15, 0.0, 10.0, 9.0), (24.3, 0.0, 14.0, 9.0))
"""A narrow plate between two wide ones: two cuts are left of it, above and below."""


@lru_cache
def planned(boxes: tuple[Box, ...] = GRID, holes: tuple[Box, ...] = (), **changes: Any) -> Planned:
    options = {key: changes.pop(key) for key in ("search", "from_contour", "rotation") if key in changes}
    process = replace(PROCESS, **changes)
    return plan("nested.dxf", data=drawn(boxes, holes), robot=ROBOT, process=process, jobs=1, what_if=False, **options)


def failed(report: Report) -> set[str]:
    return {check.name for check in report.checks if not check.passed}


def cut_length(found: Planned) -> float:
    return float(found.report.summary["cut_length_mm"])


def order_of(found: Planned) -> list[int]:
    cuts = [one.contour for one in found.program.blocks if one.kind is BlockKind.CUT and one.contour is not None]
    return list(dict.fromkeys(cuts))


def test_of_a_grid_of_plates_every_common_edge_is_cut_once() -> None:
    found, usual = planned(GRID, HOLES), planned(GRID, HOLES, common_edges=False)
    assert failed(found.report) == failed(usual.report) == set()
    shared = 6 * 9.0 + 6 * 12.0
    rounds = 4 * np.pi / 4.0 * 0.15  # about the corners where four plates meet, of which nothing is needed
    assert cut_length(usual) - cut_length(found) == pytest.approx(shared + rounds, abs=0.1)
    assert found.program.duration < usual.program.duration
    assert any(f"{shared:.1f} mm of common edges are cut once" in one.what for one in found.report.findings)
    assert len({one.name for one in found.report.checks} - {one.name for one in usual.report.checks}) == 2


def test_what_is_left_of_a_plate_is_cut_after_those_that_it_shares_an_edge_with() -> None:
    order = order_of(planned())
    assert sorted(order) == list(range(1, 10))
    for number in range(1, 10):
        if number % 3 != 1:
            assert order.index(number - 1) < order.index(number)
        if number > 3:
            assert order.index(number - 3) < order.index(number)


LEADS = {"lead_in": Lead("line+arc"), "lead_out": Lead("line", 1e-3), "overcut": 0.3e-3}


@pytest.mark.parametrize(
    ("boxes", "changes"),
    [
        (GRID, LEADS),
        (BETWEEN, {"start": "edge"}),
        (tuple(rows(2, 2)), {"corner": "loop"}),
        (BETWEEN, {"passes": 2}),
        (BETWEEN, {"passes": 3, "slower": (Slower(0.5, radius=1e-3),), **LEADS}),
        (BETWEEN, {"tabs": Tabs(0.5e-3, count=2, corner=1e-3)}),
        (BETWEEN, {"pre_pierce": True, "rotation": 0.5}),
        (GRID, {"search": Search(together=True)}),
        (tuple(rows(4, 1)), {}),
        (tuple(rows(1, 4)), {}),
        (tuple(rows(2, 2, gap=0.158)), {}),
        (tuple(rows(2, 2, gap=0.148)), {}),
    ],
)
def test_other_ways_to_do_it_pass(boxes: tuple[Box, ...], changes: dict[str, Any]) -> None:
    found = planned(boxes, **changes)
    assert failed(found.report) == set()
    assert any("of common edges are cut once" in one.what for one in found.report.findings)


def test_a_tab_is_never_on_a_shared_edge() -> None:
    found = planned(BETWEEN, tabs=Tabs(0.5e-3, count=3, corner=1e-3))
    assert failed(found.report) == set()
    tool = found.program.robot.forward(found.program.q)[:, 0]
    middle = found.program.placement.x + 19.15e-3
    tabs = [one for one in found.program.blocks if one.kind is BlockKind.TAB]
    assert len(tabs) == 6
    assert all(abs(float(tool[one.first]) - middle) > 5.5e-3 for one in tabs)
    assert any("without leads, loops and tabs" in one.what for one in found.report.findings)


def test_a_closed_cut_begins_off_the_edge_that_it_shares_even_where_that_is_the_longest() -> None:
    found = planned(((0.0, 0.0, 9.0, 12.0), (9.15, 0.0, 9.0, 12.0)), start="edge")
    assert failed(found.report) == set()
    pierce = next(one for one in found.program.blocks if one.kind is BlockKind.PIERCE)
    x = found.program.robot.forward(found.program.q[[pierce.first]])[0, 0] - found.program.placement.x
    assert pierce.contour == 1
    assert abs(x - 9.075e-3) > 0.3e-3


def test_a_program_that_goes_on_after_a_stop_relies_on_what_was_cut_before() -> None:
    order = order_of(planned())
    found = planned(from_contour=order[5])
    assert failed(found.report) == set()
    assert order_of(found) == order[5:]


FAULTS: dict[str, tuple[in_common.Damage, set[str]]] = {
    "left out": (in_common.left_out, {"uncut length", "parts come free", "part size", "part edge"}),
    "cut before the edges that it shares": (in_common.made_first, {"shared edges first"}),
    "cut twice": (in_common.made_again, {"material cut twice"}),
    "begun late": (in_common.begun_late, {"gap at the end of a cut", "uncut length", "parts come free"}),
    "ended early": (in_common.ended_early, {"gap at the end of a cut", "uncut length", "parts come free"}),
    "back at its end": (in_common.partly_back, {"cut length"}),
    "not asked for": (in_common.not_asked_for, {"every contour cut once", "uncut length", "gap at the end of a cut"}),
}
"""What happens to one of the two cuts that are left of the plate between, and the checks that find it."""


@pytest.mark.parametrize("fault", FAULTS)
def test_a_fault_is_found_by_its_checks(fault: str) -> None:
    found = planned(BETWEEN)
    damage, names = FAULTS[fault]
    assert names <= failed(verify(damage(found.program, 2), drawing=found.drawing))


def test_a_cut_made_too_early_is_found_by_nothing_else() -> None:
    found = planned(BETWEEN)
    assert failed(verify(in_common.made_first(found.program, 2), drawing=found.drawing)) == {"shared edges first"}


def test_without_the_cut_that_serves_both_neither_is_free() -> None:
    found = planned(BETWEEN)
    report = verify(in_common.left_out(found.program, 1), drawing=found.drawing)
    assert {"every contour cut once", "uncut length", "parts come free"} <= failed(report)


def test_a_bridge_in_a_shared_edge_holds_the_plate_that_has_no_other() -> None:
    found = planned(BETWEEN)
    where = found.program.placement
    changed = in_common.bridged(found.program, 1, (where.x + 14.075e-3, where.y + 5e-3))
    assert {"uncut length", "parts come free"} <= failed(verify(changed, drawing=found.drawing))


def test_an_edge_that_serves_two_is_cut_once_all_the_same() -> None:
    found = planned(BETWEEN)
    where = found.program.placement
    again = in_common.made_partly_again(found.program, 1, (where.x + 14.075e-3, where.y + 4.5e-3))
    check = next(one for one in verify(again, drawing=found.drawing).checks if one.name == "material cut twice")
    assert not check.passed
    assert check.worst == pytest.approx(8.0, abs=1.5)


def test_the_last_cut_of_a_plate_left_out_is_found_in_a_grid() -> None:
    found = planned(GRID, HOLES)
    last = order_of(found)[-1]
    report = verify(in_common.left_out(found.program, last), drawing=found.drawing)
    assert "every contour cut once" in failed(report)
    assert "uncut length" in failed(report)


def test_the_checks_are_there_only_where_they_are_asked_for() -> None:
    names = set(COMMON_EDGE_CHECKS)
    with_them = {one.name for one in planned(BETWEEN).report.checks}
    without = {one.name for one in planned(BETWEEN, common_edges=False).report.checks}
    assert len(OF_COMMON_EDGES) == len(names)
    assert with_them - without == names
    (unchecked,) = verify(planned(BETWEEN).program, drawing=None).findings
    assert all(name in unchecked.what for name in names)


def test_where_nothing_is_shared_the_rows_are_those_of_today() -> None:
    boxes = tuple(rows(2, 2, gap=1.0))
    asked, not_asked = planned(boxes), planned(boxes, common_edges=False)
    np.testing.assert_array_equal(asked.program.q, not_asked.program.q)
    np.testing.assert_array_equal(asked.program.power, not_asked.program.power)
    assert asked.program.blocks == not_asked.program.blocks


def test_plates_nearer_than_a_kerf_are_refused_with_what_to_do() -> None:
    with pytest.raises(DeltacamError) as refused:
        planned(tuple(rows(2, 1, gap=0.1)))
    assert "--common-edges" in refused.value.hint
