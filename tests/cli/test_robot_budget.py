"""``deltacam robot budget``."""

import json
import re
from pathlib import Path

import pytest
from click.testing import CliRunner

from deltacam_cli.robot.budget import command


def run(*arguments: str) -> str:
    done = CliRunner().invoke(command, arguments, catch_exceptions=False)
    assert done.exit_code == 0
    return done.output


def test_it_says_whether_the_tolerance_is_kept_and_which_source_is_the_largest() -> None:
    shown = run("delta-300")
    assert re.search(r"tolerance +NOT within the 20.0 um of steel-1mm-fibre", shown)
    assert "largest source          forearm: 36 %" in shown
    assert "what they must be for 95 % within 0.02 mm in x and y" in shown


def test_the_defaults_are_those_of_the_library_and_printed() -> None:
    import inspect

    from deltacam.robot.accuracy.sources import Errors, Source
    from deltacam_cli.robot.budget import _errors

    options = {option.name: option.default for option in command.params}
    assert _errors({source.value: options[source.value] for source in Source}) == Errors()
    assert set(inspect.signature(Errors).parameters) == {source.value for source in Source}


def test_json_has_every_source_and_finite_numbers() -> None:
    found = json.loads(run("irb360-1600", "--json", "--sheet-error", "0", "--wanted", "0.3mm"))
    assert len(found["sources"]) == 8
    assert sum(one["share_in_plane"] for one in found["sources"]) == pytest.approx(1.0)
    assert found["within_tolerance"] is False
    assert found["wanted"]["wanted_um"] == pytest.approx(300.0)
    assert found["sources"][0]["given_arcmin"] == pytest.approx(360 * 60 / 2**16)


def test_a_machine_without_errors_is_within_every_tolerance() -> None:
    nothing = [f"{option}=0" for option in ("--encoder", "--backlash", "--azimuth-error", "--sheet-error")]
    nothing += [f"--{part}-error=0" for part in ("arm", "forearm", "base", "effector")]
    shown = run("delta-300", *nothing)
    assert re.search(r"tolerance +within the 20.0 um", shown)
    assert "largest source" not in shown


def test_the_page_has_both_maps(tmp_path: Path) -> None:
    page = tmp_path / "budget.html"
    run("delta-300", "--html", str(page))
    text = page.read_text()
    assert "error in x and y over the sheet" in text
    assert "error of the height above the sheet" in text


@pytest.mark.parametrize(
    ("arguments", "where"),
    [
        (["--encoder", "fine"], "--encoder"),
        (["--encoder", "1mm"], "--encoder"),
        (["--arm-error", "-0.1"], "--arm-error"),
        (["--forearm-error", "1m"], "--forearm-error"),
        (["--azimuth-error", "90"], "--azimuth-error"),
        (["--wanted", "0"], "--wanted"),
        (["--wanted", "1m"], "--wanted"),
    ],
)
def test_a_wrong_value_is_refused_by_the_name_of_its_option(arguments: list[str], where: str) -> None:
    from deltacam.errors import DeltacamError

    with pytest.raises(DeltacamError) as refused:
        CliRunner().invoke(command, ["delta-300", *arguments], catch_exceptions=False)
    assert refused.value.where == where
    assert refused.value.hint
