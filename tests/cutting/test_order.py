"""The order of the cuts."""

import itertools

import numpy as np
import pytest

from deltacam.cutting.order import order
from deltacam.geometry import curve as curves
from deltacam.model import Cut


def ring(number: int, x: float, y: float, radius: float = 1e-3) -> Cut:
    return Cut(contour=number, layer="0", handles=("1",), curve=curves.circle(np.array([x, y]), radius))


def travel(cuts: tuple[Cut, ...], start: tuple[float, float] = (0.0, 0.0)) -> float:
    places = np.array([start, *(cut.curve.points[0] for cut in cuts), start])
    return float(np.hypot(*np.diff(places, axis=0).T).sum())


@pytest.mark.parametrize("seed", range(30))
def test_everything_inside_a_contour_is_cut_before_it_and_nothing_is_lost(seed: int) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 40))
    cuts = [ring(n, *rng.uniform(-0.1, 0.1, 2)) for n in range(1, count + 1)]
    # A random forest: the parent of each contour has a larger number; some contours are split into two cuts.
    parents = {
        n: None if n == count or rng.random() < 0.3 else int(rng.integers(n + 1, count + 1))
        for n in range(1, count + 1)
    }
    cuts += [ring(n, *rng.uniform(-0.1, 0.1, 2)) for n in range(1, count + 1) if rng.random() < 0.2]
    rng.shuffle(cuts)
    ordered = order(cuts, parents=parents, start=(0.0, 0.0))
    assert sorted(cut.contour for cut in ordered) == sorted(cut.contour for cut in cuts)
    last = {cut.contour: position for position, cut in enumerate(ordered)}
    first = {cut.contour: position for position, cut in reversed(list(enumerate(ordered)))}
    for inner, outer in parents.items():
        assert outer is None or last[inner] < first[outer]


@pytest.mark.parametrize("start", [(0.0, 0.0), (-0.2, 0.15)])
@pytest.mark.parametrize("seed", range(8))
def test_seven_cuts_are_near_the_best_order_of_all(seed: int, start: tuple[float, float]) -> None:
    rng = np.random.default_rng(seed)
    cuts = [ring(n, *rng.uniform(-0.1, 0.1, 2), radius=1e-6) for n in range(1, 8)]
    best = min(travel(p, start) for p in itertools.permutations(cuts))
    found = travel(order(cuts, parents=dict.fromkeys(range(1, 8)), start=start), start)
    assert best - 1e-4 <= found <= 1.02 * best


def test_a_cut_begins_nearest_to_the_end_of_the_one_before() -> None:
    first, second = order(
        [ring(1, 0.1, 0.0, 0.01), ring(2, 0.2, 0.0, 0.01)], parents={1: None, 2: None}, start=(0.0, 0.0)
    )
    assert first.curve.points[0] == pytest.approx([0.09, 0.0], abs=1e-9)
    assert second.curve.points[0] == pytest.approx([0.19, 0.0], abs=1e-9)
    assert curves.length(second.curve) == pytest.approx(2 * np.pi * 0.01)


def test_the_same_cuts_give_the_same_order() -> None:
    rng = np.random.default_rng(3)
    cuts = [ring(n, *rng.uniform(-0.1, 0.1, 2)) for n in range(1, 30)]
    parents = dict.fromkeys(range(1, 30))
    one, two = (order(cuts, parents=parents, start=(0.0, 0.0)) for _ in range(2))
    assert [cut.contour for cut in one] == [cut.contour for cut in two]


def test_no_cuts_need_no_order() -> None:
    assert order([], parents={}, start=(0.0, 0.0)) == ()
