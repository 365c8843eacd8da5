"""``deltacam robot workspace``."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from deltacam_cli.main import main


def test_the_workspace_is_shown_as_text_page_and_json(tmp_path: Path) -> None:
    page = tmp_path / "workspace.html"
    result = CliRunner().invoke(main, ["robot", "workspace", "delta-300", "--height", "20", "--html", str(page)])
    assert result.exit_code == 0, result.output
    assert "largest cylinder" in result.output
    assert "20.0 mm high" in result.output
    assert "Section along x" in page.read_text()
    result = CliRunner().invoke(main, ["robot", "workspace", "delta-300", "--slices", "1", "--json"])
    found = json.loads(result.output)
    assert found["sheet"]["verdict"] == found["cylinder"]["verdict"] == found["box"]["verdict"] == "certified"
    assert len(found["slices"]) == 1
    volume = found["volume_m3"]
    assert volume["proved_at_least"] < volume["about"] < volume["proved_at_most"]


@pytest.mark.parametrize(
    ("wish", "said"),
    [
        (["--height", "-3"], "not above 0"),
        (["--slices", "0"], "not 1 to 200"),
        (["--min-inverse-condition", "1.5"], "not in 0 to 1"),
        (["--min-inverse-condition", "0.99"], "no pose of the robot keeps all requirements"),
        (["--height", "900"], "no cylinder 900 mm high"),
    ],
)
def test_an_impossible_wish_is_refused_with_a_hint(wish: list[str], said: str) -> None:
    result = CliRunner().invoke(main, ["robot", "workspace", "delta-300", *wish])
    assert result.exit_code == 2
    assert said in result.output
    assert "hint:" in result.output
