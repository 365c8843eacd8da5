"""``deltacam robot show``."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from deltacam.errors import DeltacamError
from deltacam.robot.reader import profile_names
from deltacam_cli.main import cli


def run(*arguments: str) -> str:
    result = CliRunner().invoke(cli, ["robot", "show", *arguments], catch_exceptions=False)
    assert result.exit_code == 0
    return result.stdout


@pytest.mark.parametrize("name", profile_names())
def test_every_built_in_robot_is_shown(name: str) -> None:
    found = json.loads(run(name, "--json"))
    assert found["name"] == name
    assert found["tool_speed_allowed"]["worst_m_s"] > 0.0


def test_limits_say_where_they_come_from(tmp_path: Path) -> None:
    own = tmp_path / "own.toml"
    text = (Path(__file__).parents[2] / "samples" / "robot.toml").read_text()
    own.write_text(text.replace("# max_speed_deg_s = 147.2", "max_speed_deg_s = 120"))
    shown = run(str(own))
    speed, acceleration = (next(line for line in shown.splitlines() if kind in line) for kind in ("deg/s ", "deg/s2"))
    assert "120  " in speed
    assert "robot file" in speed
    assert "derived from the tool" in acceleration
    assert "note: the joints do not allow the rated speed everywhere" in shown
    assert "note" not in run()


def test_a_base_that_is_mounted_says_how(tmp_path: Path) -> None:
    own = tmp_path / "own.toml"
    text = (Path(__file__).parents[2] / "samples" / "robot.toml").read_text()
    mounted = text.replace("# z_mm = 0", "z_mm = -1300").replace("# upside_down = false", "upside_down = true")
    own.write_text(mounted)
    assert "base at (0, 0, -1300) mm, upside down" in run(str(own))


def test_a_page_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    page = tmp_path / "robot.html"
    assert f"wrote {page}" in run("delta-300", "--html", str(page))
    assert page.read_text().count('class="chart"') == 4
    with pytest.raises(DeltacamError, match=r"robot\.html") as refused:
        run("delta-300", "--html", str(tmp_path / "missing" / "robot.html"))
    assert "--html" in refused.value.hint
