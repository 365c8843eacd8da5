"""A planner for tests only: exact offset curves, one smooth time law per piece, exact inverse kinematics.

It shares nothing with deltacam's planner, so that what it makes is an independent example of a valid program.
"""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from deltacam.geometry import curve as curves
from deltacam.model import (
    Block,
    BlockKind,
    Check,
    Contour,
    Curve,
    Drawing,
    Mode,
    Operation,
    Placement,
    Process,
    Report,
)
from deltacam.program.program import DrawingRef, Program
from deltacam.report.listing import to_json
from deltacam.report.text import to_text
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot

QUARTER = np.tan(np.pi / 8)


def rounded_rectangle(centre: tuple[float, float], width: float, height: float, radius: float) -> Curve:
    x, y = width / 2, height / 2
    points = [(x - radius, -y), (x, radius - y), (x, y - radius), (x - radius, y)]
    points += [(radius - x, y), (-x, y - radius), (-x, radius - y), (radius - x, -y)]
    return Curve(points=np.array(points) + centre, bulges=np.array([QUARTER, 0.0] * 4))


def shapes(offset: float) -> dict[int, Curve]:
    """The contours of the test plate, each moved ``offset`` to its kerf side: outlines grow, holes shrink."""
    return {
        1: rounded_rectangle((0.0, 0.0), 0.06 + 2 * offset, 0.04 + 2 * offset, 5e-3 + offset),
        2: curves.circle(np.array([-0.015, 0.0]), 6e-3 - offset),
        3: rounded_rectangle((0.012, 0.0), 0.022 - 2 * offset, 0.014 - 2 * offset, 3e-3 - offset),
        4: curves.circle(np.array([0.012, 0.002]), 3e-3 + offset),
    }


NESTING = {1: (0, None), 2: (1, 1), 3: (1, 1), 4: (2, 3)}
HOLES_FIRST = (4, 3, 2, 1)
PLACED = Placement(x=0.01, y=-0.02, rotation=0.3, z=-0.65)


def plate() -> Drawing:
    contours = tuple(
        Contour(number, curve, "CUT", (f"{number}A", f"{number}B"), *NESTING[number])
        for number, curve in shapes(0.0).items()
    )
    return Drawing("plate.dxf", "ab" * 32, 1e-3, "mm", "header", contours, ())


def smooth(length: float, speed: float, acceleration: float, rate: float) -> np.ndarray:
    """Distances at every tick from rest to rest, a quintic law; peaks 1.875 L / T and 5.774 L / T^2."""
    time = max(1.875 * length / speed, np.sqrt(5.774 * length / acceleration))
    ticks = max(int(np.ceil(time * rate)), 1)
    u = np.arange(ticks + 1) / ticks
    return length * u**3 * (10.0 - 15.0 * u + 6.0 * u**2)


def along(curve: Curve, distance: np.ndarray) -> np.ndarray:
    """Points at ``distance`` from the start; past the end a closed curve starts again, an open one goes straight on."""
    ends = np.cumsum(curves.lengths(curve))
    wrapped = np.where(curve.closed & (distance >= ends[-1]), distance - ends[-1], distance)
    segment = np.minimum(np.searchsorted(ends, wrapped, side="right"), len(ends) - 1)
    points, _ = curves.evaluate(curve, segment, wrapped - np.concatenate([[0.0], ends])[segment])
    return points


@dataclass(frozen=True)
class Bench:
    """Builds programs for the test plate; every field is a way to build another one."""

    robot: Robot
    process: Process
    drawing: Drawing = field(default_factory=plate)
    placement: Placement = PLACED
    paths: Callable[[float], dict[int, Curve]] = shapes
    order: Sequence[int] = HOLES_FIRST
    feed: float | None = None
    rapid_speed: float = 0.8
    rapid_acceleration: float = 12.0
    mode: Mode = Mode.CUT
    turns: float = 1.0
    pierce_ticks: int = 20
    z: float | None = None

    def but(self, **changes: object) -> "Bench":
        return replace(self, **changes)

    def program(self) -> Program:
        rate = self.robot.controller.rate_hz
        paths = self.paths(self.process.kerf / 2)
        park = self._to_sheet(np.array([self.robot.workspace.park]))[0]
        stretches: list[tuple[BlockKind, int | None, np.ndarray]] = []
        here = park
        for number in self.order:
            path, kind = paths[number], self._kind(number)
            stretches.append((BlockKind.RAPID, None, self._line(here, path.points[0], rate)[:-1]))
            pierce = 0 if kind is BlockKind.ENGRAVE else self.pierce_ticks
            stretches.append((BlockKind.PIERCE, number, np.repeat(path.points[:1], pierce, axis=0)))
            length = curves.length(path) * self.turns
            feed = self.process.engrave_feed if kind is BlockKind.ENGRAVE else self.process.feed
            points = along(path, smooth(length, self.feed or feed or 0.0, 8.0, rate))
            stretches.append((kind, number, points[:-1]))
            here = points[-1]
        stretches.append((BlockKind.RAPID, None, self._line(here, park, rate)))
        return self._assemble([stretch for stretch in stretches if len(stretch[2])])

    def _kind(self, number: int) -> BlockKind:
        engraved = {contour.number for contour in self.drawing.contours if contour.operation is Operation.ENGRAVE}
        return BlockKind.ENGRAVE if number in engraved else BlockKind.CUT

    def _line(self, start: np.ndarray, end: np.ndarray, rate: float) -> np.ndarray:
        length = float(np.hypot(*(end - start)))
        if length == 0.0:
            return np.array([start])
        distance = smooth(length, self.rapid_speed, self.rapid_acceleration, rate)
        return start + distance[:, np.newaxis] / length * (end - start)

    def _assemble(self, stretches: list[tuple[BlockKind, int | None, np.ndarray]]) -> Program:
        blocks, first = [], 0
        for kind, number, points in stretches:
            handles = () if number is None else (f"{number}A", f"{number}B")
            last = first + len(points) - 1
            blocks.append(Block(kind, first, last, number, "CUT" if number else "", handles))
            first = last + 1
        column = np.repeat(np.arange(len(stretches)), [len(points) for _, _, points in stretches])
        powers = {BlockKind.RAPID: 0.0, BlockKind.ENGRAVE: self.process.engrave_power}
        power = np.array([powers.get(kind, self.process.power) for kind, _, _ in stretches])[column]
        sheet = np.concatenate([points for _, _, points in stretches])
        return Program(
            robot=self.robot,
            placement=self.placement,
            process=self.process,
            drawing=DrawingRef.of(self.drawing),
            mode=self.mode,
            blocks=tuple(blocks),
            q=self.robot.inverse(self._to_base(sheet)),
            power=power if self.mode is Mode.CUT else np.zeros(len(power)),
            block=column,
        )

    def _turn(self) -> np.ndarray:
        cos, sin = np.cos(self.placement.rotation), np.sin(self.placement.rotation)
        return np.array([[cos, -sin], [sin, cos]])

    def _to_base(self, sheet: np.ndarray) -> np.ndarray:
        xy = sheet @ self._turn().T + (self.placement.x, self.placement.y)
        return np.column_stack([xy, np.full(len(xy), self.placement.z if self.z is None else self.z)])

    def _to_sheet(self, base: np.ndarray) -> np.ndarray:
        return (base - (self.placement.x, self.placement.y)) @ self._turn()

    @staticmethod
    def said(program: Program, contour: int, kinds: Sequence[BlockKind], *, rows: Sequence[int] = ()) -> Program:
        """The program whose cut of a contour is said to be of these kinds, one after the other.

        Each but the first begins at one of the ``rows`` of the cut; they are of one length where none are given.
        """
        blocks = list(program.blocks)
        index = next(at for at, block in enumerate(blocks) if block.kind is BlockKind.CUT and block.contour == contour)
        cut = blocks[index]
        count = cut.last + 1 - cut.first
        edges = [0, *(rows or [count * number // len(kinds) for number in range(1, len(kinds))]), count]
        blocks[index : index + 1] = [
            replace(cut, kind=kind, first=cut.first + first, last=cut.first + end - 1)
            for kind, (first, end) in zip(kinds, pairwise(edges), strict=True)
        ]
        column = np.repeat(np.arange(len(blocks)), [block.last + 1 - block.first for block in blocks])
        return replace(program, blocks=tuple(blocks), block=column)

    @staticmethod
    def failed(report: Report) -> set[str]:
        """The names of the failed checks; the reports must be writable whatever was found."""
        assert report.passed == all(check.passed for check in report.checks)
        json.loads(to_json(report))
        assert to_text(report).isascii()
        return {check.name for check in report.checks if not check.passed}

    @staticmethod
    def check(report: Report, name: str) -> Check:
        return next(check for check in report.checks if check.name == name)

    def shifted_outwards(self, program: Program, distance: float) -> Program:
        """The program with the middle setpoint of the cut of contour 2, a circle, moved along its radius."""
        block = next(b for b in program.blocks if b.kind is BlockKind.CUT and b.contour == 2)
        return self.moved_along_the_radius(program, (block.first + block.last) // 2, distance)

    def moved_along_the_radius(self, program: Program, row: int, distance: float) -> Program:
        """The program with one setpoint moved away from the centre of contour 2."""
        arm = self._to_sheet(self.robot.forward(program.q[[row]])[:, :2])[0] + np.array([0.015, 0.0])
        dx, dy = self._turn() @ arm * distance / np.hypot(*arm)
        return self.shifted(program, row, dx, dy)

    def shifted(self, program: Program, row: int, dx: float, dy: float = 0.0) -> Program:
        """The program with one setpoint moved in the base frame."""
        q = program.q.copy()
        q[row] = self.robot.inverse(self.robot.forward(q[[row]]) + np.array([dx, dy, 0.0]))[0]
        return replace(program, q=q)


def standard() -> Bench:
    """The bench that most tests use: the built-in robot without a limit of jerk."""
    process = Process(
        name="test steel",
        source="a test",
        material="steel",
        thickness=1e-3,
        kerf=0.2e-3,
        feed=0.1,
        power=0.85,
        pierce_time=0.05,
        engrave_feed=0.2,
        engrave_power=0.15,
    )
    robot = load_robot("delta-300")
    return Bench(robot=replace(robot, joints=replace(robot.joints, max_jerk=None)), process=process)
