"""Prints what a loose test of reach does to a design: what the robot claims to reach, and what it reaches.

Some published syntheses ask a candidate whether its loops close to within a tolerance. A tolerance that is not small
against the arms makes the test say yes where there is no pose at all, and an optimiser finds exactly those robots.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from scipy.optimize import differential_evolution

from deltacam.model import Array
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.region.certify import certify
from deltacam.robot.region.requirements import Requirements
from deltacam.robot.region.shapes import Box

SIDES: Final = (0.2, 0.2, 0.2)
"""Of the prescribed box, m."""

TOLERANCES: Final = (0.1, 0.03, 0.01, 0.0)
"""Of the loop's closure, m."""

_AZIMUTHS: Final = np.radians([-90.0, 30.0, 150.0])
_LIMITS: Final = ((0.0, 0.3), (0.05, 0.5), (0.05, 0.6), (-0.8, -0.101))  # R - r, La, Lb, middle, m
_SMALLEST_BOX: Final = 9  # points along a side of the test grid


class Loose(NamedTuple):
    """A design made with a loose test of reach."""

    tolerance: float
    size: float
    lengths: tuple[float, float, float, float]
    reached: float
    verdict: str


def gap(lengths: Array, points: Array) -> Array:
    """How far the loop of the worst arm stays open at best, m: (C, N) for candidates (C, 4), points about the middle.

    The effector's joint is between |hyp - La| and hyp + La away from the elbow's circle in the plane of the arm.
    """
    offset, La, Lb, middle = (column[:, np.newaxis, np.newaxis] for column in lengths.T)
    x = points[:, :1] * np.cos(_AZIMUTHS) + points[:, 1:2] * np.sin(_AZIMUTHS) - offset
    y = points[:, 1:2] * np.cos(_AZIMUTHS) - points[:, :1] * np.sin(_AZIMUTHS)
    away = np.hypot(x, points[:, 2:] + middle)
    nearest, farthest = np.hypot(away - La, y), np.hypot(away + La, y)
    return np.asarray(np.maximum(nearest - Lb, Lb - farthest).max(axis=2))


def loose(tolerance: float, seed: int = 0) -> Loose:
    """The smallest robot whose loops close to within a tolerance at the points of a grid, and what it reaches."""
    side = np.linspace(-0.5, 0.5, _SMALLEST_BOX)
    points = np.stack(np.meshgrid(side, side, side), axis=-1).reshape(-1, 3) * SIDES

    def objective(unknowns: Array) -> Array:
        lengths = unknowns.T
        missed = np.maximum(gap(lengths, points).max(axis=1) - tolerance, 0.0)
        return np.where(missed > 0.0, 2.0 + missed, lengths[:, :3].sum(axis=1))

    found = differential_evolution(
        objective, _LIMITS, rng=seed, vectorized=True, updating="deferred", polish=False, maxiter=200, init="sobol"
    )
    inside = np.random.default_rng(seed).uniform(-0.5, 0.5, (100_000, 3)) * SIDES
    reached = float((gap(found.x[np.newaxis], inside)[0] <= 0.0).mean())
    offset, La, Lb, middle = (float(value) for value in found.x)
    half = np.array(SIDES) / 2.0
    low, high = (tuple(float(v) for v in [0.0, 0.0, middle] + sign * half) for sign in (-1.0, 1.0))
    certificate = certify(DeltaGeometry(offset, 0.0, La, Lb), Box(low, high), Requirements())
    return Loose(tolerance, offset + La + Lb, (offset, La, Lb, middle), reached, certificate.verdict)


def main() -> None:
    """Print the table of docs/explanation/published-designs.md."""
    print(table())


def table() -> str:
    """A row per tolerance."""
    lines = ["| tolerance, mm | size, mm | forearm, mm | box reached | certificate |", "|---:|---:|---:|---:|---|"]
    for tolerance in TOLERANCES:
        one = loose(tolerance)
        cells = f"{1e3 * tolerance:g} | {1e3 * one.size:.0f} | {1e3 * one.lengths[2]:.0f} | {100 * one.reached:.1f} %"
        lines.append(f"| {cells} | {one.verdict} |")
    return "\n".join(lines)


if __name__ == "__main__":
    main()
