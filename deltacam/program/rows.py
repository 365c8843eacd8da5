"""The rows of a program as text: the CSV file holds it, and the hash in the meta object of every format is over it.

Numbers are written by table, many at a time. The result is that of ``"%d,%.12f,%.12f,%.12f,%s,%d"`` for every row.
"""

from __future__ import annotations

import hashlib
from collections.abc import Iterator
from typing import Final

import numpy as np
import numpy.typing as npt

from deltacam.model import Array, IntArray

COLUMNS: Final = ("tick", "q1_rad", "q2_rad", "q3_rad", "power", "block")
HEADER: Final = ",".join(COLUMNS).encode() + b"\n"
DECIMALS: Final = 12
"""Of a joint angle in radians."""

_Cells = npt.NDArray[np.uint8]

_ONE: Final = 10**DECIMALS
_LAST_DIGIT: Final = 2.0**-52
_ROWS_PER_CHUNK: Final = 10_000
_GROUP: Final = 4  # digits that are looked up at a time
_BASE: Final = 10**_GROUP
_DIGITS: Final = np.array(
    [list(b"%04d" % value) for value in range(_BASE)]
    + [[0] * _GROUP]
    + [list((b"%d" % value).rjust(_GROUP, b"\0")) for value in range(1, _BASE)],
    dtype=np.uint8,
)
"""The digits of 0 to 9999; then the same with zero bytes for leading zeros."""


def format_rows(ticks: IntArray, angles: IntArray, power: Array, block: IntArray) -> Iterator[bytes]:
    """The rows in chunks, without the line of column names.

    Args:
        ticks: (N,).
        angles: (N, 3), joint angles as `whole_angles` gives them.
        power: (N,); written as the shortest text that gives the same number.
        block: (N,).
    """
    levels, which = np.unique(power, return_inverse=True)
    names = _names(levels)
    for first in range(0, len(ticks), _ROWS_PER_CHUNK):
        rows = slice(first, first + _ROWS_PER_CHUNK)
        cells = [_whole(ticks[rows]), *(_decimal(angles[rows, i]) for i in range(3)), [names[which[rows]]]]
        count = len(block[rows])
        parts = [part for cell in cells for part in (*cell, _column(",", count))]
        parts += [*_whole(block[rows]), _column("\n", count)]
        yield np.hstack(parts).tobytes().translate(None, b"\0")


def hash_rows(ticks: IntArray, angles: IntArray, power: Array, block: IntArray) -> str:
    """The SHA-256 of the column names and the rows as the CSV file has them, hexadecimal."""
    digest = hashlib.sha256(HEADER)
    for chunk in format_rows(ticks, angles, power, block):
        digest.update(chunk)
    return digest.hexdigest()


def whole_angles(q: Array) -> IntArray:
    """Angles of any shape as whole numbers of 1e-12 rad, rounded as ``"%.12f"`` rounds them.

    The product below is off by at most half of its last digit; where that could turn the rounding, the text decides.

    Args:
        q: rad, at most `deltacam.program.program.MAX_ANGLE` in size.
    """
    scaled = q * float(_ONE)
    whole = np.rint(scaled)
    doubtful = np.abs(np.abs(scaled - whole) - 0.5) <= _LAST_DIGIT * np.abs(scaled)
    whole[doubtful] = [float(f"{value:.12f}".replace(".", "")) for value in q[doubtful].tolist()]
    return np.asarray(whole, dtype=np.int64)


def exact_angles(angles: IntArray) -> Array:
    """Angles in rad from whole numbers of 1e-12 rad: the numbers that their text gives."""
    return np.asarray(angles / float(_ONE))


def _names(levels: Array) -> _Cells:
    """The shortest text of each level that gives the same number, as 0, 1, 0.85; padded with zero bytes."""
    texts = [repr(level + 0.0).removesuffix(".0").encode() for level in levels.tolist()]
    return np.array(texts).view(np.uint8).reshape(len(texts), -1)


def _decimal(whole: IntArray) -> list[_Cells]:
    """The text of numbers (N,) of 1e-12, with 12 decimals, in pieces; padded with zero bytes."""
    units, rest = np.divmod(np.abs(whole), _ONE)
    decimals: list[_Cells] = []
    for _ in range(DECIMALS // _GROUP):
        rest, group = np.divmod(rest, _BASE)
        decimals.append(_DIGITS[group])
    return [_minus(whole), *_natural(units), _column(".", len(whole)), *decimals[::-1]]


def _whole(values: IntArray) -> list[_Cells]:
    """The text of whole numbers (N,), in pieces; padded with zero bytes."""
    return [_minus(values), *_natural(np.abs(values))]


def _natural(values: IntArray) -> list[_Cells]:
    """The text of whole numbers >= 0 (N,), in pieces; with zero bytes for leading zeros."""
    groups: list[_Cells] = []
    while not groups or values.any():
        values, group = np.divmod(values, _BASE)
        groups.append(_DIGITS[group + _BASE * (values == 0)])
    groups[0][:, -1] |= ord("0")  # of zero itself one digit is left; the other digits have these bits
    return groups[::-1]


def _minus(values: IntArray) -> _Cells:
    return np.where(values < 0, ord("-"), 0).astype(np.uint8)[:, np.newaxis]


def _column(sign: str, rows: int) -> _Cells:
    return np.full((rows, 1), ord(sign), dtype=np.uint8)
