"""The batch for a terminal: the verdict, the totals, and why parts did not pass; it fits a screen or two."""

from __future__ import annotations

from typing import Final

from deltacam.batch.parts import Batch, Status
from deltacam.batch.results.reasons import Reason, reasons
from deltacam.batch.results.totals import clock, counted, totals, verdict
from deltacam.plain import plain

_MOST_REASONS: Final = 12
_MOST_NOTES: Final = 8
_LONGEST_NOTE: Final = 400  # characters


def to_text(batch: Batch) -> str:
    """The batch as lines of text; nothing in it makes a terminal do anything."""
    lines = [f"{'PASSED' if batch.passed else 'FAILED'}  {verdict(batch)}", *_figures(batch)]
    found = reasons(batch)
    if found:
        lines += ["", *(line for one in found[:_MOST_REASONS] for line in _lines(one))]
    if left := sum(len(one.parts) for one in found[_MOST_REASONS:]):
        lines.append(f"  and {left} more for other reasons, in batch.json")
    if batch.notes:
        lines += ["", *(f"note: {plain(note, longest=_LONGEST_NOTE)}" for note in batch.notes[:_MOST_NOTES])]
    if len(batch.notes) > _MOST_NOTES:
        lines.append(f"note: and {len(batch.notes) - _MOST_NOTES} more, in batch.json")
    return "\n".join(lines)


def _figures(batch: Batch) -> list[str]:
    """What is to be cut, and how much of it was there before."""
    lines = []
    if batch.count(Status.PASSED):
        sums = totals(batch)
        what = f"{counted(sums.pieces, 'piece')} in {clock(sums.time)} h, {sums.cut_length:.2f} m cut"
        lines.append(f"  to cut  {what}")
    if again := sum(row.again for row in batch.rows):
        verb = "was" if again == 1 else "were"
        lines.append(f"  before  {counted(again, 'part')} {verb} there already, made from the same drawing and options")
    return lines


def _lines(reason: Reason) -> list[str]:
    """One reason: how many parts, which, why, and what to do."""
    many = f"{len(reason.parts)} parts: " if len(reason.parts) > 1 else ""
    lines = [f"  {reason.status.upper():<9}  {many}{reason.named}"]
    lines += [f"             {text}" for text in (reason.sentence, reason.hint and f"hint: {reason.hint}") if text]
    return lines
