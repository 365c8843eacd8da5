"""The pictures of the page on the motion are those that the code gives now."""

import os
import re
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "docs" / "images" / "motion"
PAGE = (ROOT / "docs" / "explanation" / "motion.md").read_text()
NAMES = ["corner", "jerk", "limits", "naive"]
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
SVG = "{http://www.w3.org/2000/svg}"


@pytest.fixture(scope="module")
def made(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("motion")
    environment = {**os.environ, "PYTHONPATH": str(ROOT)}
    script = ROOT / "docs" / "make_motion_pictures.py"
    subprocess.run([sys.executable, script, "-o", folder], check=True, env=environment)
    return folder


def lines(picture: Path) -> list[tuple[str | None, str]]:
    """The colours and data of all lines that show numbers."""
    root = ElementTree.fromstring(picture.read_text())  # noqa: S314 - our own text
    return [(path.get("stroke"), path.get("d", "")) for path in root.iter(f"{SVG}path") if path.get("class") == "line"]


def words(picture: Path) -> list[str]:
    """All text, with a # for every number."""
    root = ElementTree.fromstring(picture.read_text())  # noqa: S314 - our own text
    return [NUMBER.sub("#", text.text or "") for text in root.iter(f"{SVG}text")]


def numbers(picture: Path) -> list[float]:
    """The numbers in all text."""
    root = ElementTree.fromstring(picture.read_text())  # noqa: S314 - our own text
    return [float(number) for text in root.iter(f"{SVG}text") for number in NUMBER.findall(text.text or "")]


def test_every_picture_is_made_by_the_script_and_shown(made: Path) -> None:
    assert sorted(path.stem for path in made.glob("*")) == sorted(path.stem for path in PICTURES.glob("*")) == NAMES
    assert all(f"(../images/motion/{name}.svg)" in PAGE for name in NAMES)
    assert sum(path.stat().st_size for path in PICTURES.glob("*")) < 200_000


@pytest.mark.parametrize("name", NAMES)
def test_a_picture_shows_what_the_code_gives_now(name: str, made: Path) -> None:
    stored, now = PICTURES / f"{name}.svg", made / f"{name}.svg"
    assert words(stored) == words(now)
    np.testing.assert_allclose(numbers(stored), numbers(now), rtol=5e-3, atol=5e-3)
    assert [colour for colour, _ in lines(stored)] == [colour for colour, _ in lines(now)]
    for (_, data), (_, again) in zip(lines(stored), lines(now), strict=True):
        old, new = ([float(number) for number in NUMBER.findall(text)] for text in (data, again))
        # Machines round differently, and what is left of a limit of jerk is found to a part in a thousand.
        assert np.mean(np.abs(np.subtract(old, new))) < 1.0
