"""Draws the pictures of the documentation: `python docs/make_pictures.py`, and `-o DIR` for another folder."""

from __future__ import annotations

import argparse
from dataclasses import replace
from pathlib import Path
from typing import Final

from deltacam.cutting.process import load_process
from deltacam.pipeline import plan
from deltacam.report.picture import to_svg

SAMPLES: Final = Path(__file__).parents[1] / "samples"
FEEDS: Final = {"gear": 0.15}  # m/s
PROCESSES: Final = {"mixed": SAMPLES / "mixed.toml"}


def main() -> None:
    """Plan each sample with its feed or process and draw what the tool does."""
    parser = argparse.ArgumentParser(description="Draw the pictures of the documentation.")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent / "images", help="folder")
    folder = parser.parse_args().output
    feeds = {name: replace(load_process("steel-1mm-fibre"), feed=feed) for name, feed in FEEDS.items()}
    for name, process in {**feeds, **PROCESSES}.items():
        planned = plan(SAMPLES / f"{name}.dxf", process=process, what_if=False)
        (folder / f"{name}.svg").write_text(to_svg(planned.program, drawing=planned.drawing), encoding="utf-8")


if __name__ == "__main__":
    main()
