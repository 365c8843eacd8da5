"""What was read from a drawing, for programs: one JSON object."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from typing import Any, Final

from deltacam.inspection.measures import LayerUse, Measured, kind, layers, measure, totals
from deltacam.model import Drawing, Finding, LedgerEntry
from deltacam.units import to_mm, to_um

_DIGITS: Final = 6
"""Decimals of a length in mm: a picometre is finer than any drawing."""


def to_dict(drawing: Drawing) -> dict[str, Any]:
    """All that is known of a drawing, as ``json.dumps`` takes it; lengths are in mm as their names say."""
    measured = measure(drawing)
    extents = drawing.extents
    return {
        "file": drawing.file,
        "sha256": drawing.sha256,
        "unit": drawing.unit or None,
        "unit_source": drawing.unit_source,
        "metres_per_unit": drawing.metres_per_unit,
        "extents_mm": extents and _mm(extents),
        "size_mm": extents and _mm((extents[2] - extents[0], extents[3] - extents[1])),
        "contours": _contours(measured),
        "layers": [_layer(used) for used in layers(drawing, measured)],
        "warnings": [_warning(finding) for finding in drawing.findings],
        "ledger": [_entry(entry) for entry in drawing.ledger],
        "totals": totals(drawing.ledger),
        "conversion_error_um": round(to_um(drawing.conversion_error), _DIGITS),
    }


def _contours(measured: Measured) -> dict[str, Any]:
    kinds = Counter(map(kind, measured.contours))
    rows = zip(
        measured.contours,
        measured.sizes.tolist(),
        measured.bounds.tolist(),
        measured.lengths.tolist(),
        measured.segments.tolist(),
        measured.arcs.tolist(),
        strict=True,
    )
    return {
        "closed": kinds["outer"] + kinds["inner"],
        **{name: kinds[name] for name in ("outer", "inner", "open")},
        "list": [
            {
                "number": contour.number,
                "kind": kind(contour),
                "operation": contour.operation.value,
                "layer": contour.layer,
                "handles": list(contour.handles),
                "parent": contour.parent,
                "depth": contour.depth,
                "size_mm": _mm(size),
                "bounds_mm": _mm(bounds),
                "length_mm": round(to_mm(length), _DIGITS),
                "segments": segments,
                "arcs": arcs,
            }
            for contour, size, bounds, length, segments, arcs in rows
        ],
    }


def _layer(used: LayerUse) -> dict[str, Any]:
    layer = used.layer
    return {
        "name": layer.name,
        "state": layer.state,
        "color": layer.color,
        "linetype": layer.linetype,
        "entities": layer.entities,
        "curves": layer.curves,
        "operations": list(used.operations),
        "closed": used.closed,
        "open": used.open,
    }


def _warning(finding: Finding) -> dict[str, Any]:
    return {
        "kind": finding.kind,
        "message": finding.what,
        "where_mm": finding.place and _mm(finding.place),
        "where": finding.where,
        "hint": finding.hint,
        "blocks": finding.blocks,
    }


def _entry(entry: LedgerEntry) -> dict[str, Any]:
    return {
        "handle": entry.handle,
        "kind": entry.kind,
        "layer": entry.layer,
        "block": entry.block,
        "outcome": entry.outcome.value,
        "reason": entry.reason,
        "contour": entry.contour,
    }


def _mm(lengths: Iterable[float]) -> list[float]:
    return [round(to_mm(length), _DIGITS) for length in lengths]
