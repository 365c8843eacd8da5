"""Unbounded lines and circles in the plane, run in one direction, and where two of them meet."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model import Array

_ALMOST_STRAIGHT: Final = 10.0
_STRAIGHT: Final = 1e-6


@dataclass(frozen=True, slots=True, eq=False)
class Element:
    """A line through ``anchor`` along ``heading``, or a circle about ``anchor``.

    Attributes:
        anchor: (2,) m, a point of the line or the centre of the circle.
        radius: m, 0 for a line; positive for a circle run counter-clockwise, negative for clockwise.
        heading: rad, of a line.
    """

    anchor: Array
    radius: float = 0.0
    heading: float = 0.0

    @property
    def direction(self) -> Array:
        """The unit vector along a line, (2,)."""
        return np.array([np.cos(self.heading), np.sin(self.heading)])


def shifted(start: Array, heading: float, curvature: float, shift: float) -> Element:
    """The element that runs ``shift`` m to the right of a line or arc.

    Args:
        start: (2,) m, where the line or arc starts.
        heading: rad, its direction there.
        curvature: 1/m, 0 for a line, positive to the left.
        shift: m, negative to the left.

    Returns:
        a line or circle; the radius has the other sign where the shift goes beyond the centre.
    """
    left = np.array([-np.sin(heading), np.cos(heading)])
    if abs(curvature) < _STRAIGHT:
        return Element(anchor=start - shift * left, heading=heading)
    return Element(anchor=start + left / curvature, radius=1.0 / curvature + shift)


def turn_between(element: Element, start: Array, end: Array, about: float) -> float:
    """The signed angle from ``start`` to ``end`` about a circle; of those a turn apart the nearest to ``about``."""
    before, after = start - element.anchor, end - element.anchor
    turn = float(np.arctan2(after[1], after[0]) - np.arctan2(before[1], before[0]))
    return turn + 2.0 * np.pi * round((about - turn) / (2.0 * np.pi))


def meeting_point(first: Element, second: Element, about: Array) -> Array | None:
    """The point nearest to ``about``, (2,) m, that two elements share; None where they share none."""
    near, also_near = _flattened(first, about), _flattened(second, about)
    if near.radius == 0.0 and also_near.radius == 0.0:
        places = _line_line(near, also_near)
    elif near.radius == 0.0:
        places = _line_circle(near, also_near)
    elif also_near.radius == 0.0:
        places = _line_circle(also_near, near)
    else:
        places = _circle_circle(near, also_near)
    if not len(places):
        return None
    return _polished(first, second, places[np.argmin(np.hypot(*(places - about).T))])


def _flattened(element: Element, about: Array) -> Element:
    """The tangent beside ``about`` in place of a circle so large that squares of its radius lose micrometres."""
    if abs(element.radius) < _ALMOST_STRAIGHT:
        return element
    distance, outward = _offset(element, about)
    return Element(about - distance * outward, heading=float(np.arctan2(outward[0], -outward[1])))


def _polished(first: Element, second: Element, place: Array) -> Array:
    """The meeting point near ``place`` by Newton's method."""
    for _ in range(3):
        (gap_a, a), (gap_b, b) = _offset(first, place), _offset(second, place)
        cross = a[0] * b[1] - a[1] * b[0]
        if abs(cross) < 1e-6:
            break
        place = place - np.array([gap_a * b[1] - gap_b * a[1], gap_b * a[0] - gap_a * b[0]]) / cross
    return place


def _offset(element: Element, place: Array) -> tuple[float, Array]:
    """How far ``place`` is from an element, signed, and the direction in which that grows."""
    arm = place - element.anchor
    if element.radius == 0.0:
        normal = np.array([-np.sin(element.heading), np.cos(element.heading)])
        return float(arm @ normal), normal
    distance = float(np.hypot(*arm))
    return distance - abs(element.radius), arm / max(distance, 1e-15)


def _line_line(first: Element, second: Element) -> Array:
    a, b = first.direction, second.direction
    cross = float(a[0] * b[1] - a[1] * b[0])
    if abs(cross) < 1e-12:
        return np.empty((0, 2))
    gap = second.anchor - first.anchor
    return np.array([first.anchor + a * (gap[0] * b[1] - gap[1] * b[0]) / cross])


def _line_circle(line: Element, circle: Element) -> Array:
    along = line.direction
    gap = circle.anchor - line.anchor
    foot = line.anchor + along * float(gap @ along)
    offset = float(along[0] * gap[1] - along[1] * gap[0])
    return _either_side(foot, along, circle.radius**2 - offset**2)


def _circle_circle(first: Element, second: Element) -> Array:
    gap = second.anchor - first.anchor
    distance = float(np.hypot(*gap))
    if distance < 1e-12:
        return np.empty((0, 2))
    along = gap / distance
    foot = (distance**2 + first.radius**2 - second.radius**2) / (2.0 * distance)
    across = np.array([-along[1], along[0]])
    return _either_side(first.anchor + along * foot, across, first.radius**2 - foot**2)


def _either_side(foot: Array, along: Array, squared: float) -> Array:
    """The points at the distance sqrt(``squared``) from ``foot`` along a line, both ways."""
    if squared < 0.0:
        return np.empty((0, 2))
    reach = np.sqrt(squared)
    return np.array([foot - along * reach, foot + along * reach])
