"""``deltacam robot import``: the robot file on stdout or in a file, and what became of the other program's file."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from deltacam.robot.importers.formats import FORMATS
from deltacam.robot.reader import load_robot
from deltacam_cli import main as command_line
from deltacam_cli.robot import import_

ROBOTS = Path(__file__).parents[1] / "data" / "robots"
PRINTER = str(ROBOTS / "printer.cfg")
CLASSIC = (str(ROBOTS / "classic.txt"), "--sheet", "300x300@-650", "--speed", "60m/min", "--acceleration", "23")


def run(*arguments: str | Path) -> Result:
    return CliRunner().invoke(command_line.cli, ["robot", "import", *map(str, arguments)], catch_exceptions=False)


def failed(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, *arguments: str) -> tuple[int, str]:
    """The exit code and stderr of a command that is refused."""
    monkeypatch.setattr("sys.argv", ["deltacam", "robot", "import", *arguments])
    with pytest.raises(SystemExit) as stopped:
        command_line.main()
    return int(stopped.value.code or 0), capsys.readouterr().err


def test_the_formats_of_the_option_are_those_that_are_read() -> None:
    assert tuple(FORMATS) == import_.NAMES


def test_without_an_output_the_robot_file_is_on_stdout_and_the_listing_on_stderr(tmp_path: Path) -> None:
    result = run(PRINTER, "--sheet", "r60")
    path = tmp_path / "robot.toml"
    path.write_text(result.stdout)
    assert load_robot(path).name == "printer"
    assert "not used: " in result.stderr
    assert "[printer] minimum_z_position -2" in result.stderr


def test_with_an_output_the_listing_is_on_stdout(tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    result = run(PRINTER, "--sheet", "r60", "-o", path, "--name", "mine")
    assert load_robot(path).name == "mine"
    assert "joints.max_deg: the file gives no such limit" in result.stdout
    assert result.stdout.endswith("robot.toml\n")
    assert result.stderr == ""


def test_json_holds_the_robot_its_file_and_the_ledger(tmp_path: Path) -> None:
    found = json.loads(run(PRINTER, "--sheet", "r60", "--json").stdout)
    path = tmp_path / "robot.toml"
    path.write_text(found["toml"])
    assert load_robot(path).fingerprint == found["robot"]["fingerprint"]
    assert found["estimates"][0]["key"] == "joints.max_deg"
    assert len(found["unused"]) > 5
    assert {"source", "value", "became"} == set(found["read"][0])


def test_all_options_reach_the_robot() -> None:
    result = run(*CLASSIC, "--joints-at", "middles", "--joints=-45..95", "--from", "classic", "--units", "mm", "--json")
    robot = json.loads(result.stdout)["robot"]
    assert robot["tool"] == {"max_speed": 1.0, "max_acceleration": 23.0}
    assert robot["joints"]["min"] == pytest.approx([-0.7853981633974483] * 3)
    assert robot["workspace"]["sheet_z"] == -0.65


def test_what_is_missing_is_asked_for(capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    code, message = failed(capsys, monkeypatch, PRINTER)
    assert code == 2
    assert "does not say the sheet" in message
    assert "hint: say it: --sheet 300x300" in message


def test_the_source_is_never_overwritten(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    copy = tmp_path / "printer.cfg"
    copy.write_bytes((ROBOTS / "printer.cfg").read_bytes())
    code, message = failed(capsys, monkeypatch, str(copy), "--sheet", "r60", "-o", str(copy))
    assert code == 2
    assert "would overwrite what it is made from" in message
    assert copy.read_bytes() == (ROBOTS / "printer.cfg").read_bytes()


def test_a_name_of_control_characters_cannot_reach_the_terminal(tmp_path: Path) -> None:
    path = tmp_path / "a\x1b[31m.cfg"
    path.write_bytes((ROBOTS / "printer.cfg").read_bytes())
    result = run(path, "--sheet", "r60")
    assert "\x1b" not in result.stdout + result.stderr
