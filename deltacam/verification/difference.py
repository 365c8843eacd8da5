"""What differs between two programs: what they say, how long they take, and where they cut."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any, Final

import numpy as np

from deltacam.model import Array, Check, Report
from deltacam.program.program import Program
from deltacam.verification.evidence import Evidence, gather
from deltacam.verification.near import Lines
from deltacam.verification.runs import Run

_EXACT_ABOVE: Final = 0.1e-6  # m


@dataclass(frozen=True, slots=True)
class ContourDifference:
    """How two programs cut or engrave one contour.

    Attributes:
        contour: its number in the drawing; None stands for what is cut without one.
        layer: of the contour.
        times: of both programs, s; None where one does not cut it.
        places: in the order of both programs, from 1; None likewise.
        distance: the largest from the way of either tool to that of the other, sheet frame, m; None where only one cuts
            it, or its setpoints are out of reach.
    """

    contour: int | None
    layer: str
    times: tuple[float | None, float | None]
    places: tuple[int | None, int | None]
    distance: float | None


@dataclass(frozen=True, slots=True)
class Difference:
    """What differs between two programs; pairs are of the first and the second.

    Attributes:
        settings: values of the meta object that differ, by their dotted names.
        durations: s.
        checks: every check whose worst value or verdict differs, by name; None where it was not made.
        contours: every contour that either of them cuts, in the order of their numbers.
    """

    settings: Mapping[str, tuple[Any, Any]]
    durations: tuple[float, float]
    checks: Mapping[str, tuple[Check | None, Check | None]]
    contours: tuple[ContourDifference, ...]


def difference(programs: tuple[Program, Program], reports: tuple[Report, Report]) -> Difference:
    """What differs between two programs, given the reports of both."""
    first, second = programs
    return Difference(
        settings=_settings(_stated(first), _stated(second)),
        durations=(first.duration, second.duration),
        checks=_checks(*reports),
        contours=_contours(gather(first, first.robot), gather(second, second.robot)),
    )


def _stated(program: Program) -> dict[str, Any]:
    """What the meta object says of how the program was made; not its blocks, which follow the motion."""
    return {
        "mode": program.mode.value,
        "robot": {"name": program.robot.name, **program.robot.motion_values()},
        "placement": asdict(program.placement),
        "process": asdict(program.process),
        "drawing": asdict(program.drawing),
    }


def _settings(first: Any, second: Any, name: str = "") -> dict[str, tuple[Any, Any]]:
    """The leaves of two objects that differ, by their dotted names."""
    if isinstance(first, dict) and isinstance(second, dict):
        found: dict[str, tuple[Any, Any]] = {}
        for key in {**first, **second}:
            found |= _settings(first.get(key), second.get(key), f"{name}.{key}" if name else key)
        return found
    return {} if first == second else {name: (first, second)}


def _checks(first: Report, second: Report) -> dict[str, tuple[Check | None, Check | None]]:
    """In the order of the first, then those that only the second has."""
    one, other = ({check.name: check for check in report.checks} for report in (first, second))
    pairs = {name: (one.get(name), other.get(name)) for name in [*one, *(name for name in other if name not in one)]}
    return {name: pair for name, pair in pairs.items() if _found(pair[0]) != _found(pair[1])}


def _found(check: Check | None) -> tuple[float | None, bool] | None:
    return None if check is None else (check.worst, check.passed)


def _contours(first: Evidence, second: Evidence) -> tuple[ContourDifference, ...]:
    sides = (_Side(first), _Side(second))
    numbers = {**sides[0].runs, **sides[1].runs}
    return tuple(
        ContourDifference(
            contour=number,
            layer=sides[0].layers.get(number) or sides[1].layers.get(number, ""),
            times=(sides[0].time(number), sides[1].time(number)),
            places=(sides[0].place(number), sides[1].place(number)),
            distance=_apart(sides[0].ways(number), sides[1].ways(number)),
        )
        for number in sorted(numbers, key=lambda one: one or 0)
    )


class _Side:
    """One of the two programs, by contour."""

    def __init__(self, evidence: Evidence) -> None:
        self._evidence = evidence
        self.runs: defaultdict[int | None, list[Run]] = defaultdict(list)
        for run in evidence.runs:
            self.runs[run.contour].append(run)
        self.layers = {block.contour: block.layer for block in evidence.program.blocks}
        self._order = {number: place for place, number in enumerate(self.runs, start=1)}

    def time(self, number: int | None) -> float | None:
        runs = self.runs.get(number)
        return sum(run.end - run.first for run in runs) / self._evidence.rate if runs else None

    def place(self, number: int | None) -> int | None:
        return self._order.get(number)

    def ways(self, number: int | None) -> list[Array]:
        if not len(self._evidence.sheet):
            return []
        return [self._evidence.sheet[run.first : run.end + 1] for run in self.runs.get(number, ())]


def _apart(first: list[Array], second: list[Array]) -> float | None:
    """The largest distance from either set of ways to the other, m."""
    if not first or not second:
        return None
    there = Lines(second, closed=False).distance(np.concatenate(first), exact_above=_EXACT_ABOVE)
    back = Lines(first, closed=False).distance(np.concatenate(second), exact_above=_EXACT_ABOVE)
    return float(max(there.max(), back.max()))
