"""Cutting a way into stretches that are drawn in one colour each."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from deltacam.model import Array, IntArray

Choice = Callable[[IntArray], IntArray]
"""Given the first step of every cell (C,), the one colour that stands for each cell, (C,)."""


def stretches(
    xy: Array, band: IntArray, choices: Sequence[Choice], *, reach: float, most: int
) -> tuple[IntArray, list[IntArray]]:
    """Where the way changes its band or any of its colours.

    Args:
        xy: the way, (N, 2) m.
        band: what each of its steps is, (N - 1,); no stretch spans two bands.
        choices: how the steps of a cell come to one colour, for every way of colouring.
        reach: the length of a cell, m: the steps in it share their colours. 0 makes every step a cell.
        most: stretches; where there are more, ``reach`` grows until there are not.

    Returns:
        the first step of every stretch, (S,), and for each choice the colour of every stretch, (S,).
    """
    steps = np.hypot(*np.diff(xy, axis=0).T)
    way = np.cumsum(steps) - steps
    first, colours = np.zeros(0, dtype=np.int64), [np.zeros(0, dtype=np.int64) for _ in choices]
    for doubling in range(12):
        cell = np.floor(way / (reach * 2.0**doubling)) if reach else np.arange(len(way))
        first = np.flatnonzero((np.diff(cell, prepend=-1) != 0) | (np.diff(band, prepend=-1) != 0))
        colours = [choice(first) for choice in choices]
        change = np.diff(band[first], prepend=-1) != 0
        for colour in colours:
            change[1:] |= np.diff(colour) != 0
        first, colours = first[change], [colour[change] for colour in colours]
        if len(first) <= most or not reach:
            break
    return first, colours


def most_unusual(colour: IntArray, usual: float) -> Choice:
    """The colour of a cell that is farthest from the usual one, so that no short stop or burst is lost."""

    def choose(first: IntArray) -> IntArray:
        slow, fast = np.minimum.reduceat(colour, first), np.maximum.reduceat(colour, first)
        return np.where(fast - usual > usual - slow, fast, slow)

    return choose


def largest(colour: IntArray) -> Choice:
    """The largest colour of a cell."""

    def choose(first: IntArray) -> IntArray:
        return np.asarray(np.maximum.reduceat(colour, first))

    return choose
