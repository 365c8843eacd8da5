"""The program file as text: two comment lines, a line of column names, and a row per tick.

The format is docs/reference/program-format.md. Reading trusts nothing: what cannot be interpreted is refused; what can
be, but is not as deltacam writes it, is listed in `Program.integrity` for the checks.
"""

from __future__ import annotations

import hashlib
import io
import itertools
import json
import re
from collections.abc import Iterator
from typing import BinaryIO, Final, NamedTuple

import numpy as np

from deltacam.errors import ProgramError
from deltacam.model import Array, IntArray
from deltacam.program import meta as metas
from deltacam.program.fields import MAX_WHOLE, parse_json
from deltacam.program.program import TICK_COLUMN, Program

VERSION: Final = "1"
MAGIC: Final = b"# deltacam-program "
HEADER: Final = b"tick,q1_rad,q2_rad,q3_rad,power,block\n"
MAX_BYTES: Final = 2_000_000_000
"""Largest file that is read."""
MAX_ROWS: Final = 50_000_000
"""Most rows that are read."""

_COLUMNS: Final = HEADER.count(b",") + 1
_FIRST_ROW: Final = 4  # its line
_MAX_META: Final = 64 * 2**20
_CHUNK: Final = 4 * 2**20  # bytes; no row is longer
_ROWS_PER_CHUNK: Final = 10_000
_HALF_DIGIT: Final = 5e-13  # what "%.12f" still writes as zero
_NUMBER: Final = re.compile(rb"[-+]?(\d+\.?\d*|\.\d+)([eE][-+]?\d+)?")
_IN_NUMBERS: Final = b"0123456789+-.eE,\r\n"
_DAMAGED: Final = "the file was damaged or edited; plan the drawing again"


def write(program: Program, stream: BinaryIO) -> None:
    """Write ``program`` to ``stream``; the same program gives the same bytes.

    Args:
        program: any that is whole; angles are rounded to 12 decimals.
        stream: binary and seekable, because the hash of the rows stands before them.

    Raises:
        ProgramError: the program was read from a damaged file, whose hash must not be repaired; or the format cannot
            hold a value.
    """
    if program.integrity:
        hint = "plan the drawing again"
        raise ProgramError(f"a damaged program is not written: {program.integrity[0]}", hint=hint)
    start = stream.tell()
    stream.write(_preamble(program, "0" * 64))
    digest = hashlib.sha256(HEADER)
    stream.write(HEADER)
    for chunk in _format_rows(program):
        digest.update(chunk)
        stream.write(chunk)
    end = stream.tell()
    stream.seek(start)
    stream.write(_preamble(program, digest.hexdigest()))
    stream.seek(end)


def read(stream: BinaryIO, *, name: str) -> Program:
    """Read a program.

    Args:
        stream: binary, at its start.
        name: of the file, for messages.

    Returns:
        the program as the rows say, with what is wrong with the file in `Program.integrity`.

    Raises:
        ProgramError: the file cannot be interpreted; says what, and in which line.
    """
    problems = _read_version(stream, name)
    meta, untidy = _read_meta(stream, name)
    found = _read_rows(stream, name)
    problems += untidy + _file_problems(meta, found) + _tick_problems(found.ticks)
    try:
        return Program(
            robot=meta.robot,
            placement=meta.placement,
            process=meta.process,
            drawing=meta.drawing,
            mode=meta.mode,
            blocks=meta.blocks,
            q=found.q,
            power=found.power,
            block=found.block,
            integrity=tuple(problems),
        )
    except ValueError as problem:
        raise ProgramError(str(problem), where=name, hint=_DAMAGED) from problem


def _preamble(program: Program, sha256: str) -> bytes:
    """The two comment lines. ASCII only, so that no name of a layer can end the line or hide in it."""
    meta = metas.to_meta(program, sha256=sha256)
    try:
        text = json.dumps(meta, sort_keys=True, separators=(",", ":"), allow_nan=False)
    except ValueError as problem:
        raise ProgramError("a value of the program is not finite", hint="check the process and placement") from problem
    return MAGIC + VERSION.encode() + b"\n# " + text.encode("ascii") + b"\n"


def _format_rows(program: Program) -> Iterator[bytes]:
    levels, which = np.unique(program.power, return_inverse=True)
    names = [_compact(level) for level in levels.tolist()]
    for first in range(0, len(program.q), _ROWS_PER_CHUNK):
        rows = slice(first, min(first + _ROWS_PER_CHUNK, len(program.q)))
        q = np.where(np.abs(program.q[rows]) <= _HALF_DIGIT, 0.0, program.q[rows])
        columns = (
            range(rows.start, rows.stop),
            *q.T.tolist(),
            [names[level] for level in which[rows].tolist()],
            program.block[rows].tolist(),
        )
        values = tuple(itertools.chain.from_iterable(zip(*columns, strict=True)))
        yield ("%d,%.12f,%.12f,%.12f,%s,%d\n" * len(q) % values).encode("ascii")


def _compact(power: float) -> str:
    """The shortest text that gives the same number: 0, 1, 0.85."""
    return repr(power + 0.0).removesuffix(".0")


class _Rows(NamedTuple):
    ticks: IntArray
    q: Array
    power: Array
    block: IntArray
    sha256: str
    whole: bool  # whether the last line has its end


def _read_version(stream: BinaryIO, name: str) -> list[str]:
    line = stream.readline(len(MAGIC) + 20)
    where = f"{name}, line 1"
    if not line.startswith(MAGIC):
        what = f"not a deltacam program: the first line is not {(MAGIC + VERSION.encode()).decode()!r}"
        raise ProgramError(what, where=where, hint="give a file that `deltacam plan` wrote: NAME.program.csv")
    version = line.removeprefix(MAGIC).strip()
    if version != VERSION.encode():
        shown = version[:20].decode("ascii", "backslashreplace")
        hint = "read it with the version of deltacam that wrote it"
        raise ProgramError(f"format version {shown!r} is not {VERSION}", where=where, hint=hint)
    return _line_end_problems(line, 1)


def _read_meta(stream: BinaryIO, name: str) -> tuple[metas.Meta, list[str]]:
    where = f"{name}, line 2"
    line = stream.readline(_MAX_META)
    if not line.endswith(b"\n"):
        hint = "the file was cut off, or is not from deltacam"
        raise ProgramError(f"the line does not end within {_MAX_META:,} bytes", where=where, hint=hint)
    try:
        text = line.decode("utf-8").strip()
    except UnicodeDecodeError as problem:
        raise ProgramError("the meta object is not UTF-8", where=where) from problem
    if not text.startswith("#"):
        raise ProgramError("the meta object is missing: expected '# {'", where=where)
    meta = metas.from_meta(parse_json(text.removeprefix("#"), where), where)
    header = stream.readline(len(HEADER) + 2)
    if header.rstrip(b"\r\n") != HEADER.rstrip(b"\n"):
        raise ProgramError(f"the columns are not {HEADER.decode().strip()}", where=f"{name}, line 3")
    return meta, _line_end_problems(line, 2) + _line_end_problems(header, 3)


def _line_end_problems(line: bytes, number: int) -> list[str]:
    tidy = line.endswith(b"\n") and not line.endswith(b"\r\n")
    return [] if tidy else [f"line {number} does not end with a line feed alone"]


def _read_rows(stream: BinaryIO, name: str) -> _Rows:
    digest = hashlib.sha256(HEADER)
    parts: list[tuple[IntArray, Array, Array, IntArray]] = []
    line, size, last = _FIRST_ROW, 0, b"\n"
    for chunk in _whole_lines(stream, name):
        digest.update(chunk)
        table = _parse(chunk, name, line)
        line += len(table)
        size += len(chunk)
        last = chunk[-1:]
        if size > MAX_BYTES or line - _FIRST_ROW > MAX_ROWS:
            raise ProgramError(f"the program is larger than {MAX_BYTES:,} bytes or {MAX_ROWS:,} rows", where=name)
        ticks, block = table[:, 0].astype(np.int64), table[:, 5].astype(np.int64)
        parts.append((ticks, table[:, 1:4].copy(), table[:, 4].copy(), block))
    if not parts:
        hint = "the file was cut off; plan the drawing again"
        raise ProgramError("the program has no setpoint", where=f"{name}, line {_FIRST_ROW}", hint=hint)
    ticks, q, power, block = (np.concatenate(column) for column in zip(*parts, strict=True))
    return _Rows(ticks, q, power, block, digest.hexdigest(), last == b"\n")


def _whole_lines(stream: BinaryIO, name: str) -> Iterator[bytes]:
    """The rest of the stream in chunks that end where a line ends; the last one as it is."""
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


def _parse(chunk: bytes, name: str, first_line: int) -> Array:
    """The numbers of whole lines, (n, 6)."""
    expected = chunk.count(b"\n") + (not chunk.endswith(b"\n"))
    if chunk.translate(None, _IN_NUMBERS) or not chunk.strip():  # nan, inf, 1_000, quotes; empty lines
        raise _row_problem(chunk, name, first_line)
    try:
        table = np.loadtxt(io.BytesIO(chunk), delimiter=",", comments=None, ndmin=2)
    except ValueError:
        raise _row_problem(chunk, name, first_line) from None
    if table.shape != (expected, _COLUMNS) or not np.isfinite(table).all() or not _whole_numbers(table[:, [0, 5]]):
        raise _row_problem(chunk, name, first_line)
    return table


def _whole_numbers(values: Array) -> bool:
    return bool((np.abs(values) <= MAX_WHOLE).all() and (values == np.floor(values)).all())


def _row_problem(chunk: bytes, name: str, first_line: int) -> ProgramError:
    """The error that names the first line of ``chunk`` that is not a row."""
    lines = chunk.removesuffix(b"\n").split(b"\n")
    for line, row in enumerate(lines, start=first_line):
        where = f"{name}, line {line}"
        cells = row.removesuffix(b"\r").split(b",")
        if len(cells) != _COLUMNS:
            return ProgramError(f"the row has {len(cells)} fields instead of {_COLUMNS}", where=where, hint=_DAMAGED)
        for column, cell in zip(HEADER.decode().strip().split(","), cells, strict=True):
            shown = cell[:40].decode("ascii", "backslashreplace")
            if not _NUMBER.fullmatch(cell) or not np.isfinite(float(cell)):
                return ProgramError(f"{column} is {shown!r}, which is not a number", where=where, hint=_DAMAGED)
            if column in ("tick", "block") and not _whole_numbers(np.array([float(cell)])):
                return ProgramError(f"{column} is {shown!r}, which is not a whole number", where=where, hint=_DAMAGED)
    return ProgramError("the rows cannot be read", where=f"{name}, from line {first_line}", hint=_DAMAGED)


def _file_problems(meta: metas.Meta, found: _Rows) -> list[str]:
    problems = []
    if meta.sha256 != found.sha256:
        problems.append("the rows are not those that were written: their SHA-256 is not the one in the meta object")
    if meta.rows != len(found.ticks):
        problems.append(f"the meta object states {meta.rows} rows, the file has {len(found.ticks)}")
    if not found.whole:
        problems.append("the last line has no end: the file was cut off")
    if meta.rate_hz != meta.robot.controller.rate_hz:
        problems.append(f"rate_hz is {meta.rate_hz:g}, but the robot's is {meta.robot.controller.rate_hz:g}")
    return problems


def _tick_problems(ticks: IntArray) -> list[str]:
    """What is wrong with the first tick that is not one more than the tick before it."""
    wrong = np.flatnonzero(ticks != np.arange(len(ticks)))
    if not len(wrong):
        return []
    row = int(wrong[0])
    what = f"expected tick {row}, found {ticks[row]} in line {row + _FIRST_ROW}"
    return [f"{TICK_COLUMN}{what}; {len(wrong)} of {len(ticks)} rows differ"]
