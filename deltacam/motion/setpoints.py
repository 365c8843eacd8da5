"""A setpoint at every tick, exactly on the path, for every move of a program."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.errors import InfeasibleError, ProcessError
from deltacam.geometry import curve as curves
from deltacam.model import Array, Block, BlockKind, Cut, Held, IntArray, Mode, Operation, Placement, Process
from deltacam.motion.corners import Pace
from deltacam.motion.path import Path, straight
from deltacam.motion.power import powers
from deltacam.motion.route import Limits
from deltacam.motion.run import Run, held_along
from deltacam.motion.schedule import Drawn, Move, schedule
from deltacam.units import to_um

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

FIT_ALLOWANCE: Final = 2e-6
"""Part of the tolerance, m, that is kept for tracing the kerf path; nothing is where there is no kerf."""

_HERE: Final = 1e-9
_ROUNDING: Final = 1e-9


@dataclass(frozen=True, slots=True, eq=False)
class Setpoints:
    """What the machine is to do at every tick.

    Attributes:
        q: (N, 3) rad.
        power: (N,) of the laser's rated power.
        block: (N,) index into ``blocks``.
        blocks: in order, together covering every tick once.
        held: what holds back the motion along every contour.
    """

    q: Array
    power: Array
    block: IntArray
    blocks: tuple[Block, ...]
    held: tuple[Held, ...] = ()


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
    tape = _taped(cuts, robot=robot, process=process, placement=placement, drawing_error=drawing_error, mode=mode)
    found = tape.setpoints(jobs=jobs, what_if=what_if, progress=progress)
    if mode is not Mode.CUT:
        return found
    kinds = [block.kind for block in found.blocks]
    return replace(found, power=powers(found.q, found.block, kinds, robot=robot, process=process))


def moves_of(
    cuts: Sequence[Cut], *, robot: Robot, process: Process, placement: Placement, drawing_error: float
) -> tuple[list[tuple[Move, bool]], int]:
    """The moves that `plan_motion` runs, each with whether it cuts or engraves, and for how many ticks it rests."""
    tape = _taped(cuts, robot=robot, process=process, placement=placement, drawing_error=drawing_error, mode=Mode.CUT)
    return tape.moves()


def _taped(
    cuts: Sequence[Cut], *, robot: Robot, process: Process, placement: Placement, drawing_error: float, mode: Mode
) -> _Tape:
    """The tape of what `plan_motion` plans."""
    deviation = _left_for_corners(process.tolerance, drawing_error + (FIT_ALLOWANCE if process.kerf > 0.0 else 0.0))
    rapid = rapid_limits(robot)
    ways = {operation: _way(operation, robot, process) for operation in {cut.operation for cut in cuts}}
    # Under cubic interpolation the move after a setpoint bends the one before it: a rest keeps rapids out of cuts.
    apart = 0 if robot.controller.interpolation == "linear" else 1
    tape = _Tape(robot, np.array(robot.workspace.park), placement.z)
    tape.rest(BlockKind.RAPID, ticks=1)
    for cut in cuts:
        curve = curves.transform(cut.curve, rotation=placement.rotation, shift=(placement.x, placement.y))
        tape.travel(curve.points[0], rapid, where=f"the way to contour {cut.contour}")
        way = ways[cut.operation]
        power = way.power if mode is Mode.CUT else 0.0
        tape.rest(BlockKind.PIERCE, ticks=way.pierce, power=power, cut=cut)
        tape.rest(BlockKind.RAPID, ticks=0 if way.pierce else apart)
        limits = way.limits if cut.feed is None else working_limits(robot, process, cut.feed)
        pace = _pace(robot, limits, (*curve.points[0], placement.z))
        drawn = Drawn(curve, process.corner, deviation, pace, placement.z)
        tape.run(drawn, curve.ends[-1], limits, way.kind, power=power, cut=cut, where=cut.where)
        tape.rest(BlockKind.RAPID, ticks=apart)
    tape.travel(np.array(robot.workspace.park), rapid, where="the way back to the park position")
    tape.rest(BlockKind.RAPID, ticks=2)
    return tape


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
    tape = _Tape(robot, np.array(robot.workspace.park), placement.z)
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


def engraving(process: Process) -> tuple[float, float]:
    """The feed, m/s, and the power of engraving.

    Raises:
        ProcessError: the process does not say them.
    """
    if process.engrave_feed is None or process.engrave_power is None:
        raise ProcessError(
            "the drawing has lines to engrave, and the process does not say how",
            where=f"process {process.name}",
            hint="add a section [engrave] with feed_m_min and power to the process file, or say with --ignore-layer or "
            "with [[operations]] in the process file that these lines are not engraved",
        )
    return process.engrave_feed, process.engrave_power


class _Way(NamedTuple):
    """How a cut is run: the kind of its blocks, its limits, its power, and for how many ticks it is pierced before."""

    kind: BlockKind
    limits: Limits
    power: float
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
        feed, power = engraving(process)
        return _Way(BlockKind.ENGRAVE, working_limits(robot, process, feed), power, 0)
    pierce = math.ceil(process.pierce_time * robot.controller.rate_hz - _ROUNDING)
    return _Way(BlockKind.CUT, working_limits(robot, process, process.feed), process.power, pierce)


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


class _Rest(NamedTuple):
    """Ticks at one place, (2,) m."""

    place: Array
    ticks: int


class _Step(NamedTuple):
    """What a rest or a move is for: the kind of its block, the laser's power, and the cut that it belongs to."""

    motion: _Rest | Move
    kind: BlockKind
    power: float
    cut: Cut | None


@dataclass(slots=True, eq=False)
class _Tape:
    """The program as it grows: moves and rests are put behind each other, and run at the end."""

    robot: Robot
    place: Array
    z: float
    _steps: list[_Step] = field(default_factory=list)

    def rest(self, kind: BlockKind, *, ticks: int, power: float = 0.0, cut: Cut | None = None) -> None:
        """Hold the present place for a number of ticks; none is nothing."""
        if ticks:
            self._steps.append(_Step(_Rest(self.place, ticks), kind, power, cut))

    def travel(self, end: Array, limits: Limits, *, where: str) -> None:
        """Go straight to ``end``, (2,) m, with the laser off; nothing where the tool is there."""
        if np.hypot(*(end - self.place)) > _HERE:
            self.run(straight(self.place, end, self.z), end, limits, BlockKind.RAPID, where=where)

    def run(
        self,
        path: Path | Drawn,
        end: Array,
        limits: Limits,
        kind: BlockKind,
        *,
        where: str,
        power: float = 0.0,
        cut: Cut | None = None,
    ) -> None:
        """Run along ``path`` to its ``end``, (2,) m, from rest to rest."""
        self._steps.append(_Step(Move(path, limits, where), kind, power, cut))
        self.place = end

    def moves(self) -> tuple[list[tuple[Move, bool]], int]:
        """The moves, each with whether it belongs to a cut, and the ticks of all rests."""
        moves = [(step.motion, step.cut is not None) for step in self._steps if isinstance(step.motion, Move)]
        return moves, sum(step.motion.ticks for step in self._steps if isinstance(step.motion, _Rest))

    def setpoints(self, *, jobs: int | None, what_if: bool | None, progress: Callable[[int, int], None]) -> Setpoints:
        """Everything that was put on the tape, at every tick."""
        moves = [step for step in self._steps if isinstance(step.motion, Move)]
        cuts = np.cumsum([step.cut is not None for step in moves])
        total = int(cuts[-1]) if len(cuts) else 0
        progress(0, total)
        runs = schedule(
            [step.motion for step in moves if isinstance(step.motion, Move)],
            self.robot,
            jobs=jobs,
            what_if=what_if,
            progress=lambda done: progress(int(cuts[done - 1]), total),
        )
        rests = [(*step.motion.place, self.z) for step in self._steps if isinstance(step.motion, _Rest)]
        held, moved = iter(self.robot.inverse(np.array(rests).reshape(-1, 3))), iter(runs)
        q, power, blocks = [], [], list[Block]()
        ticks = 0
        for step in self._steps:
            rows = next(moved).q if isinstance(step.motion, Move) else np.tile(next(held), (step.motion.ticks, 1))
            q.append(rows)
            power.append(np.full(len(rows), step.power))
            _append(blocks, step, ticks, len(rows))
            ticks += len(rows)
        block = np.repeat(np.arange(len(blocks)), [one.last - one.first + 1 for one in blocks])
        return Setpoints(np.concatenate(q), np.concatenate(power), block, tuple(blocks), _held(moves, runs))


def _held(steps: Sequence[_Step], runs: Sequence[Run]) -> tuple[Held, ...]:
    """What holds back the motion along every contour, the moves of each taken together."""
    by_contour: dict[int, list[Run]] = {}
    for step, run in zip(steps, runs, strict=True):
        if step.cut is not None:
            by_contour.setdefault(step.cut.contour, []).append(run)
    return tuple(held_along(contour, found) for contour, found in by_contour.items())


def _append(blocks: list[Block], step: _Step, first: int, ticks: int) -> None:
    """Put the ticks of a step into the last block where they continue it, else into a new one."""
    cut, last = step.cut, first + ticks - 1
    contour, layer, handles = (cut.contour, cut.layer, cut.handles) if cut else (None, "", ())
    if blocks and blocks[-1].kind is step.kind and blocks[-1].contour == contour:
        blocks[-1] = replace(blocks[-1], last=last)
    else:
        blocks.append(Block(step.kind, first, last, contour, layer, handles))
