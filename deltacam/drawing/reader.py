"""The bytes of a DXF file to a ``Drawing``: read, scale, join, nest, and account for every entity."""

from __future__ import annotations

import hashlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from deltacam.drawing import containment, document, entities, join, scale
from deltacam.drawing.entities import Drawn, Entity
from deltacam.errors import DrawingError
from deltacam.model import Contour, Drawing, Finding, LedgerEntry, Outcome


def read_drawing(
    path: str | Path,
    *,
    unit: str | None = None,
    metres_per_unit: float | None = None,
    default_unit: str | None = None,
) -> Drawing:
    """The closed contours of a DXF file's modelspace, and what became of every entity.

    Ends are joined at 0.01 mm. Entities on frozen layers and on layers that are off are read like all others, with a
    finding per layer.

    Args:
        path: the DXF file.
        unit: mm, cm, m, um, in, ft, mil or pt; wins over the file's header, with a finding where they differ.
        metres_per_unit: an exact factor; wins over both.
        default_unit: what one unit is where the file does not say.

    Raises:
        DrawingError: the file cannot be read, states no unit, is not flat, has contours that cross, or holds nothing
            that can be cut.
        DeltacamError: a ``unit`` that is not known.
    """
    path = Path(path)
    data = document.read_bytes(path)
    source = document.load(data, path.name)
    header = scale.read_header(source, data)
    chosen = scale.choose(header, unit=unit, metres_per_unit=metres_per_unit, default=default_unit)
    found = entities.read(source, chosen.metres)
    drawn = found.entities
    units = scale.findings(chosen, _size(found), header)
    _refuse_blocking(units, found, source, path.name)
    joined = _by_entity(join.join(found.curves, name=lambda i: drawn[found.owner[i]].where), found)
    if not joined.loops:
        raise _nothing_to_cut(found, joined, source, path.name)
    flat = [_contour(i + 1, loop, drawn) for i, loop in enumerate(joined.loops)]
    outlines = [chain.curve for chain in joined.chains if chain.nearly_closed]
    tangles = [chain.curve for chain in joined.chains if chain.ambiguous]
    contours, nesting = containment.nest(flat, outlines=outlines, tangles=tangles)
    findings = [*units, *_layer_findings(found, source), *_ignored_findings(found, source)]
    findings += [*joined.findings, *_open_findings(joined, drawn), *nesting]
    return Drawing(
        file=path.name,
        sha256=hashlib.sha256(data).hexdigest(),
        metres_per_unit=chosen.metres,
        unit=chosen.name,
        unit_source=chosen.source,
        contours=contours,
        ledger=_ledger(drawn, joined),
        findings=tuple(findings),
        conversion_error=max(loop.error for loop in joined.loops),
    )


def _by_entity(joined: join.Joined, found: Drawn) -> join.Joined:
    """The result of joining with the indices of entities in place of those of curves; chains become notes."""
    owner = found.owner.tolist()
    notes = {owner[i]: note for i, note in joined.notes.items()}
    loops = []
    for loop in joined.loops:
        members = tuple(owner[i] for i in loop.members)
        loops.append(replace(loop, members=members, error=loop.error + max(found.entities[i].error for i in members)))
    for chain in joined.chains:
        notes |= {owner[i]: (Outcome.IGNORED, chain.reason) for i in chain.members}
    copies = {owner[later]: owner[first] for later, first in joined.copies.items()}
    opened = [replace(chain, members=tuple(owner[i] for i in chain.members)) for chain in joined.chains]
    return join.Joined(loops=loops, chains=opened, notes=notes, copies=copies, findings=joined.findings)


def _open_findings(joined: join.Joined, drawn: Sequence[Entity]) -> list[Finding]:
    """One finding per layer that counts its open chains."""
    counts = Counter(drawn[chain.members[0]].layer for chain in joined.chains)
    hint = "close them in the drawing if they are outlines"
    return [
        Finding(f"{_counted(count, 'open chain')} not cut", where=f"layer {layer}", hint=hint, kind="open")
        for layer, count in counts.items()
    ]


def _contour(number: int, loop: join.Loop, drawn: Sequence[Entity]) -> Contour:
    """The contour of a loop, not yet nested."""
    handles = tuple(drawn[i].handle for i in loop.members)
    return Contour(number=number, curve=loop.curve, layer=drawn[loop.members[0]].layer, handles=handles)


def _ledger(drawn: Sequence[Entity], joined: join.Joined) -> tuple[LedgerEntry, ...]:
    """One entry per entity, in the order of the file."""
    contour = {i: number for number, loop in enumerate(joined.loops, start=1) for i in loop.members}
    entries = []
    for i, entity in enumerate(drawn):
        if i in contour:
            outcome, reason = Outcome.CUT, ""
        elif i in joined.notes:
            outcome, reason = joined.notes[i]
        else:
            outcome, reason = Outcome.MERGED if entity.is_insert else Outcome.IGNORED, entity.reason
        number = contour.get(i, contour.get(joined.copies.get(i, -1)))
        entries.append(LedgerEntry(entity.handle, entity.kind, entity.layer, entity.block, outcome, reason, number))
    return tuple(entries)


def _layer_findings(found: Drawn, source: Any) -> list[Finding]:
    """One finding per layer that is frozen or off and holds curves."""
    hidden = {}
    for layer in source.layers:
        if layer.is_frozen() or layer.is_off():
            hidden[str(layer.dxf.name).casefold()] = "frozen" if layer.is_frozen() else "off"
    counts = Counter(found.entities[i].layer for i in found.owner.tolist())
    findings = []
    for layer, count in counts.items():
        state = hidden.get(layer.casefold())
        if state:
            what = f"the layer is {state}, but its {_counted(count, 'curve')} read like all others"
            findings.append(Finding(what, where=f"layer {layer}", hint="delete what is not to be cut"))
    return findings


def _ignored_findings(found: Drawn, source: Any) -> list[Finding]:
    """One finding per kind of entity that is not cut, and one for paper space."""
    kinds = Counter((entity.kind, entity.reason) for entity in found.without_curve() if not entity.is_insert)
    findings = [Finding(f"{_counted(count, kind)} not cut: {reason}") for (kind, reason), count in kinds.items()]
    paper = _in_paper_space(source)
    if paper:
        findings.append(Finding(f"{_counted(paper, 'entity', 'entities')} not read: in paper space"))
    return findings


def _in_paper_space(source: Any) -> int:
    """How many entities lie in layouts other than the modelspace; their viewports do not count."""
    layouts = [layout for layout in source.layouts if layout.name != "Model"]
    return sum(entity.dxftype() != "VIEWPORT" for layout in layouts for entity in layout)


def _size(found: Drawn) -> tuple[float, float] | None:
    """Width and height of all curves, m."""
    if not len(found.curves):
        return None
    boxes = found.curves.bounds()
    width, height = boxes[:, 2:].max(axis=0) - boxes[:, :2].min(axis=0)
    return float(width), float(height)


def _refuse_blocking(findings: Sequence[Finding], found: Drawn, source: Any, file: str) -> None:
    """Raises where a finding blocks; that there is nothing to cut comes first."""
    for finding in findings:
        if finding.blocks:
            if not len(found.curves):
                raise _nothing_to_cut(found, join.Joined(), source, file)
            raise DrawingError(finding.what, where=file, hint=finding.hint)


def _nothing_to_cut(drawn: Drawn, joined: join.Joined, source: Any, file: str) -> DrawingError:
    """The error for a drawing without a closed contour, with what it does hold."""
    kinds = Counter(entity.kind for entity in drawn.without_curve())
    found = [_counted(len(joined.chains), "open chain", verb=False)] if joined.chains else []
    found += [f"{count} {kind}" for kind, count in kinds.items()]
    paper = _in_paper_space(source)
    found += [f"{_counted(paper, 'entity', 'entities', verb=False)} in paper space"] if paper else []
    slivers = sum(reason == join.NOTHING_INSIDE for _, reason in joined.notes.values())
    if slivers:
        found.append(f"{_counted(slivers, 'entity', 'entities', verb=False)} in closed lines that enclose nothing")
    if not found:
        held = "it holds no entities" if not drawn.entities else "it holds only lines of length zero"
        return DrawingError(f"nothing to cut: {held}", where=file, hint="export the drawing again")
    hint = "draw the part as closed outlines in the modelspace"
    notes = [reason for _, reason in joined.notes.values() if "gap of" in reason]
    where = f" ({notes[0]})" if notes else ""
    return DrawingError(f"nothing to cut: {', '.join(found)}{where}", where=file, hint=hint)


def _counted(count: int, one: str, many: str = "", *, verb: bool = True) -> str:
    """A count with its noun, and is or are: ``2 curves are``."""
    noun = one if count == 1 else many or (one if one.isupper() else f"{one}s")
    return f"{count} {noun}{(' is' if count == 1 else ' are') if verb else ''}"
