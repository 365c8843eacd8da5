"""Random problems, and what is true of an order, found the long way."""

from itertools import groupby

import numpy as np

from deltacam.cutting.ordering.problem import Problem, distance
from deltacam.cutting.precedence import Precedence
from deltacam.geometry import curve as curves
from deltacam.model import Array, Cut, Heat


def problem(
    seed: int,
    count: int,
    *,
    ruled: bool = True,
    lopsided: bool = True,
    stages: int = 1,
    parts: int = 1,
    heat: Heat | None = None,
) -> Problem:
    """Cuts with one to four places: half of the cuts lie in one of the others, of the same stage and part."""
    rng = np.random.default_rng(seed)
    sizes = rng.integers(1, 5, count)
    middle = np.repeat(rng.uniform(-0.1, 0.1, (count, 2)), sizes, axis=0)
    begins = middle + rng.uniform(-0.02, 0.02, middle.shape)
    ends = begins + (rng.uniform(-0.005, 0.005, middle.shape) if lopsided else 0.0)
    stage, part = rng.integers(0, stages, count), rng.integers(0, parts, count)
    cuts = [Cut(contour=n, layer="0", handles=("1",), curve=curves.circle(np.zeros(2), 1e-3)) for n in range(count)]
    parents: dict[int, int | None] = dict.fromkeys(range(count))
    for cut in range(count // 2 if ruled else 0):
        later = cut + 1 + np.flatnonzero((stage[cut + 1 :] == stage[cut]) & (part[cut + 1 :] == part[cut]))
        parents[cut] = int(rng.choice(later)) if len(later) else None
    return Problem(
        np.vstack([begins, [0.0, 0.0]]),
        np.vstack([ends, [0.15, 0.0]]),
        np.concatenate([[0], np.cumsum(sizes), [sizes.sum() + 1]]),
        Precedence.between(cuts, parents),
        np.append(stage, stages - 1),
        np.append(part, -1),
        distance,
        heat,
    )


def travel(one: Problem, places: list[int]) -> float:
    """The length of all ways, m."""
    left: Array = np.vstack([one.ends[-1:], one.ends[places]])
    reached: Array = np.vstack([one.begins[places], one.begins[-1:]])
    return float(np.hypot(*(reached - left).T).sum())


def keeps(one: Problem, cuts: list[int]) -> bool:
    """Whether every cut is there once, stages follow each other, parts stay together and the rule is kept."""
    position = {cut: at for at, cut in enumerate(cuts)}
    stages, parts = one.stage[cuts].tolist(), one.part[cuts].tolist()
    blocks = [block for block, _ in groupby(zip(stages, parts, strict=True))]
    return (
        sorted(cuts) == list(range(one.count))
        and stages == sorted(stages)
        and len(blocks) == len(set(blocks))
        and all(
            outer == one.count or position[cut] < position[outer]
            for cut, row in enumerate(one.rule.around[:-1].tolist())
            for outer in row
        )
    )
