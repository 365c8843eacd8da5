"""Where leads may lie and how large they must be on a robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import shapely
import shapely.affinity

from deltacam.cutting.fitting import OUTSIDE
from deltacam.cutting.leads.sizes import Ability, ability
from deltacam.model import Array, Placement

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot


@dataclass(frozen=True, slots=True)
class Reach:
    """A robot and how the sheet lies in it; places are (N, 2) m in the sheet frame."""

    robot: Robot
    placement: Placement

    @property
    def tick(self) -> float:
        """Of the controller, s."""
        return 1.0 / self.robot.controller.rate_hz

    def area(self) -> shapely.Polygon:
        """The workspace in the sheet frame; a disc as a polygon within it."""
        sheet, where = self.robot.workspace, self.placement
        if sheet.radius is not None:
            area = shapely.Point(0.0, 0.0).buffer(sheet.radius + OUTSIDE, quad_segs=256)
        else:
            x, y = 0.5 * (sheet.width or 0.0) + OUTSIDE, 0.5 * (sheet.depth or 0.0) + OUTSIDE
            area = shapely.box(-x, -y, x, y)
        moved = shapely.affinity.translate(area, -where.x, -where.y)
        return shapely.affinity.rotate(moved, -where.rotation, origin=(0.0, 0.0), use_radians=True)

    def able(self, points: Array) -> Ability:
        """What the tool can do at places."""
        cos, sin = np.cos(self.placement.rotation), np.sin(self.placement.rotation)
        machine = points @ np.array([[cos, sin], [-sin, cos]]) + (self.placement.x, self.placement.y)
        return ability(self.robot, np.column_stack([machine, np.full(len(points), self.placement.z)]))
