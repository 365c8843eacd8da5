"""Draws the pictures of the page on the motion: `python docs/make_motion_pictures.py`, and `-o DIR` to try it.

Naive ways to plan are taken from the benchmarks, which have to be on the path of Python: PYTHONPATH=. does.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable
from pathlib import Path
from typing import Final

from figures import corner, jerk, limits, naive

PICTURES: Final[dict[str, Callable[[], str]]] = {
    "naive": naive.draw,
    "corner": corner.draw,
    "limits": limits.draw,
    "jerk": jerk.draw,
}


def main() -> None:
    """Draw every picture."""
    parser = argparse.ArgumentParser(description="Draw the pictures of the page on the motion.")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent / "images" / "motion", help="folder")
    folder = parser.parse_args().output
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in PICTURES.items():
        (folder / f"{name}.svg").write_text(draw(), encoding="utf-8")


if __name__ == "__main__":
    main()
