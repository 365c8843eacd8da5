"""The largest cylinder and the largest box about a robot's axis in which it keeps its requirements, proved.

Candidates are found by looking at points of many rings at many heights; what is reported is certified (`certify`), and
shrunk until it is.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.region.certify import Certificate, certify
from deltacam.robot.region.margins import margins
from deltacam.robot.region.requirements import Requirements
from deltacam.robot.region.shapes import Box, Cylinder, Region

_HEIGHTS: Final = 61
_RINGS: Final = 48
_AROUND: Final = 48  # points of a ring; a multiple of 8, so that a square's corners are among them
_PASSES: Final = 3  # over the heights, each within the last one
_HALVINGS: Final = 4  # of the last ring, when it is certified: 2 / 48 / 2**4 is a quarter of a percent
_CELLS: Final = 12_000
_TIGHTNESS: Final = 0.01  # a yes is wanted here, not the margins


@dataclass(frozen=True, slots=True)
class Fitted:
    """A region that a robot can use all of, and the proof.

    Attributes:
        region: the cylinder or the box.
        certificate: of it; certified.
    """

    region: Region
    certificate: Certificate


@dataclass(frozen=True, slots=True)
class _Section:
    """A level section about the axis: a disc, or a rectangle of half sides 1 and ``ratio``, times its size."""

    centre: tuple[float, float]
    ratio: float | None

    def ring(self) -> Array:
        """Points of its edge at size 1, (M, 2)."""
        turn = np.linspace(0.0, 2.0 * np.pi, _AROUND, endpoint=False)
        ring = np.stack((np.cos(turn), np.sin(turn)), axis=1)
        if self.ratio is None:
            return ring
        return np.asarray(ring / np.abs(ring).max(axis=1)[:, np.newaxis] * [1.0, self.ratio])

    def region(self, size: float, low: float, high: float) -> Region:
        """The region of this section from z = ``low`` to ``high``, m."""
        if self.ratio is None:
            return Cylinder(self.centre, size, low, high)
        (x, y), deep = self.centre, size * self.ratio
        return Box((x - size, y - deep, low), (x + size, y + deep, high))


def largest_region(
    geometry: DeltaGeometry,
    requirements: Requirements,
    bounds: Array,
    *,
    ratio: float | None = None,
    height: float | None = None,
) -> Fitted:
    """The largest upright region about the robot's axis that is certified.

    Args:
        geometry: the robot.
        requirements: what it must keep everywhere in the region.
        bounds: low and high corner of a box that holds the usable region, (2, 3) m; of `usable.Usable`.
        ratio: depth by width of a box; None for a cylinder.
        height: of the region, m; None for the height that gives the largest volume.

    Returns:
        The region and its certificate. Its heights are of a grid, and its size is within a quarter of a percent of the
        largest that is certified for them with a limited number of cells.

    Raises:
        RobotError: there is no such region.
    """
    section = _Section((float(geometry.mount.x), float(geometry.mount.y)), ratio)
    wide = float(np.abs(bounds[:, :2] - section.centre).max())
    low, high = float(bounds[0, 2]), float(bounds[1, 2])
    size = 0.0
    for _ in range(_PASSES):
        heights = np.linspace(low, high, _HEIGHTS)
        sizes = _sizes(geometry, requirements, section, heights, wide)
        size, low, high = _best(heights, sizes, height)
        if size <= 0.0:
            wish = "" if height is None else f" {height * 1e3:g} mm high"
            what = f"no {'cylinder' if ratio is None else 'box'}{wish} about the axis keeps all requirements"
            raise RobotError(what, where="workspace", hint="ask for a lower height, or allow more in the robot file")
        found, step = (size, low, high), float(heights[1] - heights[0])
        wide = size * (1.0 + 4.0 / _RINGS)
        low, high = low - step, high + step
    return _certified(geometry, requirements, section, found)


def _sizes(
    geometry: DeltaGeometry, requirements: Requirements, section: _Section, heights: Array, wide: float
) -> Array:
    """The largest size at every height of which all rings up to it keep the requirements, (H,) m."""
    scale = np.linspace(0.0, wide, _RINGS + 1)
    level = section.centre + scale[:, np.newaxis, np.newaxis] * section.ring()
    points = np.concatenate(
        (
            np.broadcast_to(level, (len(heights), *level.shape)),
            np.broadcast_to(heights[:, np.newaxis, np.newaxis, np.newaxis], (len(heights), *level.shape[:2], 1)),
        ),
        axis=-1,
    )
    kept = np.asarray((margins(geometry, requirements, points.reshape(-1, 3)) >= 0.0).all(axis=1))  # false for nan
    whole = kept.reshape(points.shape[:3]).all(axis=2)
    rings = np.logical_and.accumulate(whole, axis=1).sum(axis=1)
    return np.asarray(scale[np.maximum(rings - 1, 0)])


def _best(heights: Array, sizes: Array, height: float | None) -> tuple[float, float, float]:
    """The size and the ends of the largest region: of all pairs of heights, or of the given height."""
    best = 0.0, float(heights[0]), float(heights[0])
    most = 0.0
    for first in range(len(heights)):
        if height is not None:
            top = heights[first] + height
            last = int(np.searchsorted(heights, top - 1e-9))
            if last >= len(heights):
                break
            size = float(sizes[first : last + 1].min())
            if size > best[0]:
                best = size, float(heights[first]), float(top)
            continue
        volumes = np.minimum.accumulate(sizes[first:]) ** 2 * (heights[first:] - heights[first])
        last = first + int(volumes.argmax())
        if volumes.max() > most:
            most = float(volumes.max())
            best = float(sizes[first : last + 1].min()), float(heights[first]), float(heights[last])
    return best


def _certified(
    geometry: DeltaGeometry, requirements: Requirements, section: _Section, found: tuple[float, float, float]
) -> Fitted:
    """The largest certified region of a size up to a ring more than ``found``, by bisection of the size."""
    size, low, high = found
    proved: Fitted | None = None
    least, most = 0.0, size * (1.0 + 2.0 / _RINGS)
    trial = size
    for step in range(2 * _HALVINGS):
        region = section.region(trial, low, high)
        certificate = certify(geometry, region, requirements, tightness=_TIGHTNESS, max_cells=_CELLS)
        if certificate.certified:
            least, proved = trial, Fitted(region, certificate)
        else:
            most = trial
        if proved is not None and step >= _HALVINGS:
            break
        trial = max((least + most) / 2.0, most * (1.0 - 0.02 * 2.0**step)) if proved is None else (least + most) / 2.0
    if proved is None:
        raise RobotError("no region about the axis could be certified", where="workspace", hint="allow more margin")
    # The margins of what is reported are wanted closely, those of the trials were not.
    close = certify(geometry, proved.region, requirements, tightness=0.5)
    return replace(proved, certificate=close) if close.certified else proved
