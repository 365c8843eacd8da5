"""Makes benchmarks/data/order_best.json: the best times known for the sheets of benchmarks/order.py.

The problem is the same for all: every contour begins at one of its listed places, what is inside comes first, open
lines before closed ones, from (0, 0) back to (0, 0), and the cost of a way is the estimated time of a rapid of
delta-300 in whole 0.1 us. Independent answers, and long runs of our own search; the least counts:

- up to 14 contours an exact dynamic program over sets of contours (Held and Karp 1962) with places,
- up to 350 contours OR-tools' routing library: a node for every place, of which one per contour is visited,
- for more OR-tools over the contours alone, each held at the place that our search chose, then the best places for
  that sequence,
- where nothing must come first LKH, the Lin-Kernighan heuristic of Helsgaun: up to 120 contours over all places, which
  Noon and Bean's transformation (1993) turns into a tour without groups; for more over the contours, in turns with the
  best places for each sequence,
- for nested rings also both of them over whole stacks, each cut from the inside to the outside in one go.

Needs `pip install ortools elkai`, and takes about an hour; with 0 SECONDS OR-tools is left out, with 0 RUNS LKH is, and
with 0 TRIES our own runs are as long as usual:

    python -m benchmarks.order_best [SECONDS] [TRIES_PER_CONTOUR] [RUNS] [LEAST_CONTOURS] [MOST_CONTOURS]
"""

from __future__ import annotations

import json
import sys
import time
from collections.abc import Callable
from importlib.metadata import version
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.sheets import PLACES, SIZES, Sheet, sheets
from deltacam.cutting.order import order, problem_of
from deltacam.cutting.ordering.places import best_places
from deltacam.cutting.ordering.problem import Problem
from deltacam.cutting.precedence import Precedence
from deltacam.robot.rapid import Rapids
from deltacam.robot.reader import load_robot

DATA = Path(__file__).parent / "data" / "order_best.json"
EXACT = 14
WHOLE = 350
ALL_PLACES = 120
TURNS = 4
SEEDS = (101, 102)
COARSE = 1e-5
"""s, the unit of LKH, whose numbers must stay small."""
UNIT = 1e-7  # s
NEVER = 10**9


def cost_of(problem: Problem, places: list[int]) -> float:
    """The time of the ways through places, s."""
    rest = len(problem.begins) - 1
    return float(problem.ways(np.array([rest, *places]), np.array([*places, rest])).sum())


def keeps(problem: Problem, places: list[int]) -> bool:
    """Whether every contour is there once, after all that lies inside it and after all of an earlier stage."""
    cuts = problem.owner[places]
    if len(cuts) != problem.count:
        return False
    position = np.argsort(cuts)
    around = problem.rule.around[:-1]
    later = np.append(position, len(cuts))[around] > position[:, None]
    stages = np.diff(problem.stage[cuts])
    return bool((np.sort(cuts) == np.arange(problem.count)).all() and later.all() and (stages >= 0).all())


def matrix(problem: Problem, places: np.ndarray) -> np.ndarray:
    """What the ways between places cost, whole units; those back to an earlier stage never pay."""
    left, reached = (one.ravel() for one in np.meshgrid(places, places, indexing="ij"))
    cost = np.rint(problem.ways(left, reached) / UNIT).astype(np.int64)
    cuts, rest = problem.owner, problem.count
    earlier = (
        (problem.stage[cuts[reached]] < problem.stage[cuts[left]]) & (cuts[left] != rest) & (cuts[reached] != rest)
    )
    return np.where(earlier, cost + NEVER, cost).reshape(len(places), len(places))


def exact(problem: Problem) -> list[int]:
    """The best of all orders and places."""
    count, rest, owner = problem.count, len(problem.begins) - 1, problem.owner[:-1]
    cost = matrix(problem, np.arange(rest + 1)).astype(np.float64)
    inside = np.zeros(count, dtype=np.int64)
    for cut, row in enumerate(problem.rule.around[:-1].tolist()):
        for outer in row:
            if outer < count:
                inside[outer] |= 1 << cut
    best = np.full((1 << count, rest), np.inf)
    came = np.full((1 << count, rest), -1, dtype=np.int32)
    for place in np.flatnonzero(inside[owner] == 0).tolist():
        best[1 << int(owner[place]), place] = cost[rest, place]
    for done in range(1, 1 << count):
        here = np.flatnonzero(np.isfinite(best[done]))
        next_ = np.flatnonzero(((done >> owner) & 1 == 0) & ((inside[owner] & ~done) == 0))
        if not len(here) or not len(next_):
            continue
        through = best[done, here][:, None] + cost[np.ix_(here, next_)]
        least = through.argmin(axis=0)
        found = through[least, np.arange(len(next_))]
        into = done | (1 << owner[next_])
        better = found < best[into, next_]
        best[into[better], next_[better]] = found[better]
        came[into[better], next_[better]] = here[least[better]]
    done = (1 << count) - 1
    place = int((best[done] + cost[:rest, rest]).argmin())
    places = []
    while place >= 0:
        places.append(place)
        done, place = done ^ (1 << int(owner[place])), int(came[done, place])
    return places[::-1]


def routed(problem: Problem, places: np.ndarray, seconds: float) -> list[int] | None:
    """What OR-tools finds over these places, the rest of all last among them, with guided local search."""
    from ortools.constraint_solver import pywrapcp, routing_enums_pb2

    owner = problem.owner[places]
    manager = pywrapcp.RoutingIndexManager(len(places), 1, len(places) - 1)
    model = pywrapcp.RoutingModel(manager)
    model.SetArcCostEvaluatorOfAllVehicles(model.RegisterTransitMatrix(matrix(problem, places).tolist()))
    nodes: dict[int, list[int]] = {}
    for node, cut in enumerate(owner[:-1].tolist()):
        nodes.setdefault(cut, []).append(manager.NodeToIndex(node))
    for group in nodes.values():
        if len(group) > 1:
            model.AddDisjunction(group, NEVER * 10, 1)
    _keep_rule(model, problem, nodes)
    how = pywrapcp.DefaultRoutingSearchParameters()
    how.first_solution_strategy = routing_enums_pb2.FirstSolutionStrategy.PATH_CHEAPEST_ARC
    how.local_search_metaheuristic = routing_enums_pb2.LocalSearchMetaheuristic.GUIDED_LOCAL_SEARCH
    how.time_limit.FromMilliseconds(int(seconds * 1e3))
    solution = model.SolveWithParameters(how)
    if solution is None:
        return None
    index, found = model.Start(0), []
    while not model.IsEnd(index := solution.Value(model.NextVar(index))):
        found.append(int(places[manager.IndexToNode(index)]))
    return found


def toured(problem: Problem, places: np.ndarray, runs: int) -> list[int]:
    """What LKH finds over these places, the rest of all last among them; no rule is kept.

    The places of a contour are in a ring of ways that cost nothing. A tour comes to one of them, goes around, and
    leaves from the one before it for what leaving from the first one costs.
    """
    import elkai

    owner, count = problem.owner[places], len(places)
    cost = np.rint(matrix(problem, places) * (UNIT / COARSE)).astype(np.int64)
    first = np.flatnonzero(np.append(True, owner[1:] != owner[:-1]))
    following = np.arange(1, count + 1)
    following[np.append(first[1:], count) - 1] = first
    apart = 20 * int(np.median(cost)) + int(cost.max()) + 1
    ways = cost[following] + apart
    ways[owner[:, None] == owner[None]] = 4 * apart
    ways[np.arange(count), following] = 0
    tour = elkai.DistanceMatrix(ways.tolist()).solve_tsp(runs=runs)[:-1]
    begin = tour.index(count - 1)
    tour = tour[begin + 1 :] + tour[:begin]
    return [
        int(places[one]) for before, one in zip([count - 1, *tour], tour, strict=False) if owner[before] != owner[one]
    ]


def toured_in_turns(problem: Problem, held: list[int], runs: int) -> list[int]:
    """What LKH finds over the contours, each held at a place; then over the best places for that, and so on."""
    for _ in range(TURNS):
        found = toured(problem, np.append(np.sort(held), len(problem.begins) - 1), runs)
        held = best_places(problem, problem.owner[found].tolist())
    return held


def parts_at_once(problem: Problem, solve: Callable[[Problem, np.ndarray], list[int] | None]) -> list[int] | None:
    """What a solver finds where a part is cut at once, all of it begun at places of one number; then the best places.

    None where parts are not contours in each other, one in each.
    """
    rule, rest = problem.rule, problem.count
    if (rule.waiting > 1).any() or (problem.first[1:-1] - problem.first[:-2] != PLACES).any():
        return None
    chains = []
    for cut in np.flatnonzero(rule.waiting == 0).tolist():
        chain = [cut]
        while (around := int(rule.around[chain[-1], 0])) < rest:
            chain.append(around)
        chains.append(chain)
    inner, outer = (np.append(problem.first[[chain[at] for chain in chains]], -1) for at in (0, -1))
    pick = np.arange(PLACES)
    begins, ends = (
        np.vstack([*(sides[one + pick] for one in ends[:-1]), sides[-1]])
        for sides, ends in ((problem.begins, inner), (problem.ends, outer))
    )
    count = len(chains)
    free = Precedence(np.zeros(count, dtype=np.int64), np.full((count + 1, 1), count))
    none = np.zeros(count + 1, dtype=np.int64)
    parts = Problem(begins, ends, np.append(PLACES * np.arange(count + 1), len(begins)), free, none, none, problem.cost)
    answer = solve(parts, np.arange(len(begins)))
    if answer is None or len(answer) != count:
        return None
    return best_places(problem, [cut for part in parts.owner[answer].tolist() for cut in chains[part]])


def _keep_rule(model: Any, problem: Problem, nodes: dict[int, list[int]]) -> None:
    """Tell OR-tools what comes before what: by how many places were passed."""
    pairs = [
        (cut, outer)
        for cut, row in enumerate(problem.rule.around[:-1].tolist())
        for outer in row
        if outer < problem.count
    ]
    if not pairs:
        return
    model.AddConstantDimension(1, problem.count + 2, True, "passed")
    passed = model.GetDimensionOrDie("passed")
    for cut, outer in pairs:
        for one in nodes[cut]:
            for other in nodes[outer]:
                model.solver().Add(passed.CumulVar(one) <= passed.CumulVar(other))


def ours(sheet: Sheet, cost: Rapids, problem: Problem, tries: int) -> list[int]:
    """The best that our own search finds with some seeds; in its usual time with 0 tries per contour."""
    found = []
    for seed in SEEDS if tries else (0,):
        effort = tries * len(sheet.cuts) if tries else None
        options: dict[str, Any] = {"parents": sheet.parents, "start": (0.0, 0.0), "cost": cost, "places": sheet.places}
        ordered = order(sheet.cuts, **options, seed=seed, effort=effort)
        first = problem.first[np.array(ordered.index)]
        found.append([int(base) + int(place or 0) for base, place in zip(first, ordered.place, strict=True)])
    return min(found, key=lambda places: cost_of(problem, places))


def by_or_tools(problem: Problem, held: list[int], seconds: float) -> dict[str, list[int] | None]:
    """What OR-tools finds, ``held`` being places that are good."""
    found: dict[str, list[int] | None] = {}
    if problem.count <= WHOLE:
        found["or-tools"] = routed(problem, np.arange(len(problem.begins)), seconds)
    else:
        answer = routed(problem, np.append(np.sort(held), len(problem.begins) - 1), seconds)
        found["or-tools, places held"] = answer and best_places(problem, problem.owner[answer].tolist())
    if (problem.rule.waiting > 0).any():
        found["or-tools, parts at once"] = parts_at_once(problem, lambda one, places: routed(one, places, seconds))
    return found


def by_lkh(problem: Problem, held: list[int], runs: int) -> dict[str, list[int] | None]:
    """What LKH finds, ``held`` being places that are good."""

    def solve(one: Problem, places: np.ndarray) -> list[int]:
        if one.count <= ALL_PLACES:
            return toured(one, places, runs)
        first = places[:-1].reshape(one.count, -1)[:, 0]
        return toured_in_turns(one, first.tolist(), runs)

    if (problem.rule.waiting > 0).any():
        return {"lkh, parts at once": parts_at_once(problem, solve)}
    if len(set(problem.stage.tolist())) > 1:
        return {}
    if problem.count <= ALL_PLACES:
        return {"lkh": toured(problem, np.arange(len(problem.begins)), runs)}
    return {"lkh, places in turns": toured_in_turns(problem, held, runs)}


def known(
    sheet: Sheet, cost: Rapids, seconds: float, tries: int, runs: int, earlier: dict[str, float]
) -> dict[str, Any]:
    """What every solver finds for a sheet, and found in ``earlier`` runs."""
    problem = problem_of(sheet.cuts, parents=sheet.parents, start=(0.0, 0.0), cost=cost, places=sheet.places)
    held = ours(sheet, cost, problem, tries)
    found: dict[str, list[int] | None] = {"ours": held}
    if problem.count <= EXACT:
        found["exact"] = exact(problem)
    if seconds:
        found |= by_or_tools(problem, held, seconds)
    if runs:
        found |= by_lkh(problem, held, runs)
    times = {name: round(cost_of(problem, one), 9) for name, one in found.items() if one and keeps(problem, one)}
    times = {**earlier, **{name: min(value, earlier.get(name, value)) for name, value in times.items()}}
    by = "exact" if "exact" in times else min(times, key=lambda name: times[name])
    return {"best": times[by], "by": by, "times": times}


def main() -> None:
    """Find the best times and store them, those of earlier runs included."""
    import ortools

    numbers = [float(argument) for argument in sys.argv[1:]]
    seconds, tries, runs, least, most = (*numbers, *(15.0, 30.0, 5.0, 0.0, np.inf)[len(numbers) :])
    cost = Rapids(load_robot("delta-300"))
    for sheet in sheets(tuple(size for size in SIZES if least <= size <= most)):
        started = time.perf_counter()
        stored: dict[str, Any] = json.loads(DATA.read_text()) if DATA.exists() else {}
        earlier = stored.get(sheet.name, {}).get("times", {})
        stored[sheet.name] = known(sheet, cost, seconds, int(tries), int(runs), earlier)
        stored["provenance"] = {
            "solver": f"OR-tools {ortools.__version__}, routing, PATH_CHEAPEST_ARC, GUIDED_LOCAL_SEARCH; LKH 3 as in "
            f"elkai {version('elkai')}; exact dynamic program up to {EXACT} contours; the least of several runs",
            "problem": (__doc__ or "").split("\n\n")[1].replace("\n", " "),
            "robot": "delta-300",
            "script": "benchmarks/order_best.py",
        }
        DATA.parent.mkdir(exist_ok=True)
        DATA.write_text(json.dumps(stored, indent=1) + "\n")
        print(sheet.name, stored[sheet.name], f"{time.perf_counter() - started:.0f} s", flush=True)


if __name__ == "__main__":
    main()
