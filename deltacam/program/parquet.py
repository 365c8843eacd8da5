"""The program as a Parquet file: the columns of the CSV file as numbers, and the same meta object beside them.

The format is docs/reference/formats/parquet.md. Reading trusts nothing, as for CSV. Arrow's threads are never used:
with some versions they may still be at work when Python ends, which then aborts.
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Sequence
from typing import Any, BinaryIO, Final

import numpy as np

from deltacam.errors import ProgramError
from deltacam.model import Array, BoolArray, IntArray
from deltacam.program import contents
from deltacam.program import meta as metas
from deltacam.program.contents import DAMAGED, VERSION, Rows
from deltacam.program.fields import MAX_WHOLE, parse_json
from deltacam.program.program import Program
from deltacam.program.rows import COLUMNS, exact_angles, hash_rows, whole_angles

VERSION_KEY: Final = b"deltacam-program"
META_KEY: Final = b"deltacam-meta"
HASH_KEY: Final = b"deltacam-rows-sha256"

_MAGIC: Final = b"PAR1"
_TAIL: Final = 8  # bytes at the end: the length of the footer, and the magic number
_MAX_FOOTER: Final = contents.MAX_META + 2**20
_MAX_PARTS: Final = 100_000  # lists in the footer, such as that of the row groups
_FEW_ROWS: Final = 1_000_000  # which a file of any size may hold: a program may rest
_ROWS_PER_GROUP: Final = 2**20
_ROWS_PER_BATCH: Final = 2**16
_WHOLE: Final = ("tick", "block")


def write(program: Program, stream: BinaryIO) -> None:
    """Write ``program`` to ``stream``; the same program and version of pyarrow give the same bytes.

    Args:
        program: any that is whole; angles are rounded to 12 decimals.
        stream: binary, at its start.

    Raises:
        ProgramError: pyarrow is not installed; the program was read from a damaged file, whose hash must not be
            repaired; or the format cannot hold a value.
    """
    arrow = _arrow()
    ticks, angles, power = np.arange(len(program.q)), whole_angles(program.q), program.power + 0.0  # zero has no sign
    sha256 = hash_rows(ticks, angles, power, program.block)
    columns = [ticks, *exact_angles(np.ascontiguousarray(angles.T)), power, program.block]
    metadata = {
        VERSION_KEY: VERSION,
        META_KEY: contents.dump_meta(program, sha256),
        HASH_KEY: _hash_columns(sha256, columns),
    }
    table = arrow.table(list(map(arrow.array, columns)), schema=_schema(arrow))
    options = {
        "compression": "zstd",
        "use_dictionary": ["power", "block"],
        "column_encoding": dict.fromkeys(COLUMNS[1:4], "BYTE_STREAM_SPLIT"),
        "store_schema": False,
    }
    with arrow.parquet.ParquetWriter(stream, table.schema, **options) as writer:
        writer.write_table(table, row_group_size=_ROWS_PER_GROUP)
        writer.add_key_value_metadata({key.decode(): value for key, value in metadata.items()})


def read(stream: BinaryIO, *, name: str) -> Program:
    """Read a program.

    Args:
        stream: binary and seekable, at its start.
        name: of the file, for messages.

    Returns:
        the program as the rows say, with what is wrong with the file in `Program.integrity`.

    Raises:
        ProgramError: pyarrow is not installed, or the file cannot be interpreted.
    """
    arrow = _arrow()
    size = _check_footer(stream, name)
    try:
        file = arrow.parquet.ParquetFile(
            stream,
            pre_buffer=False,
            thrift_string_size_limit=_MAX_FOOTER,
            thrift_container_size_limit=_MAX_PARTS,
        )
        metadata = file.metadata.metadata or {}
        meta = _read_meta(metadata, name)
        _check_columns(arrow, file, name)
        columns = _read_columns(file, name, most=min(contents.MAX_ROWS, size + _FEW_ROWS))
    except (arrow.ArrowException, OSError, ValueError, MemoryError) as problem:
        reason = (str(problem).splitlines() or [type(problem).__name__])[0][:200]
        shown = reason.encode("unicode_escape").decode()  # it may hold names from the file
        raise ProgramError(f"the file is not Parquet that can be read: {shown}", where=name, hint=DAMAGED) from problem
    ticks, *angles, power, block = columns
    intact = metadata[HASH_KEY] == _hash_columns(meta.sha256, columns).encode()
    rows = Rows(ticks, np.stack(angles, axis=1), power, block, intact)
    return contents.to_program(meta, rows, [], name=name, place="row", first=0)


def _arrow() -> Any:
    """The package pyarrow, which is heavy and optional.

    Raises:
        ProgramError: it is not installed.
    """
    try:
        import pyarrow.parquet
    except ImportError as problem:
        what = "Parquet files need the package pyarrow, which is not installed"
        raise ProgramError(what, hint='pip install "deltacam[parquet]"') from problem
    return pyarrow


def _schema(arrow: Any) -> Any:
    types = {name: arrow.int64() if name in _WHOLE else arrow.float64() for name in COLUMNS}
    return arrow.schema([arrow.field(name, kind, nullable=False) for name, kind in types.items()])


def _check_footer(stream: BinaryIO, name: str) -> int:
    """The size of the file; refuses by their first and last bytes those that are something else or cut off."""
    size = stream.seek(0, os.SEEK_END)
    stream.seek(0)
    head = stream.read(len(_MAGIC))
    stream.seek(max(size - _TAIL, 0))
    tail = stream.read(_TAIL)
    stream.seek(0)
    if head != _MAGIC or size < len(_MAGIC) + _TAIL:
        hint = "give a file that `deltacam export --to parquet` wrote: NAME.program.parquet"
        raise ProgramError("not a Parquet file: it does not start with 'PAR1'", where=name, hint=hint)
    if tail[4:] != _MAGIC:
        raise ProgramError("the file was cut off: it does not end with 'PAR1'", where=name, hint=DAMAGED)
    if size > contents.MAX_BYTES:
        raise contents.too_large(name)
    if int.from_bytes(tail[:4], "little") > _MAX_FOOTER:
        raise ProgramError(f"the footer is larger than {_MAX_FOOTER:,} bytes", where=name, hint=DAMAGED)
    return size


def _read_meta(found: dict[bytes, bytes], name: str) -> metas.Meta:
    where = f"{name}, key-value metadata"
    for key in (VERSION_KEY, META_KEY, HASH_KEY):
        if key not in found:
            hint = "give a file that deltacam wrote; other programs drop the metadata when they write it again"
            raise ProgramError(f"not a deltacam program: {key.decode()} is missing", where=where, hint=hint)
    contents.refuse_version(found[VERSION_KEY], where)
    if len(found[META_KEY]) > contents.MAX_META:
        raise ProgramError(f"the meta object is larger than {contents.MAX_META:,} bytes", where=where)
    try:
        text = found[META_KEY].decode("utf-8")
    except UnicodeDecodeError as problem:
        raise ProgramError("the meta object is not UTF-8", where=where) from problem
    return metas.from_meta(parse_json(text, where), where)


def _check_columns(arrow: Any, file: Any, name: str) -> None:
    found, wanted = file.schema_arrow, _schema(arrow)
    if found.names != wanted.names:
        raise ProgramError(f"the columns are not {', '.join(wanted.names)}", where=name, hint=DAMAGED)
    for one, other in zip(found, wanted, strict=True):
        if one.type != other.type:
            raise ProgramError(f"the column {one.name} is {one.type}, not {other.type}", where=name, hint=DAMAGED)


def _read_columns(file: Any, name: str, *, most: int) -> list[Any]:
    """The columns, each (N,) with N at most ``most``; all numbers are there and finite, ticks and blocks fit a double.

    The number of rows that the file states is not trusted.
    """
    parts, rows = [], 0
    for batch in file.iter_batches(batch_size=_ROWS_PER_BATCH, use_threads=False):
        for column, values in zip(COLUMNS, batch.columns, strict=True):
            wrong = _wrong(values, whole=column in _WHOLE)
            if wrong.any():
                what = f"{column} in row {rows + wrong.argmax()} is missing, not finite or too large"
                raise ProgramError(what, where=name, hint=DAMAGED)
        parts.append([values.to_numpy() for values in batch.columns])
        rows += len(batch)
        if rows > most:
            raise ProgramError(f"the file holds more than {most:,} rows, which is too many for its size", where=name)
    if not rows:
        raise ProgramError("the program has no setpoint", where=name, hint=DAMAGED)
    return [np.concatenate(column) for column in zip(*parts, strict=True)]


def _wrong(values: Any, *, whole: bool) -> BoolArray:
    """Which values of an Arrow array no program holds, (N,)."""
    if values.null_count:
        return np.asarray(values.is_null().to_numpy(zero_copy_only=False))
    array = values.to_numpy()
    return np.asarray((array < -MAX_WHOLE) | (array > MAX_WHOLE) if whole else ~np.isfinite(array))


def _hash_columns(sha256: str, columns: Sequence[Array | IntArray]) -> str:
    """The SHA-256 of the text ``sha256`` and then of the columns as numbers of 8 bytes, hexadecimal.

    To check this needs no text of the rows, which is what takes longest; and it stands for the hash of the text, too.
    """
    digest = hashlib.sha256(sha256.encode("utf-8", "backslashreplace"))
    for column in columns:
        digest.update(np.ascontiguousarray(column, dtype=column.dtype.newbyteorder("<")).data)
    return digest.hexdigest()
