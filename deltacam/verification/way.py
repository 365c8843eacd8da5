"""The way of the tool along a cut, between the ticks too."""

from __future__ import annotations

import numpy as np

from deltacam.model import Array
from deltacam.verification.evidence import Evidence, to_sheet, tool_points
from deltacam.verification.interpolate import between

_MOST_STEPS = 32  # per tick


def motion(evidence: Evidence, first: int, end: int, accuracy: float) -> Array:
    """The way of the tool from the tick ``first`` to the tick ``end`` as a polyline, (M, 2) m in the sheet frame.

    Under linear interpolation the ticks are enough: between them the tool is within a micrometre of the chord. Under
    cubic interpolation points are added until the chords of an arc at the tool's full acceleration, a dt^2 / 8, are
    within ``accuracy``, m.
    """
    ticks = evidence.sheet[first : end + 1]
    sagitta = evidence.robot.tool.max_acceleration / evidence.rate**2 / 8.0
    steps = min(int(np.ceil(np.sqrt(sagitta / accuracy))), _MOST_STEPS)
    if evidence.robot.controller.interpolation == "linear" or steps <= 1:
        return ticks
    rows = np.arange(first, end)
    controller, q = evidence.robot.controller, evidence.program.q
    parts = [tool_points(evidence.robot, between(controller, q, rows, step / steps)) for step in range(steps)]
    if any(why for _, (_, why) in parts):
        return ticks  # the arms close half-way, so that this is a matter of a hair at the edge of their reach
    points = np.stack([to_sheet(evidence.program, tool) for tool, _ in parts], axis=1)
    return np.concatenate([points.reshape(-1, 2), ticks[-1:]])
