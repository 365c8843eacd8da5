"""Improved sequences are shorter by what each move claims, and keep to the rule."""

import numpy as np
import pytest

from deltacam.cutting.improve import Precedence, Tour, improve
from deltacam.geometry import curve as curves
from deltacam.model import Cut


def free(count: int) -> Precedence:
    none, nobody = ((),) * count, np.zeros(0, dtype=np.int64)
    return Precedence(none, none, nobody, nobody)


def random_tour(seed: int, count: int) -> Tour:
    rng = np.random.default_rng(seed)
    begins, ends = rng.uniform(-0.1, 0.1, (2, count, 2))
    return Tour(rng.permutation(count), begins, ends, np.zeros(2), np.array([0.2, 0.0]))


def travel(tour: Tour) -> float:
    left = np.concatenate([[tour.start], tour.ends[tour.sequence]])
    reached = np.concatenate([tour.begins[tour.sequence], [tour.home]])
    return float(np.hypot(*(reached - left).T).sum())


@pytest.mark.parametrize("seed", range(30))
def test_a_pass_shortens_the_way_and_only_turns_lines_round(seed: int) -> None:
    tour = random_tour(seed, 12)
    before, lines = travel(tour), {tuple(sorted(map(tuple, pair))) for pair in zip(tour.begins, tour.ends, strict=True)}
    sequence = improve(tour, free(12))
    assert sorted(sequence) == list(range(12))
    assert travel(tour) < before
    assert {tuple(sorted(map(tuple, pair))) for pair in zip(tour.begins, tour.ends, strict=True)} == lines


@pytest.mark.parametrize("seed", range(30))
def test_no_move_makes_the_way_longer(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    from deltacam.cutting import improve as module

    reverse = module._reverse_best

    def watched(tour: Tour, rule: Precedence, first: int) -> None:
        before = travel(tour)
        reverse(tour, rule, first)
        assert travel(tour) <= before + 1e-12

    monkeypatch.setattr(module, "_reverse_best", watched)
    improve(random_tour(seed, 12), free(12))


def test_a_run_never_comes_before_what_lies_inside_it() -> None:
    cuts = [Cut(contour=n, layer="0", handles=("1",), curve=curves.circle(np.zeros(2), 1e-3 * n)) for n in range(1, 6)]
    rule = Precedence.between(cuts, {1: 2, 2: 5, 3: 5, 4: None, 5: None})
    for seed in range(20):
        tour = random_tour(seed, 5)
        tour.sequence = np.array([0, 1, 2, 4, 3])
        position = np.argsort(improve(tour, rule))
        assert position[0] < position[1] < position[4] > position[2]
