"""``deltacam robot design``."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from deltacam.errors import DeltacamError
from deltacam.robot.reader import load_robot
from deltacam_cli.main import cli

SMALL = ("--box", "100,100,20", "--condition", "0.25", "--base-radius-min", "60", "--head-radius", "30")


def run(*arguments: str) -> str:
    result = CliRunner().invoke(cli, ["robot", "design", *arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result.stdout


def test_a_design_is_shown_and_written(tmp_path: Path) -> None:
    robot, page = tmp_path / "own.toml", tmp_path / "own.html"
    shown = run(*SMALL, "-o", str(robot), "--html", str(page))
    assert "certified over the whole workspace" in shown
    assert "1/cond" in shown
    assert f"wrote {robot}" in shown
    assert page.read_text().count('class="chart"') == 1
    assert load_robot(robot).workspace.width == pytest.approx(0.1)


def test_json_has_the_dimensions_and_the_margins() -> None:
    found = json.loads(run(*SMALL, "--json"))
    assert found["effector_radius_mm"] == pytest.approx(30.0)
    assert found["certificate"]["verdict"] == "certified"
    assert found["demands"]["inverse_condition"]["limit"] == pytest.approx(0.25)
    low, high = found["workspace_z_mm"]
    assert high - low == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ((), "Usage"),
        (("--box", "1,2,3", "--cylinder", "3,4"), "either a box or a cylinder"),
        (("--box", "100,100"), "is not 3 numbers"),
        (("--box", "100,100,20", "--joint-range", "90"), "is not 2 numbers"),
        (("--box", "100,100,20", "-o", "robot.txt", "--condition", "0.2"), "not the name of a robot file"),
    ],
)
def test_a_wrong_command_line_says_what_to_type(arguments: tuple[str, ...], message: str) -> None:
    result = CliRunner().invoke(cli, ["robot", "design", *arguments])
    said = str(result.exception) if isinstance(result.exception, DeltacamError) else result.output
    assert message in said
