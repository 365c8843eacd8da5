"""Changes of an order save what they claim, keep to the rule, and can be taken back."""

from itertools import pairwise

import numpy as np
import pytest

from deltacam.cutting.ordering.descent import Descent
from deltacam.cutting.ordering.first import first_order
from deltacam.cutting.ordering.near import near_cuts
from deltacam.cutting.ordering.problem import Lookup, Problem
from deltacam.cutting.ordering.way import Way
from tests.cutting.ordering.problems import keeps, problem, travel

KINDS = {
    "free": {"ruled": False},
    "free, the same either way": {"ruled": False, "lopsided": False},
    "ruled": {},
    "ruled, the same either way": {"lopsided": False},
    "of stages": {"stages": 3},
    "of parts": {"parts": 4, "stages": 2},
}


def ways(one: Problem) -> tuple[Way, Descent]:
    way = Way(one, Lookup(one), first_order(one))
    bounds = one.first.tolist()
    places = [range(low, high) for low, high in pairwise(bounds)]
    return way, Descent(way, near_cuts(one), places, one.count)


def state(way: Way) -> tuple[list[int], list[int], list[int]]:
    return way.sequence[:], way.place[:], way.position[:]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("count", [1, 2, 3, 5, 12, 60])
@pytest.mark.parametrize("seed", range(4))
def test_a_descent_saves_what_it_says_and_keeps_to_the_rule(seed: int, count: int, kind: str) -> None:
    one = problem(seed, count, **KINDS[kind])
    way, descent = ways(one)
    before = travel(one, way.places)
    assert keeps(one, way.sequence[1:])
    saved = descent.run(list(way.sequence))
    assert keeps(one, way.sequence[1:])
    assert before - travel(one, way.places) == pytest.approx(saved, abs=1e-8)
    assert saved >= 0.0
    assert count < 60 or saved > 0.05 * before
    assert 0.0 in (descent.run(list(way.sequence)) for _ in range(10))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(4))
def test_every_single_change_saves_what_it_says_and_can_be_taken_back(seed: int, kind: str) -> None:
    one = problem(seed, 40, **KINDS[kind])
    way, descent = ways(one)
    made = 0
    for cut in list(way.sequence) * 3:
        kept, before = state(way), way.total()
        change = descent._about(cut)
        if change is None:
            continue
        made += 1
        assert before - way.total() == pytest.approx(change.saved, abs=1e-9)
        assert change.saved > 0.0
        assert keeps(one, way.sequence[1:])
        after = state(way)
        way.undo()
        assert state(way) == kept
        descent._about(cut)
        assert state(way) == after
        way.keep()
    assert made > 10


@pytest.mark.parametrize("seed", range(3))
def test_a_stretch_may_be_turned_or_swapped_exactly_where_the_rule_is_kept(seed: int) -> None:
    one = problem(seed, 9)
    way, descent = ways(one)
    for p in range(1, 10):
        for q in range(p + 1, 11):
            allowed = way.may_turn(p, q)
            way.turn(p, q)
            assert keeps(one, way.sequence[1:]) == allowed
            way.undo()
            for r in range(q + 1, 11):
                allowed, before = way.may_swap(p, q, r), way.total()
                change = descent.swap(p, q, r)
                assert keeps(one, way.sequence[1:]) == allowed
                assert before - way.total() == pytest.approx(change.saved, abs=1e-12)
                way.undo()


def test_what_a_turned_stretch_costs_inside_is_told() -> None:
    one = problem(1, 12, ruled=False)
    way, _ = ways(one)
    assert not way.exact

    def inside() -> float:
        places = [way.place[cut] for cut in way.sequence[3:9]]
        return sum(way.rows[left][reached] for left, reached in pairwise(places))

    before, more = inside(), way.turned_inside(3, 9)
    way.turn(3, 9)
    assert inside() - before == pytest.approx(more, abs=1e-12)


def test_open_cuts_run_the_other_way_begin_at_their_other_end() -> None:
    rng = np.random.default_rng(0)
    one = problem(0, 5, ruled=False)
    ends = rng.uniform(-0.1, 0.1, (5, 2, 2))
    lines = Problem(
        np.vstack([ends.reshape(-1, 2), [0.0, 0.0]]),
        np.vstack([ends[:, ::-1].reshape(-1, 2), [0.0, 0.0]]),
        np.array([0, 2, 4, 6, 8, 10, 11]),
        one.rule,
        one.stage,
        one.part,
        one.cost,
    )
    mirror, exact = lines.mirrors()
    assert exact
    assert mirror.tolist() == [1, 0, 3, 2, 5, 4, 7, 6, 9, 8, 10]
