"""Prints how good and how quick the order of cuts is, on 60 generated sheets against the best times known.

The best times are made by `order_best.py`. All begin contours at the same eight places each, and have the same rules.
"""

from __future__ import annotations

import json
import sys
import time

import numpy as np

from benchmarks.order_best import DATA, cost_of, keeps
from benchmarks.sheets import KINDS, SIZES, Sheet, sheet
from deltacam.cutting.order import order, problem_of
from deltacam.cutting.ordering.first import first_order
from deltacam.cutting.ordering.places import best_places
from deltacam.robot.rapid import Rapids
from deltacam.robot.reader import load_robot

LARGE = (2000, 10000)


def row(one: Sheet, cost: Rapids, best: float | None) -> tuple[float, float, float, float]:
    """The time of the nearest neighbour with its best places, of ours, the gap to the best in %, and how long it took.

    Raises:
        ValueError: the order breaks a rule.
    """
    options = {"parents": one.parents, "start": (0.0, 0.0), "cost": cost, "places": one.places}
    problem = problem_of(one.cuts, **options)
    greedy = cost_of(problem, best_places(problem, problem.owner[first_order(problem)].tolist()))
    started = time.perf_counter()
    ordered = order(one.cuts, **options)
    seconds = time.perf_counter() - started
    places = problem.first[list(ordered.index)] + np.array(ordered.place, dtype=np.int64)
    if not keeps(problem, places.tolist()):
        raise ValueError(f"{one.name}: the order breaks a rule")
    ours = cost_of(problem, places.tolist())
    return greedy, ours, float("nan") if best is None else 100.0 * (ours / best - 1.0), seconds


def main() -> None:
    """One row for every sheet, and what all come to; then the large ones, where nothing better is known."""
    cost, best = Rapids(load_robot("delta-300")), json.loads(DATA.read_text())
    largest = int(sys.argv[1]) if len(sys.argv) > 1 else max(SIZES)
    print("| sheet | contours | greedy s | ours s | best known s | gap % | took s | best by |")
    print("|---|---|---|---|---|---|---|---|")
    gaps = []
    for size in SIZES:
        for kind in KINDS if size <= largest else ():
            one = sheet(kind, size)
            known = best[one.name]
            greedy, ours, gap, seconds = row(one, cost, known["best"])
            gaps.append(gap)
            text = f"{greedy:.3f} | {ours:.3f} | {known['best']:.3f} | {round(gap, 2) + 0.0:.2f} | {seconds:.2f}"
            print(f"| {kind} | {size} | {text} | {known['by']} |", flush=True)
    print(f"\n{len(gaps)} sheets, no rule broken")
    print(f"the gap is {np.median(gaps):.2f} % in the median and {max(gaps):.2f} % at most")
    for size in LARGE if largest >= max(SIZES) else ():
        for kind in ("random", "mixed"):
            greedy, ours, _, seconds = row(sheet(kind, size), cost, None)
            print(
                f"{size} contours, {kind}: greedy {greedy:.2f} s, ours {ours:.2f} s, took {seconds:.1f} s", flush=True
            )


if __name__ == "__main__":
    main()
