"""The order of the cuts."""

import itertools
from dataclasses import replace

import numpy as np
import pytest

from deltacam.cutting import order as module
from deltacam.cutting.beginnings import Place
from deltacam.geometry import curve as curves
from deltacam.model import Curve, Cut, Heat, Operation


def order(cuts, **options):
    return module.order(cuts, **options).cuts


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


def test_a_cut_that_may_begin_anywhere_does_so_on_the_shortest_way() -> None:
    cuts = [ring(1, 0.1, 0.0, 0.01), ring(2, 0.2, 0.0, 0.01)]
    ordered = order(cuts, parents={1: None, 2: None}, start=(0.0, 0.0))
    assert travel(ordered) == pytest.approx(0.38, abs=1e-6)
    assert [curves.length(cut.curve) for cut in ordered] == pytest.approx([2 * np.pi * 0.01] * 2)


def test_the_same_cuts_give_the_same_order() -> None:
    rng = np.random.default_rng(3)
    cuts = [ring(n, *rng.uniform(-0.1, 0.1, 2)) for n in range(1, 30)]
    parents = dict.fromkeys(range(1, 30))
    one, two = (order(cuts, parents=parents, start=(0.0, 0.0)) for _ in range(2))
    assert [cut.contour for cut in one] == [cut.contour for cut in two]


def line(number: int, start: tuple[float, float], end: tuple[float, float], operation: Operation) -> Cut:
    curve = Curve(points=np.array([start, end]), bulges=np.zeros(1), closed=False)
    return Cut(contour=number, layer="0", handles=("1",), curve=curve, operation=operation)


def test_engraving_comes_first_then_open_cuts_then_contours() -> None:
    cuts = [
        ring(1, 0.0, 0.0, 0.05),
        line(2, (0.01, 0.0), (0.02, 0.0), Operation.CUT),
        replace(ring(3, 0.1, 0.1), operation=Operation.ENGRAVE),
        line(4, (-0.2, 0.0), (-0.3, 0.0), Operation.ENGRAVE),
        ring(5, 0.0, 0.0, 0.01),
    ]
    parents = {1: 3, 2: 1, 3: None, 4: 1, 5: 1}
    ordered = order(cuts, parents=parents, start=(0.0, 0.0))
    numbers = [cut.contour for cut in ordered]
    assert (sorted(numbers[:2]), numbers[2:]) == ([3, 4], [2, 5, 1])
    assert [cut.operation for cut in ordered] == [Operation.ENGRAVE] * 2 + [Operation.CUT] * 3


def test_open_lines_are_run_from_the_nearer_end_and_left_at_the_other() -> None:
    zigzag = [line(n, (0.01, 1e-3 * n), (0.11, 1e-3 * n), Operation.ENGRAVE) for n in range(1, 9)]
    ordered = order(zigzag, parents=dict.fromkeys(range(1, 9)), start=(0.0, 0.0))
    numbers = [cut.contour for cut in ordered]
    assert sorted(numbers) in (numbers, numbers[::-1])
    for before, after in itertools.pairwise(ordered):
        assert after.curve.points[0] == pytest.approx(
            before.curve.points[-1] + [0.0, 1e-3 if numbers[0] == 1 else -1e-3]
        )
    assert all(not cut.curve.closed and curves.length(cut.curve) == pytest.approx(0.1) for cut in ordered)


def test_a_contour_after_an_open_line_begins_where_the_way_past_it_is_shortest() -> None:
    start = np.array([-0.01, 0.0])
    opened, outline = order(
        [ring(1, 0.0, 0.0, 0.05), line(2, (0.0, 0.0), (0.0, 0.04), Operation.CUT)],
        parents={1: None, 2: 1},
        start=(-0.01, 0.0),
    )
    angle = np.linspace(0.0, 2.0 * np.pi, 100_001)
    around = 0.05 * np.column_stack([np.cos(angle), np.sin(angle)])
    first, last = opened.curve.points
    assert first == pytest.approx([0.0, 0.0])
    best = (np.hypot(*(around - last).T) + np.hypot(*(around - start).T)).min()
    begin = outline.curve.points[0]
    assert np.hypot(*(begin - last)) + np.hypot(*(begin - start)) == pytest.approx(best, abs=1e-6)


def best_travel(lines: list[Cut], start: tuple[float, float]) -> float:
    """Over every order and every way round."""
    ends = np.array([cut.curve.points for cut in lines])
    best = np.inf
    for sequence in itertools.permutations(range(len(lines))):
        # The shortest way so far that ends at the last point of the line before, and at its first one.
        cost = {0: 0.0}
        here = {0: np.array(start)}
        for index in sequence:
            reached = {way: min(cost[k] + np.hypot(*(ends[index][1 - way] - here[k])) for k in cost) for way in (0, 1)}
            cost, here = reached, {way: ends[index][way] for way in (0, 1)}
        best = min(best, *(cost[k] + np.hypot(*(np.array(start) - here[k])) for k in cost))
    return best


@pytest.mark.parametrize("seed", range(8))
def test_six_open_lines_are_near_the_best_order_of_all(seed: int) -> None:
    rng = np.random.default_rng(seed)
    places = rng.uniform(-0.1, 0.1, (6, 2, 2))
    lines = [line(n, tuple(a), tuple(b), Operation.ENGRAVE) for n, (a, b) in enumerate(places, start=1)]
    ordered = order(lines, parents=dict.fromkeys(range(1, 7)), start=(0.0, 0.0))
    begins = np.array([*(cut.curve.points[0] for cut in ordered), (0.0, 0.0)])
    ends = np.array([(0.0, 0.0), *(cut.curve.points[-1] for cut in ordered)])
    assert float(np.hypot(*(begins - ends).T).sum()) <= 1.25 * best_travel(lines, (0.0, 0.0))


def test_no_cuts_need_no_order() -> None:
    assert order([], parents={}, start=(0.0, 0.0)) == ()


def spots(count: int, seed: int) -> list[list[Place]]:
    """Three places of every cut, left elsewhere than they are come to."""
    rng = np.random.default_rng(seed)
    return [[Place(*map(tuple, pair)) for pair in rng.uniform(-0.1, 0.1, (3, 2, 2)).tolist()] for _ in range(count)]


def test_cuts_with_a_list_begin_at_one_of_its_places_and_are_handed_out_as_they_were() -> None:
    cuts = [ring(n, 0.01 * n, 0.0) for n in range(1, 6)]
    places = spots(5, 0)
    found = module.order(cuts, parents=dict.fromkeys(range(1, 6)), start=(0.0, 0.0), places=places)
    assert all(cut is cuts[index] for cut, index in zip(found.cuts, found.index, strict=True))
    chosen = [places[index][place] for index, place in zip(found.index, found.place, strict=True)]
    ways = np.array([[0.0, 0.0], *(one.end for one in chosen)]) - [*(one.begin for one in chosen), [0.0, 0.0]]
    assert found.time == pytest.approx(float(np.hypot(*ways.T).sum()))
    assert found.wait == (0.0,) * 5


def test_the_order_with_lists_is_the_best_of_all() -> None:
    cuts, parents = [ring(n, 0.0, 0.0) for n in range(1, 5)], {1: 3, 2: None, 3: None, 4: None}
    for seed in range(4):
        places = spots(4, seed)
        found = module.order(cuts, parents=parents, start=(0.0, 0.0), places=places)
        best = np.inf
        for sequence in itertools.permutations(range(4)):
            if sequence.index(0) > sequence.index(2):
                continue
            for chosen in itertools.product(*(places[cut] for cut in sequence)):
                left = np.array([(0.0, 0.0), *(one.end for one in chosen)])
                reached = np.array([*(one.begin for one in chosen), (0.0, 0.0)])
                best = min(best, float(np.hypot(*(reached - left).T).sum()))
        assert found.time == pytest.approx(best)


def test_only_some_cuts_need_a_list() -> None:
    cuts = [ring(1, 0.05, 0.0, 0.01), ring(2, 0.1, 0.0, 0.01), line(3, (0.02, 0.0), (0.03, 0.0), Operation.CUT)]
    places = [None, [Place((0.1, 0.02), (0.1, 0.03))], None]
    found = module.order(cuts, parents=dict.fromkeys((1, 2, 3)), start=(0.0, 0.0), places=places)
    assert dict(zip(found.index, found.place, strict=True)) == {0: None, 1: 0, 2: None}
    assert found.cuts[found.index.index(1)] is cuts[1]


@pytest.mark.parametrize("seed", range(4))
def test_the_contours_of_a_part_stay_together_where_that_is_asked(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cuts, parents = [], dict[int, int | None]()
    for part in range(6):
        parents[part] = None
        cuts.append(ring(part, *rng.uniform(-0.1, 0.1, 2), radius=0.02))
    for hole in range(6, 40):
        parents[hole] = int(rng.integers(6))
        cuts.append(ring(hole, *rng.uniform(-0.1, 0.1, 2)))  # all over the sheet, so that it does not pay to stay
    free = module.order(cuts, parents=parents, start=(0.0, 0.0))
    kept = module.order(cuts, parents=parents, start=(0.0, 0.0), together=True)
    of_part = [parents[cut.contour] if cut.contour >= 6 else cut.contour for cut in kept.cuts]
    assert len([part for part, _ in itertools.groupby(of_part)]) == 6
    assert free.time < kept.time


def test_a_cut_near_the_end_of_the_one_before_waits_for_what_the_way_does_not_take() -> None:
    heat = Heat(distance=0.05, time=1.0)
    cuts = [ring(1, 0.0, 0.0), ring(2, 0.01, 0.0)]
    found = module.order(cuts, parents={1: None, 2: None}, start=(0.0, 0.0), heat=heat)
    first, second = (cut.curve.points[0] for cut in found.cuts)
    assert found.wait == (0.0, pytest.approx(1.0 - np.hypot(*(second - first))))
    far = module.order([cuts[0], ring(2, 0.1, 0.0)], parents={1: None, 2: None}, start=(0.0, 0.0), heat=heat)
    assert far.wait == (0.0, 0.0)


def test_a_contour_between_two_cuts_that_is_not_cut_itself_does_not_break_the_rule() -> None:
    # 1 in 2 in 3: 2 is engraved, which comes first; 1 must still come before 3, which is nearer.
    cuts = [ring(1, 0.1, 0.0), replace(ring(2, 0.1, 0.0, 0.02), operation=Operation.ENGRAVE), ring(3, 0.06, 0.0, 0.06)]
    ordered = order(cuts, parents={1: 2, 2: 3, 3: None}, start=(0.0, 0.0))
    assert [cut.contour for cut in ordered] == [2, 1, 3]


def test_more_time_means_more_tries_and_few_contours_need_few() -> None:
    assert module.effort_for(0.0, 100) == 0
    assert module.effort_for(20.0, 100) > module.effort_for(10.0, 100) > 0
    efforts = [module.default_effort(count) for count in (1, 10, 50, 100, 1000, 20_000)]
    assert efforts == sorted(efforts)
    assert efforts[2] <= 300


def test_parts_that_stay_together_come_after_those_that_they_wait_for() -> None:
    # The hole of part 1 is nearest, but all of part 1 waits for part 2, which shares an edge with it.
    cuts = [ring(1, 0.05, 0.0, 0.02), ring(2, 0.15, 0.0, 0.02), ring(3, 0.05, 0.0), ring(4, 0.15, 0.0)]
    parents = {1: None, 2: None, 3: 1, 4: 2}
    ordered = order(cuts, parents=parents, after={1: [2]}, start=(0.0, 0.0), together=True)
    assert [cut.contour for cut in ordered] == [4, 2, 3, 1]
