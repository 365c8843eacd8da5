"""The files that planning a drawing writes into a folder."""

from __future__ import annotations

import os
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from deltacam.errors import ProgramError
from deltacam.program.formats import FORMATS, name_of


@dataclass(frozen=True, slots=True)
class Outputs:
    """Their paths."""

    program: Path
    report_json: Path
    report_html: Path

    @classmethod
    def of(cls, drawing: str | Path, folder: str | Path) -> Outputs:
        """The files for a drawing of that name."""
        folder, stem = Path(folder), Path(drawing).stem
        names = (f"{stem}.program.csv", f"{stem}.report.json", f"{stem}.report.html")
        return cls(*(folder / name for name in names))

    def clear(self) -> None:
        """Remove what an earlier run left, so that a failed run leaves no program to be used by mistake.

        That is the program in every format that holds a whole one, and the reports.

        Raises:
            ProgramError: the operating system refuses.
        """
        name = name_of(self.program)
        programs = [self.program.with_name(f"{name}{known.suffix}") for known in FORMATS.values() if known.whole]
        for path in (*programs, self.report_json, self.report_html):
            try:
                path.unlink(missing_ok=True)
            except NotADirectoryError:
                continue  # so nothing is left there
            except OSError as problem:
                reason = (problem.strerror or str(problem)).lower()
                hint = "choose another folder with -o, or get permission there"
                raise ProgramError(
                    f"the file of an earlier run cannot be removed: {reason}", where=str(path), hint=hint
                ) from problem


def make_folder(folder: Path) -> None:
    """Make the folder where it is missing, and find out now whether it can be written to.

    Raises:
        ProgramError: it cannot.
    """
    if folder.exists() and not folder.is_dir():
        raise ProgramError("this is a file, not a folder", where=str(folder), hint="name a folder with -o")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        probe = folder / f".deltacam-{os.getpid()}.tmp"
        try:
            probe.touch()
        finally:
            with suppress(OSError):
                probe.unlink(missing_ok=True)
    except OSError as problem:
        reason = (problem.strerror or str(problem)).lower()
        hint = "choose another folder with -o, or get permission there"
        raise ProgramError(f"the folder cannot be written to: {reason}", where=str(folder), hint=hint) from problem
