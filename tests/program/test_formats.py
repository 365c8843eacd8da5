"""Programs in files, by name."""

import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deltacam.errors import ProgramError
from deltacam.program.formats import FORMATS, name_of, read_program, write_program
from deltacam.program.program import Program


@pytest.mark.parametrize("name", [name for name, known in FORMATS.items() if known.whole])
def test_a_program_goes_through_a_file(tmp_path: Path, program: Program, name: str) -> None:
    path = tmp_path / f"part{FORMATS[name].suffix}"
    write_program(program, path)
    found = read_program(str(path))
    assert found.integrity == ()
    assert found.blocks == program.blocks
    assert [entry.name for entry in tmp_path.iterdir()] == [path.name]


def test_the_same_program_gives_the_same_bytes_everywhere(tmp_path: Path, program: Program) -> None:
    (tmp_path / "other").mkdir()
    write_program(program, tmp_path / "a.program.csv")
    write_program(program, tmp_path / "other" / "b.program.csv")
    content = (tmp_path / "a.program.csv").read_bytes()
    assert content == (tmp_path / "other" / "b.program.csv").read_bytes()
    assert str(tmp_path).encode() not in content


@pytest.mark.parametrize("name", ["part.dxf", "part", ".program", "part.csv.gz"])
def test_a_name_of_no_format_is_refused_with_the_right_one(tmp_path: Path, program: Program, name: str) -> None:
    with pytest.raises(ProgramError, match="not that of a program file") as caught:
        write_program(program, tmp_path / name)
    assert ".program.csv" in caught.value.hint
    (tmp_path / name).touch()
    with pytest.raises(ProgramError, match="not that of a program file"):
        read_program(tmp_path / name)


@pytest.mark.parametrize("name", [name for name, known in FORMATS.items() if not known.whole])
def test_a_file_that_holds_only_the_motion_is_no_program(tmp_path: Path, bench_program: Program, name: str) -> None:
    path = tmp_path / f"part{FORMATS[name].suffix}"
    write_program(bench_program, path)
    assert path.stat().st_size > 1000
    with pytest.raises(ProgramError, match="only the motion") as caught:
        read_program(path)
    assert ".program.csv" in caught.value.hint


@pytest.mark.parametrize(
    ("file", "name"),
    [
        ("out/plate.program.csv", "plate"),
        ("Plate.Program.CSV", "Plate"),
        ("a.b.program.parquet", "a.b"),
        ("plate.csv", "plate"),
        ("plate.gcode", "plate"),
    ],
)
def test_the_name_of_a_file_is_without_the_ending_of_its_format(file: str, name: str) -> None:
    assert name_of(Path(file)) == name


def test_every_ending_stands_for_one_format() -> None:
    assert len({known.ending for known in FORMATS.values()}) == len(FORMATS)


def test_a_missing_file_and_a_folder_are_errors(tmp_path: Path) -> None:
    with pytest.raises(ProgramError, match="no such file"):
        read_program(tmp_path / "a.program.csv")
    (tmp_path / "a.program.csv").mkdir()
    with pytest.raises(ProgramError, match="is a directory"):
        read_program(tmp_path / "a.program.csv")


def test_a_program_that_cannot_be_written_leaves_nothing(tmp_path: Path, program: Program) -> None:
    broken = replace(program, process=replace(program.process, kerf=float("nan")))
    with pytest.raises(ProgramError, match="not finite"):
        write_program(broken, tmp_path / "a.program.csv")
    assert list(tmp_path.iterdir()) == []


def test_importing_the_formats_loads_nothing_heavy() -> None:
    code = "import sys, deltacam.program.formats; print(*sys.modules)"
    loaded = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert not {"shapely", "scipy", "ezdxf", "toppra", "matplotlib", "pyarrow"} & set(loaded)


@pytest.mark.parametrize(
    ("q", "power", "block"),
    [
        (np.zeros((0, 3)), np.zeros(0), np.zeros(0, dtype=int)),
        (np.zeros((2, 2)), np.zeros(2), np.zeros(2, dtype=int)),
        (np.zeros((2, 3)), np.zeros(3), np.zeros(2, dtype=int)),
        (np.zeros((2, 3)), np.zeros(2), np.zeros(1, dtype=int)),
        (np.zeros((2, 3)), np.zeros(2), np.zeros(2)),
        (np.full((2, 3), 1e6), np.zeros(2), np.zeros(2, dtype=int)),
        (np.full((2, 3), np.nan), np.zeros(2), np.zeros(2, dtype=int)),
        (np.zeros((2, 3)), np.full(2, np.inf), np.zeros(2, dtype=int)),
    ],
)
def test_a_program_of_wrong_arrays_cannot_be_made(
    with_rows: Callable[..., Program], q: np.ndarray, power: np.ndarray, block: np.ndarray
) -> None:
    with pytest.raises(ValueError, match=r"shape|finite|setpoints|joint angle"):
        with_rows(q, power, block)


def test_the_arrays_of_a_program_are_its_own_and_read_only(with_rows: Callable[..., Program]) -> None:
    q = np.zeros((2, 3))
    program = with_rows(q)
    q[0, 0] = 1.0
    assert program.q[0, 0] == 0.0
    for array in (program.q, program.power, program.block):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1


def test_the_duration_is_from_the_first_setpoint_to_the_last(program: Program) -> None:
    assert program.duration == pytest.approx(5 / 400)
