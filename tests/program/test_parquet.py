"""Programs as Parquet: damage is refused or reported as in CSV, whatever wrote the file."""

import io
import json
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from deltacam.errors import ProgramError
from deltacam.program import contents, csv, parquet
from deltacam.program.formats import read_program, write_program
from deltacam.program.program import Program
from deltacam.program.rows import COLUMNS

arrow = pytest.importorskip("pyarrow", reason="pyarrow is not installed")
files = pytest.importorskip("pyarrow.parquet")

Columns = dict[str, Any]
Change = Callable[[Columns, dict[str, str]], object]


def written(program: Program) -> bytes:
    stream = io.BytesIO()
    parquet.write(program, stream)
    return stream.getvalue()


def read(content: bytes) -> Program:
    return parquet.read(io.BytesIO(content), name="plate.program.parquet")


def refused(content: bytes) -> ProgramError:
    with pytest.raises(ProgramError) as caught:
        read(content)
    assert caught.value.where.startswith("plate.program.parquet")
    assert caught.value.what.isprintable()
    return caught.value


def changed(program: Program, change: Change) -> bytes:
    """The file of a program, written by Arrow alone with other columns or metadata."""
    file = files.ParquetFile(io.BytesIO(written(program)), pre_buffer=False)
    columns: Columns = {name: file.read([name], use_threads=False)[name].to_pylist() for name in COLUMNS}
    metadata = {key.decode(): value.decode() for key, value in file.metadata.metadata.items()}
    change(columns, metadata)
    stream = io.BytesIO()
    table = arrow.table(columns)
    with files.ParquetWriter(stream, table.schema) as writer:
        writer.write_table(table, row_group_size=4)
        writer.add_key_value_metadata(metadata)
    return stream.getvalue()


def with_meta(change: Callable[[dict[str, Any]], object]) -> Change:
    def edit(_: Columns, metadata: dict[str, str]) -> None:
        values = json.loads(metadata["deltacam-meta"])
        change(values)
        metadata["deltacam-meta"] = json.dumps(values)

    return edit


def cell(column: str, row: int, value: object) -> Change:
    def edit(columns: Columns, _: dict[str, str]) -> None:
        columns[column][row] = value

    return edit


def without_row(row: int) -> Change:
    def edit(columns: Columns, _: dict[str, str]) -> None:
        for values in columns.values():
            del values[row]

    return edit


def retyped(column: str, kind: Any) -> Change:
    return lambda columns, _: columns.update({column: arrow.array(columns[column]).cast(kind)})


def test_a_file_that_arrow_wrote_unchanged_is_a_whole_program(program: Program) -> None:
    assert read(changed(program, lambda *_: None)).integrity == ()


def test_the_columns_and_the_metadata_are_as_documented(program: Program) -> None:
    file = files.ParquetFile(io.BytesIO(written(program)))
    kinds = ["int64", "double", "double", "double", "double", "int64"]
    assert [(one.name, str(one.type), one.nullable) for one in file.schema_arrow] == [
        (name, kind, False) for name, kind in zip(COLUMNS, kinds, strict=True)
    ]
    assert set(file.metadata.metadata) == {b"deltacam-program", b"deltacam-meta", b"deltacam-rows-sha256"}
    assert file.metadata.metadata[b"deltacam-program"] == b"1"
    text = io.BytesIO()
    csv.write(program, text)
    assert file.metadata.metadata[b"deltacam-meta"] == text.getvalue().split(b"\n")[1].removeprefix(b"# ")


def test_the_angles_are_exactly_those_of_the_csv_file(with_rows: Callable[..., Program]) -> None:
    program = with_rows(np.random.default_rng(3).uniform(-7.0, 7.0, (5_000, 3)))
    text = io.BytesIO()
    csv.write(program, text)
    text.seek(0)
    assert np.array_equal(read(written(program)).q, csv.read(text, name="a").q)


def keys(**values: str | None) -> Change:
    def edit(_: Columns, metadata: dict[str, str]) -> None:
        for key, value in values.items():
            metadata.pop(f"deltacam-{key}")
            if value is not None:
                metadata[f"deltacam-{key}"] = value

    return edit


DAMAGES: dict[str, tuple[Change, str]] = {
    "an angle changed": (cell("q2_rad", 3, 0.25), "SHA-256"),
    "an angle changed by less than the text shows": (cell("q1_rad", 0, 0.1 + 2e-13), "SHA-256"),
    "another hash of the columns": (keys(**{"rows-sha256": "0" * 64}), "SHA-256"),
    "a power changed": (cell("power", 2, 0.999), "SHA-256"),
    "a block changed": (cell("block", 2, 2), "SHA-256"),
    "a tick changed": (cell("tick", 2, 3), "expected tick 2, found 3 in row 2; 1 of 6"),
    "the last row lost": (without_row(5), "states 6 rows, the file has 5"),
    "a row lost": (without_row(2), "expected tick 2, found 3 in row 2; 3 of 5"),
    "another hash": (with_meta(lambda meta: meta.update(sha256="0" * 64)), "SHA-256"),
    "other rows in the meta": (with_meta(lambda meta: meta.update(rows=7)), "states 7 rows"),
    "another rate": (with_meta(lambda meta: meta.update(rate_hz=500)), "rate_hz is 500"),
}


@pytest.mark.parametrize("damage", DAMAGES)
def test_damage_that_can_be_read_is_reported(program: Program, damage: str) -> None:
    change, message = DAMAGES[damage]
    found = read(changed(program, change))
    assert any(message in problem for problem in found.integrity), found.integrity


REFUSED: dict[str, tuple[Change, str]] = {
    "no meta": (keys(meta=None), "deltacam-meta is missing"),
    "no hash": (keys(**{"rows-sha256": None}), "deltacam-rows-sha256 is missing"),
    "no version": (keys(program=None), "deltacam-program is missing"),
    "version 2": (keys(program="2"), "format version '2' is not 1"),
    "meta not JSON": (keys(meta="{{"), "not JSON"),
    "meta a bomb": (keys(meta="[" * 200_000), "nested too deeply"),
    "meta an empty object": (keys(meta="{}"), "missing blocks"),
    "a column lost": (lambda columns, _: columns.pop("power"), "the columns are not tick"),
    "a column too many": (lambda columns, _: columns.update(time=[0.0] * 6), "the columns are not tick"),
    "a column twice as text": (retyped("q1_rad", arrow.string()), "q1_rad is string, not double"),
    "angles in single precision": (retyped("q1_rad", arrow.float32()), "q1_rad is float, not double"),
    "ticks as decimals": (retyped("tick", arrow.float64()), "tick is double, not int64"),
    "unsigned blocks": (retyped("block", arrow.uint64()), "block is uint64, not int64"),
    "a gap": (cell("power", 5, None), "power in row 5 is missing"),
    "nan": (cell("q3_rad", 0, float("nan")), "q3_rad in row 0 is missing, not finite"),
    "infinity": (cell("power", 0, float("inf")), "power in row 0 is missing, not finite"),
    "a huge tick": (cell("tick", 0, 2**62), "tick in row 0 is missing, not finite or too large"),
    "the smallest tick": (cell("tick", 0, -(2**63)), "tick in row 0 is missing, not finite or too large"),
    "an angle of a million": (cell("q1_rad", 0, 1e6), "a joint angle is 1e+06 rad"),
    "no rows": (lambda columns, _: columns.update({k: arrow.array(v)[:0] for k, v in columns.items()}), "no setpoint"),
}


@pytest.mark.parametrize("damage", REFUSED)
def test_a_file_that_cannot_be_interpreted_is_refused(program: Program, damage: str) -> None:
    change, what = REFUSED[damage]
    assert what in refused(changed(program, change)).what


def test_other_files_and_files_that_were_cut_off_are_told_apart(program: Program) -> None:
    content = written(program)
    assert "does not start with 'PAR1'" in refused(b"# deltacam-program 1\n").what
    assert "does not start with 'PAR1'" in refused(b"").what
    assert "cut off" in refused(content[:-1]).what
    assert "footer is larger" in refused(content[:-8] + b"\xff\xff\xff\x7fPAR1").what
    assert "not Parquet that can be read" in refused(content[:200] + content[-8:]).what


@pytest.mark.parametrize(
    ("limit", "value", "says"), [("MAX_ROWS", 5, "more than 5 rows"), ("MAX_BYTES", 500, "larger than")]
)
def test_what_is_too_large_is_refused(
    program: Program, monkeypatch: pytest.MonkeyPatch, limit: str, value: int, says: str
) -> None:
    monkeypatch.setattr(contents, limit, value)
    assert says in refused(written(program)).what


def test_a_small_file_that_unpacks_to_very_many_rows_is_refused(
    program: Program, with_rows: Callable[..., Program], monkeypatch: pytest.MonkeyPatch
) -> None:
    count = 40_000
    resting = written(with_rows(np.zeros((count, 3)), np.zeros(count), np.zeros(count, dtype=np.int64)))
    assert len(parquet.read(io.BytesIO(resting), name="rest.program.parquet").q) == count
    monkeypatch.setattr(parquet, "_FEW_ROWS", count - len(resting) - 1)
    assert "too many for its size" in refused(resting).what


def test_too_large_a_meta_object_is_refused(program: Program, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contents, "MAX_META", 100)
    assert "the meta object is larger than 100 bytes" in refused(written(program)).what


def test_without_pyarrow_the_message_says_what_to_install(
    tmp_path: Path, program: Program, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = tmp_path / "a.program.parquet"
    write_program(program, path)
    monkeypatch.setitem(sys.modules, "pyarrow.parquet", None)
    for use in (lambda: read_program(path), lambda: write_program(program, path)):
        with pytest.raises(ProgramError, match="pyarrow, which is not installed") as caught:
            use()
        assert caught.value.hint == 'pip install "deltacam[parquet]"'


def test_zero_has_no_sign(with_rows: Callable[..., Program]) -> None:
    content = written(with_rows(np.full((2, 3), -1e-14), np.array([-0.0, 0.0])))
    assert content == written(with_rows(np.zeros((2, 3)), np.zeros(2)))
    assert not np.signbit(read(content).q).any()


def test_a_program_of_another_layer_has_other_bytes(program: Program) -> None:
    assert written(program) != written(replace(program, blocks=program.blocks[:3]))
