"""Checks of the motion against the limits of joints, tool and process, by differences at the tick rate."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from deltacam.model import Array, BlockKind, Check
from deltacam.verification.checks.measure import DIFFERENCES, ROUNDING_DEG, at_most, at_tick, per_joint
from deltacam.verification.evidence import MOVING_KINDS, Evidence, length
from deltacam.verification.interpolate import peaks

_ROUNDED: Final = 0.5e-12  # rad; how far the 12 decimals of the file may move a setpoint
_NO_FEED: Final = 1e-9  # mm/s; stands for a limit that the process does not give


def joint_range(evidence: Evidence) -> Check:
    """No joint leaves its range; negative is inside."""
    q, joints = evidence.program.q, evidence.robot.joints
    margins = np.degrees(np.stack([q.min(axis=0) - joints.min, joints.max - q.max(axis=0)])) + ROUNDING_DEG
    side, joint = (int(index) for index in np.unravel_index(np.argmin(margins), margins.shape))
    worst, row = float(margins[side, joint]), int((q if side else -q)[:, joint].argmax())
    where = f"joint {joint + 1}, {evidence.place(row)}"
    return at_tick(evidence, "joint range (at least)", worst >= 0.0, worst, 0.0, "deg inside", tick=row, where=where)


def joint_speed(evidence: Evidence) -> Check:
    """First differences of the setpoints."""
    speed = np.diff(evidence.program.q, axis=0)
    np.abs(speed, out=speed)
    speed *= evidence.rate
    limits = evidence.robot.joints.max_speed
    return per_joint(evidence, "joint speed", speed, limits, "deg/s", ticks=np.arange(len(speed)))


def joint_acceleration(evidence: Evidence) -> Check:
    """Second differences of the setpoints, the ends held, so that a start or an end at speed counts."""
    acceleration = _held_differences(evidence.program.q, 2)
    np.abs(acceleration, out=acceleration)
    acceleration *= evidence.rate**2
    limits = evidence.robot.joints.max_acceleration
    ticks = np.arange(len(acceleration))
    return per_joint(evidence, "joint acceleration", acceleration, limits, "deg/s2", ticks=ticks)


def joint_jerk(evidence: Evidence) -> Check:
    """Third differences of the setpoints, the ends held, so that a start or an end at an acceleration counts.

    What rounding may have added, 1 + 3 + 3 + 1 times `_ROUNDED`, is taken off: 0.015 deg/s3 at 400 Hz, but 229 at 10
    kHz. A robot without a limit passes with the largest jerk of any joint.
    """
    jerk = _held_differences(evidence.program.q, 3)
    np.abs(jerk, out=jerk)
    jerk -= 8.0 * _ROUNDED
    np.maximum(jerk, 0.0, out=jerk)
    jerk *= evidence.rate**3
    ticks = np.maximum(np.arange(len(jerk)) - 1, 0)  # of the former of the two rows in the middle
    return per_joint(evidence, "joint jerk", jerk, evidence.robot.joints.max_jerk, "deg/s3", ticks=ticks)


def joint_speed_between(evidence: Evidence) -> Check:
    """The largest joint speed between the ticks; a warning, since the limits are those of the planned motion.

    Under linear interpolation it is that of `joint_speed`. Hermite curves go faster where the acceleration changes, by
    up to a sixth of what it adds in a tick.
    """
    q, limits = evidence.program.q, evidence.robot.joints.max_speed
    cubic = evidence.robot.controller.interpolation == "cubic"
    speed = peaks(evidence.robot.controller, q)[0] if cubic else np.abs(np.diff(q, axis=0)) * evidence.rate
    ticks = np.arange(len(speed))
    return replace(per_joint(evidence, "joint speed between ticks", speed, limits, "deg/s", ticks=ticks), warns=True)


def joint_acceleration_between(evidence: Evidence) -> Check:
    """The largest joint acceleration of the controller's own curves between the ticks, likewise a warning.

    Linear interpolation has none: it changes its speed at the ticks, as `joint_acceleration` measures it.
    """
    q, limits = evidence.program.q, evidence.robot.joints.max_acceleration
    cubic = evidence.robot.controller.interpolation == "cubic"
    acceleration = peaks(evidence.robot.controller, q)[1] if cubic else np.zeros((max(len(q) - 1, 0), 3))
    name, ticks = "joint acceleration between ticks", np.arange(len(acceleration))
    return replace(per_joint(evidence, name, acceleration, limits, "deg/s2", ticks=ticks), warns=True)


def tool_speed(evidence: Evidence) -> Check:
    """First differences of the tool's positions."""
    limit = evidence.robot.tool.max_speed * DIFFERENCES
    return at_most(evidence, "tool speed", evidence.speed, limit, "m/s")


def tool_acceleration(evidence: Evidence) -> Check:
    """Second differences of the tool's positions, the ends held."""
    size = length(_held_differences(evidence.tool, 2)) * evidence.rate**2
    limit = evidence.robot.tool.max_acceleration * DIFFERENCES
    return at_most(evidence, "tool acceleration", size, limit, "m/s2")


def feed(evidence: Evidence) -> Check:
    """The tool's speed while the laser moves along the sheet, cutting or engraving: the one nearer to its limit."""
    process, speeds = evidence.program.process, evidence.speed * 1e3
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
    steps = evidence.speed[ends] / evidence.rate
    limit = 0.5 * evidence.robot.tool.max_acceleration / evidence.rate**2 * DIFFERENCES
    return at_most(evidence, "rest at both ends", steps * 1e6, limit * 1e6, "um per tick", ticks=ends)


def _held_differences(values: Array, order: int) -> Array:
    """(N + order - 2, k) for (N, k): before the first and after the last row the values stay as they are.

    Row i is of the rows from i - order + 1 to i + 1, so that the first and the last one are of one step alone.
    """
    held = np.concatenate([np.repeat(values[:1], order - 1, axis=0), values, np.repeat(values[-1:], order - 1, axis=0)])
    return np.asarray(np.diff(held, n=order, axis=0))
