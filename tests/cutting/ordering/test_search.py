"""The search against every order and every place there is, and its hard and soft rules."""

import itertools

import numpy as np
import pytest

from deltacam.cutting.ordering.places import best_places
from deltacam.cutting.ordering.problem import Problem
from deltacam.cutting.ordering.search import search
from deltacam.model import Heat
from tests.cutting.ordering.problems import keeps, problem, travel


def found(one: Problem, *, seed: int = 0, tries: int = 100) -> list[int]:
    return search(one, seed=seed, tries=tries, progress=lambda _done, _total: None)


def best(one: Problem) -> float:
    """Over all orders that keep to the rule, and all places."""
    groups = [range(low, high) for low, high in itertools.pairwise(one.first[:-1].tolist())]
    orders = (order for order in itertools.permutations(range(one.count)) if keeps(one, list(order)))
    return min(
        travel(one, list(places)) for order in orders for places in itertools.product(*(groups[cut] for cut in order))
    )


@pytest.mark.parametrize("seed", range(12))
def test_four_cuts_are_ordered_as_well_as_can_be(seed: int) -> None:
    one = problem(seed, 4)
    assert travel(one, found(one)) == pytest.approx(best(one), abs=1e-9)


@pytest.mark.parametrize("seed", range(6))
def test_the_places_are_the_best_for_their_sequence(seed: int) -> None:
    one = problem(seed, 5)
    sequence = np.random.default_rng(seed).permutation(5).tolist()
    groups = [range(int(one.first[cut]), int(one.first[cut + 1])) for cut in sequence]
    least = min(travel(one, list(places)) for places in itertools.product(*groups))
    places = best_places(one, sequence)
    assert one.owner[places].tolist() == sequence
    assert travel(one, places) == pytest.approx(least, abs=1e-12)


@pytest.mark.parametrize("options", [{}, {"stages": 3}, {"parts": 5}, {"parts": 3, "stages": 2}])
@pytest.mark.parametrize("seed", range(4))
def test_tries_keep_to_all_rules_and_only_make_the_order_better(seed: int, options: dict[str, int]) -> None:
    one = problem(seed, 60, **options)
    few, many = found(one, tries=0), found(one, tries=300)
    assert keeps(one, one.owner[few].tolist())
    assert keeps(one, one.owner[many].tolist())
    assert travel(one, many) <= travel(one, few)


def test_the_same_seed_gives_the_same_order_and_another_one_another() -> None:
    one = problem(3, 60)
    assert found(one, seed=1) == found(one, seed=1)
    assert found(one, seed=1) != found(one, seed=2)


@pytest.mark.parametrize("tries", [0, 7, 200])
def test_the_search_tells_how_many_tries_are_done(tries: int) -> None:
    told: list[tuple[int, int]] = []
    search(problem(0, 20), seed=0, tries=tries, progress=lambda done, total: told.append((done, total)))
    assert told[-1] == (tries, tries)
    assert [done for done, _ in told] == sorted(done for done, _ in told)


@pytest.mark.parametrize("seed", range(3))
def test_with_a_heat_rule_hardly_any_cut_begins_near_the_end_of_the_one_before(seed: int) -> None:
    heat = Heat(0.02, 1.0)

    def near(places: list[int]) -> int:
        ways = one.begins[places[1:]] - one.ends[places[:-1]]
        return int((np.hypot(*ways.T) < heat.distance).sum())

    one = problem(seed, 60, ruled=False)
    free = near(found(one))
    one = problem(seed, 60, ruled=False, heat=heat)
    assert near(found(one)) <= 2 < free
