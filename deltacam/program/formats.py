"""The table of formats, and reading and writing by a file's name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import BinaryIO, Final, Protocol, cast

from deltacam.errors import ProgramError
from deltacam.program import csv, gcode, gcode_writer, halstreamer, parquet
from deltacam.program.atomic import replace_when_done
from deltacam.program.program import Program


class _Read(Protocol):
    def __call__(self, stream: BinaryIO, *, name: str) -> object: ...


@dataclass(frozen=True, slots=True)
class Format:
    """One way to keep a program, or its motion, in a file.

    Attributes:
        suffix: how the names of its files end; the last part alone is enough for reading.
        write: a program to a seekable binary stream that is empty.
        read: what a binary stream holds; ``name`` is for messages.
        whole: whether that is a `Program`, which can be verified again, and not only its motion.
    """

    suffix: str
    write: Callable[[Program, BinaryIO], None]
    read: _Read
    whole: bool

    @property
    def ending(self) -> str:
        """The last part of the suffix, such as .csv."""
        return "." + self.suffix.rpartition(".")[2]


FORMATS: Final[dict[str, Format]] = {
    "csv": Format(".program.csv", csv.write, csv.read, whole=True),
    "parquet": Format(".program.parquet", parquet.write, parquet.read, whole=True),
    "gcode": Format(".gcode", gcode_writer.write, gcode.read, whole=False),
    "halstreamer": Format(".halstream", halstreamer.write, halstreamer.read, whole=False),
}
"""By name. A new format is one line here; the shared tests and `deltacam export` take it up by themselves."""


def find_format(path: Path) -> Format | None:
    """The format that the name of ``path`` stands for, if any."""
    return next((known for known in FORMATS.values() if path.name.lower().endswith(known.ending)), None)


def name_of(path: Path) -> str:
    """What a file is called without its folder and the ending of its format: plate, of plate.program.csv."""
    known = find_format(path)
    if known is not None and path.name.lower().endswith(known.suffix):
        return path.name[: -len(known.suffix)]
    return path.stem


def format_of(path: Path) -> Format:
    """The format that the name of ``path`` stands for.

    Raises:
        ProgramError: none does.
    """
    known = find_format(path)
    if known is not None:
        return known
    raise ProgramError("the name is not that of a program file", where=str(path), hint=_names())


def _names() -> str:
    return "a program is called " + " or ".join(f"NAME{known.suffix}" for known in FORMATS.values() if known.whole)


def read_program(path: str | Path) -> Program:
    """The program in the file at ``path``.

    Returns:
        the program; what is wrong with a damaged but readable file is in its ``integrity``.

    Raises:
        ProgramError: the file cannot be opened or interpreted.
    """
    path = Path(path)
    if not path.exists():
        raise ProgramError("there is no such file", where=str(path), hint="check the name and the folder")
    known = format_of(path)
    if not known.whole:
        what = "the file holds only the motion of a program, which cannot be verified"
        raise ProgramError(what, where=str(path), hint=_names())
    try:
        with path.open("rb") as stream:
            return cast("Program", known.read(stream, name=path.name))
    except OSError as problem:
        reason = (problem.strerror or str(problem)).lower()
        raise ProgramError(f"the file cannot be read: {reason}", where=str(path)) from problem


def write_program(program: Program, path: str | Path) -> None:
    """Write ``program`` to ``path`` in the format that the name stands for, whole or not at all.

    Raises:
        ProgramError: the name stands for no format, the program cannot be written, or the operating system refuses.
    """
    path = Path(path)
    write_as(program, path, format_of(path))


def write_as(program: Program, path: Path, known: Format) -> None:
    """Write ``program`` to ``path`` in a format, whatever the name is, whole or not at all.

    Raises:
        ProgramError: the program cannot be written in this format, or the operating system refuses.
    """
    with replace_when_done(path) as temporary, temporary.open("wb") as stream:
        known.write(program, stream)
