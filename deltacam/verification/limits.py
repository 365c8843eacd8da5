"""Checks of the motion against the limits of joints, tool and process, by differences at the tick rate."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.model import Array, BlockKind, Check
from deltacam.verification.evidence import MOVING_KINDS, Evidence
from deltacam.verification.measure import DIFFERENCES, ROUNDING_DEG, at_most, per_joint

_NO_FEED: Final = 1e-9  # mm/s; stands for a limit that the process does not give


def joint_range(evidence: Evidence) -> Check:
    """No joint leaves its range; negative is inside."""
    q, joints = evidence.program.q, evidence.robot.joints
    margin = np.degrees(np.minimum(q - joints.min, joints.max - q)) + ROUNDING_DEG
    row, joint = (int(index) for index in np.unravel_index(np.argmin(margin), margin.shape))
    worst = float(margin[row, joint])
    where = f"joint {joint + 1}, {evidence.place(row)}"
    return Check("joint range (at least)", worst >= 0.0, worst, 0.0, "deg inside", row, where)


def joint_speed(evidence: Evidence) -> Check:
    """First differences of the setpoints."""
    speed = np.abs(np.diff(evidence.program.q, axis=0)) * evidence.rate
    limits = evidence.robot.joints.max_speed
    return per_joint(evidence, "joint speed", speed, limits, "deg/s", ticks=np.arange(len(speed)))


def joint_acceleration(evidence: Evidence) -> Check:
    """Second differences of the setpoints, the ends held, so that a start or an end at speed counts."""
    acceleration = np.abs(_second_differences(evidence.program.q)) * evidence.rate**2
    limits = evidence.robot.joints.max_acceleration
    ticks = np.arange(len(acceleration))
    return per_joint(evidence, "joint acceleration", acceleration, limits, "deg/s2", ticks=ticks)


def tool_speed(evidence: Evidence) -> Check:
    """First differences of the tool's positions."""
    limit = evidence.robot.tool.max_speed * DIFFERENCES
    return at_most(evidence, "tool speed", _speeds(evidence), limit, "m/s")


def tool_acceleration(evidence: Evidence) -> Check:
    """Second differences of the tool's positions, the ends held."""
    size = np.linalg.norm(_second_differences(evidence.tool), axis=1) * evidence.rate**2
    limit = evidence.robot.tool.max_acceleration * DIFFERENCES
    return at_most(evidence, "tool acceleration", size, limit, "m/s2")


def feed(evidence: Evidence) -> Check:
    """The tool's speed while the laser moves along the sheet, cutting or engraving: the one nearer to its limit."""
    process, speeds = evidence.program.process, _speeds(evidence) * 1e3
    groups = (
        (MOVING_KINDS - {BlockKind.ENGRAVE}, process.feed),
        (frozenset({BlockKind.ENGRAVE}), process.engrave_feed or 0.0),
    )
    found = []
    for kinds, limit in groups:
        rows = np.flatnonzero(evidence.is_kind(kinds)[:-1])
        allowed = limit * DIFFERENCES * 1e3
        used = float(speeds[rows].max()) / max(allowed, _NO_FEED) if len(rows) else -1.0
        found.append((used, at_most(evidence, "feed while cutting", speeds[rows], allowed, "mm/s", ticks=rows)))
    return max(found, key=lambda one: one[0])[1]


def rest_at_ends(evidence: Evidence) -> Check:
    """The first and the last step are no longer than from rest at the tool's full acceleration, a dt^2 / 2."""
    ends = np.array([0, len(evidence.tool) - 2] if len(evidence.tool) > 1 else [], dtype=np.int64)
    steps = _speeds(evidence)[ends] / evidence.rate
    limit = 0.5 * evidence.robot.tool.max_acceleration / evidence.rate**2 * DIFFERENCES
    return at_most(evidence, "rest at both ends", steps * 1e6, limit * 1e6, "um per tick", ticks=ends)


def _speeds(evidence: Evidence) -> Array:
    """The mean speed from every tick to the next, (N - 1,) m/s."""
    return np.asarray(np.linalg.norm(np.diff(evidence.tool, axis=0), axis=1) * evidence.rate)


def _second_differences(values: Array) -> Array:
    """(N, k) for (N, k): before the first and after the last row the values stay as they are."""
    held = np.concatenate([values[:1], values, values[-1:]])
    return np.asarray(np.diff(held, n=2, axis=0))
