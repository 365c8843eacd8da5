"""Checks of where the tool is: possible poses, the sheet's plane and edges, the park position, the margins."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from deltacam.model import Array, Check, IntArray
from deltacam.verification.checks.measure import MICROMETRE, ROUNDING_DEG, at_most, at_tick
from deltacam.verification.evidence import Evidence, in_chunks


def poses(evidence: Evidence) -> Check:
    """The arms close at every tick with the elbows outwards; without that there is no position to check."""
    tick, why = evidence.impossible
    return at_tick(evidence, "possible poses", not why, tick=tick if why else None, where=why)


def reach_margin(evidence: Evidence) -> Check:
    """No arm is at the edge of its reach, at ticks and between them; the margin is a share of the upper arm."""
    margin, ticks = _everywhere(evidence, lambda points: -evidence.robot.reach_margin(points).min(axis=1), 0.02)
    row = int(np.argmax(margin))
    worst = -float(margin[row])
    return at_tick(evidence, "reach margin (at least)", worst > 0.0, worst, 0.0, tick=int(ticks[row]))


def pressure_angle(evidence: Evidence) -> Check:
    """Both pressure angles of every arm, which grow to 90 degrees at a singularity, at ticks and between them."""

    def largest(points: Array) -> Array:
        mu1, mu2 = evidence.robot.pressure_angles(points)
        return np.asarray(np.degrees(np.maximum(mu1, mu2).max(axis=1)))

    limit = float(np.degrees(evidence.robot.workspace.max_pressure_angle)) + ROUNDING_DEG
    angles, ticks = _everywhere(evidence, largest, 1.0)
    return at_most(evidence, "pressure angle", angles, limit, "deg", ticks=ticks)


def forearm_swing(evidence: Evidence) -> Check:
    """How far the forearms lean out of their arms' planes; where the robot gives no limit, 90 degrees."""

    def largest(points: Array) -> Array:
        return np.asarray(np.degrees(evidence.robot.forearm_swing(points).max(axis=1)))

    swing, ticks = _everywhere(evidence, largest, 1.0)
    stated = evidence.robot.workspace.max_forearm_swing
    limit = 90.0 if stated is None else float(np.degrees(stated))
    return at_most(evidence, "forearm swing", swing, limit + ROUNDING_DEG, "deg", ticks=ticks)


def _everywhere(evidence: Evidence, measure: Callable[[Array], Array], near: float) -> tuple[Array, IntArray]:
    """``measure`` at every tick, and half-way to the next one where it may be the worst: values and their ticks.

    Between two ticks, some millimetres, it changes by far less than ``near``: where it is further from the worst at
    both of them, it is not the worst between them either.
    """
    values = in_chunks(measure, evidence.tool)
    high = values >= values.max() - near
    rows = np.flatnonzero(high[:-1] | high[1:])
    between = in_chunks(measure, evidence.between[rows])
    return np.concatenate([values, between]), np.concatenate([np.arange(len(values)), rows])


def sheet_plane(evidence: Evidence) -> Check:
    """The tool stays in the plane of the placement, which is the robot's sheet."""
    z = evidence.tool[:, 2]
    planes = (evidence.program.placement.z, evidence.robot.workspace.sheet_z)
    off = np.maximum(np.abs(z - planes[0]), np.abs(z - planes[1]))
    return at_most(evidence, "sheet plane", off * 1e6, MICROMETRE * 1e6, "um")


def sheet_area(evidence: Evidence) -> Check:
    """The tool stays on the sheet."""
    outside = evidence.robot.workspace.excess(evidence.tool[:, :2])
    return at_most(evidence, "sheet area", outside * 1e3, MICROMETRE * 1e3, "mm outside")


def sheet_plane_between(evidence: Evidence) -> Check:
    """Half-way between the ticks, where joints that move evenly lift the tool off the plane: the chord tolerance."""
    off = np.abs(evidence.between[:, 2] - evidence.robot.workspace.sheet_z)
    limit = evidence.program.process.chord_tolerance + MICROMETRE
    return at_most(evidence, "sheet plane between ticks", off * 1e6, limit * 1e6, "um")


def sheet_area_between(evidence: Evidence) -> Check:
    """The tool stays on the sheet half-way between the ticks, to the chord tolerance."""
    outside = evidence.robot.workspace.excess(evidence.between[:, :2])
    limit = evidence.program.process.chord_tolerance + MICROMETRE
    return at_most(evidence, "sheet area between ticks", outside * 1e3, limit * 1e3, "mm outside")


def park(evidence: Evidence) -> Check:
    """The program starts and ends at the robot's park position."""
    ends = np.array([0, len(evidence.tool) - 1])
    target = (*evidence.robot.workspace.park, evidence.robot.workspace.sheet_z)
    off = np.linalg.norm(evidence.tool[ends] - target, axis=1)
    return at_most(evidence, "park position", off * 1e6, MICROMETRE * 1e6, "um", ticks=ends)
