"""The examples of the pages about the formats run on real files, and the pages say what is there."""

import contextlib
import io
import json
import re
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from deltacam.program import gcode, halstreamer
from deltacam.program.formats import FORMATS, write_program
from deltacam.program.meta import KEYS
from deltacam.program.program import Program
from deltacam.program.rows import COLUMNS

REFERENCE = Path(__file__).parents[2] / "docs" / "reference"
PAGE = REFERENCE / "program-format.md"
HOW_TO = REFERENCE.parent / "how-to" / "play-in-linuxcnc.md"
PAGES = {name: REFERENCE / "formats" / f"{name}.md" for name in FORMATS if name != "csv"} | {"csv": PAGE}
LIBRARIES = ("pandas", "duckdb", "pyarrow")


def examples(page: Path) -> list[str]:
    return re.findall(r"```python\n(.*?)```", page.read_text(encoding="utf-8"), flags=re.DOTALL)


def run(example: str, page: Path) -> dict[str, object]:
    for library in LIBRARIES:
        if library in example:
            pytest.importorskip(library, reason=f"{library} is not installed")
    found: dict[str, object] = {}
    with contextlib.redirect_stdout(io.StringIO()):
        exec(compile(example, str(page), "exec"), found)  # noqa: S102 - our own page
    return found


@pytest.fixture(autouse=True)
def plate(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, bench_program: Program) -> None:
    """A folder with the program in every format, which is the current one."""
    monkeypatch.chdir(tmp_path)
    for known in FORMATS.values():
        write_program(bench_program, tmp_path / f"plate{known.suffix}")


EXAMPLES = [(name, index) for name, page in PAGES.items() for index in range(len(examples(page)))]


@pytest.mark.parametrize(("name", "index"), EXAMPLES)
def test_the_examples_run_and_find_every_row(bench_program: Program, name: str, index: int) -> None:
    found = run(examples(PAGES[name])[index], PAGES[name])
    assert len(found.get("rows", bench_program.q)) == len(bench_program.q)  # type: ignore[arg-type]


def test_every_page_has_an_example() -> None:
    assert {name for name, _ in EXAMPLES} == set(FORMATS)


def test_pandas_and_duckdb_read_the_same_numbers_from_csv_and_parquet(bench_program: Program) -> None:
    duckdb = pytest.importorskip("duckdb", reason="duckdb is not installed")
    pandas = pytest.importorskip("pandas", reason="pandas is not installed")
    csv, parquet = "plate.program.csv", "plate.program.parquet"
    tables = [pandas.read_csv(csv, comment="#"), pandas.read_parquet(parquet)]
    assert [list(table.columns) for table in tables] == [list(COLUMNS)] * 2
    assert [list(map(str, table.dtypes)) for table in tables] == [["int64", *["float64"] * 4, "int64"]] * 2
    for source in (f"read_csv('{csv}', comment='#', max_line_size=67108864)", f"'{parquet}'"):
        relation = duckdb.sql(f"SELECT * FROM {source}")  # noqa: S608 - our own files
        assert relation.columns == list(COLUMNS)
        assert list(map(str, relation.types)) == ["BIGINT", *["DOUBLE"] * 4, "BIGINT"]
        tables.append(np.array(relation.fetchall()))
    exact = np.array(tables[1])
    assert np.abs(exact[:, 1:4] - bench_program.q).max() <= 0.6e-12
    # pandas' fast parser may miss the nearest double by the last digit.
    assert np.abs(np.array(tables[0]) - exact).max() <= 1e-15
    assert np.array_equal(tables[2], exact)
    assert np.array_equal(tables[3], exact)


def test_duckdb_reads_a_csv_file_with_a_meta_object_of_several_megabytes(
    tmp_path: Path, with_rows: Callable[..., Program]
) -> None:
    pytest.importorskip("duckdb", reason="duckdb is not installed")
    program = with_rows(np.zeros((100, 3)))
    large = replace(program, blocks=program.blocks * 8_000)
    write_program(large, tmp_path / "plate.program.csv")
    assert len((tmp_path / "plate.program.csv").read_bytes().split(b"\n")[1]) > 2_500_000
    example = next(example for example in examples(PAGE) if "duckdb" in example)
    assert len(run(example, PAGE)["rows"]) == 100  # type: ignore[arg-type]


def test_the_page_names_every_key() -> None:
    page = PAGE.read_text(encoding="utf-8")
    assert all(f"| `{key}` |" in page for key in KEYS)


def test_the_page_of_parquet_names_every_column_and_key() -> None:
    page = PAGES["parquet"].read_text(encoding="utf-8")
    assert all(f"`{name}`" in page for name in (*COLUMNS, "deltacam-program", "deltacam-meta", "deltacam-rows-sha256"))


def test_the_example_of_g_code_is_the_beginning_of_that_of_the_test_plate() -> None:
    page = PAGES["gcode"].read_text(encoding="utf-8")
    shown = re.search(r"^    \(motion.*?^    \.\.\.$", page, flags=re.DOTALL | re.MULTILINE)
    assert shown is not None
    lines = re.sub(r"^    ", "", shown[0], flags=re.MULTILINE).splitlines()[:-1]
    assert Path("plate.gcode").read_text().splitlines()[: len(lines)] == lines
    assert all(f"`{word}`" in page for word in gcode.HEAD)


def test_the_example_of_samples_is_the_beginning_of_that_of_the_test_plate() -> None:
    page = PAGES["halstreamer"].read_text(encoding="utf-8")
    lines = [line.strip() for line in page.splitlines() if re.fullmatch(r"    [\d. -]+", line)]
    assert len(lines) == 2
    assert Path("plate.halstream").read_text().splitlines()[:2] == lines
    assert f"`{halstreamer.CONFIG}`" in page


def test_the_hal_file_uses_what_it_loads() -> None:
    lines = [line.strip() for line in HOW_TO.read_text(encoding="utf-8").splitlines() if line.startswith("    ")]
    loaded = dict(re.findall(r"^loadrt (\w+) (.*)$", "\n".join(lines), flags=re.MULTILINE))
    assert loaded["threads"] == "name1=servo-thread period1=2500000"
    assert all(loaded[name].endswith(f"cfg={halstreamer.CONFIG}") for name in ("streamer", "sampler"))
    called = [line.split()[1] for line in lines if line.startswith("addf")]
    assert called == ["streamer.0", "not.0", "and2.0", "and2.1", "sampler.0"]  # in the order in which values flow
    nets = [line.split()[1:] for line in lines if line.startswith("net ")]
    pins = [word for _, *words in nets for word in words if word != "=>"]
    assert len(pins) == len(set(pins))
    assert all(pin.rpartition(".pin")[0] in called or pin.rpartition(".")[0] in called for pin in pins)
    wanted = {f"{name}.0.pin.{i}" for name in ("streamer", "sampler") for i in range(len(halstreamer.CONFIG))}
    assert wanted <= set(pins)
    assert {"streamer.0.enable", "sampler.0.enable", "streamer.0.empty"} <= set(pins)


@pytest.mark.parametrize("shift", [0.0, 2e-6])
def test_what_was_played_is_compared_with_the_file(shift: float) -> None:
    text = HOW_TO.read_text(encoding="utf-8").partition("## Compare")[2]
    code = "\n".join(line[4:] for line in text.splitlines() if line.startswith("    "))
    rows = np.loadtxt("plate.halstream")
    # As halsampler -t prints: the number of the sample, then "%f " for a float and "1 " or "0 " for a bit.
    played = [f"{tick} {q1 + shift:f} {q2:f} {q3:f} {bit:.0f} \n" for tick, (q1, q2, q3, bit) in enumerate(rows)]
    Path("played.txt").write_text("".join(played))
    Path("plate.halstream").rename("bracket.halstream")
    with pytest.raises(AssertionError) if shift else contextlib.nullcontext():
        exec(compile(code, str(HOW_TO), "exec"), {})  # noqa: S102 - our own page


def test_the_meta_object_in_parquet_is_the_text_of_the_csv_file() -> None:
    files = pytest.importorskip("pyarrow.parquet", reason="pyarrow is not installed")
    line = Path("plate.program.csv").read_bytes().split(b"\n")[1]
    found = files.read_metadata("plate.program.parquet").metadata[b"deltacam-meta"]
    assert found == line.removeprefix(b"# ")
    assert json.loads(found)["rows"] > 1000
