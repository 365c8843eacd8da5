"""What the parts that passed come to."""

from __future__ import annotations

import math
from dataclasses import dataclass

from deltacam.batch.parts import Batch, Status


@dataclass(frozen=True, slots=True)
class Totals:
    """Sums over the parts that passed, every part as often as it is wanted.

    Attributes:
        pieces: how many are to be cut.
        time: that their programs take, s.
        cut_length: of their programs, m.
    """

    pieces: int
    time: float
    cut_length: float


def totals(batch: Batch) -> Totals:
    """The sums; they do not depend on the order of the rows."""
    passed = [row for row in batch.rows if row.outcome.status is Status.PASSED]
    known = [(row.quantity, row.outcome.facts) for row in passed if row.outcome.facts]
    return Totals(
        pieces=sum(row.quantity for row in passed),
        time=math.fsum(quantity * facts.time for quantity, facts in known),
        cut_length=math.fsum(quantity * facts.cut_length for quantity, facts in known),
    )


def verdict(batch: Batch) -> str:
    """How many passed, and how the others ended: ``3 of 5 parts passed: 1 refused, 1 timeout``."""
    counts = {status: batch.count(status) for status in Status if status is not Status.PASSED}
    others = ", ".join(f"{count} {status}" for status, count in counts.items() if count)
    parts = f"{batch.count(Status.PASSED)} of {counted(len(batch.rows), 'part')}"
    return f"{parts} passed: {others}" if others else f"{parts} passed"


def counted(number: int, noun: str) -> str:
    """The number with the noun, in the plural where it needs that."""
    return f"{number} {noun}" if number == 1 else f"{number} {noun}s"


def clock(time: float) -> str:
    """So many seconds as ``h:mm:ss``."""
    minutes, seconds = divmod(round(time), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{seconds:02}"
