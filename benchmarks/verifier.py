"""Damages valid programs in many ways and prints which check of the verifier found what.

    PYTHONPATH=. python benchmarks/verifier.py [--programs 500] [--mutants 10000] [--jobs 2] [--seed 0] [--kind KIND]

The programs are what the pipeline plans for random drawings; their numbers, from ``--seed`` on, are their seeds. A kind
of damage that was missed is made again with ``--seed N --programs 1 --mutants 2 --kind KIND``. The exit code is 1 where
a mutant was not found by the check that is there for it, or where the verifier refused what is not damaged.
"""

import argparse
import multiprocessing
import sys
import time
from collections import Counter, defaultdict
from collections.abc import Iterable
from functools import partial

from tests.damage.campaign import Outcome, Trial, outcome
from tests.damage.harmless import HARMLESS
from tests.damage.table import KINDS

HEAD = ("kind of damage", "to be found by", "just above", "far above", "otherwise", "missed", "just below")
ROW = "{:38} {:34} {:>11} {:>11} {:>9} {:>7} {:>11}"


def show(outcomes: list[Outcome], seconds: float) -> bool:
    """Print the tables; whether everything was as it should be."""
    trials = [trial for one in outcomes for trial in one.trials]
    planned = [one for one in outcomes if not one.refused]
    mutants = [trial for trial in trials if trial.size in ("near", "far")]
    below = [trial for trial in trials if trial.size == "below"]
    harmless = [trial for trial in trials if not trial.size]
    _show_kinds(trials)
    print()
    print(f"valid programs that pass         {_share(not one.said.failed for one in planned)}")
    print(f"harmless changes that pass       {_share(trial.right for trial in harmless)}")
    for change in HARMLESS:
        print(f"  {change:30} {_share(trial.right for trial in harmless if trial.kind == change)}")
    print(f"mutants found by their check     {_share(trial.right for trial in mutants)}")
    print(f"  refused                        {_share(bool(trial.said.failed) for trial in mutants)}")
    print(f"just below, let pass by the check {_share(trial.right for trial in below)}")
    print(f"{seconds:.0f} s")
    for one in outcomes:
        if one.refused or one.said.failed:
            print(f"SEED {one.seed}: {one.refused or ', '.join(sorted(one.said.failed))}")
    wrong = [trial for trial in trials if not trial.right]
    for trial in wrong:
        said = ", ".join(sorted(trial.said.failed)) or "passed"
        print(f"WRONG seed {trial.seed}, {trial.kind} {trial.size}: {said}")
    return not wrong and not any(one.said.failed for one in outcomes)


def _show_kinds(trials: list[Trial]) -> None:
    """One line for every kind of damage."""
    of_kind: defaultdict[tuple[str, str], list[Trial]] = defaultdict(list)
    for trial in trials:
        of_kind[trial.kind, trial.size].append(trial)
    print(ROW.format(*HEAD))
    for name, kind in KINDS.items():
        near, far, below = (of_kind[name, size] for size in ("near", "far", "below"))
        fates = Counter("otherwise" if trial.said.failed else "missed" for trial in near + far if not trial.right)
        found = [_share(trial.right for trial in some) for some in (near, far, below)]
        print(ROW.format(name, " or ".join(kind.checks), *found[:2], fates["otherwise"], fates["missed"], found[2]))


def _share(rights: Iterable[bool]) -> str:
    """How many are right, of how many."""
    values = list(rights)
    return f"{sum(values)} of {len(values)}" if values else "-"


def main() -> None:
    """Run as many programs and mutants as asked for."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--programs", type=int, default=500)
    parser.add_argument("--mutants", type=int, default=10_000)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--kind", action="append", choices=sorted(KINDS))
    options = parser.parse_args()
    seeds = range(options.seed, options.seed + options.programs)
    each = -(-options.mutants // options.programs)
    work = partial(outcome, mutants=each, kinds=tuple(options.kind or KINDS))
    started = time.perf_counter()
    with multiprocessing.get_context("spawn").Pool(options.jobs) as pool:
        outcomes = []
        for one in pool.imap(work, seeds, chunksize=5):
            outcomes.append(one)
            if sys.stderr.isatty():
                print(f"\r{len(outcomes)} of {len(seeds)} programs", end="", file=sys.stderr)
    sys.exit(not show(outcomes, time.perf_counter() - started))


if __name__ == "__main__":
    main()
