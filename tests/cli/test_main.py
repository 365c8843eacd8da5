"""The command line as a user meets it: a real process, its output and its exit code."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest

DXF = Path(__file__).parent.parent / "data" / "dxf"
HEAVY = ("toppra", "matplotlib", "ezdxf", "shapely", "scipy", "plotly", "numpy", "distributed", "filelock")


def deltacam(*arguments: str | Path, folder: Path) -> subprocess.CompletedProcess[str]:
    """Run the command as the installed script does."""
    code = "from deltacam_cli.main import main; main()"
    return subprocess.run(
        [sys.executable, "-c", code, *map(str, arguments)],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path), "XDG_CONFIG_HOME": str(folder / "none")},
        capture_output=True,
        text=True,
        check=False,
    )


def test_help_loads_nothing_heavy(tmp_path: Path) -> None:
    code = (
        "import sys; from deltacam_cli.main import cli\n"
        "cli.main(['--help'], standalone_mode=False)\n"
        f"print([m for m in {HEAVY} if m in sys.modules], file=sys.stderr)"
    )
    run = subprocess.run([sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=True)
    assert run.stderr.strip() == "[]"
    assert "plan" in run.stdout
    assert "verify" in run.stdout


@pytest.mark.parametrize(
    "arguments",
    [["--help"], ["plan", "--help"], ["verify", "--help"], ["inspect", "--help"], ["export", "--help"], ["--version"]],
)
def test_help_and_version_are_on_stdout(tmp_path: Path, arguments: list[str]) -> None:
    run = deltacam(*arguments, folder=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    assert "deltacam" in run.stdout


def test_plan_and_verify_a_part(tmp_path: Path) -> None:
    run = deltacam("plan", DXF / "wrench-inch.dxf", "-o", "out", folder=tmp_path)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout.startswith("PASSED")
    assert "steel-1mm-fibre" in run.stdout
    assert "wrote out/wrench-inch.program.csv" in run.stdout
    again = deltacam("verify", "out/wrench-inch.program.csv", "--drawing", DXF / "wrench-inch.dxf", folder=tmp_path)
    assert again.returncode == 0
    assert again.stdout.startswith("PASSED")


def test_json_is_one_object(tmp_path: Path) -> None:
    run = deltacam("plan", DXF / "wrench-inch.dxf", "--json", folder=tmp_path)
    result = json.loads(run.stdout)
    assert result["passed"] is True
    assert result["files"] == [f"wrench-inch.{end}" for end in ("program.csv", "report.json", "report.html")]
    assert result.pop("defaults") is None
    assert result == {**json.loads((tmp_path / "wrench-inch.report.json").read_text()), "files": result["files"]}
    refused = deltacam("plan", "none.dxf", "--json", folder=tmp_path)
    assert refused.returncode == 2
    assert json.loads(refused.stdout)["error"]["where"] == "none.dxf"


def test_values_with_units_override_the_process(tmp_path: Path) -> None:
    options = ["--kerf", "0.008in", "--feed", "6m/min", "--tolerance", "0.03", "--rotate", "90", "--at", "10,-5mm"]
    run = deltacam("plan", DXF / "wrench-inch.dxf", *options, folder=tmp_path)
    assert run.returncode == 0, run.stderr
    meta = json.loads((tmp_path / "wrench-inch.program.csv").read_text().splitlines()[1].removeprefix("# "))
    assert meta["process"]["kerf"] == pytest.approx(0.008 * 25.4e-3)
    assert meta["process"]["feed"] == pytest.approx(0.1)
    assert meta["process"]["tolerance"] == pytest.approx(3e-5)
    assert meta["placement"]["rotation_rad"] == pytest.approx(1.5707963)


def test_an_edited_program_fails_with_exit_code_1(tmp_path: Path) -> None:
    deltacam("plan", DXF / "wrench-inch.dxf", folder=tmp_path)
    program = tmp_path / "wrench-inch.program.csv"
    lines = program.read_text().splitlines(keepends=True)
    program.write_text("".join([*lines[:300], *lines[301:]]))
    run = deltacam("verify", program, folder=tmp_path)
    assert run.returncode == 1
    assert run.stdout.startswith("FAILED")
    assert "tick" in run.stdout


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["plan", "none.dxf"], "no such file"),
        (["plan", "text.dxf"], "not a DXF"),
        (["plan", "wrench.dxf", "--kerf", "-1"], "-1 mm"),
        (["plan", "wrench.dxf", "--kerf", "wide"], "--kerf"),
        (["plan", "wrench.dxf", "--feed", "fast"], "--feed"),
        (["plan", "wrench.dxf", "--at", "here"], "--at"),
        (["plan", "wrench.dxf", "--rotate", "90x"], "--rotate"),
        (["plan", "wrench.dxf", "--jerk", "much"], "error: --jerk: 'much' is not a jerk"),
        (["plan", "wrench.dxf", "--jerk", "5mm/s3"], "error: --jerk: unknown unit of jerk 'mm/s3'"),
        (["plan", "wrench.dxf", "--jerk", "-1"], "error: --jerk: -1 deg/s3 is out of range"),
        (["plan", "wrench.dxf", "--at", "150,0"], "leaves the sheet"),
        (["plan", "wrench.dxf", "--units", "ell"], "ell"),
        (["plan", "wrench.dxf", "--join", "9"], "--join"),
        (["plan", "wrench.dxf", "--layer", ""], "--layer"),
        (["plan", "wrench.dxf", "--robot", "delta-30"], "delta-300"),
        (["plan", "wrench.dxf", "--robot", "bad.toml"], "base_radius_mm"),
        (["plan", "wrench.dxf", "--process", "stel-1mm-fibre"], "steel-1mm-fibre"),
        (["plan", "wrench.dxf", "-o", "text.dxf"], "not a folder"),
    ],
)
def test_what_the_user_must_change_is_said_with_exit_code_2(tmp_path: Path, arguments: list[str], says: str) -> None:
    (tmp_path / "wrench.dxf").write_bytes((DXF / "wrench-inch.dxf").read_bytes())
    (tmp_path / "text.dxf").write_text("hello")
    (tmp_path / "bad.toml").write_text('name = "x"\n[geometry]\nbase_radus_mm = 100\n')
    (tmp_path / "wrench.program.csv").write_text("old")
    run = deltacam(*arguments, folder=tmp_path)
    assert run.returncode == 2
    assert says in run.stderr
    assert "\nhint: " in run.stderr
    assert "..." not in run.stderr
    assert "Traceback" not in run.stderr
    assert run.stdout == ""
    left = {path.name for path in tmp_path.iterdir()}
    assert left <= {"wrench.dxf", "text.dxf", "bad.toml", "wrench.program.csv"}
    assert ("wrench.program.csv" in left) == (arguments[-2:] == ["-o", "text.dxf"] or arguments[1] != "wrench.dxf")


@pytest.mark.parametrize(
    "arguments",
    [["plan"], ["plan", "a.dxf", "--bogus"], ["cut", "a.dxf"], ["a.dxf"], ["plan", "a.dxf", "--dry-run", "--frame"]],
)
def test_a_wrong_command_line_exits_with_2(tmp_path: Path, arguments: list[str]) -> None:
    run = deltacam(*arguments, folder=tmp_path)
    assert run.returncode == 2
    assert "deltacam" in run.stderr + run.stdout
    assert "Traceback" not in run.stderr


def test_a_name_from_a_stranger_cannot_command_the_terminal(tmp_path: Path) -> None:
    run = deltacam("plan", "\x1b[31mred\x07.dxf", folder=tmp_path)
    assert run.returncode == 2
    assert "\x1b" not in run.stderr
    assert "\x07" not in run.stderr


def test_a_fault_of_ours_is_exit_code_3_and_asks_for_a_report(tmp_path: Path) -> None:
    code = (
        "import deltacam.pipeline as p\n"
        "def broken(*a, **k): raise ZeroDivisionError('x')\n"
        "p.plan_to_folder = broken\n"
        "from deltacam_cli.main import main; main()"
    )
    for flag in ([], ["--traceback"]):
        run = subprocess.run(
            [sys.executable, "-c", code, *flag, "plan", "a.dxf"],
            cwd=tmp_path,
            env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert run.returncode == 3
        assert "ZeroDivisionError" in run.stderr
        assert "report it" in run.stderr
        assert ("Traceback" in run.stderr) == bool(flag)


def test_an_interrupt_leaves_nothing_half_written(tmp_path: Path) -> None:
    code = (
        "import deltacam.pipeline as p, os, signal\n"
        "def interrupted(*a, **k): os.kill(os.getpid(), signal.SIGINT)\n"
        "p.listing.to_json = interrupted\n"
        "from deltacam_cli.main import main; main()"
    )
    run = subprocess.run(
        [sys.executable, "-c", code, "plan", str(DXF / "wrench-inch.dxf")],
        cwd=tmp_path,
        env={**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)},
        capture_output=True,
        text=True,
        check=False,
    )
    assert run.returncode == 130
    assert "interrupted" in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_reader_that_goes_away_is_no_fault_and_no_failed_check(tmp_path: Path) -> None:
    command = [sys.executable, "-c", "from deltacam_cli.main import main; main()", "plan", str(DXF / "wrench-inch.dxf")]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    child = subprocess.Popen(
        command, cwd=tmp_path, env=environment, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
    )
    assert child.stdout is not None
    assert child.stderr is not None
    child.stdout.close()
    assert child.stderr.read() == ""
    child.stderr.close()
    assert child.wait() == 141


@pytest.mark.parametrize("arguments", [["plna", "a.dxf"], ["plan", "a.dxf", "--corner", "slow"]])
def test_a_wrong_command_line_is_answered_like_any_other_error(tmp_path: Path, arguments: list[str]) -> None:
    run = deltacam(*arguments, folder=tmp_path)
    assert run.returncode == 2
    assert run.stderr.startswith("error: ")
    assert "\nhint: see `deltacam" in run.stderr
