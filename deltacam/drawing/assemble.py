"""The curves of a drawing to numbered contours: each operation's lines are joined among themselves.

So an engraved line that ends on an outline does not make the outline ambiguous. What is ignored is joined as well, that
people can see what they leave out.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from deltacam.drawing.entities.walk import Drawn
from deltacam.drawing.joining import join
from deltacam.drawing.nesting import containment
from deltacam.drawing.operations import Assignment
from deltacam.model import Contour, Curve, Finding, IntArray, Operation, Outcome


@dataclass(slots=True)
class Assembled:
    """All contours of a drawing, machined or not.

    Attributes:
        contours: in the order of their numbers.
        left_open: the numbers of chains that are only ignored because they do not close.
        contour_of: the number of the contour that an entity is part of, by the entity's index.
        notes: what became of the entities that are not machined, by index, and why.
        copies: entities that repeat another one: index to index.
        findings: what a person should know.
        error: largest distance of what is machined from what the entities draw, m.
    """

    contours: list[Contour] = field(default_factory=list)
    left_open: list[int] = field(default_factory=list)
    contour_of: dict[int, int] = field(default_factory=dict)
    notes: dict[int, tuple[Outcome, str]] = field(default_factory=dict)
    copies: dict[int, int] = field(default_factory=dict)
    findings: list[Finding] = field(default_factory=list)
    error: float = 0.0


@dataclass(frozen=True, slots=True, eq=False)
class _Line:
    """A loop or chain of one operation, before it has a number."""

    curve: Curve
    members: tuple[int, ...]
    operation: Operation
    error: float = 0.0
    reason: str = ""
    is_outline: bool = False
    is_tangle: bool = False


def assemble(found: Drawn, assigned: Assignment, joining: float) -> Assembled:
    """Join, number and nest the curves of a drawing.

    Args:
        found: what the drawing holds.
        assigned: what is to be done with each entity.
        joining: largest distance of ends that are joined, m.

    Raises:
        DrawingError: thousands of ends in one place, or of contours in each other.
    """
    result = Assembled()
    lines: list[_Line] = []
    for operation in Operation:
        which = np.flatnonzero(assigned.of(operation)[found.owner])
        if len(which):
            lines += _join(found, which, operation, assigned, joining, result)
    lines.sort(key=lambda line: (not line.curve.closed, line.members[0]))
    for number, line in enumerate(lines, start=1):
        _add(number, line, found, assigned, result)
    for later, first in result.copies.items():
        result.notes[later] = (Outcome.MERGED, f"duplicate of #{found.entities[first].handle}")
        if first in result.contour_of:
            result.contour_of[later] = result.contour_of[first]
    _nest(result, lines)
    return result


def _join(
    found: Drawn, which: IntArray, operation: Operation, assigned: Assignment, joining: float, result: Assembled
) -> list[_Line]:
    """The loops and chains of the curves ``which``, all of one operation; notes what is in none of them."""
    owner = found.owner[which].tolist()
    joined = join.join(found.curves.take(which), joining=joining, name=lambda i: found.entities[owner[i]].where)
    result.notes |= {owner[i]: note for i, note in joined.notes.items()}
    result.copies |= {owner[later]: owner[first] for later, first in joined.copies.items()}
    if operation is Operation.CUT:
        result.findings += joined.findings
    elif operation is Operation.ENGRAVE:  # on the line itself, however lines meet
        result.findings += (replace(finding, blocks=False) for finding in joined.findings)
    lines = [
        _Line(loop.curve, tuple(owner[i] for i in loop.members), operation, error=loop.error) for loop in joined.loops
    ]
    for chain in joined.chains:
        members = tuple(owner[i] for i in chain.members)
        if operation is Operation.IGNORE:
            lines.append(_Line(chain.curve, members, operation))
            continue
        lines.append(
            _Line(
                chain.curve,
                members,
                _if_open(members, assigned, found, result),
                reason=chain.reason,
                is_outline=chain.nearly_closed,
                is_tangle=chain.ambiguous,
            )
        )
    return lines


def _if_open(members: tuple[int, ...], assigned: Assignment, found: Drawn, result: Assembled) -> Operation:
    """What is done with an open chain; a finding where its entities do not agree."""
    wanted = [assigned[i].open for i in members]
    if len(set(wanted)) > 1:
        words = " and ".join(dict.fromkeys(wanted))
        what = f"an open chain joins lines for which the process wants different things: {words}"
        hint = "give the layers of the chain the same `open` in the process"
        result.findings.append(
            Finding(what, where=found.entities[members[0]].where, hint=hint, kind="operation", blocks=True)
        )
    return wanted[0]


def _add(number: int, line: _Line, found: Drawn, assigned: Assignment, result: Assembled) -> None:
    """Makes a contour of a line."""
    handles = tuple(dict.fromkeys(found.entities[i].handle for i in line.members))
    layer = found.entities[line.members[0]].layer
    result.contours.append(Contour(number, line.curve, layer, handles, operation=line.operation))
    if line.operation is Operation.IGNORE and line.reason:
        result.left_open.append(number)
    for i in line.members:
        result.contour_of.setdefault(i, number)
        if line.operation is Operation.IGNORE:
            result.notes[i] = (Outcome.IGNORED, line.reason or assigned[i].reason)
    if line.operation is not Operation.IGNORE:
        result.error = max(result.error, line.error + max(found.entities[i].error for i in line.members))


def _nest(result: Assembled, lines: Sequence[_Line]) -> None:
    """Gives every closed contour its depth and parent: among those that are cut, and those of its own operation."""
    outlines = [line.curve for line in lines if line.is_outline and line.operation is Operation.IGNORE]
    tangles = [line.curve for line in lines if line.is_tangle]
    cut = [contour for contour in result.contours if contour.has_kerf]
    nested: tuple[Contour, ...] = ()
    if cut:
        nested, findings = containment.nest(cut, outlines=outlines, tangles=tangles)
        result.findings += findings
    for operation in (Operation.ENGRAVE, Operation.IGNORE):
        own = [contour for contour in result.contours if contour.curve.closed and contour.operation is operation]
        if own:
            around, _ = containment.nest([*cut, *own], outlines=(), tangles=())
            nested = (*nested, *around[len(cut) :])
    for contour in nested:
        result.contours[contour.number - 1] = contour
