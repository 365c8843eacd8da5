"""Reads damaged copies of the test drawings and prints what became of them.

    PYTHONPATH=. python benchmarks/fuzz.py [--mutants 20000] [--jobs 2] [--first 0] [--keep FILE]

Each mutant has its number as its seed: ``--first N --mutants 1 --keep FILE`` makes mutant N again and keeps it.
The exit code is 1 where a mutant was neither read nor refused within 10 s and 1 GB.
"""

import argparse
import multiprocessing
import sys
import tempfile
import time
from collections import Counter
from functools import partial
from pathlib import Path

from tests.mutants import Trial, attempt, mutant

SHARE = 250  # mutants in one process, whose peak memory counts


def share(folder: Path, first: int, last: int) -> list[Trial]:
    """The trials of some mutants, in a process of their own."""
    with tempfile.TemporaryDirectory(dir=folder) as own:
        return [attempt(seed, Path(own)) for seed in range(first, last)]


def show(trials: list[Trial], seconds: float) -> None:
    """Print the table."""
    outcomes = Counter(trial.outcome for trial in trials)
    print(f"{len(trials)} mutants in {seconds:.0f} s")
    for outcome in ("read", "looked at", "refused", "failed"):
        print(f"  {outcome:10} {outcomes[outcome]:6}")
    slowest, largest = (max(trials, key=key) for key in (lambda t: t.seconds, lambda t: t.memory))
    print(f"  longest    {slowest.seconds:6.2f} s  (seed {slowest.seed}, {slowest.file})")
    print(f"  most       {largest.memory / 2**20:6.0f} MB of memory in one process")
    print("most frequent refusals:")
    for what, count in Counter(t.what[:70] for t in trials if t.outcome == "refused").most_common(12):
        print(f"  {count:6} {what}")
    for trial in trials:
        if trial.outcome == "failed":
            print(f"FAILED seed {trial.seed} ({trial.file}): {trial.what[:300]}")


def main() -> None:
    """Run as many mutants as asked for."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--mutants", type=int, default=20_000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--keep", type=Path)
    options = parser.parse_args()
    if options.keep:
        options.keep.write_bytes(mutant(options.first)[1])
    last = options.first + options.mutants
    starts = range(options.first, last, SHARE)
    ends = [min(start + SHARE, last) for start in starts]
    started = time.perf_counter()
    # A fresh process for each share: one that dies does not take the run with it unseen, and memory starts anew.
    with tempfile.TemporaryDirectory() as folder:
        context = multiprocessing.get_context("spawn")
        with context.Pool(options.jobs, maxtasksperchild=1) as pool:
            trials = pool.starmap(partial(share, Path(folder)), zip(starts, ends, strict=True), chunksize=1)
    found = [trial for part in trials for trial in part]
    show(found, time.perf_counter() - started)
    sys.exit(any(trial.outcome == "failed" for trial in found))


if __name__ == "__main__":
    main()
