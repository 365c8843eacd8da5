"""``deltacam batch``: a folder through the command line, as a shop would run it."""

import json
import os
import pty
import shutil
import signal
import subprocess
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import ezdxf
import pytest

from deltacam.program.formats import read_program
from tests.cli.test_main import deltacam

QUICK = ("--no-what-if", "--jobs", "1")


def draw(path: Path, *, radius: float = 5.0, units: int = 4) -> None:
    """A drawing of one circle; ``units`` as in the header: 4 is mm, 0 none."""
    path.parent.mkdir(parents=True, exist_ok=True)
    document = ezdxf.new(units=units)
    document.modelspace().add_circle((0.0, 0.0), radius)
    document.saveas(path)


@pytest.fixture(scope="module")
def ran(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, subprocess.CompletedProcess[str]]:
    """A folder whose batch is over: two parts that pass, two that are refused."""
    folder = tmp_path_factory.mktemp("batch")
    draw(folder / "parts" / "disc.dxf")
    draw(folder / "parts" / "small" / "disc.dxf", radius=2.0)
    draw(folder / "parts" / "small" / "unitless.dxf", units=0)
    (folder / "parts" / "broken.dxf").write_text("this is no drawing\n")
    (folder / "parts" / "old.dwg").write_bytes(b"AC1032")
    (folder / "parts" / "batch.toml").write_text('[[part]]\npattern = "small/*"\nquantity = 3\n')
    return folder, deltacam("batch", "parts", *QUICK, folder=folder)


def results(folder: Path, output: str = "out") -> dict[str, dict[str, Any]]:
    """The parts in ``batch.json`` by their names."""
    return {part["part"]: part for part in json.loads((folder / output / "batch.json").read_text())["parts"]}


def tree(folder: Path) -> dict[str, bytes]:
    """Every file of a folder of results but the lock."""
    files = (path for path in folder.rglob("*") if path.is_file() and path.name != "lock")
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in files}


def test_one_row_for_every_drawing_with_its_reason(ran: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    folder, done = ran
    assert done.returncode == 1
    rows = results(folder)
    assert {name: row["status"] for name, row in rows.items()} == {
        "broken.dxf": "refused",
        "disc.dxf": "passed",
        "small/disc.dxf": "passed",
        "small/unitless.dxf": "refused",
    }
    assert "unit" in rows["small/unitless.dxf"]["reason"]["what"]
    assert rows["small/unitless.dxf"]["reason"]["hint"]
    assert done.stdout.startswith("FAILED  2 of 4 parts passed")
    assert "small/unitless.dxf" in done.stdout
    assert "old.dwg" in done.stdout
    assert "Traceback" not in done.stdout + done.stderr


def test_subfolders_are_mirrored_and_only_passed_parts_have_a_program(
    ran: tuple[Path, subprocess.CompletedProcess[str]],
) -> None:
    out = ran[0] / "out"
    programs = sorted(path.relative_to(out).as_posix() for path in out.rglob("*.program.csv"))
    assert programs == ["disc.program.csv", "small/disc.program.csv"]
    assert read_program(out / "small" / "disc.program.csv").duration < read_program(out / "disc.program.csv").duration
    assert '<script src="../plotly.min.js">' in (out / "small" / "disc.report.html").read_text()
    assert (out / "plotly.min.js").stat().st_size > 1_000_000


def test_a_program_has_the_bytes_that_plan_writes(
    ran: tuple[Path, subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    folder, _ = ran
    assert deltacam("plan", folder / "parts" / "disc.dxf", "--no-what-if", folder=tmp_path).returncode == 0
    for name in ("disc.program.csv", "disc.report.json"):
        assert (tmp_path / name).read_bytes() == (folder / "out" / name).read_bytes()


def test_the_quantity_of_the_rules_counts_in_the_totals(ran: tuple[Path, subprocess.CompletedProcess[str]]) -> None:
    folder, _ = ran
    assert [row["quantity"] for row in results(folder).values()] == [1, 1, 3, 3]
    assert json.loads((folder / "out" / "batch.json").read_text())["totals"]["pieces"] == 4


def test_what_is_there_is_not_planned_again(ran: tuple[Path, subprocess.CompletedProcess[str]], tmp_path: Path) -> None:
    shutil.copytree(ran[0], tmp_path, dirs_exist_ok=True)
    before = {path: path.stat().st_mtime_ns for path in (tmp_path / "out").rglob("disc.*")}
    assert len(before) == 6
    done = deltacam("batch", "parts", *QUICK, folder=tmp_path)
    assert (done.returncode, done.stderr) == (1, "")
    assert {path: path.stat().st_mtime_ns for path in before} == before
    assert tree(tmp_path / "out") == tree(ran[0] / "out")


def test_an_option_that_changes_plans_again(ran: tuple[Path, subprocess.CompletedProcess[str]], tmp_path: Path) -> None:
    shutil.copytree(ran[0], tmp_path, dirs_exist_ok=True)
    done = deltacam("batch", "parts", *QUICK, "--units", "mm", "--include", "small/*", folder=tmp_path)
    assert done.returncode == 0
    assert {name: row["status"] for name, row in results(tmp_path).items()} == {
        "small/disc.dxf": "passed",
        "small/unitless.dxf": "passed",
    }
    assert "disc.dxf" in done.stdout[done.stdout.index("of an earlier") :]  # which is still there


def test_the_command_line_wins_over_the_rules_and_the_rules_over_the_defaults(tmp_path: Path) -> None:
    for name in ("a.dxf", "b.dxf"):
        draw(tmp_path / "parts" / name)
    (tmp_path / "deltacam.toml").write_text('process = "acrylic-3mm-co2"\nrobot = "irb360-1600"\n')
    (tmp_path / "parts" / "batch.toml").write_text('[[part]]\npattern = "a.*"\nprocess = "steel-1mm-fibre"\n')
    assert deltacam("batch", "parts", *QUICK, "--robot", "delta-300", folder=tmp_path).returncode == 0
    rows = results(tmp_path)
    assert [row["process"] for row in rows.values()] == ["steel-1mm-fibre", "acrylic-3mm-co2"]
    assert {row["robot"] for row in rows.values()} == {"delta-300"}


def test_a_list_on_stdin_says_which_drawings(
    ran: tuple[Path, subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    shutil.copytree(ran[0] / "parts", tmp_path / "parts")
    code = "from deltacam_cli.main import main; main()"
    command = [sys.executable, "-c", code, "batch", "parts", "--list", "-", *QUICK, "--json"]
    done = subprocess.run(command, cwd=tmp_path, input="parts/small/disc.dxf\n", capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    shown = json.loads(done.stdout)
    assert shown["passed"] is True
    assert [part["part"] for part in shown["parts"]] == ["small/disc.dxf"]


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (("nowhere",), "nowhere"),
        (("parts/disc.dxf",), "deltacam plan"),
        (("parts", "--include", "nothing*"), "nothing*"),
        (("parts", "--list", "no-list.txt"), "the list cannot be read"),
        (("parts", "--rules", "no-rules.toml"), "no-rules.toml"),
        (("parts", "--time-limit", "soon"), "--time-limit"),
        (("parts", "--time-limit", "0.1"), "it must be from 1 s to 168 h, or none"),
        (("parts", "--memory", "1MB"), "--memory"),
        (("parts", "--robot", "unheard-of"), "unheard-of"),
        (("parts", "--dry-run", "--frame"), "exclude each other"),
        (("parts", "--scheduler", "host"), "'host' is not the address of a scheduler"),
        (("parts", "--scheduler", "tcp://127.0.0.1:1"), "no scheduler answers at tcp://127.0.0.1:1"),
        (("parts", "--scheduler", "tls://127.0.0.1:1", "--tls-ca", "ca.pem"), "--tls-cert and --tls-key"),
        (("parts", "--scheduler", "tcp://127.0.0.1:1", "--jobs", "2"), "--jobs is for this machine"),
        (("parts", "-o", "parts/disc.dxf"), "this is a file, not a folder"),
    ],
)
def test_what_must_be_changed_is_said_before_anything_is_planned(
    ran: tuple[Path, subprocess.CompletedProcess[str]], arguments: Sequence[str], says: str
) -> None:
    done = deltacam("batch", *arguments, "--json", folder=ran[0])
    assert done.returncode == 2
    assert says in done.stderr
    assert json.loads(done.stdout)["error"]["what"]
    assert (ran[0] / "out" / "batch.json").exists()


def start(folder: Path, *arguments: str, **options: Any) -> subprocess.Popen[bytes]:
    code = "from deltacam_cli.main import main; main()"
    return subprocess.Popen([sys.executable, "-c", code, "batch", *arguments], cwd=folder, **options)


def test_an_interrupt_finishes_what_is_planned_and_the_next_run_does_the_rest(
    ran: tuple[Path, subprocess.CompletedProcess[str]], tmp_path: Path
) -> None:
    shutil.copytree(ran[0] / "parts", tmp_path / "parts")
    process = start(tmp_path, "parts", *QUICK, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    assert process.stderr is not None
    assert b"passed" in process.stderr.readline()  # one part is there, so others are not
    process.send_signal(signal.SIGINT)
    shown, told = process.communicate(timeout=60)
    assert process.returncode == 130
    assert b"stopping" in told
    assert b"left" in shown
    assert "left" in {row["status"] for row in results(tmp_path).values()}
    assert deltacam("batch", "parts", *QUICK, folder=tmp_path).returncode == 1
    assert tree(tmp_path / "out") == tree(ran[0] / "out")


def test_a_terminal_shows_a_bar(ran: tuple[Path, subprocess.CompletedProcess[str]], tmp_path: Path) -> None:
    shutil.copytree(ran[0] / "parts", tmp_path / "parts")
    ours, theirs = pty.openpty()
    process = start(tmp_path, "parts", *QUICK, stdout=subprocess.DEVNULL, stderr=theirs)
    os.close(theirs)
    shown = b""
    while True:
        try:
            shown += os.read(ours, 4096)
        except OSError:  # how Linux tells that the other end is closed
            break
    os.close(ours)
    assert process.wait() == 1
    assert b"4/4 parts, 2 failed" in shown
    assert b"\n" not in shown.rstrip()
