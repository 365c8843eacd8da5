"""How the commands write a new file."""

from __future__ import annotations

from pathlib import Path

import click

from deltacam.errors import DeltacamError
from deltacam_cli.main import LONGEST_MESSAGE


def write_new(path: Path, content: bytes, *, ending: str, say: bool = True) -> None:
    """Write a file that is not there yet, whole or not at all.

    Raises:
        DeltacamError: its name has another ending, it is there, or it cannot be written.
    """
    from deltacam.plain import plain
    from deltacam.program.atomic import write_whole

    if path.suffix.lower() != ending:
        raise DeltacamError(f"the name does not end in {ending}", where=str(path), hint=f"write {path.stem}{ending}")
    if path.exists() or path.is_symlink():
        raise DeltacamError("the file is there already", where=str(path), hint="choose another name, or remove it")
    write_whole(path, content)
    if say:
        click.echo(f"wrote {plain(str(path), longest=LONGEST_MESSAGE)}")
