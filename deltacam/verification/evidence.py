"""What all checks look at: the motion recomputed from the joint setpoints, and what the laser does at every tick."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.model import Array, Block, BlockKind, BoolArray, IntArray, Operation
from deltacam.program.program import Program
from deltacam.robot.robot import Robot
from deltacam.verification.interpolate import between
from deltacam.verification.runs import Run, find_runs

KINDS: Final = tuple(BlockKind)
"""`Evidence.kind` holds indices into this."""

DARK_KINDS: Final = frozenset({BlockKind.RAPID, BlockKind.LEAD_OUT, BlockKind.TAB})
"""The kinds of block in which the laser is off."""

LASER_KINDS: Final = frozenset(KINDS) - DARK_KINDS
"""The kinds of block in which the laser is on."""

WORKING_KINDS: Final = {BlockKind.CUT: Operation.CUT, BlockKind.ENGRAVE: Operation.ENGRAVE}
"""The kinds of block that run along a contour of the drawing, and what they do to it."""

ON_PATH_KINDS: Final = frozenset(WORKING_KINDS) | {BlockKind.OVERCUT}
"""The kinds of block in which the tool is on the path of a contour, with the laser on."""

MOVING_KINDS: Final = LASER_KINDS - {BlockKind.PIERCE}
"""The kinds of block that move along the sheet with the laser on."""

CHUNK: Final = 65_536
"""Rows at a time, which bounds the memory of the kinematics."""

_NO_BLOCK: Final = Block(BlockKind.RAPID, 0, 0)  # of a row whose block does not exist; the laser must be off there


@dataclass(frozen=True, slots=True, eq=False)
class Evidence:
    """A program and what follows from its setpoints alone.

    Attributes:
        program: the program.
        robot: the machine that it is checked against.
        tool: where the tool is at every tick, (N, 3) m in the machine frame; (0, 3) when a pose is impossible.
        sheet: the same in the sheet frame, (N, 2) m.
        between: where the tool is half-way between every tick and the next, as the controller interpolates, (N - 1, 3)
            m in the machine frame; (0, 3) when a pose is impossible.
        speed: of the tool from every tick to the next, (N - 1,) m/s; (0,) when a pose is impossible.
        impossible: the first tick at which the arms cannot close, and why; empty text when there is none.
        kind: index into `KINDS` of every row, (N,).
        runs: what is cut and engraved, in order.
    """

    program: Program
    robot: Robot
    tool: Array
    sheet: Array
    between: Array
    speed: Array
    impossible: tuple[int, str]
    kind: IntArray
    runs: tuple[Run, ...]

    @property
    def rate(self) -> float:
        """Ticks per second, of the robot's controller."""
        return self.robot.controller.rate_hz

    def block_of(self, row: int) -> Block:
        """The block of a row."""
        index = int(self.program.block[row])
        return self.program.blocks[index] if 0 <= index < len(self.program.blocks) else _NO_BLOCK

    def is_kind(self, kinds: frozenset[BlockKind]) -> BoolArray:
        """Which rows are of one of ``kinds``, (N,)."""
        return np.isin(self.kind, [KINDS.index(kind) for kind in kinds])

    def stretches(self, run: Run, kinds: frozenset[BlockKind]) -> list[tuple[int, int]]:
        """Where a run does nothing but ``kinds``: the tick at which each begins, and the one at which it ends."""
        inside = self.is_kind(kinds)[run.begin : run.end]
        edges = np.flatnonzero(np.diff(inside, prepend=False, append=False)) + run.begin
        return list(zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True))

    def on_path(self, run: Run) -> IntArray:
        """The ticks of a run at which the tool is to be on the path of the contour, with the laser on.

        A row that leaves the path for a loop or a lead-out ends beside it.
        """
        leaves = (KINDS.index(BlockKind.LOOP), KINDS.index(BlockKind.LEAD_OUT))
        ticks = []
        for first, end in self.stretches(run, ON_PATH_KINDS):
            stays = self.kind[end] not in leaves or self.kind[end - 1] == KINDS.index(BlockKind.OVERCUT)
            ticks.append(np.arange(first, end + stays))
        return np.concatenate([np.empty(0, dtype=np.int64), *ticks])

    def place(self, row: int) -> str:
        """Where the tool is at a row, in words: sheet coordinates, and the contour that is worked on."""
        block = self.block_of(row)
        words = f"x {1e3 * self.sheet[row, 0]:.3f} y {1e3 * self.sheet[row, 1]:.3f} mm" if len(self.sheet) else ""
        if block.contour is not None:
            handle = f", #{block.handles[0]}" if block.handles else ""
            words += f"{', ' if words else ''}contour {block.contour} (layer {block.layer}{handle})"
        return words


def gather(program: Program, robot: Robot) -> Evidence:
    """The evidence of ``program`` on ``robot``."""
    tool, impossible = tool_points(robot, program.q)
    between = np.empty((0, 3))
    if not impossible[1]:
        between, impossible = _tool_between(robot, program.q)
    if impossible[1]:
        tool = between = np.empty((0, 3))
    kind = _kinds(program)
    return Evidence(
        program=program,
        robot=robot,
        tool=tool,
        sheet=to_sheet(program, tool),
        between=between,
        speed=length(np.diff(tool, axis=0)) * robot.controller.rate_hz,
        impossible=impossible,
        kind=kind,
        runs=find_runs(program.blocks, program.block),
    )


def tool_points(robot: Robot, q: Array) -> tuple[Array, tuple[int, str]]:
    """The tool at joint angles ``q`` (N, 3) rad: (N, 3) m, and the first row that has none and why.

    Where a row has none there are no points at all, (0, 3), so that nothing can be concluded from half of them.
    """
    parts = []
    for first in range(0, len(q), CHUNK):
        chunk = q[first : first + CHUNK]
        try:
            parts.append(robot.forward(chunk))
        except RobotError as problem:
            return np.empty((0, 3)), (first + _first_impossible(robot, chunk), problem.what)
    return np.concatenate([np.empty((0, 3)), *parts]), (0, "")


def _tool_between(robot: Robot, q: Array) -> tuple[Array, tuple[int, str]]:
    """The tool half-way between all rows of ``q`` (N, 3) rad, as `tool_points` gives it, (N - 1, 3) m."""
    parts = [np.empty((0, 3))]
    for first in range(0, len(q) - 1, CHUNK):
        rows = np.arange(first, min(first + CHUNK, len(q) - 1))
        points, (row, why) = tool_points(robot, between(robot.controller, q, rows, 0.5))
        if why:
            return np.empty((0, 3)), (first + row, f"between this tick and the next: {why}")
        parts.append(points)
    return np.concatenate(parts), (0, "")


def in_chunks(measure: Callable[[Array], Array], points: Array) -> Array:
    """``measure`` of ``points`` (N, ...), a bounded number at a time; it returns (n,) for n points."""
    parts = [measure(points[first : first + CHUNK]) for first in range(0, len(points), CHUNK)]
    return np.concatenate([np.empty(0), *parts])


def length(vectors: Array) -> Array:
    """How long the ``vectors`` (N, 3) are, (N,), without an array of their size on the way."""
    square = vectors[:, 0] * vectors[:, 0]
    for column in (vectors[:, 1], vectors[:, 2]):
        square += column * column
    return np.asarray(np.sqrt(square, out=square))


def _first_impossible(robot: Robot, q: Array) -> int:
    """The first row of ``q`` that `Robot.forward` refuses, by halving; there is one."""
    low, high = 0, len(q)
    while high - low > 1:
        middle = (low + high) // 2
        try:
            robot.forward(q[low:middle])
            low = middle
        except RobotError:
            high = middle
    return low


def to_sheet(program: Program, tool: Array) -> Array:
    """Base xy = Rz(rotation) sheet xy + (x, y), inverted."""
    placement = program.placement
    cos, sin = np.cos(placement.rotation), np.sin(placement.rotation)
    arm = tool[:, :2] - (placement.x, placement.y)
    return np.stack([cos * arm[:, 0] + sin * arm[:, 1], cos * arm[:, 1] - sin * arm[:, 0]], axis=1)


def _kinds(program: Program) -> IntArray:
    """The kind of every row by its block column; a block that does not exist counts as a rapid."""
    table = np.array([KINDS.index(block.kind) for block in (*program.blocks, _NO_BLOCK)], dtype=np.int64)
    known = (program.block >= 0) & (program.block < len(program.blocks))
    return table[np.where(known, program.block, len(program.blocks))]
