"""Damaged copies of real files are read or refused, and nothing else; ``benchmarks/fuzz.py`` runs many more."""

from pathlib import Path

from tests.mutants import attempt, mutant

MUTANTS = 150


def test_damaged_files_are_read_or_refused(tmp_path: Path) -> None:
    trials = [attempt(seed, tmp_path) for seed in range(MUTANTS)]
    assert [trial for trial in trials if trial.outcome == "failed"] == []
    assert {trial.outcome for trial in trials} == {"read", "looked at", "refused"}


def test_a_mutant_is_the_same_for_the_same_seed() -> None:
    assert [mutant(seed) for seed in range(20)] == [mutant(seed) for seed in range(20)]
