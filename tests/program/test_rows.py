"""The rows as text: the same as Python's own formatting, number for number."""

import hashlib

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.program.rows import HEADER, exact_angles, format_rows, hash_rows, whole_angles

TIES = st.integers(-(2**23), 2**23).map(lambda odd: odd / 2**13)  # some lie half-way between two texts
ANGLES = st.one_of(st.floats(-1e3, 1e3), st.floats(-1e-11, 1e-11), TIES)
WHOLE = st.one_of(st.integers(-(2**53), 2**53), st.integers(-10_001, 10_001))
POWERS = st.one_of(st.floats(0.0, 1.0), st.sampled_from([0.0, -0.0, 1.0, 0.85, 1e-300]))
ROWS = st.lists(st.tuples(WHOLE, ANGLES, ANGLES, ANGLES, POWERS, WHOLE), min_size=1, max_size=20)


def as_python_writes(tick: int, q1: float, q2: float, q3: float, power: float, block: int) -> str:
    angles = ",".join(f"{angle:.12f}" for angle in (q1, q2, q3))
    tidy = ",".join(text.removeprefix("-") if float(text) == 0.0 else text for text in angles.split(","))
    return f"{tick},{tidy},{str(power + 0.0).removesuffix('.0')},{block}\n"


def columns(rows: list[tuple[int, float, float, float, float, int]]) -> tuple[np.ndarray, ...]:
    ticks, *angles, power, block = zip(*rows, strict=True)
    return np.array(ticks), whole_angles(np.array(angles).T), np.array(power), np.array(block)


@given(ROWS)
def test_every_row_is_as_python_formats_it(rows: list[tuple[int, float, float, float, float, int]]) -> None:
    expected = "".join(as_python_writes(*row) for row in rows).encode()
    assert b"".join(format_rows(*columns(rows))) == expected
    assert hash_rows(*columns(rows)) == hashlib.sha256(HEADER + expected).hexdigest()


def test_many_numbers_are_rounded_as_python_rounds_them() -> None:
    random = np.random.default_rng(2)
    half = (random.integers(-(10**12), 10**12, 20_000) + 0.5) / 1e12
    q = np.concatenate([random.uniform(-7.0, 7.0, 20_000), random.uniform(-1e3, 1e3, 20_000), half])
    texts = [f"{value:.12f}" for value in q.tolist()]
    assert whole_angles(q).tolist() == [int(text.replace(".", "")) for text in texts]
    assert exact_angles(whole_angles(q)).tolist() == [float(text) for text in texts]


@pytest.mark.parametrize("count", [1, 9_999, 10_000, 10_001, 20_001])
def test_chunks_join_without_a_gap(count: int) -> None:
    ticks = np.arange(count)
    zero = np.zeros(count)
    text = b"".join(format_rows(ticks, np.zeros((count, 3), dtype=np.int64), zero, np.zeros(count, dtype=np.int64)))
    lines = text.split(b"\n")
    assert lines[-1] == b""
    assert [int(line.split(b",")[0]) for line in lines[:-1]] == ticks.tolist()
