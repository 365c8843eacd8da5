"""Turning measured values into a `Check`."""

from __future__ import annotations

from dataclasses import replace
from typing import Final

import numpy as np

from deltacam.model import Array, BoolArray, Check, Contour, IntArray
from deltacam.robot.dimensions import Triple
from deltacam.verification.evidence import Evidence

DIFFERENCES: Final = 1.001
"""Share of a limit that differences of setpoints may reach; a motion within its limits stays within them exactly."""

MICROMETRE: Final = 1e-6
"""How far rounding and the planner's own arithmetic may move a point that should be exact, m."""

ROUNDING_DEG: Final = 1e-6
"""How far rounding may move an angle, degrees; 12 decimals of a radian are far below it."""


def at_tick(
    evidence: Evidence,
    name: str,
    passed: bool,
    worst: float | None = None,
    limit: float | None = None,
    unit: str = "",
    *,
    tick: int | None,
    where: str | None = None,
) -> Check:
    """A check whose worst value is at a tick, which says when, where and at which contour it is.

    Args:
        evidence: for the place.
        name: of the check.
        passed: whether the worst value is within the limit.
        worst: in ``unit``.
        limit: in ``unit``.
        unit: of both.
        tick: None where there is none: then there is no place either.
        where: in words; the place of the tool and the contour by default.
    """
    if tick is None:
        return Check(name, passed, worst, limit, unit, None, where or "")
    block = evidence.block_of(tick)
    return Check(
        name,
        passed,
        worst,
        limit,
        unit,
        tick,
        evidence.place(tick) if where is None else where,
        time=tick / evidence.rate,
        place=(float(evidence.sheet[tick, 0]), float(evidence.sheet[tick, 1])) if len(evidence.sheet) else None,
        contour=block.contour,
        layer=block.layer,
        handle=block.handles[0] if block.handles else "",
    )


def at_contour(check: Check, contour: Contour) -> Check:
    """The check of a contour of the drawing, which may be cut or not."""
    return replace(check, contour=contour.number, layer=contour.layer, handle=contour.handles[0])


def at_most(
    evidence: Evidence,
    name: str,
    values: Array,
    limit: float | None,
    unit: str,
    *,
    ticks: IntArray | None = None,
    note: str = "",
) -> Check:
    """The check that no value exceeds ``limit``.

    Args:
        evidence: for the place of the worst value.
        name: of the check.
        values: (M,) in ``unit``; none at all passes.
        limit: in ``unit``; None where there is none, which any value keeps.
        unit: of both.
        ticks: the tick of every value, (M,); 0, 1, 2, ... by default.
        note: what the place starts with.
    """
    if not len(values):
        return Check(name, True, limit=limit, unit=unit)
    row = int(np.argmax(values))
    tick = row if ticks is None else int(ticks[row])
    worst = float(values[row])
    where = ", ".join(part for part in (note, evidence.place(tick)) if part)
    passed = limit is None or worst <= limit
    return at_tick(evidence, name, passed, worst, limit, unit, tick=tick, where=where)


def per_joint(
    evidence: Evidence, name: str, values: Array, limits: Triple | None, unit: str, *, ticks: IntArray
) -> Check:
    """The check that no joint exceeds its limit; the joint that comes closest is reported.

    Args:
        evidence: for the place.
        name: of the check.
        values: (M, 3) rad/s, rad/s2 or rad/s3.
        limits: per joint, in the same unit; `DIFFERENCES` is allowed on top. None where there are none: the largest
            value of all is reported, and passes.
        unit: in degrees, for people.
        ticks: (M,).
    """
    if not len(values):
        return Check(name, True, limit=float(np.degrees(min(limits)) * DIFFERENCES) if limits else None, unit=unit)
    joint = int(np.argmax(values.max(axis=0) / (limits or 1.0)))
    limit = float(np.degrees(limits[joint]) * DIFFERENCES) if limits else None
    return at_most(evidence, name, np.degrees(values[:, joint]), limit, unit, ticks=ticks, note=f"joint {joint + 1}")


def none_of(evidence: Evidence, name: str, wrong: BoolArray, unit: str = "ticks") -> Check:
    """The check that no row is ``wrong`` (N,); the first one is reported, and how many there are."""
    rows = np.flatnonzero(wrong)
    if not len(rows):
        return Check(name, True, 0.0, 0.0, unit)
    return at_tick(evidence, name, False, float(len(rows)), 0.0, unit, tick=int(rows[0]))
