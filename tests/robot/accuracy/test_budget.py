"""The accuracy budget: closed form against machines that are drawn, its sums, and its inverse."""

from dataclasses import replace
from itertools import product

import numpy as np
import pytest

from deltacam.robot.accuracy.budget import Budget, budget, error_map
from deltacam.robot.accuracy.draws import draw, exact_errors, in_plane, usual
from deltacam.robot.accuracy.sensitivity import tool_by_error
from deltacam.robot.accuracy.sources import COUNT, PER_ARM, Errors, Source, columns_of
from deltacam.robot.accuracy.spread import AXES, corners, mean_squares
from deltacam.robot.accuracy.wanted import Needs, needs
from deltacam.robot.dimensions import Mount
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot

ROBOT = load_robot("delta-300")
LARGE = load_robot("irb360-1600")
NONE = Errors(**{source.value: 0.0 for source in Source})


@pytest.fixture(scope="module")
def found() -> Budget:
    return budget(ROBOT, Errors())


@pytest.fixture(scope="module")
def asked(found: Budget) -> Needs:
    return needs(ROBOT, found, wanted=50e-6)


@pytest.mark.parametrize("robot", [ROBOT, LARGE], ids=lambda robot: robot.name)
def test_the_closed_form_agrees_with_exact_machines_within_2_percent(robot: Robot) -> None:
    points, errors = robot.workspace.grid(3), Errors()
    off = exact_errors(robot.geometry, points, draw(20_000, 1) * errors.limits())
    for view, axes in AXES.items():
        exact = np.sqrt(np.square(off[:, :, axes]).sum(axis=2).mean(axis=0))
        closed = np.sqrt(mean_squares(tool_by_error(robot.geometry, points), errors.limits(), view).sum(axis=1))
        assert closed == pytest.approx(exact, rel=0.02)


def test_no_machine_is_beyond_the_bound_and_one_is_at_it(found: Budget) -> None:
    points, limits = ROBOT.workspace.grid(3), Errors().limits()
    by_error = tool_by_error(ROBOT.geometry, points)
    ends = corners(by_error, limits)
    for view, axes in AXES.items():
        bound = np.linalg.norm(ends[:, :, axes], axis=2).max(axis=0)
        signs = np.sign(np.random.default_rng(2).uniform(-1, 1, (20_000, COUNT)))
        moved = np.linalg.norm(np.einsum("nxk,dk->dnx", by_error * limits, signs)[:, :, axes], axis=2)
        assert (moved <= bound * (1 + 1e-12)).all()
        # The same by brute force: along every direction, the errors that move the tool that way.
        directions = np.random.default_rng(3).normal(size=(4000, axes.stop - axes.start))
        directions /= np.linalg.norm(directions, axis=1)[:, np.newaxis]
        along = np.abs(np.einsum("nxk,dx->dnk", (by_error * limits)[:, axes], directions)).sum(axis=2)
        assert along.max(axis=0) == pytest.approx(bound, rel=2e-3)
        assert found.total(view).bound[1] >= bound.max() * (1 - 1e-9)


def test_the_shares_of_the_sources_add_up_to_all(found: Budget) -> None:
    assert np.sum([one.share for one in found.contributions], axis=0) == pytest.approx([1.0, 1.0])


def test_the_worst_of_a_source_and_of_all_is_found_on_a_fine_grid(found: Budget) -> None:
    squares = mean_squares(tool_by_error(ROBOT.geometry, ROBOT.workspace.grid(101)), Errors().limits(), "in_plane")
    assert found.total("in_plane").rms[1] == pytest.approx(np.sqrt(squares.sum(axis=1).max()), rel=1e-4)
    for one in found.contributions:
        own = np.sqrt(squares[:, columns_of(one.source)].sum(axis=1).max())
        assert one.worst[0] == pytest.approx(own, rel=1e-4)


def test_the_sheets_height_is_an_error_of_the_focus_alone(found: Budget) -> None:
    sheet = found.contributions[-1]
    assert sheet.source is Source.SHEET
    assert sheet.worst == pytest.approx((0.0, 0.2e-3 / np.sqrt(3)))


def test_the_same_seed_gives_the_same_budget_and_another_seed_nearly(found: Budget) -> None:
    again, other = budget(ROBOT, Errors()), budget(ROBOT, Errors(), seed=7)
    assert again.totals[0].usual == found.totals[0].usual
    assert other.totals[0].usual != found.totals[0].usual
    assert other.totals[0].usual == pytest.approx(found.totals[0].usual, rel=0.04)


def test_a_machine_without_errors_has_none() -> None:
    nothing = budget(ROBOT, NONE, draws=50)
    assert all(max(*total.rms, *total.usual, *total.bound, total.joints) < 1e-12 for total in nothing.totals)
    assert needs(ROBOT, nothing, wanted=1e-5).factor is None


def test_a_machine_upside_down_errs_as_the_same_one_above_the_sheet() -> None:
    turned = replace(ROBOT.geometry, mount=Mount(upside_down=True))
    over = replace(ROBOT, geometry=turned, workspace=replace(ROBOT.workspace, sheet_z=-ROBOT.workspace.sheet_z))
    a, b = budget(ROBOT, Errors(), draws=10), budget(over, Errors(), draws=10)
    for one, other in zip(a.totals, b.totals, strict=True):
        assert other.rms == pytest.approx(one.rms, rel=1e-6)
        assert other.bound == pytest.approx(one.bound, rel=1e-6)


def test_the_map_is_the_error_at_every_place_and_empty_beside_the_sheet() -> None:
    x, y, fields = error_map(LARGE, Errors(), 11)
    for (row, column), view in product([(5, 5), (2, 6), (9, 4)], AXES):
        point = [[x[column], y[row], LARGE.workspace.sheet_z]]
        squares = mean_squares(tool_by_error(LARGE.geometry, point), Errors().limits(), view)
        assert fields[view][row, column] == pytest.approx(np.sqrt(squares.sum()))
    assert np.isnan(fields["in_plane"][0, 0])


def reached(errors: Errors, found: Budget) -> float:
    """What 95 % of exact machines with these errors stay within at the worst place."""
    machines = draw(found.draws, found.seed) * errors.limits()
    return float(usual(in_plane(exact_errors(ROBOT.geometry, found.places, machines))).max())


@pytest.mark.parametrize("source", PER_ARM, ids=lambda source: source.value)
def test_a_source_alone_may_be_as_large_as_it_says(source: Source, found: Budget, asked: Needs) -> None:
    need = asked.needs[PER_ARM.index(source)]
    assert reached(replace(NONE, **{source.value: need.alone}), found) == pytest.approx(50e-6, rel=2e-3)


@pytest.mark.parametrize("way", ["scaled", "equal"])
def test_all_sources_together_give_the_wanted_accuracy(way: str, found: Budget, asked: Needs) -> None:
    errors = Errors(**{need.source.value: getattr(need, way) for need in asked.needs}, sheet=0.0)
    assert reached(errors, found) == pytest.approx(50e-6, rel=2e-3)


def test_equal_parts_do_the_same_at_the_tool(found: Budget, asked: Needs) -> None:
    each = [reached(replace(NONE, **{need.source.value: need.equal}), found) for need in asked.needs]
    assert each == pytest.approx([each[0]] * len(each), rel=2e-3)


def test_a_source_beside_the_others_fills_what_they_leave(found: Budget) -> None:
    asked = needs(ROBOT, found, wanted=250e-6)
    for need in asked.needs:
        assert need.beside_others is not None
        errors = replace(found.errors, **{need.source.value: need.beside_others})
        assert reached(errors, found) == pytest.approx(250e-6, rel=5e-3)
        assert found.errors.given(need.source) < need.beside_others < need.alone


def test_where_the_others_are_too_large_no_error_is_small_enough(asked: Needs) -> None:
    assert all(need.beside_others is None for need in asked.needs)
