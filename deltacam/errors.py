"""The error that a user can act on."""

from __future__ import annotations

import copyreg


class DeltacamError(Exception):
    """A problem in the input, with what is wrong, where, and what to do.

    The parts are fields, so that tests and ``--json`` can read them.

    Args:
        what: the problem in one lower-case line, with the value and the limit.
        where: the file, layer and handle, or the time and joint; may be empty.
        hint: something to type or to change; may be empty.
    """

    def __init__(self, what: str, *, where: str = "", hint: str = "") -> None:
        super().__init__(what)
        self.what = what
        self.where = where
        self.hint = hint

    def __str__(self) -> str:
        return f"{self.where}: {self.what}" if self.where else self.what

    def __reduce__(self) -> tuple[object, ...]:
        # Not through ``__init__``, whose parameters are other ones in some kinds of error.
        return (copyreg.__newobj__, (type(self), *self.args), vars(self))  # type: ignore[attr-defined]


class DrawingError(DeltacamError):
    """The drawing cannot be read, or holds nothing that can be cut."""


class RobotError(DeltacamError):
    """The robot file is wrong, or the robot cannot reach a place."""


class ProcessError(DeltacamError):
    """The process file or a process value is wrong."""


class InfeasibleError(DeltacamError):
    """The drawing is right, but this robot with this process cannot cut it."""


class ProgramError(DeltacamError):
    """A program file cannot be read or written."""
