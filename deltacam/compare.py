"""Robots side by side: what they are, and what each makes of one drawing."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any, Final

import numpy as np

from deltacam import pipeline
from deltacam.cutting.process import DEFAULT_PROCESS, check_process, load_process
from deltacam.drawing.reader import read_drawing
from deltacam.errors import DeltacamError, InfeasibleError
from deltacam.model import EVERYTHING, Check, Process
from deltacam.robot.comparison import ARCMIN, Outcome
from deltacam.robot.measures import tool_error_per_joint_error
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.robot import Robot

TURNS: Final = (0.0, math.pi / 6, math.pi / 4, math.pi / 3, math.pi / 2)
"""Rotations about the sheet's centre that are tried one after the other, rad."""

Progress = Callable[[str, int, int], None]


def compare(
    drawing: str | Path, robots: Sequence[str | Path] = (), *, progress: Progress | None = None, **options: Any
) -> tuple[Outcome, ...]:
    """Plan one drawing for every robot, all built-in ones where none is named.

    A robot for which it fails is an outcome with its reason. A drawing that does not fit as it lies is tried turned.

    Args:
        drawing: path of a DXF file.
        robots: built-in names, or paths of robot files.
        progress: is told which robot is planned for.
        **options: of `pipeline.plan`, but ``robot``, ``at`` and ``rotation``.

    Raises:
        DeltacamError: the drawing cannot be read at all, by no robot's fault.
    """
    _refuse_unreadable(drawing, options)
    names = [str(name) for name in robots or profile_names()]
    found = []
    for count, name in enumerate(names):
        if progress is not None:
            progress(name, count, len(names))
        found.append(_outcome(drawing, name, options))
    return tuple(found)


def _refuse_unreadable(drawing: str | Path, options: dict[str, Any]) -> None:
    """Read the process and the drawing once, so that what is wrong with them is not said of every robot."""
    process = options.get("process", DEFAULT_PROCESS)
    process = check_process(process if isinstance(process, Process) else load_process(process))
    selection = replace(options.get("selection", EVERYTHING), rules=process.rules, open=process.open)
    unit, default = options.get("unit"), options.get("default_unit")
    read_drawing(drawing, unit=unit, default_unit=default, selection=selection)


def _outcome(drawing: str | Path, name: str, options: dict[str, Any]) -> Outcome:
    """What one robot makes of the drawing; nothing of it is raised."""
    reason = ""
    try:
        robot = load_robot(name)
    except DeltacamError as problem:
        return Outcome(name, fits=False, passed=False, reason=_words(problem))
    for turn in TURNS:
        try:
            planned = pipeline.plan(drawing, robot=robot, rotation=turn, **options)
        except InfeasibleError as problem:
            reason = reason or _words(problem)
            if "leaves the sheet" not in problem.what:
                return Outcome(robot.name, fits=True, passed=False, reason=_words(problem), rotation=turn)
        except DeltacamError as problem:
            return Outcome(robot.name, fits=False, passed=False, reason=_words(problem))
        else:
            return _measured(robot, planned, turn)
    return Outcome(robot.name, fits=False, passed=False, reason=reason)


def _measured(robot: Robot, planned: pipeline.Planned, turn: float) -> Outcome:
    report, program = planned.report, planned.program
    failed = [check.name for check in report.checks if not (check.passed or check.warns)]
    lit = program.power > 0.0
    points = robot.forward(program.q[lit]) if lit.any() else np.zeros((0, 3))
    time = sum(one.time for one in report.held)
    bound: dict[str, float] = {}
    for one in report.held:
        for limit, seconds in one.bound.items():
            bound[limit] = bound.get(limit, 0.0) + seconds
    shares = [(limit, seconds / time) for limit, seconds in bound.items() if limit != "none" and seconds > 0.0]
    return Outcome(
        name=robot.name,
        fits=True,
        passed=report.passed,
        reason=f"failed: {', '.join(failed)}" if failed else "",
        rotation=turn,
        duration=program.duration,
        laser=float(lit.sum()) / robot.controller.rate_hz,
        binds=tuple(sorted(shares, key=lambda item: (-item[1], item[0]))),
        error=float(tool_error_per_joint_error(robot.geometry, points).max()) * ARCMIN if lit.any() else None,
        tightest=_tightest(report.checks),
    )


def _tightest(checks: Sequence[Check]) -> tuple[str, float] | None:
    """The check of a largest value that uses most of its limit."""
    shares = [
        (check.name, check.worst / check.limit)
        for check in checks
        if check.worst is not None and check.limit is not None and check.limit > 0.0 and check.passed
    ]
    shares = [item for item in shares if item[1] <= 1.0 + 1e-9]
    return max(shares, key=lambda item: item[1]) if shares else None


def _words(problem: DeltacamError) -> str:
    return f"{problem.where}: {problem.what}" if problem.where else problem.what
