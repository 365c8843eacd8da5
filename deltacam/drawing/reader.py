"""The bytes of a DXF file to a ``Drawing``: read, scale, join, nest, and account for every entity.

Reading goes on past everything that a person may still want to look at. What forbids a plan is a finding that blocks;
``strict`` turns the first one into an error.
"""

from __future__ import annotations

import gc
import hashlib
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from deltacam.drawing import operations, remarks, scale
from deltacam.drawing.assemble import Assembled, assemble
from deltacam.drawing.dxf import document
from deltacam.drawing.entities import layers, walk
from deltacam.drawing.entities.walk import Drawn, Entity
from deltacam.errors import DrawingError
from deltacam.model import EVERYTHING, BoolArray, Drawing, Finding, LedgerEntry, Operation, Outcome, Selection

_LARGE: Final = 10_000_000
"""Above so many bytes it pays to free the document before its curves are joined."""


@contextmanager
def _without_collection() -> Iterator[None]:
    """Leaves Python's search for garbage out while the objects of a drawing are made.

    It looks at all of them again and again, and finds nothing: up to half of the time of a large drawing.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


@_without_collection()
def read_drawing(
    path: str | Path,
    *,
    data: bytes | None = None,
    unit: str | None = None,
    metres_per_unit: float | None = None,
    default_unit: str | None = None,
    selection: Selection = EVERYTHING,
    strict: bool = True,
) -> Drawing:
    """The contours of a DXF file's modelspace, and what became of every entity.

    Entities on frozen layers and on layers that are off are read like all others, with a finding per layer.

    Args:
        path: the DXF file.
        data: its bytes, where they are at hand; then ``path`` is only its name.
        unit: mm, cm, m, um, in, ft, mil or pt; wins over the file's header, with a finding where they differ.
        metres_per_unit: an exact factor; wins over both.
        default_unit: what one unit is where the file does not say.
        selection: what is done with which lines, and how far apart ends may be that are joined.
        strict: whether a finding that blocks is an error. Without, the drawing is only good to be looked at.

    Raises:
        DrawingError: the file cannot be read or holds no line at all; with ``strict``, also the first finding that
            blocks: no unit, damaged or missing geometry, not flat, contours that cross, nothing to cut.
        DeltacamError: a unit that is not known, or a layer that the drawing does not have.
    """
    path = Path(path)
    data = document.read_bytes(path) if data is None else data
    loaded = document.load(data, path.name)
    source, lost, damage = loaded.document, loaded.lost, loaded.findings
    header = scale.read_header(source, data)
    chosen = scale.choose(header, unit=unit, metres_per_unit=metres_per_unit, default=default_unit)
    found = walk.read(source, chosen.metres, concerns=lambda those: _concern(those, selection))
    paper = _in_paper_space(source)
    if not len(found.curves):
        raise _without_lines(found, paper, path.name)
    table = layers.tabulate(source, found.entities, found.owner)
    operations.check_patterns(selection, [layer.name for layer in table])
    del source, loaded
    if len(data) > _LARGE:
        gc.collect()
    joined = assemble(found, operations.assign(found.entities, selection), selection.joining)
    extents = _extents(found)
    findings = [
        *(_accepted(finding, selection) for finding in (*damage, *found.findings)),
        *scale.findings(chosen, (extents[2] - extents[0], extents[3] - extents[1]), header),
        *joined.findings,
        *_nothing_to_machine(found, joined),
        *remarks.left_out(table, selection),
        *remarks.hidden_layers(table, selection),
        *remarks.open_chains(joined.contours[number - 1].layer for number in joined.left_open),
        *remarks.not_cut(found),
        *remarks.paper_space(paper),
        *remarks.drawing_sheet(found.entities, joined.contours),
        *remarks.doubles([contour for contour in joined.contours if contour.has_kerf]),
    ]
    if strict:
        _refuse(findings, path.name)
    return Drawing(
        file=path.name,
        sha256=hashlib.sha256(data).hexdigest(),
        metres_per_unit=chosen.metres,
        unit=chosen.name,
        unit_source=chosen.source,
        contours=tuple(contour for contour in joined.contours if contour.operation is not Operation.IGNORE),
        ignored=tuple(contour for contour in joined.contours if contour.operation is Operation.IGNORE),
        ledger=(*_ledger(found, joined), *lost),
        findings=tuple(findings),
        conversion_error=joined.error,
        layers=table,
        extents=extents,
        selection=selection,
    )


def _extents(found: Drawn) -> tuple[float, float, float, float]:
    """The smallest x and y and the largest x and y of all curves, m."""
    boxes = found.curves.bounds()
    low, high = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    return float(low[0]), float(low[1]), float(high[0]), float(high[1])


def _concern(those: Sequence[Entity], selection: Selection) -> BoolArray:
    """Which entities matter: those that are not ignored, and every INSERT, whatever the layers in its block are."""
    inserts = np.array([entity.kind == "INSERT" for entity in those], dtype=np.bool_)
    return inserts | ~operations.assign(those, selection).of(Operation.IGNORE)


def _accepted(finding: Finding, selection: Selection) -> Finding:
    """A finding about lost geometry no longer blocks where the user accepts the loss."""
    return replace(finding, blocks=False) if finding.kind == "lost" and selection.accept_loss else finding


def _ledger(found: Drawn, joined: Assembled) -> tuple[LedgerEntry, ...]:
    """One entry per entity, in the order of the file."""
    operation = {contour.number: contour.operation for contour in joined.contours}
    done = {Operation.CUT: Outcome.CUT, Operation.ENGRAVE: Outcome.ENGRAVED}
    entries = []
    for i, entity in enumerate(found.entities):
        number = joined.contour_of.get(i)
        if i in joined.notes:
            outcome, reason = joined.notes[i]
        elif number is not None:
            outcome, reason = done[operation[number]], ""
        elif entity.lost:
            outcome, reason = Outcome.LOST, entity.reason
        else:
            outcome, reason = Outcome.MERGED if entity.is_insert else Outcome.IGNORED, entity.reason
        entries.append(LedgerEntry(entity.handle, entity.kind, entity.layer, entity.block, outcome, reason, number))
    return tuple(entries)


def _nothing_to_machine(found: Drawn, joined: Assembled) -> list[Finding]:
    """The finding that no line is cut or engraved, and what there is instead."""
    if any(contour.operation is not Operation.IGNORE for contour in joined.contours):
        return []
    chains = [contour for contour in joined.contours if not contour.curve.closed]
    closed = len(joined.contours) - len(chains)
    held = [f"{remarks.counted(closed, 'closed contour', verb=False)} left out"] if closed else []
    held += [remarks.counted(len(chains), "open chain", verb=False)] if chains else []
    held += [f"{count} {kind}" for kind, count in Counter(entity.kind for entity in found.without_curve()).items()]
    gap = next((finding for finding in joined.findings if finding.kind == "gap"), None)
    where = f" ({gap.what})" if gap else ""
    hint = "draw the part as closed outlines" if chains else "see --layer, --ignore-layer and the process"
    what = f"nothing to cut: {', '.join(held) or 'only specks'}{where}"
    return [Finding(what, hint=hint, kind="open", place=gap.place if gap else None, blocks=True)]


def _without_lines(found: Drawn, paper: int, file: str) -> DrawingError:
    """The error for a drawing without a line, with what it does hold."""
    kinds = Counter(entity.kind for entity in found.entities if not entity.is_insert)
    held = [f"{count} {kind}" for kind, count in kinds.items()]
    held += [f"{remarks.counted(paper, 'entity', 'entities', verb=False)} in paper space"] if paper else []
    lost = next((entity.reason for entity in found.entities if entity.lost), "")
    what = f"nothing to cut: {', '.join(held) or 'it holds no entities'}{f' ({lost})' if lost else ''}"
    hint = "draw the part as closed outlines in the modelspace" if held else "export the drawing again"
    return DrawingError(what, where=file, hint=hint)


def _refuse(findings: Sequence[Finding], file: str) -> None:
    """Raises for the first finding that blocks."""
    for finding in findings:
        if finding.blocks:
            raise DrawingError(finding.what, where=finding.where or file, hint=finding.hint)


def _in_paper_space(source: Any) -> int:
    """How many entities lie in layouts other than the modelspace; their viewports do not count."""
    layouts = [layout for layout in source.layouts if layout.name != "Model"]
    return sum(entity.dxftype() != "VIEWPORT" for layout in layouts for entity in layout)
