"""Where on the sheet a part can lie, and how it must be turned for that; exact for a rectangle and for a disc.

Only the convex hull of what is cut matters. Turned by t, it lies on a rectangle exactly where its box does, so that the
places are a rectangle too. It lies on a disc exactly where every corner of it does, and fits at all exactly where the
smallest circle around it is no larger than the disc, whichever way it is turned.

Everything is about the place that `--at` names: where the centre of the drawing's box comes to lie.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np
import shapely
from shapely.geometry.polygon import orient

from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import Array, BoolArray, Cut, readonly
from deltacam.units import parse_angle, parse_length, to_mm

if TYPE_CHECKING:
    from deltacam.robot.workspace import Workspace

FLATTENING: Final = 1e-6
"""How far the hull of a part may lie inside its arcs, m."""

OUTSIDE: Final = 1e-7
"""How far a part may leave the sheet by rounding, m."""

DIGITS: Final = (2, 3, 4, 5, 6)
"""Decimals of mm and of degrees with which a place and a turn are written: the fewest that fit."""

_NICE: Final = tuple(np.radians(15.0 * np.array([6, 3, 9, 2, 4, 8, 10, 1, 5, 7, 11])).tolist())
_QUARTER: Final = 0.5 * np.pi


class Spot(NamedTuple):
    """A place and a turn as they are typed, in mm and degrees."""

    x_mm: str
    y_mm: str
    turn_deg: str

    @property
    def at(self) -> tuple[float, float]:
        """Where the centre of the drawing's box comes to lie, m."""
        return parse_length(self.x_mm), parse_length(self.y_mm)

    @property
    def rotation(self) -> float:
        """Of the drawing about that centre, rad."""
        return parse_angle(self.turn_deg)

    @property
    def options(self) -> str:
        """What to type."""
        return f"--at {self.x_mm},{self.y_mm} --rotate {self.turn_deg}"


class Places(NamedTuple):
    """The places at which a part lies on the sheet, for one rotation.

    Attributes:
        low: (2,) m, the smallest x and y that any of them has.
        high: (2,) m, the largest.
        excess: m, by how much the part leaves the sheet at the best place; negative is room to spare.
    """

    low: Array
    high: Array
    excess: float

    @property
    def centre(self) -> tuple[float, float]:
        """The middle of them, m: the place with the most room around it."""
        x, y = 0.5 * (self.low + self.high)
        return float(x), float(y)

    @property
    def any(self) -> bool:
        """Whether there is one."""
        return self.excess <= OUTSIDE


@dataclass(frozen=True, slots=True, eq=False)
class Footprint:
    """What a part needs of the sheet.

    Attributes:
        hull: (H, 2) m, the corners of its convex hull, counter-clockwise, from the centre of the drawing's box.
    """

    hull: Array

    def __post_init__(self) -> None:
        object.__setattr__(self, "hull", readonly(self.hull, columns=2))

    @classmethod
    def of(cls, cuts: Sequence[Cut], *, centre: Array) -> Footprint:
        """The footprint of cuts in the sheet frame, about ``centre`` (2,) m."""
        points, _ = rings.flatten(Pack.of(cut.curve for cut in cuts), FLATTENING)
        hull = shapely.MultiPoint(points - centre).convex_hull
        if hull.geom_type == "Polygon":
            return cls(shapely.get_coordinates(orient(hull).exterior)[:-1])
        return cls(shapely.get_coordinates(hull))

    def turned(self, rotation: float) -> Array:
        """The corners of the hull of the part turned by ``rotation`` rad, (H, 2) m."""
        cos, sin = np.cos(rotation), np.sin(rotation)
        return np.asarray(self.hull @ np.array([[cos, sin], [-sin, cos]]))

    def places(self, sheet: Workspace, rotation: float) -> Places:
        """Where the part, turned by ``rotation`` rad, lies on the sheet."""
        hull = self.turned(rotation)
        if sheet.radius is not None:
            centre, radius = _circle(hull)
            room = np.sqrt(max(sheet.radius**2 - radius**2, 0.0))
            return Places(-centre - room, -centre + room, radius - sheet.radius)
        half = _half_sides(sheet)
        low, high = -half - hull.min(axis=0), half - hull.max(axis=0)
        excess = float(0.5 * (low - high).max())
        middle = 0.5 * (low + high)
        return Places(np.minimum(low, middle), np.maximum(high, middle), excess)

    def holds(self, sheet: Workspace, rotation: float, at: Array) -> BoolArray:
        """Whether the part lies on the sheet at places ``at`` (N, 2) m, (N,)."""
        places = self.places(sheet, rotation)
        if sheet.radius is None:
            return np.asarray(((at >= places.low - OUTSIDE) & (at <= places.high + OUTSIDE)).all(axis=1) & places.any)
        corners = self.turned(rotation)
        far = [np.hypot(*(corners + place).T).max() for place in at]
        return np.array(far) <= sheet.radius + OUTSIDE

    def best_turn(self, sheet: Workspace) -> tuple[float, float]:
        """The rotation, rad in 0 to pi, with the most room to spare or the least excess, and its `Places.excess`, m.

        On a rectangle the box is smallest where a side of the hull lies along a side of the sheet, or where both sides
        of the box are equally much too long: between two such turns, both sides are concave functions of the turn.
        """
        if sheet.radius is not None or len(self.hull) < 2:
            return 0.0, self.places(sheet, 0.0).excess
        turns = np.concatenate([[0.0], *_critical(self.hull, _half_sides(sheet))])
        excess = _excess(self.hull, turns, _half_sides(sheet))
        best = int(np.argmin(excess - 1e-9 * (turns == 0.0)))
        return float(turns[best]), float(excess[best])

    def turns(self, sheet: Workspace) -> Iterator[float]:
        """Turns, rad, to try for a part that does not fit as it is: simple ones, and that with the most room."""
        yield from _NICE
        yield self.best_turn(sheet)[0]

    def excess_at(self, sheet: Workspace, at: tuple[float, float], rotation: float) -> float:
        """By how much the part leaves the sheet at a place, m; 0 where it does not."""
        return float(sheet.excess(self.turned(rotation) + np.array(at)).max())

    def spot(
        self, sheet: Workspace, at: tuple[float, float], rotation: float, digits: Sequence[int] = DIGITS
    ) -> Spot | None:
        """A place and a turn, m and rad, with the fewest digits with which the part is on the sheet; else None."""
        for count in digits:
            x, y = (_written(to_mm(value), count) for value in at)
            spot = Spot(x, y, _written(float(np.degrees(rotation)), count))
            if self.holds(sheet, spot.rotation, np.array([spot.at]))[0]:
                return spot
        return None

    def turned_spot(self, sheet: Workspace, at: tuple[float, float] | None = None) -> Spot | None:
        """The first of `turns` with which the part is on the sheet, ``at`` a place or anywhere; None where none is."""
        spots = (self.spot(sheet, at or self.places(sheet, turn).centre, turn) for turn in self.turns(sheet))
        return next((spot for spot in spots if spot is not None), None)


def _written(value: float, digits: int) -> str:
    """The number with so many decimals at most."""
    text = f"{value:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text == "-0" else text


def _half_sides(sheet: Workspace) -> Array:
    return 0.5 * np.array([sheet.width or 0.0, sheet.depth or 0.0])


def _circle(points: Array) -> tuple[Array, float]:
    """The centre, (2,) m, and the radius of the smallest circle around points (N, 2) m."""
    radius = float(shapely.minimum_bounding_radius(shapely.MultiPoint(points)))
    # The circle is drawn as a polygon about its centre.
    around = shapely.get_coordinates(shapely.minimum_bounding_circle(shapely.MultiPoint(points)))
    return 0.5 * (around.min(axis=0) + around.max(axis=0)), radius


def _furthest(hull: Array, direction: Array) -> Array:
    """The corner of the hull that is furthest in each ``direction`` (N,) rad, (N,) indices."""
    side = np.roll(hull, -1, axis=0) - hull
    normal = np.arctan2(-side[:, 0], side[:, 1]) % (2.0 * np.pi)
    first = int(np.argmin(normal))
    # Between the normals of the sides that meet in it, a corner is the furthest.
    order = np.roll(normal, -first)
    return np.asarray((np.searchsorted(order, direction % (2.0 * np.pi)) + first) % len(hull))


def _spans(hull: Array, turns: Array) -> Array:
    """From the leftmost to the rightmost and from the lowest to the highest corner, hull not turned, (2, N, 2) m."""
    across = np.stack([-turns, _QUARTER - turns])
    return np.asarray(hull[_furthest(hull, across)] - hull[_furthest(hull, across + np.pi)])


def _excess(hull: Array, turns: Array, half: Array) -> Array:
    """By how much the box of the hull is longer than the sheet, on each side of it, (N,) m, for every turn."""
    cos, sin = np.cos(turns), np.sin(turns)
    wide, deep = _spans(hull, turns)
    width, depth = wide[:, 0] * cos - wide[:, 1] * sin, deep[:, 0] * sin + deep[:, 1] * cos
    return np.asarray(np.maximum(0.5 * width - half[0], 0.5 * depth - half[1]))


def _critical(hull: Array, half: Array) -> tuple[Array, Array]:
    """The turns, rad in 0 to pi, at which a side of the hull lies along the sheet, and those with a square excess."""
    side = np.roll(hull, -1, axis=0) - hull
    flush = np.unique((-np.arctan2(side[:, 1], side[:, 0])) % _QUARTER)
    flush = np.concatenate([flush, flush + _QUARTER])
    start, end = flush, np.append(flush[1:], flush[0] + np.pi)
    # Between two turns the same corners are outermost: half the width minus half the depth is a cos + b sin.
    wide, deep = _spans(hull, 0.5 * (start + end))
    a, b = 0.5 * (wide[:, 0] - deep[:, 1]), 0.5 * (-wide[:, 1] - deep[:, 0])
    size = np.maximum(np.hypot(a, b), 1e-300)
    share = (half[0] - half[1]) / size
    apart = np.arccos(np.clip(share, -1.0, 1.0))
    middle = np.arctan2(b, a)
    equal = np.concatenate([middle - apart, middle + apart])
    begin, until, real = np.tile(start, 2), np.tile(end, 2), np.tile(np.abs(share) <= 1.0, 2)
    equal = begin + (equal - begin) % (2.0 * np.pi)
    return flush, equal[real & (equal <= until)] % np.pi
