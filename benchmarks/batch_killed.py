"""Kills a batch at many moments, looks at what is left, lets it go on, and prints a table.

    PYTHONPATH=. .venv/bin/python benchmarks/batch_killed.py [--moments 50] [--parts 12] [--seed 0]

After every kill all files must be whole, and no process may be left; in the end all bytes must be those of a batch that
nobody disturbed. Then a small batch is killed, interrupted, and kept from one or every further change of the disk, at
each of its steps. The exit code is 1 where something is wrong.
"""

import argparse
import subprocess
import sys
import tempfile
from pathlib import Path

from tests.batch.killing import campaign, draw

ROW = "{:>6} {:>8} {:>6} {:>11}  {:32} {}"


def main() -> None:
    """Run the campaign and print a line for every moment."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--moments", type=int, default=50)
    parser.add_argument("--parts", type=int, default=12)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    wrong = unfinished = 0
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        draw(scratch / "parts", options.parts)
        print(ROW.format("moment", "after s", "files", "unfinished", "killed", "what is wrong"))
        found = campaign(scratch / "parts", scratch / "results", moments=options.moments, seed=options.seed)
        for number, one in enumerate(found, start=1):
            wrong += bool(one.flaws)
            unfinished += bool(one.unfinished)
            said = "; ".join(one.flaws) or "nothing"
            print(ROW.format(number, f"{one.after:.2f}", one.files, one.unfinished, one.when, said), flush=True)
    print(
        f"{options.moments - wrong} of {options.moments} moments without a flaw, {unfinished} in the middle of a file"
    )
    *flaws, disturbed = _at_every_step()
    print(*flaws, f"{len(flaws)} flaws of a small batch that was disturbed {disturbed} times", sep="\n")
    sys.exit(1 if wrong or flaws else 0)


def _at_every_step() -> list[str]:
    """The flaws, and how often the batch was disturbed."""
    with tempfile.TemporaryDirectory() as scratch:
        command = [sys.executable, "-m", "tests.batch.steps", scratch, "--all"]
        return subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True).stdout.splitlines()


if __name__ == "__main__":
    main()
