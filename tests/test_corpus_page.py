"""The page about real drawings says what the reader gives now."""

import os
import re
import subprocess
import sys
import tomllib
from collections import Counter
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest

from deltacam.drawing.reader import read_drawing
from deltacam.inspection.listing import to_dict
from deltacam.inspection.picture import to_svg
from deltacam.model import Drawing

ROOT = Path(__file__).parents[1]
DRAWINGS = ROOT / "tests" / "data" / "dxf"
PICTURES = ROOT / "docs" / "images" / "corpus"
PAGE = (ROOT / "docs" / "reference" / "corpus.md").read_text()
EXPECTED: dict[str, dict[str, Any]] = tomllib.loads((DRAWINGS / "expected.toml").read_text())
NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
ROWS = {row[0]: row[1:] for row in re.findall(r"^\| \[([\w-]+)\]\(#\1\)" + r" \| ?(.*?)" * 5 + r" ?\|$", PAGE, re.M)}
SHOWN = sorted(name for name, row in EXPECTED.items() if row["loops"] != "unreadable")


def read(name: str) -> Drawing:
    unit = None if EXPECTED[name]["unit_from"] == "the file" else EXPECTED[name]["unit"]
    return read_drawing(DRAWINGS / f"{name}.dxf", unit=unit, strict=False)


def paths(picture: str) -> list[tuple[str | None, str]]:
    """The classes and data of all paths."""
    root = ElementTree.fromstring(picture)  # noqa: S314 - our own text
    return [(path.get("class"), path.get("d", "")) for path in root.iter("{http://www.w3.org/2000/svg}path")]


def without_numbers(text: str) -> str:
    return NUMBER.sub("0", text)


def test_every_drawing_has_its_row_and_section() -> None:
    assert set(ROWS) == set(EXPECTED)
    assert set(re.findall(r"^## ([\w-]+)$", PAGE, re.M)) == set(EXPECTED)
    assert all(ROWS[name][1] == row["loops"] for name, row in EXPECTED.items())


@pytest.mark.parametrize("name", SHOWN)
def test_the_numbers_are_those_of_the_reader(name: str) -> None:
    unit, _, loops, size, warnings = ROWS[name]
    found = to_dict(read(name))
    assert unit == f"{found['unit']}, from {EXPECTED[name]['unit_from']}"
    assert [int(count) for count in loops.split(" / ")] == [
        found["contours"][kind] for kind in ("outer", "inner", "open")
    ]
    assert [float(length) for length in size.split(" x ")] == pytest.approx(found["size_mm"], abs=0.011)
    stated = {(kind.strip("*"), "*" in kind): int(count) for count, kind in re.findall(r"(\d+) ([*\w]+)", warnings)}
    assert stated == Counter((warning["kind"], warning["blocks"]) for warning in found["warnings"])


@pytest.mark.parametrize("name", SHOWN)
def test_the_picture_is_the_one_that_inspect_draws_now(name: str) -> None:
    stored, now = paths((PICTURES / f"{name}.svg").read_text()), paths(to_svg(read(name)))
    assert [kind for kind, _ in stored] == [kind for kind, _ in now]
    for (_, data), (_, again) in zip(stored, now, strict=True):
        numbers = [[float(number) for number in NUMBER.findall(text)] for text in (data, again)]
        np.testing.assert_allclose(*numbers, rtol=1e-3, atol=3.0)  # micrometres; machines round differently


def test_the_pictures_are_small_and_all_are_shown() -> None:
    pictures = sorted(PICTURES.glob("*"))
    assert [path.stem for path in pictures] == SHOWN
    assert sum(path.stat().st_size for path in pictures) < 4_000_000
    assert all(f"(../images/corpus/{path.name})" in PAGE for path in pictures)


def test_the_page_is_made_by_the_script(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    script = ROOT / "docs" / "make_corpus_page.py"
    subprocess.run([sys.executable, script, "-o", tmp_path], check=True, env=environment)
    made = (tmp_path / "reference" / "corpus.md").read_text()
    assert without_numbers(made) == without_numbers(PAGE)
    assert sorted(path.stem for path in (tmp_path / "images" / "corpus").glob("*.svg")) == SHOWN
