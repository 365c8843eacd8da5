"""Prove that a robot keeps its requirements everywhere in a region, or find a point where it does not.

Looking at the corners of a region, or at any grid of points, proves nothing about the points between them. Here the
region is divided into cells; `margins.cell_margins` bounds every requirement over a whole cell, not only at points of
it. A cell whose bounds are good enough is done, the others are divided again (branch and bound).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from deltacam.model import Array
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.region.margins import cell_margins, margins
from deltacam.robot.region.requirements import Requirements
from deltacam.robot.region.shapes import Region

Verdict = Literal["certified", "refuted", "undecided"]

_ACROSS: Final = 4  # first cells along the longest side
MAX_CELLS: Final = 200_000
TIGHTNESS: Final = 0.5


@dataclass(frozen=True, slots=True)
class Margin:
    """How well one requirement is kept in a region.

    Attributes:
        name: of the requirement, as in `Requirements.names`.
        low: proved: no point of the region has a smaller margin; minus infinity where nothing is known.
        sampled: the smallest margin that was found at a point; between it and ``low`` lies the smallest of all.
        point: where it was found, m.
    """

    name: str
    low: float
    sampled: float
    point: tuple[float, float, float]


@dataclass(frozen=True, slots=True)
class Certificate:
    """Whether a robot keeps its requirements everywhere in a region.

    Attributes:
        verdict: "certified": proved everywhere; "refuted": some point of the region breaks one; "undecided": the cells
            ran out first, because the smallest margin is too close to zero.
        margins: one per requirement.
        cells: how many were looked at.
    """

    verdict: Verdict
    margins: tuple[Margin, ...]
    cells: int

    @property
    def certified(self) -> bool:
        """Whether it is proved."""
        return self.verdict == "certified"

    @property
    def worst(self) -> Margin:
        """The requirement with the smallest margin at a point."""
        return min(self.margins, key=lambda margin: margin.sampled)


def certify(
    geometry: DeltaGeometry,
    region: Region,
    requirements: Requirements,
    *,
    tightness: float = TIGHTNESS,
    max_cells: int = MAX_CELLS,
) -> Certificate:
    """Prove that a robot keeps its requirements everywhere in a region, or refute it.

    Args:
        geometry: the robot.
        region: where, in the machine frame.
        requirements: what it must keep.
        tightness: how much of the smallest margin that is found at points must be proved, in 0 to 1. 0 is quickest,
            and enough for a yes or no; close to 1 the margins are known well and it takes longer.
        max_cells: give up after so many.

    Returns:
        The certificate. It is the same for the same input.
    """
    low, high = region.bounds
    counts = _first_counts(high - low)
    half = (high - low) / counts / 2.0
    cells = low + half * (1.0 + 2.0 * _grid(counts))
    found = _Found(requirements)
    found.sample(geometry, region.corners())
    proved, looked_at = np.full(len(requirements.names), np.inf), 0
    while True:
        cells = cells[region.touches(cells, half)]
        if not found.broken:
            found.sample(geometry, region.nearest(cells))
        lows = cell_margins(geometry, requirements, cells, half).low
        looked_at += len(cells)
        again = (lows < tightness * np.maximum(found.smallest, 0.0)).any(axis=1) | (lows[:, 0] <= 0.0)
        proved = np.minimum(proved, lows[~again].min(axis=0, initial=np.inf))
        pieces = _grid(np.where(half > 0.0, 2, 1)) * 2.0 - 1.0
        if found.broken or not again.any() or looked_at + again.sum() * len(pieces) > max_cells:
            break
        half, cells = half / 2.0, cells[again]
        cells = (cells[:, np.newaxis] + half * 2.0 * pieces / 2.0).reshape(-1, 3)
    proved = np.minimum(proved, lows[again].min(axis=0, initial=np.inf))
    return Certificate(found.verdict(proved), found.margins(proved), looked_at)


class _Found:
    """The smallest margins found at points so far."""

    def __init__(self, requirements: Requirements) -> None:
        self.requirements = requirements
        self.smallest = np.full(len(requirements.names), np.inf)
        self.points = np.zeros((len(requirements.names), 3))

    @property
    def broken(self) -> bool:
        """Whether a point breaks a requirement; reach is broken at its very edge too."""
        return bool((self.smallest < 0.0).any() or self.smallest[0] <= 0.0)

    def sample(self, geometry: DeltaGeometry, points: Array) -> None:
        """Look at more points of the region, (N, 3) m."""
        values = margins(geometry, self.requirements, points)
        values = np.where(np.isnan(values), np.inf, values)
        at = values.argmin(axis=0)
        least = values[at, np.arange(values.shape[1])]
        better = least < self.smallest
        self.smallest[better], self.points[better] = least[better], points[at[better]]

    def verdict(self, proved: Array) -> Verdict:
        """What follows from the points and from the margins ``proved`` (K,)."""
        if self.broken:
            return "refuted"
        return "certified" if (proved >= 0.0).all() and proved[0] > 0.0 else "undecided"

    def margins(self, proved: Array) -> tuple[Margin, ...]:
        """One per requirement."""
        values = zip(self.requirements.names, proved, self.smallest, self.points, strict=True)
        return tuple(
            Margin(name, float(low), float(least), (float(x), float(y), float(z)))
            for name, low, least, (x, y, z) in values
        )


def _first_counts(size: Array) -> Array:
    """How many first cells along each side, so that they are about cubes; (3,)."""
    longest = float(size.max())
    if longest == 0.0:
        return np.ones(3)
    return np.maximum(np.round(_ACROSS * size / longest), 1.0)


def _grid(counts: Array) -> Array:
    """All whole numbers from 0 to below ``counts`` (3,): (N, 3)."""
    return np.stack(np.meshgrid(*(np.arange(count) for count in counts), indexing="ij"), axis=-1).reshape(-1, 3)
