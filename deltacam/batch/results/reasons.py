"""Why parts did not pass: those that say the same of different things together."""

from __future__ import annotations

from collections import defaultdict
from typing import Final, NamedTuple

from deltacam.batch.parts import Batch, Row, Status
from deltacam.inspection.similar import pattern, summary
from deltacam.plain import plain

_LONGEST: Final = 400  # characters of a sentence
_NAMED: Final = 3  # parts


class Reason(NamedTuple):
    """Why some parts did not pass; all texts are plain.

    Attributes:
        status: how all of them ended.
        what: went wrong, in one line for all.
        where: the place in the first of them, if any.
        hint: what to do about it, if anything.
        parts: their names, in order.
    """

    status: Status
    what: str
    where: str
    hint: str
    parts: tuple[str, ...]

    @property
    def sentence(self) -> str:
        """What went wrong, and where in the first of them."""
        more = " ..." if self.where and len(self.parts) > 1 else ""
        return f"{self.where}{more}: {self.what}" if self.where else self.what

    @property
    def named(self) -> str:
        """The first few of the parts, and how many more there are."""
        more = f" and {len(self.parts) - _NAMED} more" if len(self.parts) > _NAMED else ""
        return ", ".join(plain(name) for name in self.parts[:_NAMED]) + more


def reasons(batch: Batch) -> list[Reason]:
    """The reasons, those of most parts first; every part that did not pass is in one of them."""
    groups: defaultdict[tuple[Status, str, str], list[Row]] = defaultdict(list)
    for row in batch.rows:
        outcome = row.outcome
        if outcome.status is not Status.PASSED:
            groups[outcome.status, pattern(_plain(outcome.what)), pattern(_plain(outcome.hint))].append(row)
    found = [_reason(status, rows) for (status, _, _), rows in groups.items()]
    order = list(Status)
    return sorted(found, key=lambda one: (-len(one.parts), order.index(one.status)))


def _reason(status: Status, rows: list[Row]) -> Reason:
    return Reason(
        status=status,
        what=summary(_plain(row.outcome.what) for row in rows),
        where=plain(rows[0].outcome.where),
        hint=summary(_plain(row.outcome.hint) for row in rows),
        parts=tuple(row.part for row in rows),
    )


def _plain(text: str) -> str:
    return plain(text, longest=_LONGEST)
