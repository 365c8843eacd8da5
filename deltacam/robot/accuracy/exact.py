"""Where the tool of a machine with errors is, exactly."""

from __future__ import annotations

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array
from deltacam.robot.accuracy.sources import Source, columns_of
from deltacam.robot.arms import machine_vectors
from deltacam.robot.dimensions import DeltaGeometry
from deltacam.robot.kinematics import inverse, meeting_point


def erring_tool(geometry: DeltaGeometry, angles: Array, errors: Array) -> Array:
    """The tool points of machines with errors that are asked for joint ``angles``.

    Args:
        geometry: the robot without errors.
        angles: that the controller asks for, (N, 3) rad.
        errors: of every machine, (D, COUNT) rad or m, in the order of `sources.columns_of`.

    Returns:
        (D, N, 3) in the machine frame, m.

    Raises:
        RobotError: the forearms of a machine do not meet.
    """
    machines, poses = len(errors), len(angles)

    def of(source: Source) -> Array:
        return errors[:, np.newaxis, columns_of(source)]

    q = angles + of(Source.ENCODER) + of(Source.BACKLASH)
    La, turn = geometry.upper_arms + of(Source.UPPER_ARM), of(Source.AZIMUTH)
    reach = geometry.base_radii + of(Source.BASE_RADIUS) + La * np.cos(q)
    along = reach * np.cos(turn) - (geometry.effector_radii + of(Source.EFFECTOR_RADIUS))
    parts = (part.reshape(-1, 3) for part in (along, reach * np.sin(turn), -La * np.sin(q)))
    elbows = geometry.centre + machine_vectors(geometry, *parts)
    forearms = np.repeat(geometry.forearms + of(Source.FOREARM)[:, 0], poses, axis=0)
    points, meet = meeting_point(elbows, forearms, down=-geometry.up)
    if not meet.all():
        what = f"with such errors the forearms do not meet in {(~meet).sum()} of {len(meet)} poses"
        raise RobotError(what, hint="give smaller errors, or move the sheet away from the edge of the reach")
    return points.reshape(machines, poses, 3)


def tool_errors(geometry: DeltaGeometry, points: Array, errors: Array) -> Array:
    """How far the tools of machines with errors are from ``points`` of the sheet that they should be at.

    Args:
        geometry: the robot without errors.
        points: (N, 3) in the machine frame, m.
        errors: of every machine, (D, COUNT) rad or m, in the order of `sources.columns_of`.

    Returns:
        (D, N, 3) m: x and y of the tool, and its height above the sheet, each less what it should be.

    Raises:
        RobotError: a point is out of reach, or the forearms of a machine do not meet.
    """
    found = erring_tool(geometry, inverse(geometry, points), errors) - points
    found[:, :, 2:] -= errors[:, np.newaxis, columns_of(Source.SHEET)]
    return found
