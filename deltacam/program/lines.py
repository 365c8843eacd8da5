"""Lines of numbers, as CSV and other tables in text have them: read in chunks, and strictly."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Sequence
from typing import BinaryIO, Final

import numpy as np

from deltacam.errors import ProgramError
from deltacam.model import Array
from deltacam.program.contents import DAMAGED
from deltacam.program.fields import MAX_WHOLE

_CHUNK: Final = 4 * 2**20  # bytes; no line is longer
_NUMBER: Final = re.compile(rb"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_IN_NUMBERS: Final = b"0123456789+-.eE\r\n"


def whole_lines(stream: BinaryIO, name: str) -> Iterator[bytes]:
    """The rest of the stream in chunks that end where a line ends; the last one as it is.

    Raises:
        ProgramError: a line is longer than a chunk.
    """
    rest = b""
    while chunk := stream.read(_CHUNK):
        lines, end, after = (rest + chunk).rpartition(b"\n")
        if end:
            yield lines + end
        rest = after
        if len(rest) > _CHUNK:
            raise ProgramError(f"a line is longer than {_CHUNK:,} bytes", where=name)
    if rest:
        yield rest


def parse_lines(
    chunk: bytes, name: str, first_line: int, columns: Sequence[str], *, whole: Sequence[str], delimiter: str = ","
) -> Array:
    """The numbers of whole lines, (n, columns), all finite.

    Args:
        chunk: whole lines; the last one may lack its end.
        name: of the file, for messages.
        first_line: the number of its first line, for messages.
        columns: their names, for messages.
        whole: those of the columns that hold whole numbers.
        delimiter: one character between the numbers of a line.

    Raises:
        ProgramError: a line that is empty or has another number of fields, or a field that is not such a number.
    """
    expected = chunk.count(b"\n") + (not chunk.endswith(b"\n"))
    problem = (chunk, name, first_line, columns, whole, delimiter)
    if chunk.translate(None, _IN_NUMBERS + delimiter.encode()) or not chunk.strip():  # nan, inf, 1_000; empty lines
        raise _line_problem(*problem)
    try:
        table = np.loadtxt(io.BytesIO(chunk), delimiter=delimiter, comments=None, ndmin=2)
    except ValueError:
        raise _line_problem(*problem) from None
    if table.shape != (expected, len(columns)) or not np.isfinite(table).all():
        raise _line_problem(*problem)
    if not _whole_numbers(table[:, [columns.index(column) for column in whole]]):
        raise _line_problem(*problem)
    return table


def _whole_numbers(values: Array) -> bool:
    return bool((np.abs(values) <= MAX_WHOLE).all() and (values == np.floor(values)).all())


def _line_problem(
    chunk: bytes, name: str, first_line: int, columns: Sequence[str], whole: Sequence[str], delimiter: str
) -> ProgramError:
    """The error that names the first line of ``chunk`` that is not as it should be."""
    for line, row in enumerate(chunk.removesuffix(b"\n").split(b"\n"), start=first_line):
        where = f"{name}, line {line}"
        cells = row.removesuffix(b"\r").split(delimiter.encode())
        if len(cells) != len(columns):
            what = f"the row has {len(cells)} fields instead of {len(columns)}"
            return ProgramError(what, where=where, hint=DAMAGED)
        for column, cell in zip(columns, cells, strict=True):
            shown = cell[:40].decode("ascii", "backslashreplace")
            if not _NUMBER.fullmatch(cell) or not np.isfinite(float(cell)):
                return ProgramError(f"{column} is {shown!r}, which is not a number", where=where, hint=DAMAGED)
            if column in whole and not _whole_numbers(np.array([float(cell)])):
                return ProgramError(f"{column} is {shown!r}, which is not a whole number", where=where, hint=DAMAGED)
    return ProgramError("the rows cannot be read", where=f"{name}, from line {first_line}", hint=DAMAGED)
