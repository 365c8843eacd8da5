"""Marks of a size in pixels over a picture that can be zoomed: from which scale on does one lie on no other?"""

from __future__ import annotations

import numpy as np

from deltacam.model import Array

NEVER = float("inf")


class Crowd:
    """Marks that are there already: boxes of a fixed size in pixels beside points of the picture.

    Args:
        unit: metres for each pixel in the smallest picture; a zoom of z shows unit / z.
    """

    def __init__(self, unit: float) -> None:
        self._unit = unit
        self._count = 0
        self._points = np.zeros((64, 2))
        self._offsets = np.zeros((64, 2))
        self._halves = np.zeros((64, 2))
        self._zooms = np.zeros(64)

    def add(self, point: Array, offset: Array, half: Array, zoom: float = 1.0) -> None:
        """A mark at ``point``, (2,) m, its middle ``offset`` pixels away, to be seen from ``zoom`` on."""
        if self._count == len(self._zooms):
            for name in ("_points", "_offsets", "_halves", "_zooms"):
                values = getattr(self, name)
                setattr(self, name, np.concatenate([values, np.zeros_like(values)]))
        at = self._count
        self._points[at], self._offsets[at], self._halves[at], self._zooms[at] = point, offset, half, zoom
        self._count += 1

    def free(self, point: Array, offsets: Array, half: Array, least: float = 1.0) -> tuple[int, float]:
        """The best of the ``offsets``, (K, 2) pixels, of a mark at ``point``, and the zoom from which on it is free.

        Two marks overlap at the zooms z at which |z d + o| < h in x and in y: d being the way from the one point to the
        other in the smallest picture, o that between the offsets, h the sum of their halves. That is an interval.

        Returns:
            the index of the offset, and a zoom >= ``least``; `NEVER` where it lies on another one at any zoom.
        """
        seen = slice(0, self._count)
        apart = (point - self._points[seen]) / self._unit
        shift = offsets[:, None] - self._offsets[seen]
        room = half + self._halves[seen]
        with np.errstate(divide="ignore", invalid="ignore"):
            ends = np.stack([(-room - shift) / apart, (room - shift) / apart])
        first, last = ends.min(axis=0).max(axis=2), ends.max(axis=0).min(axis=2)
        overlaps = (first < last) & (last > np.maximum(self._zooms[seen], least))
        zooms = np.where(overlaps, last, least).max(axis=1, initial=least)
        best = int(np.argmin(zooms))
        return best, float(zooms[best])
