"""``deltacam export``: one file, whole or not at all."""

import json
import sys
from pathlib import Path

import pytest
from click.testing import CliRunner

from deltacam.program.formats import FORMATS, read_program, write_program
from deltacam.program.program import Program
from deltacam_cli import main
from deltacam_cli.export import command
from tests.cli.test_main import deltacam


@pytest.fixture(autouse=True)
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, program: Program) -> Path:
    """A folder with a program, which is the current one."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "out").mkdir()
    write_program(program, tmp_path / "out" / "plate.program.csv")
    return tmp_path


def run(monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str], *words: str) -> tuple[int, str, str]:
    """The exit code, stdout and stderr of the whole command line."""
    monkeypatch.setattr(sys, "argv", ["deltacam", "export", *words])
    with pytest.raises(SystemExit) as stopped:
        main.main()
    shown = capsys.readouterr()
    return int(stopped.value.code or 0), shown.out, shown.err


@pytest.mark.parametrize("name", FORMATS)
def test_every_format_is_written_into_the_current_folder(folder: Path, name: str) -> None:
    shown = CliRunner().invoke(command, ["out/plate.program.csv", "--to", name])
    assert (shown.exit_code, shown.output) == (0, f"wrote plate{FORMATS[name].suffix}\n")
    with (folder / f"plate{FORMATS[name].suffix}").open("rb") as stream:
        assert FORMATS[name].read(stream, name="plate") is not None
    assert len(list(folder.iterdir())) == 2


def test_parquet_and_back_gives_the_same_bytes(folder: Path) -> None:
    assert CliRunner().invoke(command, ["out/plate.program.csv", "--to", "parquet"]).exit_code == 0
    assert CliRunner().invoke(command, ["plate.program.parquet", "--to", "csv"]).exit_code == 0
    assert (folder / "plate.program.csv").read_bytes() == (folder / "out/plate.program.csv").read_bytes()


def test_the_help_names_every_format() -> None:
    shown = CliRunner().invoke(command, ["--help"]).output
    assert ", ".join(list(FORMATS)[:-1]) + f" or {list(FORMATS)[-1]}." in " ".join(shown.split())


def test_json_is_one_object_with_the_files() -> None:
    shown = CliRunner().invoke(command, ["out/plate.program.csv", "--to", "parquet", "-o", "a.pq", "--json"])
    assert json.loads(shown.stdout) == {"files": ["a.pq"]}


def test_a_damaged_program_is_refused(
    folder: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    path = folder / "out/plate.program.csv"
    path.write_bytes(path.read_bytes().replace(b",0.85,", b",0.95,", 1))
    assert read_program(path).integrity
    code, shown, error = run(monkeypatch, capsys, "out/plate.program.csv", "--to", "parquet")
    assert (code, shown) == (2, "")
    assert (
        "error: out/plate.program.csv: a damaged program is not written: the rows are not those that were written"
        in error
    )
    assert "hint: plan the drawing again" in error
    assert [entry.name for entry in folder.iterdir()] == ["out"]


@pytest.mark.parametrize(
    ("words", "says", "hint"),
    [
        (["out/plate.program.csv", "--to", "nc"], "--to: 'nc' is not a format", "it is one of csv, parquet"),
        (["out/none.program.csv", "--to", "parquet"], "there is no such file", "check the name"),
        (["out", "--to", "parquet"], "the name is not that of a program file", "NAME.program.csv"),
        (["out/plate.program.csv", "--to", "csv", "-o", "out/plate.program.csv"], "would overwrite", "-o FILE"),
        (["out/plate.program.csv", "--to", "csv", "-o", "link"], "would overwrite", "-o FILE"),
        (["out/plate.program.csv", "--to", "parquet", "-o", "a.csv"], "another format, NAME.program.csv", ".parquet"),
        (["out/plate.program.csv", "--to", "parquet", "-o", "none/a"], "no such file or directory", "another folder"),
        (["out/plate.program.csv", "--to", "parquet", "-o", "out"], "is a directory", "another folder"),
        (["out/plate.program.csv"], "missing option '--to'", "--help"),
    ],
)
def test_what_must_be_changed_is_said_and_nothing_is_written(
    folder: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    words: list[str],
    says: str,
    hint: str,
) -> None:
    (folder / "link").symlink_to("out/plate.program.csv")
    before = (folder / "out/plate.program.csv").read_bytes()
    code, shown, error = run(monkeypatch, capsys, *words)
    assert (code, shown) == (2, "")
    assert says in error
    assert hint in error.partition("hint: ")[2]
    assert sorted(path.name for path in folder.rglob("*")) == ["link", "out", "plate.program.csv"]
    assert (folder / "out/plate.program.csv").read_bytes() == before


def test_verify_takes_what_was_exported(folder: Path) -> None:
    done = deltacam("export", "out/plate.program.csv", "--to", "parquet", folder=folder)
    assert (done.returncode, done.stdout, done.stderr) == (0, "wrote plate.program.parquet\n", "")
    verified = deltacam("verify", "plate.program.parquet", folder=folder)
    assert verified.returncode == 0, verified.stdout
    assert verified.stdout.startswith("PASSED")
