"""What was read from a drawing, for a terminal; it fits a screen."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import Final

from deltacam.inspection.measures import Measured, kind, kind_in_words, layers, measure, totals
from deltacam.inspection.similar import pattern, summary
from deltacam.inspection.table import aligned
from deltacam.inspection.warning_lines import warning_lines
from deltacam.model import Contour, Drawing, IntArray, LedgerEntry, Operation, Outcome
from deltacam.plain import plain
from deltacam.units import METRES_PER, to_mm, to_um

_WIDTH: Final = 120  # columns
_NAME: Final = 30  # characters of a layer's name
_MOST_LAYERS: Final = 8
_MOST_CONTOURS: Final = 12
_MOST_REASONS: Final = 6
_NOTICED: Final = 1e-8
"""Conversion errors below a hundredth of a micrometre are rounding, m."""

_ALTERNATIVES: Final = ("mm", "in", "pt")
_BLOCKS: Final = "inserted blocks, whose entities are counted one by one"


def to_text(drawing: Drawing, *, again: str = "") -> str:
    """The drawing as lines of text with a line feed at the end; nothing in it makes a terminal do anything.

    Args:
        drawing: any.
        again: the command that plans it, without what this drawing needs in addition; empty for none.
    """
    measured = measure(drawing)
    parts = [
        _heading(drawing),
        _layer_table(drawing, measured),
        _contour_table(measured),
        _ledger(drawing.ledger),
        warning_lines(drawing.findings, width=_WIDTH),
        _next(drawing, again),
    ]
    return "\n\n".join("\n".join(part) for part in parts if part) + "\n"


def _heading(drawing: Drawing) -> list[str]:
    """The file, the unit with who states it, and the size."""
    lines = [plain(drawing.file)]
    missing = not drawing.unit
    lines.append(f"  unit     {'not stated: everything below is as if it were mm' if missing else _unit(drawing)}")
    if drawing.extents is None:
        return [*lines, "  size     nothing is drawn"]
    size = _size(drawing.extents)
    if missing:
        width, height = (length / drawing.metres_per_unit for length in size)
        sizes = [f"{_by((METRES_PER[unit] * width, METRES_PER[unit] * height))} if {unit}" for unit in _ALTERNATIVES]
        lines.append(f"  size     {', '.join(sizes)}")
    else:
        lines.append(f"  size     {_by(size)}")
    x, y = drawing.extents[:2]
    lines[-1] += f"; lower left corner at ({to_mm(x):.2f}, {to_mm(y):.2f}) mm"
    if drawing.conversion_error >= _NOTICED:
        lines.append(f"  error    {to_um(drawing.conversion_error):.2g} um at most between these contours and the file")
    return lines


def _unit(drawing: Drawing) -> str:
    return plain(drawing.unit_in_words)


def _layer_table(drawing: Drawing, measured: Measured) -> list[str]:
    used = layers(drawing, measured)
    if not used:
        return []
    used = sorted(used, key=lambda one: -one.layer.curves) if len(used) > _MOST_LAYERS else used
    rows = [("layer", "colour", "line type", "state", "entities", "operation", "closed", "open")]
    rows += [
        (
            plain(one.layer.name, longest=_NAME),
            str(one.layer.color),
            plain(one.layer.linetype, longest=_NAME),
            one.layer.state,
            str(one.layer.entities),
            ", ".join(one.operations) or "-",
            str(one.closed),
            str(one.open),
        )
        for one in used[:_MOST_LAYERS]
    ]
    lines = aligned(rows, right=(1, 4, 6, 7))
    return [*lines, *_rest(len(used) - _MOST_LAYERS, "layer")]


def _contour_table(measured: Measured) -> list[str]:
    """The counts, then a row per contour, equal ones together."""
    kinds = Counter(map(kind, measured.contours))
    lines = ["  contours: " + ", ".join(f"{kinds[name]} {name}" for name in ("outer", "inner", "open"))]
    if not measured.contours:
        return lines
    groups = _alike(measured)
    if len(groups) > _MOST_CONTOURS:
        groups = sorted(groups, key=lambda group: _rank(measured.contours[group[0]], measured.lengths[group[0]]))
    rows = [("number", "like it", "kind", "layer", "size mm", "length mm", "segments", "operation")]
    for group in groups[:_MOST_CONTOURS]:
        contour = measured.contours[group[0]]
        kinds_in_words = {kind_in_words(measured.contours[i]) for i in group}
        rows.append(
            (
                str(contour.number),
                str(len(group) - 1) if len(group) > 1 else "",
                kind_in_words(contour) if len(kinds_in_words) == 1 else kind_in_words(replace(contour, parent=None)),
                plain(contour.layer, longest=_NAME),
                _by(measured.sizes[group[0]].tolist(), unit=""),
                f"{to_mm(measured.lengths[group[0]]):.2f}",
                _segments(measured.segments[group], measured.arcs[group]),
                contour.operation.value,
            )
        )
    lines += aligned(rows, right=(0, 1, 4, 5))
    return [*lines, *_rest(sum(map(len, groups[_MOST_CONTOURS:])), "contour")]


def _alike(measured: Measured) -> list[list[int]]:
    """The contours in groups of the same kind, layer, operation, size and length, in the order of their numbers."""
    measures = zip(measured.sizes.round(5).tolist(), measured.lengths.round(5).tolist(), strict=True)
    groups: dict[tuple[object, ...], list[int]] = {}
    for i, (contour, (size, length)) in enumerate(zip(measured.contours, measures, strict=True)):
        groups.setdefault((kind(contour), contour.layer, contour.operation, *size, length), []).append(i)
    return list(groups.values())


def _segments(segments: IntArray, arcs: IntArray) -> str:
    """How many segments some contours have: ``4``, ``26 to 28``, and how many arcs: ``2 (2 arcs)``."""
    few, many = int(segments.min()), int(segments.max())
    if few != many:
        return f"{few} to {many}"
    bent = int(arcs.max())
    return f"{few}" + (f" ({bent} arc{'s' if bent > 1 else ''})" if bent and bent == arcs.min() else "")


def _rank(contour: Contour, length: float) -> tuple[bool, int, float]:
    """What a person looks at first: what is machined, then outlines, open ones and holes, of these the longest."""
    return contour.operation is Operation.IGNORE, ("outer", "open", "inner").index(kind(contour)), -length


def _ledger(ledger: Sequence[LedgerEntry]) -> list[str]:
    """How many entities had each outcome, and why those that are not machined are not."""
    counts = totals(ledger)
    told = [f"{counts[outcome]} {outcome.value}" for outcome in Outcome if counts[outcome]]
    lines = [f"  entities: {counts['entities']}" + (f": {', '.join(told)}" if told else "")]
    reasons: dict[tuple[Outcome, str], list[str]] = {}
    for entry in ledger:
        reason = _BLOCKS if entry.kind == "INSERT" and entry.outcome is Outcome.MERGED else entry.reason
        if reason:
            reasons.setdefault((entry.outcome, pattern(reason)), []).append(reason)
    found = sorted(reasons.items(), key=lambda item: (-list(Outcome).index(item[0][0]), -len(item[1])))
    rows = [
        (str(len(those)), outcome.value, plain(summary(those), longest=_WIDTH - 20))
        for (outcome, _), those in found[:_MOST_REASONS]
    ]
    lines += aligned(rows, right=(0,), indent="    ") if rows else []
    return [*lines, *_rest(len(found) - _MOST_REASONS, "reason", indent="    ")]


def _next(drawing: Drawing, again: str) -> list[str]:
    """What to type next."""
    if not again:
        return []
    blocking = {finding.kind for finding in drawing.findings if finding.blocks}
    if not drawing.unit:
        again += f" --units {_proposed_unit(drawing)}"
    if "lost" in blocking:
        again += " --accept-loss"
    change = "change the drawing as said above, then " if blocking - {"units", "lost"} else ""
    return [f"next: {change}{again}"]


def _proposed_unit(drawing: Drawing) -> str:
    """The unit that the warning about the missing one proposes."""
    hints = [finding.hint for finding in drawing.findings if finding.kind == "units"]
    found = re.search(r"--units (\w+)", " ".join(hints))
    return found[1] if found else "mm"


def _rest(count: int, noun: str, *, indent: str = "  ") -> list[str]:
    """The line that says that a list is cut short."""
    return [f"{indent}and {count} more {noun}{'s' if count > 1 else ''}, all of them with --json"] if count > 0 else []


def _size(extents: tuple[float, float, float, float]) -> tuple[float, float]:
    return extents[2] - extents[0], extents[3] - extents[1]


def _by(size: Sequence[float], *, unit: str = " mm") -> str:
    """Width by height: ``120.00 x 80.00 mm``."""
    return f"{to_mm(size[0]):.2f} x {to_mm(size[1]):.2f}{unit}"
