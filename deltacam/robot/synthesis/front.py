"""The trade between size and dexterity: the smallest robot for every demanded 1/cond of a row (epsilon constraints)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Final

from deltacam.errors import RobotError
from deltacam.robot.synthesis.synthesis import Design, Progress, design
from deltacam.robot.synthesis.wish import Wish

ROW: Final = (0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8)
"""The demands on 1/cond where nothing else is asked."""


@dataclass(frozen=True, slots=True)
class Front:
    """Designs in the order of what they were asked, every one the smallest that was found.

    Attributes:
        designs: with rising `Wish.min_inverse_condition` and rising size.
        refused: the demands on 1/cond that no robot met, and why.
    """

    designs: tuple[Design, ...]
    refused: tuple[tuple[float, str], ...]


def front(wish: Wish, *, row: Sequence[float] = ROW, seed: int = 0, progress: Progress | None = None) -> Front:
    """The smallest robot for every demand on 1/cond of a row, each search begun at the design before.

    Raises:
        RobotError: a demand is out of range, or no design of the row was found.
    """
    designs: list[Design] = []
    refused: list[tuple[float, str]] = []
    for count, demanded in enumerate(sorted(row)):
        if progress is not None:
            progress("front", count, len(row))
        one = replace(wish, min_inverse_condition=demanded)
        try:
            start = designs[-1].candidate if designs else None
            designs.append(design(one, seed=seed, start=start))
        except RobotError as problem:
            refused.append((demanded, problem.what))
            if not designs and demanded == max(row):
                raise
            break
    if not designs:
        raise RobotError(refused[0][1], where="demands", hint="ask less, or let the robot be larger (--max-size)")
    return Front(tuple(designs), tuple(refused))
