"""The places at which closed cuts may begin, of all cuts together, and what the contour allows there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Final, NamedTuple

import numpy as np

from deltacam.cutting.leads.shapes import Ends
from deltacam.cutting.leads.sizes import Ability
from deltacam.cutting.leads.starts import Start, starts_off
from deltacam.geometry import curve as curves
from deltacam.model import Array, BoolArray, Contour, Curve, Cut, IntArray, Process

_FEW: Final = 4
_MANY: Final = 3000  # cuts, from which on fewer places are tried
_CORNER: Final = np.radians(15.0)
_BETTER: Final = 1.6  # the acceleration in the best direction over that in the worst, at most
_AROUND: Final = 1.2  # the same along a bend, which runs through many directions


class Spots(NamedTuple):
    """Where leads meet contours, and how it goes on there, (N,) each.

    Attributes:
        ends: the place, the direction and the side of the waste.
        bend: curvature of the contour, 1/m, positive where it turns to the waste.
        ahead: from there to the end of the line or arc, m.
        corner: from there to the next corner, m; inf where there is none.
        turn: of that corner, rad.
    """

    ends: Ends
    bend: Array
    ahead: Array
    corner: Array
    turn: Array

    def chosen(self, which: IntArray | BoolArray) -> Spots:
        """Some of them."""
        return Spots(self.ends.chosen(which), *(column[which] for column in self[1:]))

    def allowed(self, feed: Array, able: Ability, deviation: float) -> Array:
        """At most how fast the tool may pass there, (N,) m/s: for the bend, and to be slow enough at the corner.

        Args:
            feed: that is asked for, (N,) m/s.
            able: what the tool can do there.
            deviation: that the round of a corner may have, m.
        """
        acceleration = _BETTER * able.acceleration
        bend = np.maximum(np.abs(self.bend), 1e-9)
        on_bend = np.minimum(np.sqrt(_AROUND * able.acceleration / bend), np.cbrt(_AROUND * able.jerk / bend**2))
        rise = 1.0 / np.maximum(np.cos(0.5 * np.abs(self.turn)), 1e-3) - 1.0
        corner = acceleration * deviation / np.maximum(rise, 1e-6)
        before_corner = np.sqrt(corner + 2.0 * acceleration * self.corner)
        return np.asarray(np.minimum(np.minimum(feed, on_bend), before_corner))


class Places(NamedTuple):
    """Places of all cuts, (N,) each: whose they are, where they are, and the spots of both leads."""

    cut: IntArray
    segment: IntArray
    distance: Array
    begin: Spots
    end: Spots


def places(
    cuts: Sequence[Cut],
    closed: Sequence[int],
    contours: Sequence[Contour],
    *,
    process: Process,
    beyond: Sequence[float],
    count: int,
    clear: Mapping[int, Sequence[Curve]],
    given: Mapping[int, Start],
) -> Places:
    """All places where closed cuts may begin.

    Args:
        cuts: with their kerf.
        closed: which of them may have leads.
        contours: of the drawing.
        process: says by which rule.
        beyond: how far each of the closed ones goes on beyond its start, m.
        count: of places per cut, where the rule leaves a choice.
        clear: by number of contour, edges on which its cut should not begin.
        given: by index of cut, where it begins whatever the rule.
    """
    drawn = {contour.number: contour for contour in contours}
    count = count if len(closed) < _MANY else _FEW
    owner, at, begins, ends = [], [], [], []
    for index, further in zip(closed, beyond, strict=True):
        cut = cuts[index]
        if index in given:
            segment, distance = np.array([given[index].segment]), np.array([given[index].distance])
        else:
            edges = clear.get(cut.contour, ())
            segment, distance = starts_off(edges, cut.curve, process.start, count=count, kerf=process.kerf)
        side = waste_side(cut, drawn[cut.contour], process.kerf)
        line = _Line(cut.curve, side)
        owner.append(np.full(len(segment), index))
        at.append((segment, distance))
        begins.append(line.spots(segment, distance))
        ends.append(line.spots(*line.onwards(segment, distance, further)))
    segment, distance = (np.concatenate(part) for part in zip(*at, strict=True))
    return Places(np.concatenate(owner), segment, distance, _together(begins), _together(ends))


def waste_side(cut: Cut, contour: Contour, kerf: float) -> float:
    """On which side of a cut the waste is: 1 for left, inside of it, and -1 for right, outside."""
    if contour.is_hole:
        return 1.0
    inside = kerf > 0.0 and curves.signed_area(cut.curve) < curves.signed_area(contour.curve)
    return 1.0 if inside else -1.0


class _Line:
    """A closed curve with its measures."""

    def __init__(self, curve: Curve, side: float) -> None:
        self.curve, self.side = curve, side
        self.length, self.curvature = curves.lengths(curve), curves.curvatures(curve)
        self.heading = curves.headings(curve)[0]
        self.ends = np.cumsum(self.length)
        angle = np.roll(curves.corner_angles(curve), -1)  # at the end of every segment
        sharp = np.flatnonzero(np.abs(angle) > _CORNER)
        self.corners = np.concatenate([self.ends[sharp], self.ends[-1] + self.ends[sharp[:1]]])
        self.angles = np.concatenate([angle[sharp], angle[sharp[:1]]])

    def onwards(self, segment: IntArray, distance: Array, way: float) -> tuple[IntArray, Array]:
        """The places ``way`` m further on."""
        at = np.mod(self.ends[segment] - self.length[segment] + distance + way, self.ends[-1])
        on = np.minimum(np.searchsorted(self.ends, at, side="left"), len(self.length) - 1)
        return on, at - (self.ends[on] - self.length[on])

    def spots(self, segment: IntArray, distance: Array) -> tuple[Array, ...]:
        """What `Spots` holds of places, one column after the other."""
        curvature = self.curvature[segment]
        place, heading = curves.advance(self.curve.starts[segment], self.heading[segment], curvature, distance)
        corner, turn = np.full(len(segment), np.inf), np.zeros(len(segment))
        if len(self.corners):
            at = self.ends[segment] - self.length[segment] + distance
            following = np.searchsorted(self.corners, at + 1e-9)
            corner, turn = self.corners[following] - at, self.angles[following]
        side = np.full(len(segment), self.side)
        return place, heading, side, side * curvature, self.length[segment] - distance, corner, turn


def _together(columns: Sequence[tuple[Array, ...]]) -> Spots:
    place, heading, side, *others = (np.concatenate(part) for part in zip(*columns, strict=True))
    return Spots(Ends(place, heading, side), *others)
