"""Robots side by side: what they are, and what each makes of one drawing."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

from deltacam import pipeline
from deltacam.cutting import kerf, placement
from deltacam.cutting.fitting import Footprint, Spot
from deltacam.cutting.process import DEFAULT_PROCESS, check_process, load_process
from deltacam.drawing.reader import read_drawing
from deltacam.errors import DeltacamError, InfeasibleError
from deltacam.model import EVERYTHING, Process, Report
from deltacam.robot.comparison import ARCMIN, Outcome
from deltacam.robot.measures import tool_error_per_joint_error
from deltacam.robot.reader import load_robot, profile_names
from deltacam.robot.robot import Robot

Progress = Callable[[str, int, int], None]


def compare(
    drawing: str | Path, robots: Sequence[str | Path] = (), *, progress: Progress | None = None, **options: Any
) -> tuple[Outcome, ...]:
    """Plan one drawing for every robot, all built-in ones where none is named.

    A robot for which it fails is an outcome with its reason. A drawing that does not fit as it lies, its centre in the
    middle of the sheet, is moved, then turned, until it does.

    Args:
        drawing: path of a DXF file.
        robots: built-in names, or paths of robot files.
        progress: is told which robot is planned for.
        **options: of `pipeline.plan`, but ``robot``, ``at``, ``rotation`` and ``place``.

    Raises:
        DeltacamError: the drawing or the process must be changed, whatever the robot.
    """
    part = _footprint(drawing, options)
    names = [str(name) for name in robots or profile_names()]
    found = []
    for count, name in enumerate(names):
        if progress is not None:
            progress(name, count, len(names))
        found.append(_outcome(drawing, part, name, options))
    return tuple(found)


def _footprint(drawing: str | Path, options: dict[str, Any]) -> Footprint:
    """What the part needs of a sheet; reads the process and the drawing once, so that no robot is blamed for them."""
    process = options.get("process", DEFAULT_PROCESS)
    process = check_process(process if isinstance(process, Process) else load_process(process))
    selection = replace(options.get("selection", EVERYTHING), rules=process.rules, open=process.open)
    unit, default = options.get("unit"), options.get("default_unit")
    contours = read_drawing(drawing, unit=unit, default_unit=default, selection=selection).contours
    return placement.footprint(kerf.offset(contours, kerf=process.kerf).cuts, contours)


def _outcome(drawing: str | Path, part: Footprint, name: str, options: dict[str, Any]) -> Outcome:
    """What one robot makes of the drawing; nothing of it is raised."""
    fits = False
    try:
        robot = load_robot(name)
        name = robot.name
        placement.refuse_everywhere(part, robot=robot)
        spot, fits = _spot(part, robot), True
        planned = pipeline.plan(drawing, robot=robot, at=spot.at, rotation=spot.rotation, **options)
    except DeltacamError as problem:
        reason = f"{problem.where}: {problem.what}" if problem.where else problem.what
        return Outcome(name, fits=fits, passed=False, reason=reason)
    return _measured(robot, planned, spot)


def _spot(part: Footprint, robot: Robot) -> Spot:
    """Where the part lies: as it is in the middle, else moved, else turned in the middle, else both.

    Raises:
        InfeasibleError: it fits with no turn that is tried, though barely with the best one.
    """
    sheet = robot.workspace
    tried = (
        part.spot(sheet, (0.0, 0.0), 0.0)
        or part.spot(sheet, part.places(sheet, 0.0).centre, 0.0)
        or part.turned_spot(sheet, (0.0, 0.0))
        or part.turned_spot(sheet)
    )
    if tried is None:
        raise InfeasibleError("the part fits the sheet too barely to be placed with numbers of six decimals")
    return tried


def _measured(robot: Robot, planned: pipeline.Planned, spot: Spot) -> Outcome:
    report, program = planned.report, planned.program
    failed = [check.name for check in report.checks if not (check.passed or check.warns)]
    lit = program.power > 0.0
    error = tool_error_per_joint_error(robot.geometry, robot.forward(program.q[lit])).max() if lit.any() else None
    return Outcome(
        name=robot.name,
        fits=True,
        passed=report.passed,
        reason=f"failed: {', '.join(failed)}" if failed else "",
        at=spot.at,
        rotation=spot.rotation,
        duration=program.duration,
        laser=float(lit.sum()) / robot.controller.rate_hz,
        binds=_binds(report),
        error=None if error is None else float(error) * ARCMIN,
    )


def _binds(report: Report) -> tuple[tuple[str, float], ...]:
    """The limits that hold the contours back, with their share of the time along them, the largest first."""
    time = sum(one.time for one in report.held)
    bound: dict[str, float] = {}
    for one in report.held:
        for limit, seconds in one.bound.items():
            bound[limit] = bound.get(limit, 0.0) + seconds
    shares = [(limit, seconds / time) for limit, seconds in bound.items() if limit != "none" and seconds > 0.0]
    return tuple(sorted(shares, key=lambda item: (-item[1], item[0])))
