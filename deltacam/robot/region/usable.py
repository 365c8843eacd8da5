"""The region that a robot can use: how large it is, between proved bounds, and how well it moves there."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model import Array
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.region.certify import first_cells, halved
from deltacam.robot.region.margins import cell_margins
from deltacam.robot.region.requirements import Requirements
from deltacam.robot.region.shapes import Box
from deltacam.robot.robot import Robot

MAX_CELLS: Final = 120_000


def requirements_of(robot: Robot, *, min_inverse_condition: float | None = None) -> Requirements:
    """What the file of a robot requires of its poses: joint ranges, pressure angles, forearm swing.

    Args:
        robot: the robot.
        min_inverse_condition: smallest inverse condition number, 0 to 1; no robot file has it.

    Returns:
        The requirements.
    """
    sheet = robot.workspace
    return Requirements(
        joint_min=robot.joints.min,
        joint_max=robot.joints.max,
        max_mu1=sheet.max_pressure_angle,
        max_mu2=sheet.max_pressure_angle,
        max_swing=sheet.max_forearm_swing,
        min_inverse_condition=min_inverse_condition,
    )


def whole_reach(geometry: DeltaGeometry) -> Box:
    """A box that holds every point that the robot reaches: no arm is longer than stretched, and the base is above."""
    x, y, z = geometry.centre
    length = geometry.upper_arms + geometry.forearms
    middles = geometry.outwards * geometry.offsets[:, np.newaxis]
    low = (middles - length[:, np.newaxis]).max(axis=0)
    high = (middles + length[:, np.newaxis]).min(axis=0)
    deep = z - geometry.up * float(length.min())
    return Box((x + low[0], y + low[1], min(z, deep)), (x + high[0], y + high[1], max(z, deep)))


@dataclass(frozen=True, slots=True, eq=False)
class Usable:
    """The cells of a region in which a robot keeps its requirements, as far as it is known.

    Attributes:
        low: volume of the cells in which every requirement is kept everywhere, m^3: proved, the volume is not smaller.
        high: the volume is not larger, m^3: the rest is proved to break a requirement.
        inside: middles of the cells that are inside, (N, 3) m.
        halves: half of the sides of each of them, (N, 3) m.
        bounds: corners of a box that holds the usable region, (2, 3) m.
    """

    low: float
    high: float
    inside: Array
    halves: Array
    bounds: Array


def usable_region(geometry: DeltaGeometry, requirements: Requirements, *, max_cells: int = MAX_CELLS) -> Usable:
    """The region that a robot can use, between bounds.

    Cells are inside where every margin is proved to be kept, outside where one is proved to be broken, and divided
    again otherwise, until there are too many.

    Args:
        geometry: the robot.
        requirements: what it must keep.
        max_cells: as many are looked at, about.

    Returns:
        The region; the difference of its two volumes is that of the cells at its edge.
    """
    cells, half = first_cells(whole_reach(geometry), across=10)
    kept, halves, looked_at = [], [], 0
    while True:
        _, low, high = cell_margins(geometry, requirements, cells, half)
        looked_at += len(cells)
        inside, outside = (low > 0.0).all(axis=1), (high < 0.0).any(axis=1)
        kept.append(cells[inside])
        halves.append(np.broadcast_to(half, cells[inside].shape))
        open_cells = cells[~inside & ~outside]
        if not len(open_cells) or looked_at + 8 * len(open_cells) > max_cells:
            break
        cells, half = halved(open_cells, half)
    middles, sides = np.concatenate(kept), np.concatenate(halves)
    least, edge = 8.0 * float(sides.prod(axis=1).sum()), 8.0 * float(half.prod()) * len(open_cells)
    both = np.concatenate((middles, open_cells))
    reach = np.concatenate((sides, np.broadcast_to(half, open_cells.shape)))
    bounds = np.stack(((both - reach).min(axis=0), (both + reach).max(axis=0))) if len(both) else np.zeros((2, 3))
    return Usable(least, least + edge, middles, sides, bounds)
