"""What small errors of the machine do at the tool, in closed form.

The controller asks for the joint angles of a machine without errors. The tool of the real one is where its own loop
closure |S_i|^2 = Lb_i^2 holds. To first order (implicit differentiation; Merlet 2006, "Parallel robots", 7.2)

    S_i . dP = S_i . dC_i + Lb_i dLb_i
    dC_i = b_i dq_i + (cos q_i u_i - sin q_i z) dLa_i + u_i (dR_i - dr_i) + (R_i + La_i cos q_i) w_i dphi_i

with the notation of `deltacam.robot.arms`; three equations, one per arm, for the three unknowns dP.
"""

from __future__ import annotations

from typing import Final

import numpy as np
import numpy.typing as npt

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot.accuracy.sources import COUNT, Source, columns_of
from deltacam.robot.arms import forearm_vectors, solve
from deltacam.robot.dimensions import DeltaGeometry

_FLAT: Final = 1e-6  # volume of the unit forearms below which they lie in one plane


def tool_by_error(geometry: DeltaGeometry, points: npt.ArrayLike) -> Array:
    """How the tool moves against the sheet for each of the independent errors.

    Args:
        geometry: the robot.
        points: where the tool should be, (N, 3) in the machine frame, m.

    Returns:
        (N, 3, COUNT) m/rad or m/m: x and y of the tool, and its height above the sheet; the errors in the order of
        `sources.columns_of`.

    Raises:
        RobotError: a point is not finite or out of reach, or the forearms do not hold the effector there.
        ValueError: the shape is not (N, 3).
    """
    arms = solve(geometry, points)
    forearms = forearm_vectors(geometry, arms)
    flat = np.abs(np.linalg.det(forearms / geometry.forearms[:, np.newaxis])) <= _FLAT
    if flat.any():
        what = f"the forearms lie in one plane at {flat.sum()} of {len(flat)} points: nothing holds the tool there"
        raise RobotError(what, where=f"point {int(np.argmax(flat))}")
    La = geometry.upper_arms
    along = arms.x - La * arms.cos  # S along u; across it is y, along the base's z it is z + La sin q
    pull = {
        Source.ENCODER: La * arms.t,
        Source.BACKLASH: La * arms.t,
        Source.UPPER_ARM: along * arms.cos - (arms.z + La * arms.sin) * arms.sin,
        Source.FOREARM: np.broadcast_to(geometry.forearms, along.shape),
        Source.BASE_RADIUS: along,
        Source.EFFECTOR_RADIUS: -along,
        Source.AZIMUTH: arms.y * (geometry.base_radii + La * arms.cos),
    }
    held = np.linalg.inv(forearms)
    found = np.zeros((len(forearms), 3, COUNT))
    for source, value in pull.items():
        found[:, :, columns_of(source)] = held * value[:, np.newaxis]
    found[:, 2, columns_of(Source.SHEET)] = -1.0
    return found
