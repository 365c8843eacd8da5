"""Where the controller moves the tool between the ticks."""

from __future__ import annotations

import numpy as np

from deltacam.model import Array, IntArray
from deltacam.verification.evidence import Evidence, Run, to_sheet, tool_points

_MOST_STEPS = 32  # per tick


def between(evidence: Evidence, rows: IntArray, share: float) -> Array:
    """The joint angles at ``share`` of the way in time from ``rows`` (M,) to the next rows, (M, 3) rad.

    Linear: on the straight line between them. Cubic: Hermite curves whose slopes are central differences; before the
    first row and after the last one the angles stay as they are.
    """
    q = evidence.program.q
    here, there = q[rows], q[rows + 1]
    if evidence.robot.controller.interpolation == "linear":
        return np.asarray(here + share * (there - here))
    last = len(q) - 1
    leave = (there - q[np.maximum(rows - 1, 0)]) / 2.0  # slopes per tick
    arrive = (q[np.minimum(rows + 2, last)] - here) / 2.0
    u = share
    blend = u**2 * (3.0 - 2.0 * u)
    return np.asarray(here + blend * (there - here) + u * (1.0 - u) ** 2 * leave - u**2 * (1.0 - u) * arrive)


def motion(evidence: Evidence, run: Run, accuracy: float) -> Array:
    """The way of the tool along a run as a polyline, (M, 2) m in the sheet frame.

    Under linear interpolation the ticks are enough: between them the tool is within a micrometre of the chord. Under
    cubic interpolation points are added until the chords of an arc at the tool's full acceleration, a dt^2 / 8, are
    within ``accuracy``, m.
    """
    ticks = evidence.sheet[run.first : run.end + 1]
    sagitta = evidence.robot.tool.max_acceleration / evidence.rate**2 / 8.0
    steps = min(int(np.ceil(np.sqrt(sagitta / accuracy))), _MOST_STEPS)
    if evidence.robot.controller.interpolation == "linear" or steps <= 1:
        return ticks
    rows = np.arange(run.first, run.end)
    parts = [tool_points(evidence.robot, between(evidence, rows, step / steps)) for step in range(steps)]
    if any(why for _, (_, why) in parts):
        return ticks  # the check of the deviation between ticks reports it
    points = np.stack([to_sheet(evidence.program, tool) for tool, _ in parts], axis=1)
    return np.concatenate([points.reshape(-1, 2), ticks[-1:]])
