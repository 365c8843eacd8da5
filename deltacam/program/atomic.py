"""Files that appear whole under their name, or not at all."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from deltacam.errors import ProgramError


@contextmanager
def replace_when_done(path: Path, *, by_way_of: Path | None = None) -> Iterator[Path]:
    """A temporary file beside ``path`` that takes its name when the block ends well.

    The temporary name starts with a dot and ends in ``.tmp``, so that nothing takes it for a program. It is removed
    when the block ends with any exception, also KeyboardInterrupt; an older file called ``path`` then stays as it was.
    The content is on the disk before the file takes its name.

    Args:
        path: where the file is wanted; its folder must exist.
        by_way_of: the folder of the temporary file, on the same file system; None takes that of ``path``.

    Yields:
        the path of an empty file to write, read back and check.

    Raises:
        ProgramError: the operating system refuses, within the block too.
    """
    temporary = (by_way_of or path.parent) / f".deltacam-{secrets.token_hex(8)}.tmp"
    try:
        try:
            temporary.touch(exist_ok=False)
            yield temporary
            _flush(temporary)
            temporary.replace(path)
            _flush_folder(path.parent)
        finally:
            with suppress(OSError):
                temporary.unlink(missing_ok=True)
    except OSError as problem:
        reason = (problem.strerror or str(problem)).lower()
        hint = "choose another folder with -o, or make room and permission there"
        raise ProgramError(f"the file cannot be written: {reason}", where=str(path), hint=hint) from problem


def write_whole(path: Path, content: bytes, *, by_way_of: Path | None = None) -> None:
    """Write ``content`` to ``path``, whole or not at all.

    Raises:
        ProgramError: the operating system refuses, or does not keep what was written.
    """
    with replace_when_done(path, by_way_of=by_way_of) as temporary:
        temporary.write_bytes(content)
        if temporary.read_bytes() != content:
            raise ProgramError("the file system did not keep what was written", where=str(path))


def _flush(path: Path) -> None:
    """Wait until the content of ``path`` is on the disk."""
    with path.open("rb+") as stream:
        os.fsync(stream.fileno())


def _flush_folder(folder: Path) -> None:
    """Wait until the names in ``folder`` are on the disk, where the system can do that."""
    with suppress(OSError):
        descriptor = os.open(folder, os.O_RDONLY)
        try:
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
