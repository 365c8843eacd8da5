"""The geometry of leads.

A lead-out begins at a place of the contour in its direction, and turns to the side of the waste. A lead-in is one that
is run backwards: seen that way the contour runs the other way, and the waste is on its other side.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np

from deltacam.cutting.leads.sizes import Size
from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Curve, IntArray

_SAMPLES: Final = np.linspace(0.0, 1.0, 25)  # of an arc
_NOTHING: Final = 1e-9


class Ends(NamedTuple):
    """Where leads meet contours, (N,) each.

    Attributes:
        place: (N, 2) m.
        heading: rad, of the contour.
        side: of the waste: 1 is left of the contour, -1 right.
    """

    place: Array
    heading: Array
    side: Array

    def chosen(self, which: IntArray | BoolArray) -> Ends:
        """Some of them."""
        return Ends(*(column[which] for column in self))

    def backwards(self) -> Ends:
        """The same with the contour run the other way."""
        return Ends(self.place, self.heading + np.pi, -self.side)


def ways(ends: Ends, size: Size) -> Array:
    """Points along lead-outs, (N, K, 2) m, from the contour to the far end."""
    count = len(ends.place)
    bend = _bend(ends, size)
    along = (size.radius * size.turn)[:, None] * _SAMPLES
    spread = len(_SAMPLES)
    arc, heading = curves.advance(
        np.repeat(ends.place, spread, axis=0), np.repeat(ends.heading, spread), np.repeat(bend, spread), along.ravel()
    )
    arc, heading = arc.reshape(count, spread, 2), heading.reshape(count, spread)[:, -1] + ends.side * size.angle
    far = arc[:, -1] + size.line[:, None] * np.stack([np.cos(heading), np.sin(heading)], axis=1)
    return np.concatenate([arc, far[:, None]], axis=1)


def lead_outs(ends: Ends, size: Size) -> list[Curve | None]:
    """The lead-outs of all rows; None where one has no length."""
    tips = ways(ends, size)[:, -2:]
    arcs, lines = size.radius * size.turn > _NOTHING, size.line > _NOTHING
    bulges = np.tan(0.25 * ends.side * size.turn)
    found: list[Curve | None] = []
    for place, way, arc, line, bulge in zip(ends.place, tips, arcs, lines, bulges, strict=True):
        points, own = [place], []
        if arc:
            points.append(way[0])
            own.append(bulge)
        if line:
            points.append(way[1])
            own.append(0.0)
        found.append(Curve(points=np.array(points), bulges=np.array(own), closed=False) if own else None)
    return found


def lead_ins(ends: Ends, size: Size) -> list[Curve | None]:
    """The lead-ins of all rows, which end at the contour; None where one has no length."""
    found = lead_outs(ends.backwards(), size)
    return [None if one is None else curves.reverse(one) for one in found]


def _bend(ends: Ends, size: Size) -> Array:
    """The curvature of the arcs, (N,) 1/m."""
    bend = np.divide(1.0, size.radius, out=np.zeros_like(size.radius), where=size.radius > 0.0)
    return np.asarray(ends.side * bend)
