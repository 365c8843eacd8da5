"""Writes the page about real drawings with its pictures: `python docs/make_corpus_page.py`, and `-o DIR` to try it."""

from __future__ import annotations

import argparse
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any, Final

from deltacam.drawing.reader import read_drawing
from deltacam.errors import DrawingError
from deltacam.inspection.listing import to_dict
from deltacam.inspection.picture import to_svg

DRAWINGS: Final = Path(__file__).parents[1] / "tests" / "data" / "dxf"
PAGE: Final = "reference/corpus.md"
PICTURES: Final = "images/corpus"

HEAD: Final = """\
# Real drawings

What deltacam makes of 36 DXF files from public repositories. None was made for it; they are chosen to show what goes
wrong with real files. Where they are from, and their licences, is beside the files in `tests/data/dxf`.

*Expected* is what a person says who looked at a picture of the file, made without deltacam: outer contours / inner
contours / open chains. *Read* is what deltacam finds. Sizes are those of all lines. Where the file states no unit, or a
wrong one, the one that the person concludes was given with `--units`; without it `plan` refuses the file. The tests
compare this page with the files.

"""


def main() -> None:
    """Read every drawing, draw it, and write the page."""
    parser = argparse.ArgumentParser(description="Write the page about real drawings.")
    parser.add_argument("-o", "--output", type=Path, default=Path(__file__).parent, help="folder in the place of docs")
    folder = parser.parse_args().output
    for name in (PAGE, f"{PICTURES}/x"):
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
    expected = tomllib.loads((DRAWINGS / "expected.toml").read_text(encoding="utf-8"))
    rows = ["| drawing | unit | expected | read | size, mm | warnings |", "|---|---|---|---|---|---|"]
    sections = []
    for name, row in expected.items():
        try:
            found, picture = look(name, row)
        except DrawingError as refused:
            rows.append(f"| [{name}](#{name}) | | {row['loops']} | unreadable | | |")
            sections.append(f"## {name}\n\n{row['person']}\n\nRefused: *{refused.what}*.\n")
            continue
        (folder / PICTURES / f"{name}.svg").write_text(picture, encoding="utf-8")
        rows.append(table_row(name, row, found))
        sections.append(section(name, row, found))
    page = HEAD + "\n".join(rows) + "\n\n" + "\n".join(sections)
    (folder / PAGE).write_text(page, encoding="utf-8")


def look(name: str, row: dict[str, Any]) -> tuple[dict[str, Any], str]:
    """What inspect says of a drawing, in the unit that a person concludes, and its picture."""
    unit = None if row["unit_from"] == "the file" else row["unit"]
    drawing = read_drawing(DRAWINGS / f"{name}.dxf", unit=unit, strict=False)
    return to_dict(drawing), to_svg(drawing)


def table_row(name: str, row: dict[str, Any], found: dict[str, Any]) -> str:
    """The row of a drawing; `tests/test_corpus_page.py` reads it again."""
    loops = " / ".join(str(found["contours"][kind]) for kind in ("outer", "inner", "open"))
    width, height = found["size_mm"]
    unit = f"{found['unit']}, from {row['unit_from']}"
    return f"| [{name}](#{name}) | {unit} | {row['loops']} | {loops} | {width:.2f} x {height:.2f} | {kinds(found)} |"


def kinds(found: dict[str, Any]) -> str:
    """The warnings by kind: ``2 gap, 1 **crossing**``; what plan refuses is bold."""
    counts = Counter((warning["kind"], warning["blocks"]) for warning in found["warnings"])
    return ", ".join(f"{count} {f'**{kind}**' if blocks else kind}" for (kind, blocks), count in sorted(counts.items()))


def section(name: str, row: dict[str, Any], found: dict[str, Any]) -> str:
    """What a person sees, why deltacam counts in another way, what plan refuses, and the picture."""
    lines = [f"## {name}", "", row["person"]]
    if "why" in row:
        lines.append(f"It counts in another way: {row['why']}.")
    blocking = next((warning for warning in found["warnings"] if warning["blocks"]), None)
    if blocking:
        lines.append(f"`plan` refuses it: *{blocking['message'].replace('*', '')}*.")
    return "\n".join([*lines, "", f"![{name} as it was read](../{PICTURES}/{name}.svg)", ""])


if __name__ == "__main__":
    main()
