"""The motion at every tick, by differences of the setpoints: what the charts and colours of the page show."""

from __future__ import annotations

from collections import defaultdict
from dataclasses import dataclass

import numpy as np

from deltacam.model import Array, Drawing, IntArray, Operation
from deltacam.verification.evidence import WORKING_KINDS, Evidence, length
from deltacam.verification.kerf_path import rings
from deltacam.verification.near import Lines


@dataclass(frozen=True, slots=True, eq=False)
class Motion:
    """What follows from N setpoints. Speeds hold from their tick to the next; the last one is 0.

    Attributes:
        joints: angle, speed, acceleration and jerk of the joints, each (3, N) in rad, s.
        speed: of the tool, (N,) m/s; empty, like all that follows, where a pose is impossible.
        acceleration: of the tool, (N,) m/s2.
        worked: how far the tool has cut or engraved before the tick, (N,) m.
    """

    joints: tuple[Array, Array, Array, Array]
    speed: Array
    acceleration: Array
    worked: Array


def motion_of(evidence: Evidence) -> Motion:
    """The motion of a program; before its first and after its last tick everything stays as it is."""
    q, rate = np.ascontiguousarray(evidence.program.q.T), evidence.rate
    speed, acceleration, jerk = (_differences(q, order) * rate**order for order in (1, 2, 3))
    joints = (q, speed, acceleration, jerk)
    if not len(evidence.tool):
        return Motion(joints, *(np.empty(0) for _ in range(3)))
    works = evidence.is_kind(frozenset(WORKING_KINDS))[:-1]
    return Motion(
        joints,
        speed=np.append(evidence.speed, 0.0),
        acceleration=length(_differences(np.ascontiguousarray(evidence.tool.T), 2).T) * rate**2,
        worked=np.append(0.0, np.cumsum(np.where(works, evidence.speed, 0.0)) / rate),
    )


def deviations(evidence: Evidence, drawing: Drawing) -> Array:
    """How far the tool is from the path of the contour that it works on, (N,) m; nan where it works on none.

    As in the check of the deviation at ticks, what the reader lost of the drawing counts as distance.
    """
    process, found = evidence.program.process, np.full(len(evidence.sheet), np.nan)
    spans: defaultdict[tuple[int | None, Operation], list[IntArray]] = defaultdict(list)
    for run in evidence.runs:
        spans[run.contour, run.operation].append(np.arange(run.first, run.end + 1))
    for contour in drawing.contours:
        done = spans[contour.number, contour.operation]
        path = rings(contour, process.kerf) if done else ()
        if path:
            lines, ticks = Lines(path, closed=contour.curve.closed), np.concatenate(done)
            found[ticks] = lines.distance(evidence.sheet[ticks], exact_above=process.tolerance / 2.0)
    return found + drawing.conversion_error


def _differences(values: Array, order: int) -> Array:
    """The differences of ``values`` (3, N) along time, (3, N): the value at a tick is that of the steps around it.

    The speed is of the step that leaves the tick, the acceleration of both steps, the jerk of the three steps from the
    one that arrives. Of the two jerks at the first tick the larger one counts.
    """
    before = order - 1
    held = np.pad(values, ((0, 0), (before, max(before, 1))), mode="edge")
    found = np.diff(held, n=order, axis=1)
    if order == 3:
        start, found = found[:, 0], found[:, 1:]
        found[:, 0] = np.where(np.abs(start) > np.abs(found[:, 0]), start, found[:, 0])
    return found
