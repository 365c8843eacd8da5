"""Robots side by side: every row is what planning alone gives, and no robot stops the others."""

import json
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from click.testing import CliRunner

from deltacam import compare as comparing
from deltacam.errors import DeltacamError
from deltacam.pipeline import plan
from deltacam.robot.comparison import profiles
from deltacam.robot.producers import GRADES
from deltacam.robot.reader import profile_names
from deltacam_cli.main import cli

PART = Path(__file__).parents[1] / "samples" / "bracket.dxf"


def test_a_robot_has_the_time_and_the_verdict_that_planning_gives() -> None:
    (found,) = comparing.compare(PART, ["delta-300"])
    planned = plan(PART, robot="delta-300")
    assert (found.fits, found.passed, found.reason, found.rotation) == (True, True, "", 0.0)
    assert found.duration == planned.program.duration
    times = planned.report.summary["time_s"]
    on = sum(times[kind] for kind in ("pierce", "lead_in", "cut", "overcut"))
    assert found.laser == pytest.approx(on, abs=0.01)
    assert sum(share for _, share in found.binds) <= 1.0 + 1e-9


def test_a_robot_that_cannot_be_read_or_is_too_small_is_a_row_with_its_reason(tmp_path: Path) -> None:
    bad = tmp_path / "bad.toml"
    bad.write_text("name = 1", encoding="utf-8")
    broken, small, good = comparing.compare(PART, [bad, _small(tmp_path), "delta-300"])
    assert not broken.fits
    assert "name" in broken.reason
    assert (small.fits, small.passed, small.duration) == (False, False, None)
    assert "the part fits nowhere on the sheet" in small.reason
    assert good.passed


def test_a_part_that_must_be_turned_is_turned_and_planned_there(tmp_path: Path) -> None:
    long = tmp_path / "long.dxf"
    drawing = ezdxf.new(units=4)
    outline = [(0, 0), (320, 0), (320, 10), (0, 10)]
    drawing.modelspace().add_lwpolyline(outline, close=True)
    drawing.saveas(long)
    (found,) = comparing.compare(long, ["delta-300"])
    assert found.fits
    assert found.passed
    assert found.rotation == pytest.approx(np.radians(45.0))
    assert found.at == (0.0, 0.0)


def _small(folder: Path) -> Path:
    text = (Path(comparing.__file__).parent / "robot" / "profiles" / "delta-300.toml").read_text(encoding="utf-8")
    path = folder / "small.toml"
    path.write_text(text.replace("width_mm = 300", "width_mm = 20"), encoding="utf-8")
    return path


def test_a_drawing_that_cannot_be_read_is_an_error_and_not_a_row() -> None:
    with pytest.raises(DeltacamError):
        comparing.compare("no-such-file.dxf", ["delta-300"])


def test_every_built_in_robot_has_its_figures() -> None:
    found = {one.name: one for one in profiles()}
    assert tuple(found) == profile_names()
    assert found["delta-300"].reach == pytest.approx(0.3)
    assert all(one.pressure < np.radians(60) and one.condition < 3.0 for one in found.values())


def test_the_command_lists_robots_and_compares_them(tmp_path: Path) -> None:
    page = tmp_path / "page.html"
    listed = CliRunner().invoke(cli, ["robot", "compare", "--json"])
    found = json.loads(listed.output)
    assert [one["robot"] for one in found["robots"]] == list(profile_names())
    assert {one["grade"] for one in found["producers"]} <= set(GRADES)
    missing = next(one for one in found["producers"] if one["model"] == "RL3-600")
    assert missing["si"]["repeatability"] is None
    arguments = ["robot", "compare", str(PART), "--robot", "delta-300", "--robot", "nosuch", "--html", str(page)]
    shown = CliRunner().invoke(cli, arguments)
    assert shown.exit_code == 0, shown.output
    assert "nosuch: unknown robot" in shown.output
    assert "Time and accuracy" in page.read_text(encoding="utf-8")
