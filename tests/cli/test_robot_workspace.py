"""``deltacam robot workspace``."""

import json
from pathlib import Path

import pytest
from click.testing import CliRunner

from deltacam.errors import DeltacamError
from deltacam_cli.main import cli


def run(*arguments: str) -> str:
    result = CliRunner().invoke(cli, ["robot", "workspace", *arguments], catch_exceptions=False)
    assert result.exit_code == 0
    return result.stdout


def test_the_workspace_is_shown_as_text_and_as_a_page(tmp_path: Path) -> None:
    page = tmp_path / "workspace.html"
    shown = run("delta-300", "--height", "20", "--html", str(page))
    assert shown.count("20.0 mm high") == 2
    assert f"wrote {page}" in shown
    assert page.read_text().count('class="chart"') == 6


def test_json_has_the_proved_numbers() -> None:
    found = json.loads(run("delta-300", "--height", "20", "--slices", "1", "--json"))
    assert found["sheet"]["verdict"] == found["cylinder"]["verdict"] == found["box"]["verdict"] == "certified"
    assert len(found["slices"]) == 1
    volume = found["volume_m3"]
    assert volume["proved_at_least"] < volume["about"] < volume["proved_at_most"]
    for shape in ("sheet", "cylinder", "box"):
        assert all(0.0 <= margin["proved"] <= margin["found"] for margin in found[shape]["margins"].values())


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
    with pytest.raises(DeltacamError, match=said) as refused:
        run("delta-300", *wish)
    assert refused.value.hint
