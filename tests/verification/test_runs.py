"""What a table of blocks does along contours."""

import numpy as np
import pytest

from deltacam.model import Block, BlockKind, Operation
from deltacam.verification.runs import Run, find_runs

KINDS = {
    "r": BlockKind.RAPID,
    "p": BlockKind.PIERCE,
    "i": BlockKind.LEAD_IN,
    "c": BlockKind.CUT,
    "o": BlockKind.OVERCUT,
    "l": BlockKind.LOOP,
    "t": BlockKind.TAB,
    "x": BlockKind.LEAD_OUT,
    "e": BlockKind.ENGRAVE,
}


def runs(table: str, contours: str) -> list[tuple[int | None, int, int, int]]:
    """The runs of blocks of ten rows each: contour, begin, first and end."""
    blocks = [
        Block(KINDS[kind], 10 * number, 10 * number + 9, None if kind == "r" else int(contour), "", ())
        for number, (kind, contour) in enumerate(zip(table, contours, strict=True))
    ]
    found = find_runs(blocks, np.repeat(np.arange(len(blocks)), 10))
    return [(run.contour, run.begin, run.first, run.end) for run in found]


@pytest.mark.parametrize(
    ("table", "contours", "expected"),
    [
        ("rpcr", "0110", [(1, 20, 20, 30)]),
        ("rpicoxr", "0111110", [(1, 20, 30, 50)]),
        ("rpclclcor", "011111110", [(1, 20, 20, 80)]),
        ("rpctpcr", "0111110", [(1, 20, 20, 60)]),  # the pierce behind a tab does not end the cut
        ("rpcpcr", "011110", [(1, 20, 20, 30), (1, 40, 40, 50)]),  # any other does
        ("rpcicr", "011110", [(1, 20, 20, 30), (1, 30, 40, 50)]),
        ("rpccr", "01120", [(1, 20, 20, 30), (2, 30, 30, 40)]),
        ("recr", "0110", [(1, 10, 10, 20), (1, 20, 20, 30)]),
        ("rpcxcr", "011110", [(1, 20, 20, 30), (1, 40, 40, 50)]),
        ("rpir", "0110", []),  # a lead-in to nothing
        ("rpctr", "01110", [(1, 20, 20, 30)]),  # a tab at the end does not count
        ("rpc", "011", [(1, 20, 20, 29)]),  # the last row holds no longer
    ],
)
def test_a_run_is_what_follows_each_other_along_a_contour(
    table: str, contours: str, expected: list[tuple[int, int, int, int]]
) -> None:
    assert runs(table, contours) == expected


def test_what_a_run_does_is_cut_or_engrave() -> None:
    blocks = [Block(BlockKind.ENGRAVE, 0, 4, 7, "", ()), Block(BlockKind.RAPID, 5, 9)]
    column = np.repeat([0, 1], 5)
    assert find_runs(blocks, column) == (Run(7, 0, 0, 5, Operation.ENGRAVE),)


def test_rows_of_a_block_that_is_not_there_do_nothing() -> None:
    blocks = [Block(BlockKind.CUT, 0, 4, 7, "", ())]
    assert find_runs(blocks, np.repeat([0, 5, -1], 5)) == (Run(7, 0, 0, 5, Operation.CUT),)
