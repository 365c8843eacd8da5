"""The robot, and what is planned on it, in the pictures."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import Array, Curve
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot

LEFT: Final = 62.0
"""Where charts begin, pixels."""

ACROSS: Final = 808.0
"""How wide they are, pixels."""

DEVIATION: Final = 18e-6
"""What the tolerance leaves for the corners of a drawing of lines and arcs, m."""

JERK: Final = float(np.radians(366_000.0))
"""Of delta-300, rad/s3."""


def robot(*, acceleration: float = 1.0, jerk: float | None = None) -> Robot:
    """delta-300 with a share of the acceleration of its joints, and with a limit of jerk, rad/s3, or none."""
    whole = load_robot("delta-300")
    limits = tuple(acceleration * limit for limit in whole.joints.max_acceleration)
    jerks = None if jerk is None else (jerk,) * 3
    return replace(whole, joints=replace(whole.joints, max_acceleration=limits, max_jerk=jerks))


def rounded_rectangle(width: float, depth: float, radius: float) -> Curve:
    """A rectangle with arcs for corners, m, from the middle of its lower side around and back to there."""
    x, y, r = 0.5 * width, 0.5 * depth, radius
    right = [(0.0, -y), (x - r, -y), (x, -y + r), (x, y - r), (x - r, y)]
    left = [(-across, up) for across, up in right[:0:-1]]
    bend = np.tan(np.pi / 8.0)
    bulges = np.array([0.0, bend, 0.0, bend, 0.0, bend, 0.0, bend, 0.0])
    return Curve(points=np.array([*right, *left, right[0]]), bulges=bulges, closed=False)


def outline(curve: Curve) -> Array:
    """Points along a curve, near enough to draw it, (N, 2) m."""
    points, _ = curves.flatten(curve, 5e-6)
    return np.vstack([points, points[:1]]) if curve.closed else points
