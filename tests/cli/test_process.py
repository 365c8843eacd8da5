"""``deltacam process``, and the options that change a process."""

import json
import sys
from dataclasses import replace
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from deltacam.cutting.process import load_process, process_names
from deltacam.errors import DeltacamError
from deltacam.model import Lead, Process, Tabs
from deltacam_cli import main as command_line
from deltacam_cli.main import cli
from deltacam_cli.process_options import with_options

STEEL = load_process("steel-1mm-fibre")
NOTHING = dict.fromkeys(
    ("kerf", "feed", "power", "gas", "tolerance", "corner", "lead_in", "lead_out", "start", "overcut", "tabs", "passes")
)


def run(*arguments: str) -> Result:
    result = CliRunner().invoke(cli, ["process", *arguments], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return result


def refused(*arguments: str) -> DeltacamError:
    result = CliRunner().invoke(cli, ["process", *arguments])
    assert isinstance(result.exception, DeltacamError), result.output
    return result.exception


def changed(process: Process = STEEL, **given: str) -> Process:
    return with_options(process, **{**NOTHING, **given})


def test_every_built_in_process_is_listed() -> None:
    shown = run("list").stdout.splitlines()
    assert [line.split()[0] for line in shown] == ["name", *process_names()]
    listed = json.loads(run("list", "--json").stdout)["processes"]
    assert [one["name"] for one in listed] == list(process_names())
    assert {one["worst_grade"] for one in listed} <= {"vendor", "community", "estimate"}


def test_the_list_can_be_cut_down() -> None:
    found = json.loads(run("list", "--json", "--material", "STEEL", "--laser", "fibre", "--thickness", "0.1cm").stdout)[
        "processes"
    ]
    assert {(one["laser"], one["thickness_mm"]) for one in found} == {("fibre", 1.0)}
    assert {one["material"] for one in found} == {"mild steel", "stainless steel"}
    assert json.loads(run("list", "--json", "--material", "cheese").stdout) == {"processes": []}
    assert "no built-in process" in refused("list", "--material", "cheese").what


def test_show_says_every_value_with_its_unit_grade_and_source() -> None:
    shown = run("show", "acrylic-3mm-co2").stdout
    assert ["kerf_mm", "0.2", "mm", "estimate", "[1]"] in [line.split() for line in shown.splitlines()]
    assert "\n[1] usual value for a 2 inch lens\n" in shown
    values = json.loads(run("show", "acrylic-3mm-co2", "--json").stdout)["values"]
    (power,) = [value for value in values if (value["section"], value["key"]) == ("engrave", "power")]
    assert (power["value"], power["grade"]) == ("0.2", "community")


def test_new_writes_a_file_that_is_the_same_process(tmp_path: Path) -> None:
    file = tmp_path / "mine.toml"
    assert f"wrote {file}" in run("new", str(file), "--from", "mdf-3mm-co2-60w").stdout
    found, given = load_process(file), load_process("mdf-3mm-co2-60w")
    assert found.name == "mine"
    assert (found.kerf, found.feed, found.lead_in, found.provenance) == (
        *(given.kerf, given.feed, given.lead_in, given.provenance),
    )


@pytest.mark.parametrize(
    "arguments", [["new"], ["measured", "steel-1mm-fibre", "--kerf", "0.2", "-o"], ["testcut", "steel-1mm-fibre", "-o"]]
)
def test_nothing_is_written_over(tmp_path: Path, arguments: list[str]) -> None:
    file = tmp_path / ("there.dxf" if arguments[0] == "testcut" else "there.toml")
    file.write_text("mine")
    assert "there already" in refused(*arguments, str(file)).what
    assert file.read_text() == "mine"
    assert "does not end in" in refused(*arguments, str(tmp_path / "there.txt")).what
    assert [path.name for path in tmp_path.iterdir()] == [file.name]


def test_what_was_measured_is_in_the_new_file_and_graded_so(tmp_path: Path) -> None:
    file = tmp_path / "own.toml"
    shown = run(
        "measured", "steel-1mm-fibre", "--gap", "44.22", "--feed", "8.5m/min", "--source", "me", "-o", str(file)
    )
    assert "kerf   0.170 mm, was 0.150" in shown.stdout
    found = load_process(file)
    assert (found.kerf, found.feed, found.name) == (pytest.approx(0.17e-3), pytest.approx(8.5 / 60.0), "own")
    said = {one.key: (one.grade, one.source) for one in found.provenance}
    assert said["kerf_mm"] == said["feed_m_min"] == ("measured", "me")
    assert said["power"][0] == "community"


@pytest.mark.parametrize(
    ("given", "says"),
    [(["--gap", "30"], "kerf"), (["--kerf", "wide"], "not a length"), (["--power", "much"], "not a number")],
)
def test_a_measurement_that_cannot_be_is_refused(tmp_path: Path, given: list[str], says: str) -> None:
    file = tmp_path / "own.toml"
    assert says in refused("measured", "steel-1mm-fibre", *given, "-o", str(file)).what
    assert not file.exists()


@pytest.mark.parametrize("given", [[], ["--kerf", "0.2", "--gap", "44"]])
def test_one_kerf_must_be_measured(tmp_path: Path, given: list[str]) -> None:
    result = CliRunner().invoke(cli, ["process", "measured", "steel-1mm-fibre", *given, "-o", str(tmp_path / "a.toml")])
    assert result.exit_code == 2


@pytest.mark.parametrize("process", ["steel-1mm-fibre", "birch-plywood-3mm-co2-60w"])
def test_a_kerf_comb_is_planned_and_passes_every_check(
    process: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    shown = run("testcut", process, "-o", "comb.dxf").stdout.splitlines()
    assert execute(monkeypatch, f"{shown[1]} --no-what-if") == 0
    assert (tmp_path / "comb.program.csv").exists()


def test_the_commands_of_a_grid_plan_every_square(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    commands = run("testcut", "steel-1mm-fibre", "--kind", "grid", "-o", "grid.dxf").stdout.splitlines()[1:]
    assert len(commands) == 26
    for command in (commands[0], commands[1], commands[-1]):
        assert execute(monkeypatch, f"{command} --no-what-if") == 0
    folders = sorted(path.name for path in (tmp_path / "grid").iterdir())
    assert folders == ["ENGRAVE", "GRID-P100-F8", "GRID-P60-F10"]


def execute(monkeypatch: pytest.MonkeyPatch, line: str) -> int:
    monkeypatch.setattr(sys, "argv", line.split())
    with pytest.raises(SystemExit) as stopped:
        command_line.main()
    return int(stopped.value.code or 0)


def test_options_replace_single_values() -> None:
    found = changed(kerf="0.2", feed="9m/min", power="0.8", corner="loop", start="edge", overcut="0.5", passes="2")
    assert (found.kerf, found.feed, found.power, found.overcut) == pytest.approx((0.2e-3, 0.15, 0.8, 0.5e-3))
    assert (found.corner, found.start, found.passes) == ("loop", "edge", 2)
    assert changed() == STEEL


def test_the_feed_that_is_given_wins_over_that_of_the_gas() -> None:
    assert changed(gas="nitrogen").feed == pytest.approx(0.65 * STEEL.feed)
    assert changed(gas="nitrogen", feed="100").feed == pytest.approx(0.1)


def test_a_feed_outside_of_the_range_is_noted(capsys: pytest.CaptureFixture[str]) -> None:
    changed(feed="9m/min")
    assert not capsys.readouterr().err
    changed(feed="20m/min")
    assert "outside of 8 to 10 m/min" in capsys.readouterr().err
    changed(gas="nitrogen", feed="9m/min")
    assert "outside of 5.2 to 6.5 m/min" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("text", "lead"),
    [
        ("none", Lead()),
        ("line", Lead("line")),
        ("line+arc:auto", Lead("line+arc")),
        ("line:3", Lead("line", 3e-3)),
        ("arc:0.1in", Lead("arc", 2.54e-3)),
    ],
)
def test_a_lead_is_a_shape_with_or_without_a_length(text: str, lead: Lead) -> None:
    assert changed(lead_in=text).lead_in == lead
    assert changed(lead_out=text).lead_out == lead


def test_a_lead_of_the_same_shape_keeps_the_angle_of_the_process() -> None:
    own = replace(STEEL, lead_in=Lead("arc", None, 2e-3, 1.0))
    assert changed(own, lead_in="arc").lead_in == own.lead_in
    assert changed(own, lead_in="arc:3").lead_in == Lead("arc", 3e-3, None, 1.0)
    assert changed(own, lead_in="line").lead_in == Lead("line")


def test_tabs_are_a_number_with_or_without_a_width() -> None:
    own = replace(STEEL, tabs=Tabs(0.3e-3, spacing=50e-3, corner=3e-3, holes=True))
    assert changed(tabs="4").tabs == Tabs(0.5e-3, count=4)
    assert changed(tabs="4:0.8").tabs == Tabs(0.8e-3, count=4)
    assert changed(own, tabs="2").tabs == Tabs(0.3e-3, count=2, corner=3e-3, holes=True)
    assert changed(own, tabs="0").tabs is None


@pytest.mark.parametrize(
    ("option", "text"),
    [
        ("--lead-in", "spiral"),
        ("--lead-in", "line:long"),
        ("--lead-out", "none:3"),
        ("--tabs", "many"),
        ("--tabs", "-2"),
        ("--tabs", "2:wide"),
        ("--passes", "1.5"),
        ("--power", "full"),
        ("--overcut", "far"),
        ("--gas", "argon"),
    ],
)
def test_an_option_that_cannot_be_read_is_named(option: str, text: str) -> None:
    with pytest.raises(DeltacamError) as caught:
        changed(**{option.removeprefix("--").replace("-", "_"): text})
    assert caught.value.where == option
    assert caught.value.hint
