"""What a program does along contours, by its table of blocks."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Final, NamedTuple

import numpy as np

from deltacam.model import Block, BlockKind, IntArray, Operation

_WORKS: Final = {BlockKind.CUT: Operation.CUT, BlockKind.ENGRAVE: Operation.ENGRAVE}
_GOES_ON: Final = frozenset({*_WORKS, BlockKind.LOOP, BlockKind.OVERCUT, BlockKind.TAB})


class Run(NamedTuple):
    """One cut or engraving of a contour, with its loops and tabs: the motion from tick ``begin`` to tick ``end``.

    Row ``end - 1`` is the last one with the laser on; it holds until tick ``end``.

    Attributes:
        contour: None where the program names none.
        begin: where its lead-in begins.
        first: where the cut itself begins.
        end: where it, or its overcut, ends.
        operation: cut or engrave.
    """

    contour: int | None
    begin: int
    first: int
    end: int
    operation: Operation


def find_runs(blocks: Sequence[Block], column: IntArray) -> tuple[Run, ...]:
    """The runs of a program, in order.

    Args:
        blocks: the table.
        column: the index into it of every row, (N,); rows of a block that does not exist do nothing.
    """
    edges = np.flatnonzero(np.diff(column)) + 1
    found = []
    for first, end in itertools.pairwise([0, *edges.tolist(), len(column)]):
        index = int(column[first])
        if 0 <= index < len(blocks):
            found.append(replace(blocks[index], first=first, last=end - 1))
        else:
            found.append(Block(BlockKind.RAPID, first, end - 1))
    runs = (_run(group, len(column) - 1) for group in _groups(found))
    return tuple(run for run in runs if run is not None)


def _groups(blocks: Sequence[Block]) -> Iterator[list[Block]]:
    """Blocks that follow each other along one contour, without a rapid or a lead-out in between.

    A pierce goes on only after a tab, and a lead-in never does.
    """
    group: list[Block] = []
    for block in blocks:
        last = group[-1].kind if group else None
        joins = block.kind in _GOES_ON or (block.kind is BlockKind.PIERCE and last is BlockKind.TAB)
        engraves = last is BlockKind.ENGRAVE or block.kind is BlockKind.ENGRAVE
        changes = group and (block.contour != group[-1].contour or (engraves and block.kind is not last))
        if group and (not joins or changes):
            yield group
            group = []
        if joins or block.kind is BlockKind.LEAD_IN:
            group.append(block)
    if group:
        yield group


def _run(group: Sequence[Block], final: int) -> Run | None:
    """The run of a group of blocks; None where nothing is cut or engraved in it. The ``final`` row holds no longer."""
    works = [block for block in group if block.kind in _WORKS]
    if not works:
        return None
    last = max(block.last for block in group if block.kind not in (BlockKind.TAB, BlockKind.PIERCE))
    return Run(works[0].contour, group[0].first, works[0].first, min(last + 1, final), _WORKS[works[0].kind])
