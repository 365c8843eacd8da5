"""The samples are what the script draws, and each becomes a program that passes every check."""

from __future__ import annotations

import subprocess
import sys
import tomllib
from pathlib import Path
from typing import NamedTuple

import numpy as np
import pytest

import deltacam
from deltacam.errors import ProcessError
from deltacam.model import BlockKind, Drawing, Operation, Outcome
from deltacam.pipeline import plan

SAMPLES = Path(__file__).parents[1] / "samples"
DRAWINGS = sorted(path.stem for path in SAMPLES.glob("*.dxf"))


class Expected(NamedTuple):
    contours: int
    parts: int  # outlines: what is cut and lies in an even number of others
    deepest: int
    ignored: int
    engraved: int = 0


EXPECTED = {
    "bracket": Expected(contours=13, parts=1, deepest=1, ignored=1),
    "gear": Expected(contours=8, parts=1, deepest=1, ignored=0),
    "mixed": Expected(contours=55, parts=15, deepest=3, ignored=0, engraved=11),
    "nameplate": Expected(contours=53, parts=1 + 3, deepest=2, ignored=0),
    "panels": Expected(contours=27, parts=9, deepest=1, ignored=0),
    "sheet": Expected(contours=184, parts=92, deepest=4, ignored=0),
    "snowflake": Expected(contours=8, parts=1, deepest=1, ignored=0),
}


def read(name: str) -> Drawing:
    return deltacam.read_drawing(SAMPLES / f"{name}.dxf")


def geometry(content: bytes) -> bytes:
    """Everything before the OBJECTS section, which holds no geometry and differs between versions of ezdxf."""
    before, section, _ = content.partition(b"\nOBJECTS\n")
    assert section
    return before


def draw_into(folder: Path) -> dict[str, bytes]:
    folder.mkdir()
    subprocess.run([sys.executable, SAMPLES / "make_samples.py", "-o", folder], check=True, capture_output=True)
    return {path.stem: path.read_bytes() for path in folder.iterdir()}


def test_the_script_draws_the_same_bytes_twice_and_those_that_are_kept(tmp_path: Path) -> None:
    first, second = draw_into(tmp_path / "first"), draw_into(tmp_path / "second")
    assert first == second
    assert sorted(first) == DRAWINGS
    for name, content in first.items():
        assert geometry(content) == geometry((SAMPLES / f"{name}.dxf").read_bytes()), name


@pytest.mark.parametrize("name", DRAWINGS)
def test_a_sample_states_its_unit_and_nests_as_expected(name: str) -> None:
    drawing = read(name)
    depth = np.array([contour.depth for contour in drawing.contours])
    engraved = np.array([contour.operation is Operation.ENGRAVE for contour in drawing.contours])
    ignored = [entry for entry in drawing.ledger if entry.outcome is Outcome.IGNORED]
    assert drawing.unit_in_words == "mm (header)"
    assert not [entry for entry in drawing.ledger if entry.outcome is Outcome.LOST]
    outlines = int(np.sum((depth % 2 == 0) & ~engraved))
    assert Expected(len(depth), outlines, int(depth.max()), len(ignored), int(engraved.sum())) == EXPECTED[name]


@pytest.mark.parametrize("name", DRAWINGS)
def test_the_program_of_a_sample_passes_every_check(name: str) -> None:
    planned = plan(SAMPLES / f"{name}.dxf")
    failed = [check for check in planned.report.checks if not check.passed]
    assert not failed
    assert planned.report.summary["contours_cut"] == EXPECTED[name].contours - EXPECTED[name].engraved


def test_the_sample_robot_and_process_plan_a_sample() -> None:
    planned = plan(SAMPLES / "bracket.dxf", robot=SAMPLES / "robot.toml", process=SAMPLES / "process.toml")
    assert planned.report.passed
    assert planned.program.robot.name == "my-robot"
    assert planned.program.process.name == "my-steel-2mm"


def test_the_mixed_sheet_is_cut_with_all_that_a_cut_can_have() -> None:
    planned = plan(SAMPLES / "mixed.dxf", process=SAMPLES / "mixed.toml", what_if=False)
    assert planned.report.passed
    assert planned.report.summary["contours_cut"] == 44
    assert {block.kind for block in planned.program.blocks} == set(BlockKind)


def test_the_flanks_of_the_gear_are_involutes() -> None:
    """At radius r a tooth reaches to the angle pi / 2z + inv(20 deg) - inv(acos(base / r)) from its middle."""
    teeth, base = 24, 48e-3 * np.cos(np.radians(20.0))
    (outline,) = [contour.curve for contour in read("gear").contours if contour.depth == 0]
    radius = np.hypot(*outline.points.T)
    flank = (radius > base + 1e-5) & (radius < 52e-3 - 1e-5)
    assert flank.sum() > 4 * teeth
    pressure = np.arccos(base / radius[flank])
    expected = np.pi / (2 * teeth) + (np.tan(np.radians(20)) - np.radians(20)) - (np.tan(pressure) - pressure)
    angle = np.arctan2(outline.points[flank, 1], outline.points[flank, 0])
    from_middle = np.abs(np.remainder(angle + np.pi / teeth, 2 * np.pi / teeth) - np.pi / teeth)
    np.testing.assert_allclose(from_middle * radius[flank], expected * radius[flank], atol=1e-6)


def test_the_sample_process_gives_every_key_that_there_is(tmp_path: Path) -> None:
    given = tomllib.loads((SAMPLES / "process.toml").read_text())
    wrong = tmp_path / "process.toml"
    wrong.write_text('name = "x"\nkerf_mm = 0.1\nfeed_m_min = 1\nzz = 1\n')
    with pytest.raises(ProcessError) as refused:
        deltacam.load_process(wrong)
    assert sorted(refused.value.hint.removeprefix("known: ").split(", ")) == sorted(given)
