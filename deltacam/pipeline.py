"""The order of the stages: from a drawing to a verified program and its files.

This is the only place that knows the order. Stages say nothing and ask nothing; progress is told to a callback.
"""

from __future__ import annotations

import io
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from deltacam.cutting import kerf, placement
from deltacam.cutting.process import DEFAULT_PROCESS, check_process, load_process
from deltacam.cutting.resume import resume
from deltacam.cutting.ways import Ways, ways
from deltacam.drawing.reader import read_drawing
from deltacam.model import (
    EVERYTHING,
    Cut,
    Drawing,
    Finding,
    Held,
    Mode,
    Operation,
    Placement,
    Process,
    Report,
    Search,
    Selection,
)
from deltacam.motion import setpoints
from deltacam.motion.tape import Setpoints
from deltacam.placing.find import By, Found, Task, find
from deltacam.placing.sampled import Sampled
from deltacam.program import csv
from deltacam.program.atomic import write_whole
from deltacam.program.outputs import Outputs, make_folder
from deltacam.program.program import DrawingRef, Program
from deltacam.report import html, listing
from deltacam.robot.reader import DEFAULT_ROBOT, load_robot
from deltacam.robot.robot import Robot
from deltacam.verification import verify as verification

Progress = Callable[[str, int, int], None]
"""Is told the stage, how much of it is done, and of how much."""


def _silent(_stage: str, _done: int, _total: int) -> None:
    """Tell nobody."""


@dataclass(frozen=True, slots=True, eq=False)
class Planned:
    """A program, and what the independent check of it found.

    Attributes:
        program: as it was read back from ``content``.
        report: says whether it may be used.
        drawing: what it was planned from.
        content: the bytes of the program file.
    """

    program: Program
    report: Report
    drawing: Drawing
    content: bytes


def plan(
    drawing: str | Path,
    *,
    data: bytes | None = None,
    robot: Robot | str | Path = DEFAULT_ROBOT,
    process: Process | str | Path = DEFAULT_PROCESS,
    unit: str | None = None,
    default_unit: str | None = None,
    selection: Selection = EVERYTHING,
    at: tuple[float, float] = (0.0, 0.0),
    rotation: float = 0.0,
    place: By | None = None,
    mode: Mode = Mode.CUT,
    from_contour: int | None = None,
    search: Search = Search(),  # noqa: B008 - it cannot be changed
    jobs: int | None = None,
    what_if: bool | None = None,
    progress: Progress = _silent,
) -> Planned:
    """Plan a drawing and check the program independently.

    Args:
        drawing: path of a DXF file.
        data: the bytes of the drawing, where they are at hand; then ``drawing`` is only its name.
        robot: a robot, a built-in name, or the path of a robot file.
        process: a process, a built-in name, or the path of a process file.
        unit: what the drawing's numbers are, where the file does not say or is wrong: "mm", "in", ...
        default_unit: what they are where neither the file nor ``unit`` says.
        selection: which layers count, and how far apart ends may be; the rules are those of the process.
        at: where the centre of what is cut comes to lie, machine frame, m.
        rotation: of the drawing about that centre, rad, counter-clockwise.
        place: what the place and the rotation are chosen by, as `best_places` finds them; None takes those given.
        mode: cut, the same motion with the laser off, or the bounding box with the laser off.
        from_contour: the number of the contour to go on with after a stop; what comes before it is not cut again.
        search: how long the order of the cuts is looked for, and what must stay together.
        jobs: how many processes plan the motion, >= 1; None takes as many as pay. The program is the same for any.
        what_if: whether to find out how long the cuts would take without each limit; None does where that is quick.
        progress: is told what is going on.

    Returns:
        the program and its report; ``report.passed`` says whether the program may be used.

    Raises:
        DeltacamError: the drawing, robot or process must be changed; says what, where and how.
    """
    robot = robot if isinstance(robot, Robot) else load_robot(robot)
    process = check_process(process if isinstance(process, Process) else load_process(process))
    progress("read", 0, 1)
    selection = replace(selection, rules=process.rules, open=process.open)
    part = read_drawing(drawing, data=data, unit=unit, default_unit=default_unit, selection=selection)
    how = _How(robot, process, at, rotation, mode, jobs, what_if, progress, from_contour, search)
    found = None if place is None else _placed(part, how, place)
    if found is not None:
        how = how._replace(at=found.best[0].spot.at, rotation=found.best[0].spot.rotation)
    program, held, findings = _program(part, how)
    findings += () if found is None else (_where(found),)
    progress("write", 0, 1)
    content = _content(program)
    program = csv.read(io.BytesIO(content), name=Outputs.of(drawing, ".").program.name)
    progress("verify", 0, 1)
    report = verification.verify(program, drawing=part)
    summary = {**report.summary, "derived_joint_limits": list(robot.joints.derived)}
    report = replace(report, summary=summary, findings=(*report.findings, *findings), held=held)
    progress("verify", 1, 1)
    return Planned(program, report, part, content)


def best_places(
    drawing: str | Path,
    *,
    robot: Robot | str | Path = DEFAULT_ROBOT,
    process: Process | str | Path = DEFAULT_PROCESS,
    unit: str | None = None,
    default_unit: str | None = None,
    selection: Selection = EVERYTHING,
    by: By = "both",
    jobs: int | None = None,
    progress: Progress = _silent,
) -> tuple[Found, Robot]:
    """Where on the sheet, and how turned, a drawing is cut fastest and most accurately.

    Args:
        drawing: path of a DXF file.
        robot: a robot, a built-in name, or the path of a robot file.
        process: a process, a built-in name, or the path of a process file.
        unit: as `plan`.
        default_unit: as `plan`.
        selection: as `plan`.
        by: whether the time, the error of the tool, or both are to be small.
        jobs: as `plan`.
        progress: is told what is going on.

    Returns:
        the places, planned, the best first, and the robot.

    Raises:
        DeltacamError: as `plan`; or the part fits nowhere, which says by how much.
    """
    robot = robot if isinstance(robot, Robot) else load_robot(robot)
    process = check_process(process if isinstance(process, Process) else load_process(process))
    progress("read", 0, 1)
    selection = replace(selection, rules=process.rules, open=process.open)
    part = read_drawing(drawing, unit=unit, default_unit=default_unit, selection=selection)
    how = _How(robot, process, (0.0, 0.0), 0.0, Mode.CUT, jobs, False, progress)
    return _placed(part, how, by), robot


def plan_to_folder(
    drawing: str | Path, folder: str | Path, *, progress: Progress = _silent, **options: Any
) -> tuple[Planned, Outputs]:
    """Plan a drawing and write its files: the reports always, the program only if every check passed.

    Args:
        drawing: path of a DXF file.
        folder: where the files go; made where it is missing.
        progress: is told what is going on.
        **options: of ``plan``.

    Raises:
        DeltacamError: as ``plan``, or the folder cannot be written to. No program of an earlier run is left then.
    """
    outputs = Outputs.of(drawing, folder)
    make_folder(Path(folder))
    outputs.clear()
    planned = plan(drawing, progress=progress, **options)
    progress("report", 0, 1)
    data, page = reports_of(planned)
    write_whole(outputs.report_json, data)
    write_whole(outputs.report_html, page)
    if planned.report.passed:
        write_whole(outputs.program, planned.content)
    progress("report", 1, 1)
    return planned, outputs


def reports_of(planned: Planned, *, library: str | None = None) -> tuple[bytes, bytes]:
    """The report of a plan as JSON and as a page.

    Args:
        planned: the program and its report.
        library: where a copy of `page.plotly_js` lies, relative to the page; None puts it into the page, 4.8 MB.
    """
    title = Path(planned.drawing.file).stem
    page = html.to_html(planned.report, planned.program, drawing=planned.drawing, title=title, library=library)
    return listing.to_json(planned.report).encode(), page.encode()


class _How(NamedTuple):
    """How a drawing is planned, as `plan` takes it."""

    robot: Robot
    process: Process
    at: tuple[float, float]
    rotation: float
    mode: Mode
    jobs: int | None
    what_if: bool | None
    progress: Progress
    from_contour: int | None = None
    search: Search = Search()


def _program(part: Drawing, how: _How) -> tuple[Program, tuple[Held, ...], tuple[Finding, ...]]:
    """The program of a drawing, what holds it back, and what a person should know about it."""
    robot, process = how.robot, how.process
    if any(contour.operation is Operation.ENGRAVE for contour in part.contours):
        setpoints.engraving_feed(process)  # refuses now rather than after everything else
    where = placement.place(part.contours, robot=robot, at=how.at, rotation=how.rotation)
    how.progress("kerf", 0, 1)
    shifted = kerf.offset(part.contours, kerf=process.kerf)
    placement.refuse_outside(
        shifted.cuts,
        contours=part.contours,
        robot=robot,
        placement=where,
        unit=part.unit_in_words,
        metres_per_unit=part.metres_per_unit,
    )
    moves, findings = (_frame if how.mode is Mode.FRAME else _cutting)(part, shifted.cuts, how, where)
    program = Program(
        robot=robot,
        placement=where,
        process=process,
        drawing=DrawingRef.of(part),
        mode=how.mode,
        blocks=moves.blocks,
        q=moves.q,
        power=moves.power,
        block=moves.block,
        from_contour=how.from_contour,
    )
    return program, moves.held, (*shifted.findings, *findings)


def _placed(part: Drawing, how: _How, by: By) -> Found:
    """The places and turns at which a drawing is cut best."""
    robot, process = how.robot, how.process
    if any(contour.operation is Operation.ENGRAVE for contour in part.contours):
        setpoints.engraving_feed(process)
    how.progress("kerf", 0, 1)
    cuts = kerf.offset(part.contours, kerf=process.kerf).cuts
    footprint = placement.footprint(cuts, part.contours)
    placement.refuse_everywhere(footprint, robot=robot)
    quiet = how._replace(what_if=False, mode=Mode.CUT, progress=_silent)

    def sample(at: tuple[float, float], rotation: float) -> Sampled:
        where = placement.place(part.contours, robot=robot, at=at, rotation=rotation)
        ordered, error = _ways(part, cuts, how, where).cuts, part.conversion_error
        moves, rests = setpoints.moves_of(ordered, robot=robot, process=process, placement=where, drawing_error=error)
        park, resting = np.array(robot.workspace.park), (rests - 1) / robot.controller.rate_hz
        return Sampled.of(moves, at=at, rotation=rotation, park=park, resting=resting)

    def duration(at: tuple[float, float], rotation: float) -> float:
        where = placement.place(part.contours, robot=robot, at=at, rotation=rotation)
        return (len(_cutting(part, cuts, quiet, where)[0].q) - 1) / robot.controller.rate_hz

    task = Task(footprint, robot, sample, duration)
    return find(task, by=by, progress=lambda done, total: how.progress("place", done, total))


def _where(found: Found) -> Finding:
    """What a person should know of the place that was chosen."""
    best = found.best[0]
    what = f"placed by {found.by if found.by != 'both' else 'time and accuracy'}: {best.spot.options}"
    if found.centre is None:
        return Finding(f"{what}; at the centre the part does not fit", kind="place")
    if best == found.centre:
        return Finding(f"{what}; no place that was planned is better than the centre", kind="place")
    errors = f"{best.worst * 1e3:.1f} instead of {found.centre.worst * 1e3:.1f} um per mrad of the joints"
    times = f"{best.time:.3f} instead of {found.centre.time:.3f} s at the centre"
    return Finding(f"{what}; {times}, error of the tool {errors}", kind="place")


def _ways(part: Drawing, cuts: tuple[Cut, ...], how: _How, where: Placement) -> Ways:
    return ways(
        cuts,
        part.contours,
        process=how.process,
        robot=how.robot,
        placement=where,
        search=how.search,
        progress=lambda done, total: how.progress("order", done, total),
    )


def _cutting(
    part: Drawing, cuts: tuple[Cut, ...], how: _How, where: Placement
) -> tuple[Setpoints, tuple[Finding, ...]]:
    how.progress("order", 0, 1)
    found = _ways(part, cuts, how, where)
    left, left_out = (found.cuts, ()) if how.from_contour is None else resume(found.cuts, how.from_contour)
    moves = setpoints.plan_motion(
        left,
        robot=how.robot,
        process=how.process,
        placement=where,
        drawing_error=part.conversion_error,
        mode=how.mode,
        jobs=how.jobs,
        what_if=how.what_if,
        progress=lambda done, total: how.progress("motion", done, total),
    )
    return moves, (*found.findings, *left_out)


def _frame(part: Drawing, cuts: tuple[Cut, ...], how: _How, where: Placement) -> tuple[Setpoints, tuple[Finding, ...]]:
    worked = _ways(part, cuts, how, where).cuts
    leads = [stretch for cut in worked for stretch in cut.way]  # and loops, which go outside of the part
    (left, bottom), (right, top) = placement.bounding_box([*worked, *leads])
    corners = np.array([[left, bottom], [right, bottom], [right, top], [left, top]])
    placement.refuse_frame_outside(corners, robot=how.robot, placement=where)
    return setpoints.plan_frame(corners, robot=how.robot, process=how.process, placement=where), ()


def _content(program: Program) -> bytes:
    stream = io.BytesIO()
    csv.write(program, stream)
    return stream.getvalue()
