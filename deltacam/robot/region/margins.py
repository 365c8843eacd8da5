"""By how much poses keep their requirements: at points, and bounded over cells."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.model import Array
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.region.pose_bounds import Interval, PoseBounds, pose_bounds
from deltacam.robot.region.requirements import REACH, Requirements

ROUNDING: Final = 1e-12  # of the size of a quantity; they are of the order of one
_LARGEST_ANGLE: Final = np.pi - 1e-9  # rad; beyond it a joint angle jumps by a turn


def margins(geometry: DeltaGeometry, requirements: Requirements, points: Array) -> Array:
    """By how much every requirement is kept at points; negative where it is not.

    Args:
        geometry: the robot.
        requirements: what is required.
        points: (N, 3) in the machine frame, m; they may be out of reach.

    Returns:
        (N, K), one column per name of ``requirements``: the reach margin as a part of the upper arm, angles in rad, the
        inverse condition number as it is. The worst arm counts. Out of reach all but the first are nan.
    """
    wanted = requirements.min_inverse_condition is not None
    return margins_of(requirements, pose_bounds(geometry, points, np.zeros(3), conditioned=wanted))


def margins_of(requirements: Requirements, bounds: PoseBounds) -> Array:
    """The `margins` of points whose ``bounds`` are known."""
    found = np.array(_against(requirements, bounds).at)
    out = (found[:, 0] <= 0.0) | (bounds.along.at <= 0.0).any(axis=1)
    found[out, 1:] = np.nan
    found[out, 0] = np.minimum(found[out, 0], 0.0)
    return found


def cell_margins(geometry: DeltaGeometry, requirements: Requirements, centres: Array, half: Array) -> Interval:
    """The smallest and the largest margin that any pose of every cell can have.

    Args:
        geometry: the robot.
        requirements: what is required.
        centres: middles of the cells, (N, 3) m.
        half: half of the sides of every cell, (3,) m.

    Returns:
        Three arrays as `margins`. Where a part of a cell is out of reach, or close to it, little is known of the
        others: they are minus and plus infinity. The largest is that of the poses within reach.
    """
    bounds = pose_bounds(geometry, centres, half)
    at, low, high = _against(requirements, bounds)
    low, high = low - ROUNDING * (1.0 + np.abs(low)), high + ROUNDING * (1.0 + np.abs(high))
    low[~bounds.steady, 1:] = -np.inf
    anyhow = [name in (REACH, "mu1", "swing") for name in requirements.names]  # from t and y, which are always bounded
    high[np.ix_(~bounds.steady, ~np.array(anyhow))] = np.inf
    around = (np.maximum(bounds.angle.high, -bounds.angle.low) > _LARGEST_ANGLE).any(axis=1)
    for name in {"joint_min", "joint_max"}.intersection(requirements.names):
        column = requirements.names.index(name)
        low[around, column], high[around, column] = -np.inf, np.inf
    return Interval(at, low, high)


def _against(requirements: Requirements, bounds: PoseBounds) -> Interval:
    """The margins at the middle, the smallest and the largest: each (N, K)."""
    smallest, largest = requirements.joint_limits()
    angle, condition = bounds.angle, bounds.inverse_condition
    mu1 = Interval(*(np.arccos(value) for value in (bounds.along.at, bounds.along.high, bounds.along.low)))
    swing = Interval(*(np.arcsin(np.minimum(value, 1.0)) for value in bounds.aside))
    columns = {
        REACH: bounds.reach,
        "joint_min": Interval(*(value - smallest for value in angle)),
        "joint_max": _below(largest, angle),
        "mu1": _below(requirements.max_mu1, mu1),
        "mu2": _below(requirements.mu2_limit, bounds.mu2),
        "swing": _below(requirements.max_swing, swing),
        "inverse_condition": Interval(
            *(value[:, np.newaxis] - (requirements.min_inverse_condition or 0.0) for value in condition)
        ),
    }
    worst = [[value.min(axis=1) for value in columns[name]] for name in requirements.names]
    return Interval(*(np.stack(values, axis=1) for values in zip(*worst, strict=True)))


def _below(limit: Array | float | None, value: Interval) -> Interval:
    largest = np.inf if limit is None else limit
    return Interval(largest - value.at, largest - value.high, largest - value.low)
