"""A program taken apart at its blocks and put together in another way, with rapids that the machine can follow."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from deltacam.model import Array, Block, BlockKind
from deltacam.program.program import Program
from tests.bench import smooth
from tests.damage.aim import NoPlaceError

STRETCHES = frozenset({BlockKind.LEAD_IN, BlockKind.LEAD_OUT, BlockKind.LOOP, BlockKind.TAB, BlockKind.OVERCUT})
"""What only some programs have."""

EASY = 0.7  # of every limit, for rapids


@dataclass(frozen=True, eq=False)
class Stretch:
    """A stretch of motion.

    Attributes:
        block: what it is; its ticks do not count.
        q: the joint angles at its ticks and where it ends, (n + 1, 3) rad, n >= 1.
        power: of the laser.
    """

    block: Block
    q: Array
    power: float

    def backwards(self) -> "Stretch":
        """The same way from its end to its start."""
        return replace(self, q=self.q[::-1])


Job = tuple[Stretch, ...]
"""What is done between two rapids."""


def jobs(program: Program) -> list[Job]:
    """What a program does between its rapids, in order."""
    found: list[list[Stretch]] = [[]]
    for block in program.blocks:
        if block.kind is BlockKind.RAPID:
            found.append([])
        else:
            rows = slice(block.first, block.last + 2)
            found[-1].append(Stretch(block, program.q[rows], float(program.power[block.first])))
    return [tuple(job) for job in found if job]


def plain_jobs(program: Program) -> list[Job]:
    """The same of a program in which every job is a pierce at most, and then a cut or what is engraved.

    Raises:
        NoPlaceError: it has leads, loops or tabs.
    """
    if any(block.kind in STRETCHES for block in program.blocks):
        raise NoPlaceError
    return jobs(program)


def together(program: Program, todo: Sequence[Job]) -> Program:
    """The program that does these jobs, with rapids before, between and after them."""
    parts: list[Stretch] = []
    here = program.q[0]
    for job in todo:
        parts += [rapid(program, here, job[0].q[0]), *job]
        here = job[-1].q[-1]
    return joined(program, [*parts, rapid(program, here, program.q[-1])])


def joined(program: Program, parts: Sequence[Stretch]) -> Program:
    """The program of stretches that follow each other."""
    counts = [len(part.q) - 1 for part in parts]
    counts[-1] += 1  # the last row of a program is where it ends
    ends = np.cumsum(counts).tolist()
    blocks = [
        replace(part.block, first=end - count, last=end - 1)
        for part, count, end in zip(parts, counts, ends, strict=True)
    ]
    return replace(
        program,
        q=np.concatenate([*(part.q[:-1] for part in parts), parts[-1].q[-1:]]),
        power=np.repeat([part.power for part in parts], counts),
        block=np.repeat(np.arange(len(parts)), counts),
        blocks=tuple(blocks),
    )


def rapid(program: Program, start: Array, end: Array) -> Stretch:
    """A straight way of the tool from rest to rest, between joint angles (3,)."""
    points = program.robot.forward(np.stack([start, end]))
    return Stretch(Block(BlockKind.RAPID, 0, 0), along(program, points), 0.0)


def along(program: Program, points: Array, speed: float = np.inf) -> Array:
    """Joint angles at the ticks of a motion from rest to rest along a polyline (K, 3) m, at most ``speed`` m/s fast.

    It is as slow as the limits of the machine ask for, but for the corners of the polyline.
    """
    robot = program.robot
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    rate, speed = program.rate_hz, min(speed, EASY * robot.tool.max_speed)
    acceleration = EASY * robot.tool.max_acceleration
    while True:
        law = smooth(float(way[-1]), speed, acceleration, rate)
        tool = np.stack([np.interp(law, way, column) for column in points.T], axis=1)
        q = robot.inverse(tool)
        if len(points) > 2 or _share(program, q) <= 1.0:
            return q
        speed, acceleration = 0.8 * speed, 0.64 * acceleration


def _share(program: Program, q: Array) -> float:
    """The largest share of a limit of the joints that the ticks of a motion have, (N, 3) rad; `EASY` counts as all."""
    joints, held = program.robot.joints, np.pad(q, ((2, 2), (0, 0)), mode="edge")
    limits = (joints.max_speed, joints.max_acceleration, joints.max_jerk)
    shares = [
        float((np.abs(np.diff(held, n=order, axis=0)) * program.rate_hz**order / limit).max())
        for order, limit in enumerate(limits, start=1)
        if limit is not None
    ]
    return max(shares) / EASY
