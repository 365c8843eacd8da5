"""Verifying one program or many: what is shown, what is written, and the exit code."""

import json
import shutil
from pathlib import Path

import pytest

from tests.cli.test_main import deltacam

SAMPLES = Path(__file__).parents[2] / "samples"
DXF = Path(__file__).parents[1] / "data" / "dxf"
CUBIC = """
name = "cubic"
[geometry]
base_radius_mm = 130
effector_radius_mm = 35
upper_arm_mm = 300
forearm_mm = 600
[joints]
min_deg = -60
max_deg = 100
[tool]
max_speed_m_min = 60
max_acceleration_m_s2 = 23
[workspace]
sheet_z_mm = -550
radius_mm = 150
[controller]
interpolation = "cubic"
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with programs of two samples, one of them in two ways and one edited."""
    folder = tmp_path_factory.mktemp("programs")
    for name, into, *options in (
        ("bracket", "new"),
        ("bracket", "old", "--feed", "120"),
        ("gear", "new"),
    ):
        run = deltacam("plan", SAMPLES / f"{name}.dxf", "-o", into, *options, folder=folder)
        assert run.returncode == 0, run.stderr
    rows = (folder / "new" / "bracket.program.csv").read_text()
    (folder / "edited.program.csv").write_text(rows.replace(",1,2\n", ",0,2\n", 1))
    return folder


def test_several_programs_are_verified_with_their_own_drawings(folder: Path) -> None:
    programs = ["new/bracket.program.csv", "new/gear.program.csv"]
    run = deltacam("verify", *programs, "--drawing", SAMPLES, folder=folder)
    assert (run.returncode, run.stderr) == (0, "")
    assert [line for line in run.stdout.splitlines() if line.startswith(("PASSED", "new/"))] == [
        "new/bracket.program.csv:",
        "PASSED  bracket.dxf (cut): all 52 checks",
        "new/gear.program.csv:",
        "PASSED  gear.dxf (cut): all 52 checks",
    ]
    assert run.stdout.endswith("2 of 2 programs passed\n")


@pytest.mark.parametrize(
    ("programs", "code", "passed"),
    [
        (["new/gear.program.csv", "edited.program.csv"], 1, [True, False]),
        (["new/gear.program.csv", "missing.program.csv", "edited.program.csv"], 2, [True, False, False]),
    ],
)
def test_one_bad_program_does_not_stop_the_others(
    folder: Path, programs: list[str], code: int, passed: list[bool]
) -> None:
    run = deltacam("verify", *programs, "--json", folder=folder)
    found = json.loads(run.stdout)
    assert (run.returncode, found["passed"]) == (code, False)
    assert [one["program"] for one in found["programs"]] == programs
    assert [one["passed"] for one in found["programs"]] == passed
    if code == 2:
        assert found["programs"][1]["error"]["what"] == "there is no such file"
        assert "error: missing.program.csv: there is no such file" in run.stderr


def test_strict_wants_every_check_to_be_made(folder: Path) -> None:
    program = "new/bracket.program.csv"
    assert deltacam("verify", program, folder=folder).returncode == 0
    strict = deltacam("verify", program, "--strict", folder=folder)
    assert strict.returncode == 1
    assert "error: not passed with --strict: not checked without the drawing" in strict.stderr
    whole = deltacam("verify", program, "--strict", "--drawing", SAMPLES / "bracket.dxf", folder=folder)
    assert (whole.returncode, whole.stderr) == (0, "")


def test_strict_fails_where_a_check_warns(tmp_path: Path) -> None:
    """Cubic interpolation without a limit of jerk accelerates more between the ticks than at them."""
    (tmp_path / "cubic.toml").write_text(CUBIC)
    drawing, program = SAMPLES / "bracket.dxf", "bracket.program.csv"
    planned = deltacam("plan", drawing, "--robot", "cubic.toml", folder=tmp_path)
    assert planned.returncode == 0, planned.stdout
    assert "51 of 52 checks; warning: joint acceleration between ticks" in planned.stdout
    assert deltacam("verify", program, "--drawing", drawing, folder=tmp_path).returncode == 0
    strict = deltacam("verify", program, "--drawing", drawing, "--strict", "--json", folder=tmp_path)
    found = json.loads(strict.stdout)
    assert (strict.returncode, found["passed"]) == (1, False)
    assert found["warnings"] == ["joint acceleration between ticks"]


def test_every_check_is_listed_only_where_that_is_asked_for(folder: Path) -> None:
    program = "new/bracket.program.csv"
    assert "joint speed between ticks" not in deltacam("verify", program, folder=folder).stdout
    assert "  ok  joint speed between ticks " in deltacam("verify", program, "--checks", folder=folder).stdout


def test_the_page_is_written_where_it_is_wanted(folder: Path, tmp_path: Path) -> None:
    one = deltacam("verify", "new/gear.program.csv", "--html", tmp_path / "gear.html", folder=folder)
    assert f"wrote {tmp_path / 'gear.html'}" in one.stdout
    assert "<title>gear" in (tmp_path / "gear.html").read_text()
    several = ["new/gear.program.csv", "edited.program.csv"]
    deltacam("verify", *several, "--html", tmp_path / "pages", folder=folder)
    assert sorted(path.name for path in (tmp_path / "pages").iterdir()) == ["edited.report.html", "gear.report.html"]
    assert "failed</title>" in (tmp_path / "pages" / "edited.report.html").read_text()


def test_a_page_overwrites_nothing_that_it_is_made_from(folder: Path) -> None:
    program = folder / "new" / "gear.program.csv"
    before = program.read_bytes()
    run = deltacam("verify", program, "--html", program, folder=folder)
    assert (run.returncode, program.read_bytes()) == (2, before)
    assert "the page would overwrite what it is made from" in run.stderr
    twice = ["new/bracket.program.csv", "old/bracket.program.csv", "--html", "pages"]
    run = deltacam("verify", *twice, folder=folder)
    assert run.returncode == 2
    assert "several programs would write bracket.report.html" in run.stderr
    assert not (folder / "pages").exists()


def test_a_page_that_cannot_be_written_is_said_with_the_option(folder: Path) -> None:
    run = deltacam("verify", "new/gear.program.csv", "--html", "missing/gear.html", folder=folder)
    assert run.returncode == 2
    assert "hint: choose another file with --html" in run.stderr


def test_a_folder_of_drawings_is_not_left_by_what_a_program_says(folder: Path, tmp_path: Path) -> None:
    shutil.copy(SAMPLES / "gear.dxf", tmp_path)
    (tmp_path / "inside").mkdir()
    text = (folder / "new" / "gear.program.csv").read_text().replace('"file":"gear.dxf"', '"file":"../gear.dxf"')
    (tmp_path / "away.program.csv").write_text(text)
    run = deltacam("verify", "away.program.csv", "--drawing", "inside", folder=tmp_path)
    assert run.returncode == 2
    assert "there is no such file" in run.stderr


def test_against_says_what_is_different(folder: Path) -> None:
    programs = "new/bracket.program.csv", "--against", "old/bracket.program.csv"
    run = deltacam("verify", *programs, folder=folder)
    assert run.returncode == 0
    shown = run.stdout.partition("what is different\n")[2]
    assert "\n  process.feed: 0.12 -> 0.15\n" in shown
    assert "\n  feed while cutting: " in shown
    assert "um apart, " in shown
    found = json.loads(deltacam("verify", *programs, "--json", folder=folder).stdout)["difference"]
    assert found["duration_s"][0] > found["duration_s"][1]
    assert found["settings"] == {"process.feed": [0.12, 0.15]}
    assert [one["contour"] for one in found["contours"]] == list(range(1, 14))


def test_against_itself_nothing_is_different(folder: Path, tmp_path: Path) -> None:
    shutil.copy(folder / "new" / "gear.program.csv", tmp_path / "copy.program.csv")
    run = deltacam("verify", "new/gear.program.csv", "--against", tmp_path / "copy.program.csv", folder=folder)
    shown = run.stdout.partition("what is different\n")[2].splitlines()
    assert [line.strip().partition(" (")[0] for line in shown if line] == [
        shown[0].strip().partition(" (")[0],
        "8 contours are cut alike",
    ]
    assert shown[0].endswith("(+0.0000 s)")


def test_against_goes_with_one_program(folder: Path) -> None:
    several = ["new/gear.program.csv", "edited.program.csv", "--against", "old/bracket.program.csv"]
    run = deltacam("verify", *several, folder=folder)
    assert run.returncode == 2
    assert "--against compares one program with one other" in run.stderr
