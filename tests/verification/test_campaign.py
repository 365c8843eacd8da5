"""Damaged programs are found by the check that is there for the damage; ``benchmarks/verifier.py`` tries many more."""

from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache

import numpy as np
import pytest

from deltacam.model import BlockKind
from tests.damage.aim import NoPlaceError
from tests.damage.campaign import SIZES, Trial, attempt, try_harmless
from tests.damage.example import Example, example
from tests.damage.harmless import HARMLESS
from tests.damage.kind import Verdict
from tests.damage.table import KINDS

SEEDS = (57, 67, 99, 71, 11, 12, 1004, 1042)
"""Programs with few rows that have a place for every kind of damage between them: both robots, linear and cubic.

The last two have leads, an overcut, loops and tabs.
"""

NOT_DAMAGED = {
    "reach margin (at least)",  # without reach there is no pose, and that check comes first
    "energy per mm",  # has no limit
}


@lru_cache
def case(seed: int) -> Example:
    return example(seed)


def first_place(trial: Callable[[Example], Trial], turn: int) -> Trial:
    """The trial of the first program that has a place for it, the programs in turn."""
    for index in range(len(SEEDS)):
        with suppress(NoPlaceError):
            return trial(case(SEEDS[(turn + index) % len(SEEDS)]))
    raise NoPlaceError


@pytest.mark.parametrize("seed", SEEDS)
def test_a_planned_program_passes(seed: int) -> None:
    assert Verdict.of(case(seed).report).failed == frozenset()


@pytest.mark.parametrize("kind", KINDS)
def test_damage_is_found_by_its_check_and_not_below_its_tolerance(kind: str) -> None:
    turn = list(KINDS).index(kind)
    for index, size in enumerate(SIZES if KINDS[kind].below is not None else SIZES[:2]):
        trial = first_place(lambda program, size=size: attempt(program, kind, size), turn + index)
        assert trial.right, trial


@pytest.mark.parametrize("change", HARMLESS)
def test_a_change_that_does_no_harm_passes(change: str) -> None:
    for turn in range(2):
        trial = first_place(lambda program: try_harmless(program, change), turn)
        assert trial.right, trial


def test_there_is_damage_for_every_check() -> None:
    covered = {name for kind in KINDS.values() for name in kind.checks}
    assert set(case(SEEDS[0]).checks) - covered == NOT_DAMAGED


def test_a_mutant_is_the_same_for_the_same_seed() -> None:
    one, other = example(SEEDS[0]), example(SEEDS[0])
    assert one.content == other.content
    chances = [np.random.default_rng(1), np.random.default_rng(1)]
    made = [
        KINDS["digits changed"].make(program, 1, chance) for program, chance in zip((one, other), chances, strict=True)
    ]
    assert made[0] == made[1] != one.content


def test_the_programs_do_everything_that_a_program_can() -> None:
    assert {block.kind for seed in SEEDS for block in case(seed).program.blocks} == set(BlockKind)
