"""The picture of the part: what is drawn, and the path of the tool in stretches that the script colours."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Drawing, Operation
from deltacam.report import palette
from deltacam.report.colouring import Colouring
from deltacam.report.figures import Json, dots, lines, map_layout, packed
from deltacam.report.picture import RAPID, View, bands
from deltacam.report.stretches import stretches
from deltacam.report.thin import thin_lines, thin_way
from deltacam.units import to_mm
from deltacam.verification.evidence import Evidence

EXACT: Final = 1e-6
"""How far the path of a program that is shown tick by tick may be drawn from its setpoints, m."""

_MOST_STRETCHES: Final = 12_000
_MOST_NUMBERS: Final = 60  # cuts that are numbered
_NUMBER: Final = np.array([0.045, 0.032])  # width and height of a number, of what the starts span
_SIDES: Final = {"top right": (1, 1), "bottom right": (1, -1), "top left": (-1, 1), "bottom left": (-1, -1)}


def part_figure(evidence: Evidence, drawing: Drawing | None, view: View) -> Json:
    """The contours, the sheet's edge where it is near, where cuts begin and in which order.

    Returns:
        ``below`` and ``above``: the traces under and over the path; ``rapid`` and ``dots``: colours; ``layout``.
    """
    below = []
    if len(view.sheet):
        below.append(lines([_closed(to_mm(1.0) * view.sheet)], palette.SHEET, width=1.0))
    below += _drawn(drawing, view)
    above: list[Json] = []
    cuts = [run.first for run in evidence.runs if run.operation is Operation.CUT]
    if len(evidence.sheet) and cuts:
        starts = to_mm(1.0) * evidence.sheet[cuts]
        few = len(cuts) < _MOST_NUMBERS
        above.append(dots(starts, palette.STRONG, size=5.5 if few else 4.0) | (_numbers(starts) if few else {}))
    return {
        "below": below,
        "above": above,
        "rapid": palette.RAPID.light,
        "dots": palette.STRONG.light,
        "layout": map_layout(to_mm(1.0) * view.box),
    }


def _numbers(starts: Array) -> Json:
    """The place of every cut in the order, beside its start where no other number is in the way; else it has none.

    The distance that two numbers need is a share of what the starts span, for a picture that shows the whole part.
    """
    room = _NUMBER * max(float(np.ptp(starts, axis=0).max()), 1e-9)
    taken, text, sides = np.empty((0, 2)), [], []
    for number, start in enumerate(starts, start=1):
        middles = start + np.array([_SIDES[side] for side in _SIDES]) * room / 2.0
        gaps = np.abs(middles[:, None] - taken[None]) / room
        free = ~(gaps < 1.0).all(axis=2).any(axis=1)
        side = int(np.argmax(free))
        text.append(str(number) if free[side] else "")
        sides.append(list(_SIDES)[side])
        taken = np.concatenate([taken, middles[side : side + 1]]) if free[side] else taken
    font = {"size": 12, "color": palette.STRONG.light, "weight": 600}
    return {"mode": "markers+text", "text": text, "textposition": sides, "textfont": font}


def route(evidence: Evidence, colourings: Sequence[Colouring], view: View, *, exact: bool) -> Json:
    """The path of the tool without the points that it can spare, cut into stretches of one colour.

    Args:
        evidence: with the places of at least two ticks.
        colourings: the ways of colouring it.
        view: says how far the path may be off where it is not ``exact``.
        exact: whether every step may have colours of its own, and the path is within `EXACT`.

    Returns:
        ``x`` and ``y`` in mm; ``first``: the point at which every stretch starts; ``band`` of every stretch;
        ``colours``: for every way of colouring the colour of every stretch; ``within``: mm.
    """
    within = EXACT if exact else view.error
    band = bands(evidence)
    reach = 0.0 if exact else 3.0 * within
    choices = [colouring.choice for colouring in colourings]
    first, colours = stretches(evidence.sheet, band, choices, reach=reach, most=_MOST_STRETCHES)
    fixed = np.zeros(len(evidence.sheet), dtype=bool)
    fixed[first] = fixed[-1] = True
    kept = np.flatnonzero(thin_way(evidence.sheet, fixed, within))
    points = to_mm(1.0) * evidence.sheet[kept]
    return {
        "x": packed(points[:, 0]),
        "y": packed(points[:, 1]),
        "first": packed(np.searchsorted(kept, first), "u4"),
        "band": packed(band[first], "u1"),
        "colours": [packed(np.where(band[first] == RAPID, 0, colour), "u1") for colour in colours],
        "within": to_mm(within),
    }


def _drawn(drawing: Drawing | None, view: View) -> list[Json]:
    """The material filled, holes left out, and the lines that enclose none."""
    edges: list[Array] = []
    others: list[Array] = []
    for contour in drawing.contours if drawing else ():
        points = curves.flatten(contour.curve, view.error / 8.0)[0]
        line = _closed(points) if contour.curve.closed else points
        # Fills count turns: what runs clockwise takes away from what it lies in.
        (edges if contour.has_kerf else others).append(line[::-1] if contour.is_hole else line)
    found = []
    if edges:
        thinned = [to_mm(1.0) * line for line in thin_lines(edges, view.error / 8.0)]
        found.append(lines(thinned, palette.LINE, width=0.8, fill=palette.PART))
    if others:
        thinned = [to_mm(1.0) * line for line in thin_lines(others, view.error / 8.0)]
        found.append(lines(thinned, palette.LINE, width=0.8))
    return found


def _closed(points: Array) -> Array:
    return np.concatenate([points, points[:1]])
