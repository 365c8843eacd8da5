"""Many machines with random errors, and how far their tools are off."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.model import Array
from deltacam.robot.accuracy.exact import tool_errors
from deltacam.robot.accuracy.sources import COUNT
from deltacam.robot.dimensions import DeltaGeometry

CONFIDENCE: Final = 0.95
"""The part of all machines and moments that is at most as far off as the figure says."""

_POSES: Final = 100_000  # that are solved at once, for the sake of memory


def draw(count: int, seed: int) -> Array:
    """Independent errors in parts of their limits, uniform in -1 to 1: (count, COUNT); the same for the same seed."""
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (count, COUNT))


def exact_errors(geometry: DeltaGeometry, points: Array, errors: Array) -> Array:
    """As `exact.tool_errors`, in parts that fit into memory: (D, N, 3) m.

    Raises:
        RobotError: as `exact.tool_errors`.
    """
    part = max(1, _POSES // len(points))
    parts = [tool_errors(geometry, points, errors[i : i + part]) for i in range(0, len(errors), part)]
    return np.concatenate(parts)


def usual(distances: Array) -> Array:
    """The distances that `CONFIDENCE` of the draws stay within: (N,) of (D, N)."""
    return np.asarray(np.quantile(distances, CONFIDENCE, axis=0))


def in_plane(errors: Array) -> Array:
    """The distances in x and y of errors (..., 3): (...,) m."""
    return np.hypot(errors[..., 0], errors[..., 1])
