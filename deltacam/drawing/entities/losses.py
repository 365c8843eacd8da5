"""Findings about single entities: what is lost, not flat, wide or drawn by guess."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Sequence
from typing import Final

import numpy as np

from deltacam.drawing.entities import blocks
from deltacam.drawing.entities.entity import Entity
from deltacam.drawing.entities.traces import Traces
from deltacam.model import Array, Finding
from deltacam.units import to_mm

FLATNESS: Final = 1e-5
"""How far z may differ, m, within a flat drawing."""

BEYOND: Final = "beyond the limit of"
"""Part of the reason of an entity that is absurdly far away."""

_LISTED: Final = 20
"""So many findings of one sort name their entity; one more counts the others."""

_PROJECT: Final = "project the drawing onto the xy plane in the CAD program"
_LEDGER: Final = "the ledger lists every one"


def lost(entities: Sequence[Entity]) -> list[Finding]:
    """A blocking finding for each entity that is lost; one that is inserted often is named once."""
    named = dict.fromkeys(entity for entity in entities if entity.lost)
    found = [
        Finding(f"the {entity.kind} is lost: {entity.reason}", entity.where, _hint(entity), "lost", blocks=True)
        for entity in named
    ]
    return _bounded(found, [entity.kind for entity in named], "lost")


def not_flat(entities: Sequence[Entity], curves: Traces) -> list[Finding]:
    """A blocking finding for each entity that is not at the height of most others; z is taken from the curves."""
    low, high = curves.heights.T
    level = high - low <= FLATNESS
    common = _common(low[level]) if level.any() else 0.0
    away = ~level | (np.abs(low - common) > FLATNESS)
    first = curves.first
    found: dict[Entity, Finding] = {}
    for k in np.flatnonzero(away).tolist():
        entity = entities[int(curves.owner[k])]
        if entity in found:
            continue
        if level[k]:
            others = f"most others at {to_mm(common):.6g} mm"
            what = f"the drawing is not flat: this lies at z = {to_mm(float(low[k])):.6g} mm, {others}"
        else:
            what = f"it is not flat: z runs from {to_mm(float(low[k])):.6g} to {to_mm(float(high[k])):.6g} mm"
        x, y = curves.points[first[k]].tolist()
        found[entity] = Finding(what, entity.where, _PROJECT, "not_flat", (x, y), blocks=True)
    return _bounded(list(found.values()), [entity.kind for entity in found], "not flat")


def wide(entities: Sequence[Entity]) -> list[Finding]:
    """One finding for all polylines with a width."""
    many = "a polyline has a width" if len(entities) == 1 else f"{len(entities)} polylines have a width"
    line = "its centre line is" if len(entities) == 1 else "their centre lines are"
    hint = "draw the outline if the edges of the wide line are meant"
    return [Finding(f"{many}: {line} used", entities[0].where, hint, "wide")] if entities else []


def guessed(entities: Sequence[Entity]) -> list[Finding]:
    """One finding for all splines of which the file gives only points to run through."""
    many = "a spline is" if len(entities) == 1 else f"{len(entities)} splines are"
    what = f"{many} given only by points to run through, and CAD programs may draw the way between them differently"
    hint = "convert it to control points in the CAD program if it must be exact"
    return [Finding(what, entities[0].where, hint, "fit_points")] if entities else []


def _common(heights: Array) -> float:
    """The height that most of the heights, (N,) m, are near to; among equals the first."""
    ordered = np.sort(heights)
    near = np.searchsorted(ordered, heights + FLATNESS, "right") - np.searchsorted(ordered, heights - FLATNESS, "left")
    return float(heights[np.argmax(near)])


def _bounded(found: list[Finding], kinds: Iterable[str], what: str) -> list[Finding]:
    """The findings, and for each kind of entity with too many one that counts the rest."""
    kept = []
    counts: Counter[str] = Counter()
    for finding, kind in zip(found, kinds, strict=True):
        counts[kind] += 1
        if counts[kind] <= _LISTED:
            kept.append(finding)
    for kind, count in counts.items():
        if count > _LISTED:
            more = count - _LISTED
            rest = f"{more} more {kind} entit{'y is' if more == 1 else 'ies are'} {what}"
            kept.append(Finding(rest, hint=_LEDGER, kind=found[0].kind, blocks=True))
    return kept


def _hint(entity: Entity) -> str:
    """What to do about a lost entity."""
    if BEYOND in entity.reason:
        return "check the unit (--units) and the entity"
    if entity.kind == "INSERT":
        return blocks.hint(entity.reason)
    return "draw it again in the CAD program, or delete it"
