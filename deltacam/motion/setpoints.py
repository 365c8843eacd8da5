"""A setpoint at every tick, exactly on the path, for every move of a program."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Final

import numpy as np

from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.model import Array, Block, BlockKind, Cut, IntArray, Mode, Placement, Process
from deltacam.motion.corners import pieces
from deltacam.motion.parametrize import Limits, TimeLaw, parametrize
from deltacam.motion.path import Path, from_curve, straight
from deltacam.units import to_um

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

FIT_ALLOWANCE: Final = 2e-6
"""Part of the tolerance, m, that is kept for tracing the kerf path and for leaving out slivers."""

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
    """

    q: Array
    power: Array
    block: IntArray
    blocks: tuple[Block, ...]


def sample(path: Path, law: TimeLaw, robot: Robot) -> Array:
    """The joint setpoints of a move from rest to rest, (N, 3) rad, without the one at which it ends.

    The motion is stretched by less than one tick, so that it ends on a tick; that only lowers speed and acceleration.
    """
    rate = robot.controller.rate_hz
    ticks = max(1, math.ceil(law.duration * rate - _ROUNDING))
    distance = law.at(np.arange(ticks) / ticks * law.duration)
    position, _, _ = path.evaluate(*path.locate(distance))
    return robot.inverse(position)


def plan_motion(
    cuts: Sequence[Cut],
    *,
    robot: Robot,
    process: Process,
    placement: Placement,
    drawing_error: float,
    mode: Mode = Mode.CUT,
    progress: Callable[[int, int], None] = lambda _done, _total: None,
) -> Setpoints:
    """The setpoints that run the cuts in order, from rest at the park position to rest at the park position.

    Args:
        cuts: in order, each beginning where it is to be pierced, sheet frame.
        robot: the machine.
        process: how to cut.
        placement: of the sheet frame.
        drawing_error: how far the contours may lie from the file's exact geometry, m; part of the tolerance.
        mode: with ``DRY_RUN`` the laser stays off.
        progress: is told how many cuts are done, and of how many.

    Raises:
        InfeasibleError: a move has no time law within the limits, or the tolerance is less than the errors before it.
        RobotError: a move leaves the reach.
    """
    power = process.power if mode is Mode.CUT else 0.0
    deviation = _left_for_corners(process.tolerance, drawing_error)
    rapid, cutting = rapid_limits(robot), cutting_limits(robot, process)
    tape = _Tape(robot, np.array(robot.workspace.park), placement.z)
    tape.rest(BlockKind.RAPID, ticks=1)
    for done, cut in enumerate(cuts):
        progress(done, len(cuts))
        curve = curves.transform(cut.curve, rotation=placement.rotation, shift=(placement.x, placement.y))
        tape.travel(curve.points[0], rapid, where=f"the way to contour {cut.contour}")
        pierce = math.ceil(process.pierce_time * robot.controller.rate_hz - _ROUNDING)
        tape.rest(BlockKind.PIERCE, ticks=pierce, power=power, cut=cut)
        for piece in pieces(curve, corner=process.corner, deviation=deviation):
            path = from_curve(piece, placement.z)
            tape.run(path, cutting, BlockKind.CUT, power=power, cut=cut, where=_name(cut))
    tape.travel(np.array(robot.workspace.park), rapid, where="the way back to the park position")
    tape.rest(BlockKind.RAPID, ticks=2)
    progress(len(cuts), len(cuts))
    return tape.setpoints()


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
    rapid, tracing = rapid_limits(robot), cutting_limits(robot, process)
    tape = _Tape(robot, np.array(robot.workspace.park), placement.z)
    tape.rest(BlockKind.RAPID, ticks=1)
    tape.travel(box.points[0], rapid, where="the way to the frame")
    for corner in np.roll(box.points, -1, axis=0):
        tape.travel(corner, tracing, where="the frame")
    tape.travel(np.array(robot.workspace.park), rapid, where="the way back to the park position")
    tape.rest(BlockKind.RAPID, ticks=2)
    return tape.setpoints()


def rapid_limits(robot: Robot) -> Limits:
    """The limits of a move with the laser off."""
    return Limits(speed=robot.tool.max_speed, acceleration=robot.tool.max_acceleration)


def cutting_limits(robot: Robot, process: Process) -> Limits:
    """The limits of a cut."""
    return Limits(
        speed=min(robot.tool.max_speed, process.feed),
        acceleration=robot.tool.max_acceleration,
        chord=process.chord_tolerance,
    )


def _left_for_corners(tolerance: float, drawing_error: float) -> float:
    """What reading and tracing leave of the tolerance, m."""
    left = tolerance - drawing_error - FIT_ALLOWANCE
    if left < -_ROUNDING:
        least = to_um(drawing_error + FIT_ALLOWANCE)
        raise InfeasibleError(
            f"a tolerance of {to_um(tolerance):.3g} um is too small for this drawing, whose curves are only known to "
            f"within {to_um(drawing_error):.2g} um",
            hint=f"use at least --tolerance {math.ceil(least * 10.0) / 10.0:g}um; errors of reading come from splines, "
            "from ellipses and from ends that do not quite meet",
        )
    return max(0.0, left)


def _name(cut: Cut) -> str:
    return f"contour {cut.contour} (layer {cut.layer}, #{cut.handles[0]})"


@dataclass(slots=True, eq=False)
class _Tape:
    """The program as it grows: moves and rests are put behind each other."""

    robot: Robot
    place: Array
    z: float
    _q: list[Array] = field(default_factory=list)
    _power: list[Array] = field(default_factory=list)
    _blocks: list[Block] = field(default_factory=list)
    _ticks: int = 0

    def rest(self, kind: BlockKind, *, ticks: int, power: float = 0.0, cut: Cut | None = None) -> None:
        """Hold the present place for a number of ticks; none is nothing."""
        if ticks:
            here = self.robot.inverse(np.array([[*self.place, self.z]]))
            self._append(np.repeat(here, ticks, axis=0), kind, power, cut)

    def travel(self, end: Array, limits: Limits, *, where: str) -> None:
        """Go straight to ``end``, (2,) m, with the laser off; nothing where the tool is there."""
        if np.hypot(*(end - self.place)) > _HERE:
            self.run(straight(self.place, end, self.z), limits, BlockKind.RAPID, where=where)

    def run(
        self, path: Path, limits: Limits, kind: BlockKind, *, where: str, power: float = 0.0, cut: Cut | None = None
    ) -> None:
        """Run along ``path`` from rest to rest."""
        law = parametrize(path, self.robot, limits, where=where)
        self._append(sample(path, law, self.robot), kind, power, cut)
        end, _, _ = path.evaluate(np.array([len(path.length) - 1]), path.length[-1:])
        self.place = end[0, :2]

    def setpoints(self) -> Setpoints:
        """Everything that was put on the tape."""
        block = np.repeat(np.arange(len(self._blocks)), [b.last - b.first + 1 for b in self._blocks])
        return Setpoints(np.concatenate(self._q), np.concatenate(self._power), block, tuple(self._blocks))

    def _append(self, q: Array, kind: BlockKind, power: float, cut: Cut | None) -> None:
        first, self._ticks = self._ticks, self._ticks + len(q)
        self._q.append(q)
        self._power.append(np.full(len(q), power))
        contour, layer, handles = (cut.contour, cut.layer, cut.handles) if cut else (None, "", ())
        if self._blocks and self._blocks[-1].kind is kind and self._blocks[-1].contour == contour:
            self._blocks[-1] = replace(self._blocks[-1], last=self._ticks - 1)
        else:
            self._blocks.append(Block(kind, first, self._ticks - 1, contour, layer, handles))
