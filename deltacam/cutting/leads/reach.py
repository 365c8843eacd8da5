"""Where leads may lie and how large they must be on a robot."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from deltacam.cutting.fitting import OUTSIDE
from deltacam.cutting.leads.sizes import Ability, ability
from deltacam.model import Array, BoolArray, Placement

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

    def is_allowed(self, points: Array) -> BoolArray:
        """Which places lie in the robot's workspace, (N,)."""
        return np.asarray(self.robot.workspace.excess(self._in_machine(points)) <= OUTSIDE)

    def able(self, points: Array) -> Ability:
        """What the tool can do at places."""
        heights = np.full(len(points), self.placement.z)
        return ability(self.robot, np.column_stack([self._in_machine(points), heights]))

    def _in_machine(self, points: Array) -> Array:
        cos, sin = np.cos(self.placement.rotation), np.sin(self.placement.rotation)
        shift = np.array([self.placement.x, self.placement.y])
        return np.asarray(points @ np.array([[cos, sin], [-sin, cos]]) + shift)
