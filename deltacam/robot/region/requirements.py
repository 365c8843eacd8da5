"""What a pose must keep to count as usable."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array

Triple = tuple[float, float, float]

REACH: Final = "reach"
PARALLEL_SINGULARITY: Final = math.pi / 2
"""mu2 here: the tool gains a freedom that no joint holds. Beyond it the tool is on the other side, where no motion
from the usual poses leads without passing the singularity."""


@dataclass(frozen=True, slots=True)
class Requirements:
    """What a pose must keep; None is not required. Reach always is, and that mu2 stays below 90 degrees.

    Attributes:
        joint_min: smallest joint angle, rad; one number for the three joints, or one for each.
        joint_max: largest joint angle, rad; likewise.
        max_mu1: largest pressure angle between a forearm and the motion of its elbow, rad.
        max_mu2: largest pressure angle between a forearm and the motion of the tool, rad.
        max_swing: largest lean of a forearm out of its arm's plane, rad.
        min_inverse_condition: smallest inverse condition number of the Jacobian, 0 to 1.

    Raises:
        RobotError: a number is not finite, or a joint's smallest angle is not below its largest.
    """

    joint_min: float | Triple | None = None
    joint_max: float | Triple | None = None
    max_mu1: float | None = None
    max_mu2: float | None = None
    max_swing: float | None = None
    min_inverse_condition: float | None = None

    def __post_init__(self) -> None:
        for name in ("joint_min", "joint_max", "max_mu1", "max_mu2", "max_swing", "min_inverse_condition"):
            value = getattr(self, name)
            if value is not None and not np.isfinite(value).all():
                raise RobotError(f"{name} = {value} is not finite", where="requirements")
        if self.joint_min is not None and self.joint_max is not None:
            low, high = np.broadcast_arrays(np.asarray(self.joint_min), np.asarray(self.joint_max))
            if (low >= high).any():
                raise RobotError("a joint's smallest angle is not below its largest", where="requirements")

    @property
    def names(self) -> tuple[str, ...]:
        """The requirements that are made, in the order of every array of margins."""
        made = {
            REACH: True,
            "joint_min": self.joint_min is not None,
            "joint_max": self.joint_max is not None,
            "mu1": self.max_mu1 is not None,
            "mu2": True,
            "swing": self.max_swing is not None,
            "inverse_condition": self.min_inverse_condition is not None,
        }
        return tuple(name for name, is_made in made.items() if is_made)

    @property
    def mu2_limit(self) -> float:
        """The largest mu2, rad: that of the parallel singularity where none is required."""
        return PARALLEL_SINGULARITY if self.max_mu2 is None else self.max_mu2

    def joint_limits(self) -> tuple[Array, Array]:
        """The smallest and largest joint angles, each (3,) rad; infinite where none is required."""
        low = -np.inf if self.joint_min is None else self.joint_min
        high = np.inf if self.joint_max is None else self.joint_max
        return np.broadcast_to(low, 3).astype(np.float64), np.broadcast_to(high, 3).astype(np.float64)
