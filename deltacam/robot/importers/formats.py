"""The programs whose robot descriptions can be read, and which of them a file is of."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from types import ModuleType
from typing import Final

from deltacam.errors import RobotError
from deltacam.robot.importers import classic, klipper, linuxcnc, reprap
from deltacam.robot.importers.complete import Imported, Wishes, complete
from deltacam.robot.importers.description import Choices, Description
from deltacam.robot.importers.ledger import Source, read_source

FORMATS: Final[dict[str, ModuleType]] = {module.NAME: module for module in (linuxcnc, klipper, reprap, classic)}
"""The importers by the name of their format."""


def import_robot(
    paths: Sequence[Path],
    *,
    format_name: str | None = None,
    choices: Choices | None = None,
    wishes: Wishes | None = None,
) -> Imported:
    """The robot that the files of another program describe.

    Args:
        paths: the files, all of the same robot.
        format_name: one of `FORMATS`; None to see it from the files.
        choices: what the files do not say of themselves.
        wishes: what the files do not say of the robot.

    Raises:
        RobotError: what is wrong or missing, in which file and line, and what to do.
    """
    return complete(
        describe([read_source(path) for path in paths], format_name, choices or Choices()), wishes or Wishes()
    )


def describe(sources: Sequence[Source], format_name: str | None, choices: Choices) -> Description:
    """What the files say.

    Raises:
        RobotError: an unknown format, a choice that the format has no use for, or whatever is wrong with the files.
    """
    importer = FORMATS[format_name or _format_of(sources)]
    for name, value in (("units", choices.millimetres_per_unit), ("joints_at", choices.joints_at)):
        if value is not None and name not in importer.USES:
            option = f"--{name.replace('_', '-')}"
            raise RobotError(
                f"{option} has no meaning for {importer.TITLE}, which fixes it", hint=f"leave {option} out"
            )
    found: Description = importer.describe(sources, choices)
    return found


def _format_of(sources: Sequence[Source]) -> str:
    """The format that the files are in.

    Raises:
        RobotError: none, or more than one.
    """
    found = [name for name, importer in FORMATS.items() if any(map(importer.is_like, sources))]
    if len(found) != 1:
        what = f"the file could be of {' and of '.join(found)}" if found else "the file describes no rotary delta robot"
        hint = f"say --from {' or '.join(found or FORMATS)}"
        raise RobotError(what, where=", ".join(source.name for source in sources), hint=hint)
    return found[0]
