"""The program as it grows: moves and rests behind each other, which become a row for every tick at the end."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Final, NamedTuple

import numpy as np

from deltacam.model import Array, Block, BlockKind, Cut, Held, IntArray
from deltacam.motion.path import Path, straight
from deltacam.motion.route import Limits
from deltacam.motion.run import Run, held_along
from deltacam.motion.schedule import Drawn, Move, schedule

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

KINDS: Final = tuple(
    BlockKind(name) for name in ["rapid", "pierce", "engrave", "cut", "overcut", "loop", "lead_in", "lead_out", "tab"]
)
"""What the numbers of stretches stand for."""

NUMBER: Final = {kind: number for number, kind in enumerate(KINDS)}

_HERE: Final = 1e-9


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


class _Rest(NamedTuple):
    """Ticks at one place, (2,) m."""

    place: Array
    ticks: int


class _Step(NamedTuple):
    """What a rest or a move is for: what is done, None where a move has stretches, and the cut."""

    motion: _Rest | Move
    kind: BlockKind | None
    cut: Cut | None


@dataclass(slots=True, eq=False)
class Tape:
    """Moves and rests that are put behind each other, from a place on."""

    robot: Robot
    place: Array
    z: float
    _steps: list[_Step] = field(default_factory=list)

    def rest(self, kind: BlockKind, *, ticks: int, cut: Cut | None = None) -> None:
        """Hold the present place for a number of ticks; none is nothing."""
        if ticks:
            self._steps.append(_Step(_Rest(self.place, ticks), kind, cut))

    def travel(self, end: Array, limits: Limits, *, where: str) -> None:
        """Go straight to ``end``, (2,) m; nothing where the tool is there."""
        if np.hypot(*(end - self.place)) > _HERE:
            self._run(straight(self.place, end, self.z), end, limits, BlockKind.RAPID, where)

    def work(self, drawn: Drawn, limits: Limits, *, cut: Cut) -> None:
        """Run along a part of a cut from rest to rest; its segments say what is done."""
        self._run(drawn, drawn.curve.ends[-1], limits, None, cut.where, cut=cut)

    def _run(
        self,
        path: Path | Drawn,
        end: Array,
        limits: Limits,
        kind: BlockKind | None,
        where: str,
        *,
        cut: Cut | None = None,
    ) -> None:
        self._steps.append(_Step(Move(path, limits, where), kind, cut))
        self.place = end

    def moves(self) -> tuple[list[tuple[Move, bool]], int]:
        """The moves, each with whether it belongs to a cut, and the ticks of all rests."""
        moves = [(step.motion, step.cut is not None) for step in self._steps if isinstance(step.motion, Move)]
        return moves, sum(step.motion.ticks for step in self._steps if isinstance(step.motion, _Rest))

    def setpoints(self, *, jobs: int | None, what_if: bool | None, progress: Callable[[int, int], None]) -> Setpoints:
        """Everything that was put on the tape, at every tick, with the laser off."""
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
        rows = [
            _moved(step, next(moved)) if isinstance(step.motion, Move) else _rested(step, step.motion.ticks, next(held))
            for step in self._steps
        ]
        q, kind = (np.concatenate(part) for part in zip(*rows, strict=True))
        owner = np.repeat(np.arange(len(rows)), [len(one.kind) for one in rows])
        block, blocks = _blocks(kind, [self._steps[step].cut for step in range(len(rows))], owner)
        return Setpoints(q, np.zeros(len(q)), block, blocks, _held(moves, runs))


class _Rows(NamedTuple):
    """The setpoints of a step, (N, 3) rad, and what is done, (N,) as `KINDS` has it."""

    q: Array
    kind: IntArray


def _rested(step: _Step, ticks: int, joints: Array) -> _Rows:
    """The rows of a rest with the ``joints``, (3,) rad."""
    kind = BlockKind.RAPID if step.kind is None else step.kind
    return _Rows(np.tile(joints, (ticks, 1)), np.full(ticks, NUMBER[kind]))


def _moved(step: _Step, run: Run) -> _Rows:
    """The rows of a move."""
    if step.kind is not None:
        return _Rows(run.q, np.full(len(run.q), NUMBER[step.kind]))
    kind = run.stretch.copy()
    # The laser is off before the lead-out begins: the overcut is longer than asked for by what a tick can take.
    last = step.motion.path.stretch[-1] if isinstance(step.motion, Move) and isinstance(step.motion.path, Drawn) else -1
    ends = (kind == NUMBER[BlockKind.OVERCUT]) & (np.append(kind[1:], last) == NUMBER[BlockKind.LEAD_OUT])
    kind[ends] = NUMBER[BlockKind.LEAD_OUT]
    return _Rows(run.q, kind)


def _held(steps: Sequence[_Step], runs: Sequence[Run]) -> tuple[Held, ...]:
    """What holds back the motion along every contour, the moves of each taken together."""
    by_contour: dict[int, list[Run]] = {}
    for step, run in zip(steps, runs, strict=True):
        if step.cut is not None:
            by_contour.setdefault(step.cut.contour, []).append(run)
    return tuple(held_along(contour, found) for contour, found in by_contour.items())


def _blocks(kind: IntArray, cuts: Sequence[Cut | None], owner: IntArray) -> tuple[IntArray, tuple[Block, ...]]:
    """The block of every row and the table of blocks: rows in a row that do the same to the same contour.

    Args:
        kind: of every row, (N,).
        cuts: of every step.
        owner: the step of every row, (N,).
    """
    contour = np.array([0 if cut is None else cut.contour for cut in cuts])[owner]
    new = (np.diff(kind, prepend=-1) != 0) | (np.diff(contour, prepend=-1) != 0)
    first = np.flatnonzero(new)
    last = np.append(first[1:], len(kind)) - 1
    blocks = []
    for start, end in zip(first.tolist(), last.tolist(), strict=True):
        cut, does = cuts[owner[start]], KINDS[kind[start]]
        named = (None, "", ()) if cut is None else (cut.contour, cut.layer, cut.handles)
        blocks.append(Block(does, start, end, *named))
    return np.cumsum(new) - 1, tuple(blocks)
