"""Attempts to get damaged programs past the verifier, the same for the same seed."""

import zlib
from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from deltacam.errors import DeltacamError
from tests.damage.aim import NoPlaceError
from tests.damage.example import Example, example
from tests.damage.harmless import HARMLESS
from tests.damage.kind import Verdict, verdict
from tests.damage.table import KINDS

SIZES = ("near", "far", "below")
"""Just above what is tolerated, far above it, and just below."""


@dataclass(frozen=True)
class Trial:
    """What the verifier said to one mutant.

    Attributes:
        seed: of the program.
        kind: of damage, or what harmless change was made.
        size: one of `SIZES`, or empty for a harmless change.
        said: what was said.
        right: whether that was as it should be: the check of the kind found it, or let it pass below its tolerance; a
            harmless change passes.
    """

    seed: int
    kind: str
    size: str
    said: Verdict
    right: bool


@dataclass(frozen=True)
class Outcome:
    """What became of the program of a seed.

    Attributes:
        seed: of the program.
        refused: why the pipeline planned nothing; empty where it did.
        said: what was said to the valid program.
        trials: of its mutants and its harmless changes.
    """

    seed: int
    refused: str
    said: Verdict
    trials: tuple[Trial, ...]


def attempt(case: Example, kind: str, size: str) -> Trial:
    """Make a mutant and verify it.

    Raises:
        NoPlaceError: the program has no place for it.
    """
    damage = KINDS[kind]
    amount = getattr(damage, size)
    if amount is None:
        raise NoPlaceError
    chance = np.random.default_rng([case.seed, zlib.crc32(kind.encode()), SIZES.index(size)])
    said = verdict(case, damage.make(case, amount, chance))
    silent = (said.failed | said.warned).isdisjoint(damage.checks)
    return Trial(case.seed, kind, size, said, silent == (size == "below"))


def try_harmless(case: Example, change: str) -> Trial:
    """Make a change that does no harm and verify it.

    Raises:
        NoPlaceError: the program has no place for it.
    """
    said = verdict(case, HARMLESS[change](case))
    return Trial(case.seed, change, "", said, not said.failed)


def outcome(seed: int, mutants: int, kinds: Iterable[str] = tuple(KINDS)) -> Outcome:
    """Plan the program of a seed and try so many mutants of it, the kinds in turn; other seeds begin with other kinds.

    A mutant below its tolerance comes with every one just above it where there is such a size; it does not count.
    """
    try:
        case = example(seed)
    except DeltacamError as problem:
        return Outcome(seed, str(problem), Verdict(frozenset()), ())
    turns = [(kind, size) for kind in kinds for size in ("near", "far")]
    start = seed * mutants % len(turns)
    trials: list[Trial] = []
    made = 0
    for kind, size in [*turns[start:], *turns[:start]]:
        if made >= mutants:
            break
        both = list(_attempts(case, kind, size))
        made += bool(both)
        trials += both
    return Outcome(seed, "", Verdict.of(case.report), (*trials, *_harmless(case)))


def _attempts(case: Example, kind: str, size: str) -> Iterator[Trial]:
    """The trial of a kind at a size, with that below the tolerance; none where there is no place for it."""
    for one in (size, "below") if size == "near" else (size,):
        try:
            yield attempt(case, kind, one)
        except NoPlaceError:
            if one == size:
                return


def _harmless(case: Example) -> Iterator[Trial]:
    for change in HARMLESS:
        try:
            yield try_harmless(case, change)
        except NoPlaceError:
            continue
