"""What holds of every format that holds a whole program; a new line in the table of formats is tested by itself."""

import io
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.errors import ProgramError
from deltacam.model import Block, BlockKind, Mode
from deltacam.program.formats import FORMATS
from deltacam.program.program import Program

WHOLE = sorted(name for name, known in FORMATS.items() if known.whole)
ANGLES = st.one_of(st.floats(-7.0, 7.0), st.floats(-999.0, 999.0), st.floats(-1e-11, 1e-11))
ROWS = st.lists(st.tuples(ANGLES, ANGLES, ANGLES, st.floats(0.0, 1.0)), min_size=1, max_size=30)
NASTY = st.text(alphabet=st.characters(codec=None, categories=None), min_size=1, max_size=20)

every_format = pytest.mark.parametrize("name", WHOLE)


def written(program: Program, name: str) -> bytes:
    stream = io.BytesIO()
    FORMATS[name].write(program, stream)
    return stream.getvalue()


def read(content: bytes, name: str) -> Program:
    found = FORMATS[name].read(io.BytesIO(content), name="a")
    assert isinstance(found, Program)
    return found


def assert_equal(found: Program, expected: Program) -> None:
    for name in ("placement", "process", "drawing", "mode", "blocks", "robot", "integrity"):
        assert getattr(found, name) == getattr(expected, name), name
    assert found.robot.fingerprint == expected.robot.fingerprint
    assert (np.abs(found.q - expected.q) <= 0.5e-12 + 2.0 * np.spacing(np.abs(expected.q))).all()
    assert np.array_equal(found.power, expected.power)
    assert np.array_equal(found.block, expected.block)


@every_format
@given(rows=ROWS)
def test_what_is_written_comes_back_and_is_written_the_same(
    name: str, with_rows: Callable[..., Program], rows: list[tuple[float, float, float, float]]
) -> None:
    table = np.array(rows)
    program = with_rows(table[:, :3], table[:, 3], np.arange(len(table)) % 4)
    content = written(program, name)
    found = read(content, name)
    assert_equal(found, program)
    assert written(found, name) == content


@every_format
@pytest.mark.parametrize("other", WHOLE)
def test_a_program_comes_through_another_format_with_the_same_bytes(
    bench_program: Program, name: str, other: str
) -> None:
    content = written(bench_program, name)
    assert written(read(written(read(content, name), other), other), name) == content


@every_format
@given(layer=NASTY, handle=NASTY)
def test_any_name_survives(name: str, program: Program, layer: str, handle: str) -> None:
    block = Block(BlockKind.CUT, 0, 5, 1, layer, (handle,))
    renamed = replace(program, blocks=(block, *program.blocks[1:]))
    assert read(written(renamed, name), name).blocks[0] == block


@every_format
@pytest.mark.parametrize("mode", list(Mode))
def test_every_mode_comes_back(name: str, program: Program, mode: Mode) -> None:
    assert read(written(replace(program, mode=mode), name), name).mode is mode


@every_format
def test_many_rows_stay_in_order(name: str, with_rows: Callable[..., Program]) -> None:
    q = np.random.default_rng(1).uniform(-1.0, 1.0, (150_000, 3))
    found = read(written(with_rows(q), name), name)
    assert found.integrity == ()
    assert np.abs(found.q - q).max() <= 0.5e-12 * (1 + 1e-3)


@pytest.mark.parametrize("name", sorted(FORMATS))
def test_no_format_takes_a_damaged_program(name: str, program: Program) -> None:
    with pytest.raises(ProgramError, match="a damaged program is not written: a row is missing") as caught:
        written(replace(program, integrity=("a row is missing",)), name)
    assert "plan the drawing again" in caught.value.hint


@every_format
def test_a_process_that_is_not_finite_is_refused(name: str, program: Program) -> None:
    with pytest.raises(ProgramError, match="not finite"):
        written(replace(program, process=replace(program.process, feed=float("inf"))), name)


@every_format
@given(content=st.binary(max_size=300))
def test_arbitrary_bytes_are_refused(name: str, content: bytes) -> None:
    with pytest.raises(ProgramError) as caught:
        read(content, name)
    assert caught.value.where.startswith("a")


@every_format
@given(data=st.data())
def test_a_mutated_file_is_refused_or_read_and_never_a_traceback(
    name: str, program: Program, data: st.DataObject
) -> None:
    content = bytearray(written(program, name))
    for _ in range(data.draw(st.integers(1, 3))):
        first = data.draw(st.integers(0, len(content) - 1))
        last = data.draw(st.integers(first, min(first + 8, len(content))))
        content[first:last] = data.draw(st.binary(max_size=8))
    try:
        read(bytes(content), name)
    except ProgramError as problem:
        assert problem.what.isprintable()  # noqa: PT017 - most mutations are refused, not all


@every_format
@given(data=st.data())
def test_a_file_that_was_cut_off_is_refused_or_reported(name: str, program: Program, data: st.DataObject) -> None:
    content = written(program, name)
    kept = data.draw(st.integers(0, len(content) - 1))
    try:
        found = read(content[:kept], name)
    except ProgramError:
        return
    assert found.integrity
