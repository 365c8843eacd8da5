"""A kind of damage, what comes of it, and what the verifier says to that."""

import io
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from deltacam.errors import ProgramError
from deltacam.model import Drawing, Process, Report
from deltacam.program import csv
from deltacam.program.program import Program
from deltacam.robot.robot import Robot
from deltacam.verification.verify import verify
from tests.damage.example import Example

READING = "reading"
"""Stands among the checks for a file that is refused when it is read."""


@dataclass(frozen=True, eq=False)
class Mutant:
    """What is handed to the verifier instead of a valid program and its drawing.

    Attributes:
        program: the bytes of a file, or a program that is written as deltacam writes it.
        drawing: that it is checked against; None takes that of the example.
        robot: that it is checked against; None takes the one in the program.
        process: likewise.
    """

    program: Program | bytes
    drawing: Drawing | None = None
    robot: Robot | None = None
    process: Process | None = None


Make = Callable[[Example, float, np.random.Generator], Program | bytes | Mutant]
"""Makes a mutant of an example at a size; raises `NoPlaceError` where the example has no place for it."""


@dataclass(frozen=True)
class Kind:
    """A kind of damage.

    Attributes:
        make: the mutant.
        checks: the mutant must fail at least one of these.
        tolerance: what the sizes are multiples of, in words.
        near: a size just above what is tolerated.
        far: a size far above it.
        below: a size at which these checks must still pass; None where nothing at all is tolerated.
    """

    make: Make
    checks: tuple[str, ...]
    tolerance: str
    near: float
    far: float
    below: float | None = None


@dataclass(frozen=True)
class Verdict:
    """What the verifier says to a mutant.

    Attributes:
        failed: the names of the checks that it fails, or `READING`; none where it may be used.
        warned: the names of those that do not make it fail.
    """

    failed: frozenset[str]
    warned: frozenset[str] = frozenset()

    @classmethod
    def of(cls, report: Report) -> "Verdict":
        """What a report comes to."""
        wrong = [check for check in report.checks if not check.passed]
        warned = frozenset(check.name for check in wrong if check.warns)
        return cls(frozenset(check.name for check in wrong) - warned, warned)


def verdict(example: Example, made: Program | bytes | Mutant) -> Verdict:
    """What the verifier says to a mutant, by way of the bytes of a file."""
    mutant = made if isinstance(made, Mutant) else Mutant(made)
    try:
        program = csv.read(io.BytesIO(_content(mutant.program)), name="mutant.program.csv")
    except ProgramError:
        return Verdict(frozenset({READING}))
    drawing = mutant.drawing or example.drawing
    report = verify(program, drawing=drawing, robot=mutant.robot, process=mutant.process)
    return Verdict.of(report)


def _content(program: Program | bytes) -> bytes:
    if isinstance(program, bytes):
        return program
    stream = io.BytesIO()
    csv.write(program, stream)
    return stream.getvalue()
