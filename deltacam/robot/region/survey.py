"""How well a robot moves over its usable region, its sheet and slices of them: at points, not proved."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model import Array, BoolArray
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.kinematics import inverse_jacobian
from deltacam.robot.region.margins import margins_of
from deltacam.robot.region.pose_bounds import pose_bounds
from deltacam.robot.region.requirements import Requirements

PER_SIDE: Final = 48


@dataclass(frozen=True, slots=True, eq=False)
class Poses:
    """Poses at points; nan where a point is out of reach, but for ``kept``.

    Attributes:
        points: (N, 3) m.
        kept: whether all requirements are kept, (N,).
        inverse_condition: (N,), 0 to 1.
        mu1: of the worst arm, (N,) rad.
        mu2: of the worst arm, (N,) rad.
        swing: of the worst arm, (N,) rad.
        angles: of the joints, (N, 3) rad.
        reach: the reach margin of the worst arm as a part of its upper arm, (N,).
        manipulability: |det J|, (N,) m^3/rad^3 (Yoshikawa 1985).
        tool_error: the largest movement of the tool for a joint error of norm 1, (N,) m/rad: the largest singular value
            of J.
    """

    points: Array
    kept: BoolArray
    inverse_condition: Array
    mu1: Array
    mu2: Array
    swing: Array
    angles: Array
    reach: Array
    manipulability: Array
    tool_error: Array


def poses_at(geometry: DeltaGeometry, requirements: Requirements, points: Array) -> Poses:
    """What the poses at ``points`` (N, 3) m are like; the points may be out of reach."""
    bounds = pose_bounds(geometry, points, np.zeros(3))
    found = margins_of(requirements, bounds)
    reached = ~np.isnan(found[:, 1])

    def known(values: Array) -> Array:
        out = np.full(values.shape, np.nan)
        out[reached] = values[reached]
        return out

    sizes = np.full((len(points), 3), np.nan)
    drivable = bounds.steady
    sizes[drivable] = np.linalg.svd(inverse_jacobian(geometry, points[drivable]), compute_uv=False)
    return Poses(
        points=points,
        kept=reached & (np.nan_to_num(found, nan=-1.0) >= 0.0).all(axis=1),
        inverse_condition=known(bounds.inverse_condition.at),
        mu1=known(np.arccos(bounds.along.at).max(axis=1)),
        mu2=known(bounds.mu2.at.max(axis=1)),
        swing=known(np.arcsin(np.minimum(bounds.aside.at, 1.0)).max(axis=1)),
        angles=known(bounds.angle.at),
        reach=bounds.reach.at.min(axis=1),
        manipulability=1.0 / sizes.prod(axis=1),
        tool_error=1.0 / sizes[:, -1],
    )


@dataclass(frozen=True, slots=True, eq=False)
class Slice:
    """A plane through the usable region: a grid of points along two axes of the machine.

    Attributes:
        axes: which two, 0 to 2; the second is upwards in a picture.
        first: coordinates along the first, (K,) m.
        second: coordinates along the second, (L,) m.
        poses: at the points, row by row: (L * K).
    """

    axes: tuple[int, int]
    first: Array
    second: Array
    poses: Poses

    def field(self, values: Array) -> Array:
        """One value per pose as (L, K); nan where the requirements are not kept."""
        return np.where(self.poses.kept, values, np.nan).reshape(len(self.second), len(self.first))

    @property
    def area(self) -> float:
        """Of the usable part, m^2, as the share of the points has it."""
        cell = float((self.first[1] - self.first[0]) * (self.second[1] - self.second[0]))
        return cell * int(self.poses.kept.sum())


def cut(
    geometry: DeltaGeometry,
    requirements: Requirements,
    bounds: Array,
    *,
    axes: tuple[int, int],
    at: float,
    per_side: int = PER_SIDE,
) -> Slice:
    """A slice of what lies within ``bounds`` (2, 3) m: the plane through ``at`` m on the third axis."""
    first, second = (_middles(bounds[0, axis], bounds[1, axis], per_side) for axis in axes)
    across, up = np.meshgrid(first, second)
    points = np.full((across.size, 3), at)
    points[:, axes[0]], points[:, axes[1]] = across.ravel(), up.ravel()
    return Slice(axes, first, second, poses_at(geometry, requirements, points))


def survey(
    geometry: DeltaGeometry, requirements: Requirements, bounds: Array, *, per_side: int = PER_SIDE
) -> tuple[Poses, float]:
    """Poses at a grid of points within ``bounds`` (2, 3) m, and the volume that belongs to each, m^3."""
    sides = [_middles(bounds[0, axis], bounds[1, axis], per_side) for axis in range(3)]
    points = np.stack(np.meshgrid(*sides, indexing="ij"), axis=-1).reshape(-1, 3)
    return poses_at(geometry, requirements, points), float((bounds[1] - bounds[0]).prod()) / per_side**3


def _middles(low: float, high: float, count: int) -> Array:
    return low + (high - low) * (np.arange(count) + 0.5) / count
