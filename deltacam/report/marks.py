"""The marks over the path of the tool: where cuts begin and in which order, which way they run, and where tabs are.

Marks have their size in pixels, whatever the scale. A number or an arrow that would lie on another one is shown once
the picture is zoomed so far that it does not.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.model import Array, BlockKind, IntArray, Operation
from deltacam.report.crowd import NEVER, Crowd
from deltacam.verification.evidence import Evidence
from deltacam.verification.runs import Run

SIDES: Final = {"top right": (1, 1), "bottom right": (1, -1), "top left": (-1, 1), "bottom left": (-1, -1)}
"""Where a number may stand beside its dot."""

MANY: Final = 60
"""Cuts from which on marks are smaller."""

_MOST_NUMBERS: Final = 1000
_MOST_ARROWS: Final = 1500
_COARSEST: Final = 250.0  # pixels of the longer side of the smallest picture
_DIGIT: Final = 7.5  # pixels
_TALL: Final = 13.0  # pixels, of a number
_DOT: Final = 3.0  # pixels from the middle of a dot to its edge
_ARROW: Final = 5.5  # pixels from the middle of an arrow to its edge
_SHORTEST: Final = 45.0  # pixels of a cut that has an arrow
_APART: Final = 100.0  # pixels between the arrows of a cut
_AROUND: Final = 30.0  # pixels around an arrow without others of its cut
_CLOSEST: Final = 8e-3  # m between the arrows of a cut, however near one looks
_STRAIGHT: Final = 1.5e-3  # m on both sides of an arrow in which the cut should not turn
_WINDOW: Final = 0.3  # of the distance between arrows: where the straightest place is looked for


@dataclass(frozen=True, slots=True, eq=False)
class Numbers:
    """The places of the cuts in their order, beside the starts of the cuts that have one.

    Attributes:
        points: where these cuts begin, (K, 2) m, sheet frame.
        text: the numbers.
        side: of `SIDES`.
        scale: a number is shown where a pixel is at most so many metres, (K,).
    """

    points: Array
    text: Sequence[str]
    side: Sequence[str]
    scale: Array


@dataclass(frozen=True, slots=True, eq=False)
class Arrows:
    """Which way the cuts run.

    Attributes:
        points: (K, 2) m, sheet frame.
        heading: from the x axis, counter-clockwise, (K,) rad.
        scale: an arrow is shown where a pixel is at most so many metres, (K,).
    """

    points: Array
    heading: Array
    scale: Array


@dataclass(frozen=True, slots=True, eq=False)
class Marks:
    """All marks of a program.

    Attributes:
        starts: the ticks at which cuts begin to pierce or to lead in, (C,).
        pierces: the first ticks of the pierces at tabs, (P,).
        tabs: the ticks at both ends of every tab, (T,).
        numbers: beside the starts.
        arrows: along the cuts.
    """

    starts: IntArray
    pierces: IntArray
    tabs: IntArray
    numbers: Numbers
    arrows: Arrows


def marks_of(evidence: Evidence, box: Array) -> Marks:
    """The marks of a program in pictures of the ``box``, (2, 2) m; none where the tool has no place at some tick."""
    sheet = evidence.sheet
    runs = [run for run in evidence.runs if run.operation is Operation.CUT] if len(sheet) else []
    starts = _ticks([run.begin for run in runs])
    tabs = _ticks([tick for run in runs for ends in evidence.stretches(run, _OF_TABS) for tick in ends])
    pierces = _ticks([first for run in runs for first, _ in evidence.stretches(run, _OF_PIERCES) if first > run.begin])
    unit = max(float(np.ptp(box, axis=0).max()), 1e-3) / _COARSEST
    crowd = Crowd(unit)
    for tick in (*starts.tolist(), *tabs.tolist()):
        crowd.add(sheet[tick], np.zeros(2), np.full(2, _DOT))
    return Marks(starts, pierces, tabs, _numbers(sheet[starts], unit), _arrows(evidence, runs, crowd, unit))


_OF_TABS: Final = frozenset({BlockKind.TAB})
_OF_PIERCES: Final = frozenset({BlockKind.PIERCE})
_OF_CUTS: Final = frozenset({BlockKind.CUT})


def headings(sheet: Array, ticks: IntArray) -> Array:
    """Which way the tool goes at ``ticks``, (K,) rad: from where it was to where it will be, beyond any rest."""
    found = np.zeros(len(ticks))
    for at, tick in enumerate(ticks.tolist()):
        reach = np.array([1, 2, 4, 8, 16, 32, 64, 128])
        ways = sheet[np.minimum(tick + reach, len(sheet) - 1)] - sheet[np.maximum(tick - reach, 0)]
        far = int(np.argmax(np.hypot(*ways.T) > 5e-5))
        found[at] = np.arctan2(ways[far, 1], ways[far, 0])
    return found


def _ticks(found: Sequence[int]) -> IntArray:
    return np.array(found, dtype=np.int64)


def _numbers(starts: Array, unit: float) -> Numbers:
    """The numbers; of very many every second, fifth, tenth has one."""
    steps = (factor * 10**power for power in range(9) for factor in (1, 2, 5))
    every = next(step for step in steps if len(starts) <= step * _MOST_NUMBERS)
    crowd = Crowd(unit)
    kept: list[int] = []
    sides, scales = [], []
    for index in range(0, len(starts), every):
        half = np.array([_DIGIT * len(str(index + 1)), _TALL]) / 2.0
        offsets = np.array(list(SIDES.values())) * (half + _DOT)
        side, zoom = crowd.free(starts[index], offsets, half)
        if zoom < NEVER:
            crowd.add(starts[index], offsets[side], half, zoom)
            kept.append(index)
            sides.append(list(SIDES)[side])
            scales.append(unit / zoom)
    return Numbers(starts[kept], [str(index + 1) for index in kept], sides, np.array(scales))


def _arrows(evidence: Evidence, runs: Sequence[Run], crowd: Crowd, unit: float) -> Arrows:
    """One arrow in the middle of every cut, more between as one looks closer; the first ones first."""
    places = [(*place, cut) for cut, run in enumerate(runs) for place in _places(*_way(evidence, run), unit)]
    places.sort(key=lambda place: place[0])
    found: list[tuple[float, float, float, float]] = []
    own = [Crowd(unit) for _ in runs]  # a cut that winds needs no more arrows than one that does not
    for least, step, heading, cut in places[:_MOST_ARROWS]:
        point, middle = (evidence.sheet[step] + evidence.sheet[step + 1]) / 2.0, np.zeros((1, 2))
        _, far = own[cut].free(point, middle, np.full(2, _AROUND), least)
        _, zoom = crowd.free(point, middle, np.full(2, _ARROW), far)
        if zoom < NEVER:
            crowd.add(point, middle[0], np.full(2, _ARROW), zoom)
            own[cut].add(point, middle[0], np.full(2, _AROUND), zoom)
            found.append((float(point[0]), float(point[1]), heading, unit / zoom))
    columns = np.array(found).reshape(-1, 4)
    return Arrows(columns[:, :2], columns[:, 2], columns[:, 3])


def _way(evidence: Evidence, run: Run) -> tuple[IntArray, Array, Array, Array]:
    """The steps along the contour of a run: ticks, lengths up to their ends, m, headings and turns there, rad."""
    ticks = np.concatenate([np.arange(*ends) for ends in evidence.stretches(run, _OF_CUTS)])
    ticks = ticks[ticks + 1 < len(evidence.sheet)]
    way = evidence.sheet[ticks + 1] - evidence.sheet[ticks]
    length = np.hypot(*way.T)
    moves = length > 0.3 * np.median(length) if len(length) else np.zeros(0, dtype=bool)
    heading = np.arctan2(way[:, 1], way[:, 0])
    change = np.abs(np.angle(np.exp(1j * np.diff(heading))))
    turned, ends = np.append(0.0, np.cumsum(change)), np.cumsum(length)
    near = min(_STRAIGHT, 0.1 * float(ends[-1])) if len(ends) else 0.0
    before, after = np.searchsorted(ends, ends - near), np.searchsorted(ends, ends + near)
    turn = turned[np.minimum(after, len(ends) - 1)] - turned[before]
    return ticks, ends, heading, np.where(moves, turn, np.pi)


def _places(
    ticks: IntArray, ends: Array, heading: Array, turn: Array, unit: float
) -> Iterator[tuple[float, int, float]]:
    """Where one cut may have arrows: the zoom from which on there is room along the cut, the step, the heading."""
    whole = float(ends[-1]) if len(ends) else 0.0
    parts = 1
    while whole > 0.0 and (parts == 1 or whole / parts >= _CLOSEST):
        apart = whole / parts
        least = (_SHORTEST if parts == 1 else 2.0 * _APART) * unit / apart
        # In the middle of all, then in the middle of the halves: each time half-way between those that are there.
        for place in apart * np.arange(0.5, parts):
            low, high = np.searchsorted(ends, [place - _WINDOW * apart, place + _WINDOW * apart])
            steps = np.arange(low, min(max(high, low + 1), len(ends)))
            aside = np.abs(ends[steps] - place) / apart
            best = int(steps[np.argmin(turn[steps] + 0.5 * aside)])
            yield max(least, 1.0), int(ticks[best]), float(heading[best])
        parts *= 2
