"""Samples for LinuxCNC's halstreamer, whose rules are in its source: a bit is 0 or 1, and white space ends a field."""

import io
from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.errors import ProgramError
from deltacam.program import contents, halstreamer
from deltacam.program.halstreamer import Samples
from deltacam.program.program import Program


def written(program: Program) -> bytes:
    stream = io.BytesIO()
    halstreamer.write(program, stream)
    return stream.getvalue()


def read(content: bytes) -> Samples:
    return halstreamer.read(io.BytesIO(content), name="plate.halstream")


def refused(content: bytes) -> ProgramError:
    with pytest.raises(ProgramError) as caught:
        read(content)
    return caught.value


def as_streamer_parses(content: bytes) -> list[tuple[float, float, float, int]]:
    """What the component gets: each line by itself, fields ended by white space, anything else an error."""
    assert content.endswith(b"\n")
    found = []
    for line in content.decode("ascii").splitlines():
        *angles, bit = line.split(" ")
        assert len(angles) == len(halstreamer.CONFIG) - 1
        assert bit in ("0", "1")
        found.append((*map(float, angles), int(bit)))
    return found


def test_every_tick_is_a_line_of_three_angles_in_degrees_and_a_bit(bench_program: Program) -> None:
    table = np.array(as_streamer_parses(written(bench_program)))
    assert np.abs(table[:, :3] - np.degrees(bench_program.q)).max() <= 1e-10
    assert np.array_equal(table[:, 3] == 1, bench_program.power > 0.0)


@given(st.lists(st.tuples(*[st.floats(-1e3, 1e3)] * 3, st.booleans()), min_size=1, max_size=20))
def test_what_is_written_comes_back(
    with_rows: Callable[..., Program], rows: list[tuple[float, float, float, bool]]
) -> None:
    table = np.array([*rows, (0.0, 0.0, 0.0, False)])
    program = with_rows(table[:, :3], 0.85 * table[:, 3])
    found = read(written(program))
    assert np.abs(np.degrees(found.angles) - np.degrees(program.q)).max() <= 1e-10
    assert np.array_equal(found.laser, program.power > 0.0)


def test_zero_has_no_sign(with_rows: Callable[..., Program]) -> None:
    assert written(with_rows(np.full((1, 3), -4e-13))) == b"0.0000000000 0.0000000000 0.0000000000 0\n"


def test_what_one_bit_cannot_say_is_refused(with_rows: Callable[..., Program]) -> None:
    with pytest.raises(ProgramError, match=r"on or off here, and the program has powers of 0\.15, 0\.85") as caught:
        written(with_rows(np.zeros((4, 3)), np.array([0.0, 0.15, 0.85, 0.0])))
    assert "--layer" in caught.value.hint
    with pytest.raises(ProgramError, match="on in the last row, and would stay on"):
        written(with_rows(np.zeros((2, 3)), np.array([0.0, 0.85])))


@pytest.mark.parametrize(
    ("content", "where", "what"),
    [
        (b"", "line 1", "no sample"),
        (b"1 2 3 0\n1 2 3\n", "line 2", "3 fields instead of 4"),
        (b"1 2 3 0\n1 2 3 4 0\n", "line 2", "5 fields"),
        (b"1 2  3 0\n", "line 1", "5 fields"),
        (b"1,2,3,0\n", "line 1", "1 fields"),
        (b"1 2 3 0\n\n1 2 3 0\n", "line 2", "1 fields"),
        (b"# 1\n", "line 1", "2 fields"),
        (b"1 2 nan 0\n", "line 1", "q3_deg is 'nan'"),
        (b"1 2 3 0.5\n", "line 1", "laser is '0.5'"),
        (b"1 2 3 0\n1 2 3 2\n", "line 2", "does not end with 0 or 1"),
        (b"1 2 3 1.0\n", "line 1", "does not end with 0 or 1"),
        (b"1 2 3 0\r\n", "line 1", "does not end with 0 or 1"),
        (b"1 2 3 0\n1 2 3 1", "line 2", "does not end with 0 or 1"),
        (b"1 2 3 0\n1 60000 3 1\n", "line 2", "an angle is larger than 57295.8 degrees"),
    ],
)
def test_what_halstreamer_would_skip_is_refused_with_its_line(content: bytes, where: str, what: str) -> None:
    problem = refused(content)
    assert problem.where == f"plate.halstream, {where}"
    assert what in problem.what


@given(st.binary(max_size=100), st.integers(0, 10_000), st.integers(0, 60))
def test_a_mutated_file_is_refused_or_read_and_never_a_traceback(
    program: Program, inserted: bytes, place: int, removed: int
) -> None:
    content = written(replace(program, power=0.5 * (program.block == 1)))
    place %= len(content)
    try:
        found = read(content[:place] + inserted + content[place + removed :])
    except ProgramError as problem:
        assert problem.what.isprintable()  # noqa: PT017 - most mutations are refused, not all
    else:
        assert len(found.angles) == len(found.laser) > 0


def test_what_is_too_large_is_refused(bench_program: Program, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(contents, "MAX_ROWS", 5)
    assert "5 rows" in refused(written(bench_program)).what


def test_the_arrays_are_read_only(bench_program: Program) -> None:
    found = read(written(bench_program))
    for array in (found.angles, found.laser):
        with pytest.raises(ValueError, match="read-only"):
            array[0] = 1
