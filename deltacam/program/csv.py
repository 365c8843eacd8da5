"""The program file as text: two comment lines, a line of column names, and a row per tick.

The format is docs/reference/program-format.md. Reading trusts nothing: what cannot be interpreted is refused; what can
be, but is not as deltacam writes it, is listed in `Program.integrity` for the checks.
"""

from __future__ import annotations

import hashlib
from typing import BinaryIO, Final

import numpy as np

from deltacam.errors import ProgramError
from deltacam.model import Array, IntArray
from deltacam.program import contents
from deltacam.program import meta as metas
from deltacam.program.contents import VERSION, Rows
from deltacam.program.fields import parse_json
from deltacam.program.lines import parse_lines, whole_lines
from deltacam.program.program import Program
from deltacam.program.rows import COLUMNS, HEADER, format_rows, whole_angles

MAGIC: Final = b"# deltacam-program "

_FIRST_ROW: Final = 4  # its line
_CUT_OFF: Final = "the last line has no end: the file was cut off"


def write(program: Program, stream: BinaryIO) -> None:
    """Write ``program`` to ``stream``; the same program gives the same bytes.

    Args:
        program: any that is whole; angles are rounded to 12 decimals.
        stream: binary and seekable, because the hash of the rows stands before them.

    Raises:
        ProgramError: the program was read from a damaged file, whose hash must not be repaired; or the format cannot
            hold a value.
    """
    start = stream.tell()
    stream.write(_preamble(program, "0" * 64))
    digest = hashlib.sha256(HEADER)
    stream.write(HEADER)
    for chunk in format_rows(np.arange(len(program.q)), whole_angles(program.q), program.power, program.block):
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
    rows, whole = _read_rows(stream, name, meta.sha256)
    problems += untidy if whole else [*untidy, _CUT_OFF]
    return contents.to_program(meta, rows, problems, name=name, place="line", first=_FIRST_ROW)


def _preamble(program: Program, sha256: str) -> bytes:
    """The two comment lines."""
    return MAGIC + VERSION.encode() + b"\n# " + contents.dump_meta(program, sha256).encode("ascii") + b"\n"


def _read_version(stream: BinaryIO, name: str) -> list[str]:
    line = stream.readline(len(MAGIC) + 20)
    where = f"{name}, line 1"
    if not line.startswith(MAGIC):
        what = f"not a deltacam program: the first line is not {(MAGIC + VERSION.encode()).decode()!r}"
        raise ProgramError(what, where=where, hint="give a file that `deltacam plan` wrote: NAME.program.csv")
    version = line.removeprefix(MAGIC).strip()
    contents.refuse_version(version, where)
    return _line_end_problems(line, 1)


def _read_meta(stream: BinaryIO, name: str) -> tuple[metas.Meta, list[str]]:
    where = f"{name}, line 2"
    line = stream.readline(contents.MAX_META)
    if not line.endswith(b"\n"):
        hint = "the file was cut off, or is not from deltacam"
        raise ProgramError(f"the line does not end within {contents.MAX_META:,} bytes", where=where, hint=hint)
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


def _read_rows(stream: BinaryIO, name: str, sha256: str) -> tuple[Rows, bool]:
    """The rows, and whether the last line has its end."""
    digest = hashlib.sha256(HEADER)
    parts: list[tuple[IntArray, Array, Array, IntArray]] = []
    line, size, last = _FIRST_ROW, 0, b"\n"
    for chunk in whole_lines(stream, name):
        digest.update(chunk)
        table = parse_lines(chunk, name, line, COLUMNS, whole=("tick", "block"))
        line += len(table)
        size += len(chunk)
        last = chunk[-1:]
        if size > contents.MAX_BYTES or line - _FIRST_ROW > contents.MAX_ROWS:
            raise contents.too_large(name)
        ticks, block = table[:, 0].astype(np.int64), table[:, 5].astype(np.int64)
        parts.append((ticks, table[:, 1:4].copy(), table[:, 4].copy(), block))
    if not parts:
        hint = "the file was cut off; plan the drawing again"
        raise ProgramError("the program has no setpoint", where=f"{name}, line {_FIRST_ROW}", hint=hint)
    ticks, q, power, block = (np.concatenate(column) for column in zip(*parts, strict=True))
    return Rows(ticks, q, power, block, digest.hexdigest() == sha256), last == b"\n"
