"""Going on after a stop: everything that comes before a contour is left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

from deltacam.errors import InfeasibleError
from deltacam.model import Cut, Finding, Operation

_NAMED = 10  # contours in a finding or an error
_DONE = {Operation.CUT: "cut", Operation.ENGRAVE: "engraved"}


class Resumed(NamedTuple):
    """The cuts that are left, in their order, and what a person should know about them."""

    cuts: tuple[Cut, ...]
    findings: tuple[Finding, ...]


def resume(ordered: Sequence[Cut], number: int) -> Resumed:
    """The cuts from the first one of a contour on; a finding names what is left out.

    The order must be that of the program that was stopped: the same drawing, process, robot and options give it.

    Args:
        ordered: all cuts in the order of the whole program.
        number: of the contour that is cut first.

    Raises:
        InfeasibleError: nothing is cut of that contour.
    """
    first = next((index for index, cut in enumerate(ordered) if cut.contour == number), None)
    if first is None:
        there = _numbers([cut.contour for cut in ordered])
        raise InfeasibleError(
            f"nothing is cut of contour {number}, so that the program cannot begin there",
            where=f"contours in their order: {there}",
            hint="give a number of the table of contours in the report (--from-contour)",
        )
    before = ordered[:first]
    if not before:
        return Resumed(tuple(ordered), ())
    counts = {done: sum(cut.operation is one for cut in before) for one, done in _DONE.items()}
    left_out = " and ".join(f"{count} {done}" for done, count in counts.items() if count)
    what = f"the program begins with contour {number}: {left_out} before it are left out, "
    what += f"contours {_numbers([cut.contour for cut in before])}"
    hint = "look at the sheet: all of them must be through, or the parts do not come out"
    return Resumed(tuple(ordered[first:]), (Finding(what, where=ordered[first].where, hint=hint, kind="resumed"),))


def _numbers(contours: Sequence[int]) -> str:
    """The numbers, each once, the first ones of many."""
    once = list(dict.fromkeys(contours))
    more = f" and {len(once) - _NAMED} more" if len(once) > _NAMED else ""
    return ", ".join(map(str, once[:_NAMED])) + more
