"""A setpoint at every tick, exactly on the path, for every move of a program."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.errors import InfeasibleError, ProcessError
from deltacam.geometry import curve as curves
from deltacam.model import Array, BlockKind, Curve, Cut, Mode, Operation, Placement, Process
from deltacam.motion.corners import Pace
from deltacam.motion.parts import parts
from deltacam.motion.power import powers
from deltacam.motion.route import Limits
from deltacam.motion.schedule import Drawn, Move
from deltacam.motion.tape import NUMBER, Setpoints, Tape
from deltacam.units import to_um

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

FIT_ALLOWANCE: Final = 2e-6
"""Part of the tolerance, m, that is kept for tracing the kerf path; nothing is where there is no kerf."""

_ROUNDING: Final = 1e-9


def plan_motion(
    cuts: Sequence[Cut],
    *,
    robot: Robot,
    process: Process,
    placement: Placement,
    drawing_error: float,
    mode: Mode = Mode.CUT,
    jobs: int | None = None,
    what_if: bool | None = None,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> Setpoints:
    """The setpoints that run the cuts in order, from rest at the park position to rest at the park position.

    Every cut begins and ends at rest. Only what is cut is pierced.

    Args:
        cuts: in order, each run from its first point, sheet frame.
        robot: the machine.
        process: how to cut.
        placement: of the sheet frame.
        drawing_error: how far the contours may lie from the file's exact geometry, m; part of the tolerance.
        mode: with ``DRY_RUN`` the laser stays off.
        jobs: processes, >= 1; None takes as many as pay.
        what_if: whether to find out how long the cuts would take without each limit; None does where that is quick.
        progress: is told how many cuts or parts of cuts are done, and of how many.

    Raises:
        InfeasibleError: a move has no time law within the limits, or the tolerance is less than the errors before it.
        ProcessError: something is to be engraved, and the process does not say how.
        RobotError: a move leaves the reach.
    """
    tape = _taped(cuts, robot=robot, process=process, placement=placement, drawing_error=drawing_error)
    found = tape.setpoints(jobs=jobs, what_if=what_if, progress=progress)
    if mode is not Mode.CUT:
        return found
    kinds = [block.kind for block in found.blocks]
    return replace(found, power=powers(found.q, found.block, kinds, robot=robot, process=process))


def moves_of(
    cuts: Sequence[Cut], *, robot: Robot, process: Process, placement: Placement, drawing_error: float
) -> tuple[list[tuple[Move, bool]], int]:
    """The moves that `plan_motion` runs, each with whether it cuts or engraves, and for how many ticks it rests."""
    tape = _taped(cuts, robot=robot, process=process, placement=placement, drawing_error=drawing_error)
    return tape.moves()


def _taped(cuts: Sequence[Cut], *, robot: Robot, process: Process, placement: Placement, drawing_error: float) -> Tape:
    """The tape of what `plan_motion` plans."""
    deviation = _left_for_corners(process.tolerance, drawing_error + (FIT_ALLOWANCE if process.kerf > 0.0 else 0.0))
    rapid = rapid_limits(robot)
    ways = {operation: _way(operation, robot, process) for operation in {cut.operation for cut in cuts}}
    # Under cubic interpolation the move after a setpoint bends the one before it: a rest keeps rapids out of cuts.
    apart = 0 if robot.controller.interpolation == "linear" else 1
    tape = Tape(robot, np.array(robot.workspace.park), placement.z)
    tape.rest(BlockKind.RAPID, ticks=1)
    holes = _first_pierces(cuts) if process.pre_pierce else {}
    for index, cut in enumerate(cuts):
        way = ways[cut.operation]
        limits = way.limits if cut.feed is None else working_limits(robot, process, cut.feed)
        for hole in holes.get(index, ()):
            tape.travel(_in_machine(hole, placement).points[0], rapid, where=f"the way to contour {hole.contour}")
            tape.rest(BlockKind.PIERCE, ticks=way.pierce, cut=hole)
        _put(tape, cut, process, placement, _Own(way, limits, deviation, bool(holes), apart))
    tape.travel(np.array(robot.workspace.park), rapid, where="the way back to the park position")
    tape.rest(BlockKind.RAPID, ticks=2)
    return tape


class _Own(NamedTuple):
    """What holds for one cut: how it is run, within what, and for how many ticks the tool rests around its parts."""

    way: _Way
    limits: Limits
    deviation: float
    is_pierced: bool
    apart: int


def _put(tape: Tape, cut: Cut, process: Process, placement: Placement, own: _Own) -> None:
    """Put a cut on the tape: the way there, and every part of it from rest to rest."""
    robot, rapid = tape.robot, rapid_limits(tape.robot)
    every = list(parts(cut))
    for number, part in enumerate(every):
        curve = curves.transform(part.curve, rotation=placement.rotation, shift=(placement.x, placement.y))
        before, after = (BlockKind.TAB if inside else BlockKind.RAPID for inside in (number, part is not every[-1]))
        if not part.is_tab:
            pierce = 0 if own.is_pierced and number == 0 else own.way.pierce
            tape.travel(curve.points[0], rapid, where=f"the way to contour {cut.contour}")
            tape.rest(BlockKind.RAPID, ticks=0 if number else _ticks(cut.wait, robot))
            tape.rest(BlockKind.PIERCE, ticks=pierce, cut=cut)
            tape.rest(before, ticks=0 if pierce else own.apart, cut=cut if number else None)
        pace = _pace(robot, own.limits, (*curve.points[0], placement.z))
        drawn = Drawn(curve, part.stretch, part.speed, process.corner, own.deviation, pace, placement.z)
        tape.work(drawn, own.limits, cut=cut)
        # A lead-out behind a cut without an overcut may be passed within a tick: then its end must not count as cut.
        beside = part.stretch[-1] == NUMBER[BlockKind.LEAD_OUT] and process.overcut == 0.0
        tape.rest(BlockKind.LEAD_OUT, ticks=1 if beside else 0, cut=cut)
        tape.rest(after, ticks=own.apart, cut=None if part is every[-1] else cut)


def _first_pierces(cuts: Sequence[Cut]) -> dict[int, list[Cut]]:
    """All that is pierced before the first cut, by the index of that cut, which follows what is engraved."""
    cutting = [index for index, cut in enumerate(cuts) if cut.operation is Operation.CUT]
    return {cutting[0]: [cuts[index] for index in cutting]} if cutting else {}


def _in_machine(cut: Cut, placement: Placement) -> Curve:
    """The first stretch of a cut in the machine frame."""
    curve = cut.way[0].curve if cut.way else cut.curve
    return curves.transform(curve, rotation=placement.rotation, shift=(placement.x, placement.y))


def plan_frame(corners: Array, *, robot: Robot, process: Process, placement: Placement) -> Setpoints:
    """The setpoints that trace a box once at the cutting feed, with the laser off.

    Args:
        corners: (4, 2) m, sheet frame.
        robot: the machine.
        process: gives the feed.
        placement: of the sheet frame.

    Raises:
        RobotError: the box leaves the reach.
    """
    box = curves.transform(curves.polygon(corners), rotation=placement.rotation, shift=(placement.x, placement.y))
    rapid, tracing = rapid_limits(robot), working_limits(robot, process, process.feed)
    tape = Tape(robot, np.array(robot.workspace.park), placement.z)
    tape.rest(BlockKind.RAPID, ticks=1)
    tape.travel(box.points[0], rapid, where="the way to the frame")
    for corner in np.roll(box.points, -1, axis=0):
        tape.travel(corner, tracing, where="the frame")
    tape.travel(np.array(robot.workspace.park), rapid, where="the way back to the park position")
    tape.rest(BlockKind.RAPID, ticks=2)
    return tape.setpoints(jobs=1, what_if=False, progress=lambda _done, _total: None)


def rapid_limits(robot: Robot) -> Limits:
    """The limits of a move with the laser off."""
    return Limits(speed=robot.tool.max_speed, acceleration=robot.tool.max_acceleration)


def working_limits(robot: Robot, process: Process, feed: float) -> Limits:
    """The limits of a cut or of engraving at ``feed`` m/s."""
    return Limits(
        speed=min(robot.tool.max_speed, feed),
        acceleration=robot.tool.max_acceleration,
        chord=process.chord_tolerance,
    )


def engraving_feed(process: Process) -> float:
    """The feed of engraving, m/s.

    Raises:
        ProcessError: the process does not say it, or not the power.
    """
    if process.engrave_feed is None or process.engrave_power is None:
        raise ProcessError(
            "the drawing has lines to engrave, and the process does not say how",
            where=f"process {process.name}",
            hint="add a section [engrave] with feed_m_min and power to the process file, or say with --ignore-layer or "
            "with [[operations]] in the process file that these lines are not engraved",
        )
    return process.engrave_feed


class _Way(NamedTuple):
    """How a cut is run: its limits, and for how many ticks it is pierced before."""

    limits: Limits
    pierce: int


def _pace(robot: Robot, limits: Limits, place: tuple[float, float, float]) -> Pace | None:
    """What the tool can do in any direction at a place, (3,) m; None where there is no limit of jerk."""
    if robot.joints.max_jerk is None:
        return None
    needed = np.linalg.norm(robot.inverse_jacobian([place])[0, :, :2], axis=1)
    acceleration = min(limits.acceleration, float(np.min(robot.joints.max_acceleration / needed)))
    jerk = float(np.min(robot.joints.max_jerk / needed))
    return Pace(limits.speed, acceleration, jerk, 1.0 / robot.controller.rate_hz)


def _way(operation: Operation, robot: Robot, process: Process) -> _Way:
    """How cuts of an operation are run."""
    if operation is Operation.ENGRAVE:
        return _Way(working_limits(robot, process, engraving_feed(process)), 0)
    pierce = _ticks(process.pierce_time, robot)
    return _Way(working_limits(robot, process, process.feed), pierce)


def _ticks(time: float, robot: Robot) -> int:
    """The fewest ticks that take so many seconds."""
    return math.ceil(time * robot.controller.rate_hz - _ROUNDING)


def _left_for_corners(tolerance: float, error: float) -> float:
    """What the ``error`` of reading and tracing leaves of the tolerance, m."""
    left = tolerance - error
    if left < -_ROUNDING:
        least = to_um(error)
        raise InfeasibleError(
            f"a tolerance of {to_um(tolerance):.3g} um is too small for this drawing, whose curves are only known to "
            f"within {to_um(error):.2g} um",
            hint=f"use at least --tolerance {math.ceil(least * 10.0) / 10.0:g}um; errors of reading come from splines, "
            "from ellipses and from ends that do not quite meet",
        )
    return max(0.0, left)
