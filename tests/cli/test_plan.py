"""``deltacam plan``: units, the user's own defaults, and how a drawing is to be read."""

import json
import re
from dataclasses import replace
from pathlib import Path
from typing import Any

import click
import ezdxf
import numpy as np
import pytest
from click.testing import CliRunner

from deltacam import pipeline
from deltacam.cutting.process import DEFAULT_PROCESS
from deltacam.defaults import Defaults
from deltacam.errors import DeltacamError
from deltacam.model import DEFAULT_JOINING, Selection
from deltacam.robot.reader import load_robot
from deltacam.units import METRES_PER
from deltacam_cli import options
from deltacam_cli.plan import command
from tests.cli.test_main import DXF, deltacam


@pytest.fixture
def planned(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> list[dict[str, Any]]:
    """What the pipeline was asked for; nothing is planned."""
    asked: list[dict[str, Any]] = []

    def ask(*_: Any, **given: Any) -> None:
        asked.append(given)
        raise click.exceptions.Exit(0)

    monkeypatch.setattr(pipeline, "plan_to_folder", ask)
    monkeypatch.setattr(click, "get_app_dir", lambda _: str(tmp_path / "settings"))
    monkeypatch.chdir(tmp_path)
    return asked


def run(*arguments: str) -> str:
    """What is on stderr after a run that must get as far as planning."""
    result = CliRunner().invoke(command, ["part.dxf", *arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.stderr


def test_without_options_and_settings_everything_is_built_in(planned: list[dict[str, Any]]) -> None:
    assert run() == ""
    asked = planned[0]
    assert (asked["robot"].name, asked["process"].name) == (pipeline.DEFAULT_ROBOT, DEFAULT_PROCESS)
    assert (asked["unit"], asked["default_unit"], asked["selection"]) == (None, None, Selection())


def test_starts_are_places_of_the_drawing(planned: list[dict[str, Any]]) -> None:
    run("--start-at", "10,0.5in", "--start-at", "-3,7")
    assert planned[0]["search"].starts == ((10e-3, 12.7e-3), (-3e-3, 7e-3))


def test_the_help_names_what_is_built_in_and_every_unit() -> None:
    shown = " ".join(CliRunner().invoke(command, ["--help"]).stdout.split())
    assert pipeline.DEFAULT_ROBOT in shown
    assert DEFAULT_PROCESS in shown
    assert ", ".join(METRES_PER) in shown


def test_layers_and_joining_are_passed_on(planned: list[dict[str, Any]]) -> None:
    run("--layer", "CUT*", "--layer", "HOLES", "--ignore-layer", "Frame", "--join", "0.002in", "--accept-loss")
    expected = Selection(
        layers=("CUT*", "HOLES"), ignored_layers=("Frame",), joining=pytest.approx(50.8e-6), accept_loss=True
    )
    assert planned[0]["selection"] == expected


def test_settings_win_over_what_is_built_in_and_the_command_line_over_both(
    planned: list[dict[str, Any]], tmp_path: Path
) -> None:
    text = 'robot = "irb360-1600"\nprocess = "acrylic-3mm-co2"\nunits = "in"\njoining_mm = 0.05\n'
    (tmp_path / "deltacam.toml").write_text(text)
    assert run() == "note: defaults from deltacam.toml\n"
    assert (planned[0]["robot"].name, planned[0]["process"].name) == ("irb360-1600", "acrylic-3mm-co2")
    assert (planned[0]["unit"], planned[0]["default_unit"]) == (None, "in")
    assert planned[0]["selection"].joining == pytest.approx(5e-5)
    run("--robot", "delta-300", "--process", "steel-1mm-fibre", "--units", "cm", "--join", "0.2", "--kerf", "0.3")
    assert (planned[1]["robot"].name, planned[1]["process"].name) == ("delta-300", "steel-1mm-fibre")
    assert (planned[1]["unit"], planned[1]["default_unit"], planned[1]["process"].kerf) == ("cm", "in", 0.3e-3)
    assert planned[1]["selection"].joining == pytest.approx(2e-4)


def test_the_folder_for_settings_is_looked_at_after_the_current_one(
    planned: list[dict[str, Any]], tmp_path: Path
) -> None:
    (tmp_path / "settings").mkdir()
    (tmp_path / "settings" / "deltacam.toml").write_text('units = "in"\n')
    assert run() == f"note: defaults from {tmp_path / 'settings' / 'deltacam.toml'}\n"
    (tmp_path / "deltacam.toml").write_text('robot = "delta-300"\n')
    assert run() == "note: defaults from deltacam.toml\n"
    assert [asked["default_unit"] for asked in planned] == ["in", None]


def robot_file(folder: Path, jerk: str) -> str:
    """A robot file with that line for the limit of jerk."""
    text = (DXF.parents[2] / "samples" / "robot.toml").read_text()
    changed = re.sub(r"^max_jerk_deg_s3 = .*$", jerk, text, flags=re.MULTILINE)
    assert changed != text
    (folder / "robot.toml").write_text(changed)
    return "robot.toml"


@pytest.mark.parametrize(
    ("arguments", "limits"),
    [
        ([], (1e5, 1e5, 2e5)),
        (["--jerk", "50000"], (5e4,) * 3),
        (["--jerk", f"{np.radians(1e5)}rad/s3"], (1e5,) * 3),
        (["--jerk", "100001"], (100_001.0,) * 3),
        (["--jerk", "none"], None),
        (["--jerk", "0.001"], (1e-3,) * 3),
        (["--jerk", "1e12"], (1e12,) * 3),
    ],
)
def test_a_limit_of_jerk_replaces_that_of_the_robot_and_a_looser_one_is_said(
    planned: list[dict[str, Any]], tmp_path: Path, arguments: list[str], limits: tuple[float, ...] | None
) -> None:
    said = run("--robot", robot_file(tmp_path, "max_jerk_deg_s3 = [100000, 100000, 200000]"), *arguments)
    robot, own = planned[0]["robot"], load_robot("robot.toml")
    assert robot.joints.max_jerk == (None if limits is None else pytest.approx(np.radians(limits)))
    assert robot == replace(own, joints=replace(own.joints, max_jerk=robot.joints.max_jerk))
    assert robot.joints.derived == own.joints.derived
    assert said.startswith("note: --jerk is looser than") is (limits is None or limits[0] > 1e5)
    assert said.count("\n") <= 1


def test_nothing_is_looser_than_no_limit_of_jerk(planned: list[dict[str, Any]], tmp_path: Path) -> None:
    for value in ("5000", "none"):
        assert run("--robot", robot_file(tmp_path, ""), "--jerk", value) == ""


@pytest.mark.parametrize("value", ["0", "-5", "0.0009", "1.1e12", "0.00001rad/s3"])
def test_a_limit_of_jerk_out_of_range_is_refused(value: str) -> None:
    with pytest.raises(DeltacamError, match="deg/s3 is out of range") as caught:
        options.with_jerk(load_robot("delta-300"), value)
    assert caught.value.where == "--jerk"
    assert caught.value.hint == "it must be from 0.001 to 1e+12 deg/s3, or none"


@pytest.mark.parametrize(("arguments", "jobs"), [([], None), (["--jobs", "0"], None), (["--jobs", "3"], 3)])
def test_the_number_of_processes_is_passed_on(
    planned: list[dict[str, Any]], arguments: list[str], jobs: int | None
) -> None:
    run(*arguments)
    assert planned[0]["jobs"] == jobs


@pytest.mark.parametrize("number", ["-1", "65", "two"])
def test_a_number_of_processes_out_of_range_is_refused(number: str) -> None:
    result = CliRunner().invoke(command, ["part.dxf", "--jobs", number])
    assert result.exit_code == 2
    assert "--jobs" in result.stderr


@pytest.mark.parametrize("value", ["0", "-0.1", "0.0001", "5.1", "1in"])
def test_a_joining_distance_out_of_range_is_refused(value: str) -> None:
    with pytest.raises(DeltacamError, match="out of range") as caught:
        options.selection(Defaults(), layers=(), ignored_layers=(), join=value)
    assert (caught.value.where, bool(caught.value.hint)) == ("--join", True)


def test_the_smallest_and_the_largest_joining_distance_are_taken() -> None:
    for value, metres in (("0.001", 1e-6), ("5", 5e-3), (None, DEFAULT_JOINING)):
        found = options.selection(Defaults(), layers=(), ignored_layers=(), join=value)
        assert found.joining == pytest.approx(metres)


@pytest.mark.parametrize(
    ("text", "where", "says"),
    [
        ('robot = "delta-30"', "deltacam.toml: robot", "unknown robot"),
        ('process = "stel"', "deltacam.toml: process", "there is no process"),
        ('robot = "bad.toml"', "bad.toml", "missing"),
        ("kerf = 1", "deltacam.toml", "unknown key"),
    ],
)
def test_a_mistake_in_the_settings_is_said_with_its_place(tmp_path: Path, text: str, where: str, says: str) -> None:
    (tmp_path / "deltacam.toml").write_text(text)
    (tmp_path / "bad.toml").touch()
    (tmp_path / "wrench-inch.program.csv").write_text("old")
    result = deltacam("plan", DXF / "wrench-inch.dxf", "--json", folder=tmp_path)
    assert result.returncode == 2
    error = json.loads(result.stdout)["error"]
    assert error["where"] == where
    assert says in error["what"]
    assert error["hint"]
    assert not (tmp_path / "wrench-inch.program.csv").exists()


def test_the_default_unit_is_for_files_that_state_none_and_is_said(tmp_path: Path) -> None:
    (tmp_path / "deltacam.toml").write_text('units = "mm"\n')
    result = deltacam("plan", DXF / "gear-unitless.dxf", "--json", folder=tmp_path)
    assert result.returncode == 0, result.stdout
    assert result.stderr == "note: defaults from deltacam.toml\n"
    shown = json.loads(result.stdout)
    assert shown["defaults"] == "deltacam.toml"
    assert shown["summary"]["part_size_mm"] == pytest.approx([32.19, 32.03], abs=0.01)
    assert "the file states no unit: it is read in mm as deltacam.toml says" in shown["findings"][0]["what"]
    other = json.loads(deltacam("plan", DXF / "wrench-inch.dxf", "--json", folder=tmp_path).stdout)
    assert other["summary"]["part_size_mm"] == pytest.approx([82.6, 23.8], abs=0.1)
    assert "deltacam.toml" not in json.dumps(other["findings"])


@pytest.mark.parametrize(
    ("drawing", "arguments", "says", "hint"),
    [
        ("redox-r12-polylines", [], "the drawing states no unit: it is 6.3", "state the unit: --units in"),
        ("box-end-openscad", [], "it is 206 x 381.5 mm if its unit is mm", "state the unit: --units mm"),
        ("badges-illustrator", [], "x 297 mm if it is pt", "state the unit: --units pt"),
        ("wrench-inch", ["--units", "m"], "leaves the sheet", "--units in, or take a larger robot"),
        ("case-top-inch", [], "leaves the sheet", "in mm it would be 24.0 x 24.0 mm and fit: --units mm, or"),
    ],
)
def test_a_unit_that_is_missing_or_wrong_is_answered_with_the_one_that_would_fit(
    tmp_path: Path, drawing: str, arguments: list[str], says: str, hint: str
) -> None:
    result = deltacam("plan", DXF / f"{drawing}.dxf", *arguments, folder=tmp_path)
    assert result.returncode == 2
    assert says in result.stderr
    assert hint in result.stderr.splitlines()[-1]


@pytest.fixture
def two_discs(tmp_path: Path) -> Path:
    """A disc of 40 mm on layer A, and one of 20 mm on layer B."""
    document = ezdxf.new()
    document.header["$INSUNITS"] = 4
    document.modelspace().add_circle((0, 0), 20, dxfattribs={"layer": "A"})
    document.modelspace().add_circle((60, 0), 10, dxfattribs={"layer": "B"})
    document.saveas(tmp_path / "discs.dxf")
    return tmp_path / "discs.dxf"


@pytest.mark.parametrize(
    ("arguments", "contours", "width"),
    [([], 2, 90.0), (["--layer", "a"], 1, 40.0), (["--ignore-layer", "A"], 1, 20.0), (["--layer", "?"], 2, 90.0)],
)
def test_only_the_layers_that_count_are_cut_and_verified(
    tmp_path: Path, two_discs: Path, arguments: list[str], contours: int, width: float
) -> None:
    result = deltacam("plan", two_discs, *arguments, "--json", folder=tmp_path)
    assert result.returncode == 0, result.stderr
    summary = json.loads(result.stdout)["summary"]
    assert (summary["contours_cut"], summary["part_size_mm"][0]) == (contours, pytest.approx(width))
    again = deltacam("verify", "discs.program.csv", "--drawing", two_discs, folder=tmp_path)
    assert again.returncode == 0, again.stdout


def test_a_layer_that_the_drawing_does_not_have_is_refused_with_those_it_has(tmp_path: Path, two_discs: Path) -> None:
    result = deltacam("plan", two_discs, "--layer", "CUT", folder=tmp_path)
    assert result.returncode == 2
    assert "--layer: no layer of the drawing is called 'CUT'" in result.stderr
    assert "'A', 'B'" in result.stderr
