"""Rows of text in columns."""

from __future__ import annotations

from collections.abc import Sequence
from unicodedata import combining, east_asian_width


def aligned(rows: Sequence[Sequence[str]], *, right: Sequence[int] = (), indent: str = "  ") -> list[str]:
    """The rows as lines, each column as wide as its widest cell, with two spaces between.

    Args:
        rows: of the same number of cells each; the first one may be a heading.
        right: the columns that are aligned to the right.
        indent: before each line.
    """
    widths = [max(map(width, column)) for column in zip(*rows, strict=True)]
    lines = []
    for row in rows:
        cells = []
        for i, (cell, wide) in enumerate(zip(row, widths, strict=True)):
            blank = " " * (wide - width(cell))
            cells.append(blank + cell if i in right else cell + blank)
        lines.append(f"{indent}{'  '.join(cells)}".rstrip())
    return lines


def width(text: str) -> int:
    """How many columns of a terminal the text takes: two for each wide letter of East Asia, none for an accent."""
    if text.isascii():
        return len(text)
    return sum(0 if combining(letter) else 2 if east_asian_width(letter) in "WF" else 1 for letter in text)
