"""Kills a batch at many moments, looks at what is left, lets it go on, and prints a table.

    PYTHONPATH=. .venv/bin/python benchmarks/batch_killed.py [--moments 50] [--parts 12] [--seed 0]

After every kill all files must be whole, and no process may be left; in the end all bytes must be those of a batch that
nobody disturbed. The exit code is 1 where something is wrong.
"""

import argparse
import sys
import tempfile
from pathlib import Path

from tests.batch.killing import campaign, draw

ROW = "{:>6} {:>8} {:>6}  {:40} {}"


def main() -> None:
    """Run the campaign and print a line for every moment."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--moments", type=int, default=50)
    parser.add_argument("--parts", type=int, default=12)
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    wrong = 0
    with tempfile.TemporaryDirectory() as name:
        scratch = Path(name)
        draw(scratch / "parts", options.parts)
        print(ROW.format("moment", "after s", "files", "killed", "what is wrong"))
        for one in campaign(scratch / "parts", scratch / "results", moments=options.moments, seed=options.seed):
            wrong += bool(one.flaws) or "left" in one.when
            said = "; ".join(one.flaws) or "nothing"
            print(ROW.format(one.number, f"{one.after:.2f}", one.files, one.when, said), flush=True)
    print(f"{options.moments - wrong} of {options.moments} moments without a flaw")
    sys.exit(1 if wrong else 0)


if __name__ == "__main__":
    main()
