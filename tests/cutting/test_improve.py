"""Improved sequences are shorter by what each move claims, and keep to the rule."""

import numpy as np
import pytest

from deltacam.cutting import improve as module
from deltacam.cutting import moves
from deltacam.cutting.improve import Tour, improve
from deltacam.cutting.precedence import Precedence
from deltacam.geometry import curve as curves
from deltacam.model import Cut

KINDS = (moves.REVERSE, moves.SWAP, moves.BEHIND, moves.BEFORE)


def free(count: int) -> Precedence:
    return Precedence(np.zeros(count, dtype=np.int64), np.full((count + 1, 1), count))


def random_rule(seed: int, count: int) -> Precedence:
    """Half of the cuts lie in one of the others."""
    rng = np.random.default_rng(seed)
    half = count // 2
    cuts = [Cut(contour=n, layer="0", handles=("1",), curve=curves.circle(np.zeros(2), 1e-3)) for n in range(1, count)]
    cuts.append(Cut(contour=count - 1, layer="0", handles=("1",), curve=curves.circle(np.ones(2), 1e-3)))  # split
    parents = {n: int(rng.integers(half, count - 1)) + 1 if n <= half else None for n in range(1, count)}
    return Precedence.between(cuts, parents)


def keeps(sequence: np.ndarray, rule: Precedence) -> bool:
    position = np.argsort(sequence).tolist()
    around = ((inner, outer) for inner in range(len(position)) for outer in rule.around[inner].tolist())
    return all(position[inner] < position[outer] for inner, outer in around if outer < len(position))


def random_tour(seed: int, count: int) -> Tour:
    rng = np.random.default_rng(seed)
    begins, ends = rng.uniform(-0.1, 0.1, (2, count, 2))
    return Tour(rng.permutation(count), begins, ends, np.zeros(2), np.array([0.2, 0.0]))


def travel(tour: Tour) -> float:
    left = np.concatenate([[tour.start], tour.ends[tour.sequence]])
    reached = np.concatenate([tour.begins[tour.sequence], [tour.home]])
    return float(np.hypot(*(reached - left).T).sum())


@pytest.mark.parametrize("count", [1, 2, 3, 12, 60])
@pytest.mark.parametrize("seed", range(10))
def test_a_sequence_gets_shorter_and_lines_are_only_turned_round(seed: int, count: int) -> None:
    tour = random_tour(seed, count)
    before, lines = travel(tour), {tuple(sorted(map(tuple, pair))) for pair in zip(tour.begins, tour.ends, strict=True)}
    sequence = improve(tour, free(count))
    assert sorted(sequence) == list(range(count))
    assert travel(tour) <= before
    assert count < 4 or travel(tour) < before
    assert {tuple(sorted(map(tuple, pair))) for pair in zip(tour.begins, tour.ends, strict=True)} == lines


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(20))
def test_a_move_saves_what_it_claims(seed: int, kind: int) -> None:
    tour, rng = random_tour(seed, 12), np.random.default_rng(seed)
    p, q, r = sorted(rng.choice(13, 3, replace=False).tolist())
    q = p if kind == moves.REVERSE else q
    before, claimed = travel(tour), tour.saved(kind, p, q, r)
    module._make(tour, kind, p, q, r)
    assert before - travel(tour) == pytest.approx(claimed, abs=1e-12)
    assert tour.position[tour.sequence].tolist() == list(range(12))


@pytest.mark.parametrize("seed", range(10))
def test_every_move_is_made_for_what_it_saves(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    make, made = module._make, []

    def watched(tour: Tour, kind: int, p: int, q: int, r: int) -> None:
        before = travel(tour)
        make(tour, kind, p, q, r)
        made.append(before - travel(tour))

    monkeypatch.setattr(module, "_make", watched)
    improve(random_tour(seed, 60), free(60))
    assert made
    assert min(made) > 0.0


@pytest.mark.parametrize("seed", range(30))
def test_no_move_puts_anything_behind_what_is_around_it(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    rule, tour, make = random_rule(seed, 40), random_tour(seed, 40), module._make
    tour = Tour(np.arange(40), tour.begins, tour.ends, tour.start, tour.home)  # inner cuts have the lower indices
    assert keeps(tour.sequence, rule)

    def watched(tour: Tour, kind: int, p: int, q: int, r: int) -> None:
        make(tour, kind, p, q, r)
        assert keeps(tour.sequence, rule)

    monkeypatch.setattr(module, "_make", watched)
    before = travel(tour)
    improve(tour, rule)
    assert travel(tour) < 0.8 * before


@pytest.mark.parametrize("kind", KINDS)
def test_a_move_is_refused_exactly_where_it_breaks_the_rule(kind: int) -> None:
    rule = random_rule(1, 12)
    for p in range(12):
        for q in range(p, 13) if kind != moves.REVERSE else (p,):
            for r in range(q + 1, 13):
                tour = Tour(np.arange(12), *np.zeros((2, 12, 2)), np.zeros(2), np.zeros(2))
                kept = module._keeps(tour, rule, kind, p, q, r)
                module._make(tour, kind, p, q, r)
                assert keeps(tour.sequence, rule) == kept


def test_moves_are_looked_for_only_where_something_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    find, looked_at = module.find, []

    def watched(steps: moves.Steps, wanted: np.ndarray, *, above: float) -> moves.Moves:
        looked_at.append(int(wanted.sum()))
        return find(steps, wanted, above=above)

    monkeypatch.setattr(module, "find", watched)
    tour = random_tour(1, 300)
    improve(tour, free(300))
    assert looked_at[0] == 301
    assert looked_at[-1] < 100
    tour.begins[7] = tour.ends[7] = tour.home  # which is far away
    before = travel(tour)
    looked_at.clear()
    improve(tour, free(300), np.arange(300) == 7)
    assert looked_at[0] <= moves.LONGEST_RUN + 2
    assert travel(tour) < before - 0.1
