"""Checking a program that is there: what it is read with, and what it is compared with.

Nothing of the planner is loaded here, so that a check starts quickly and is independent.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from deltacam.cutting.process import load_process
from deltacam.drawing.reader import read_drawing
from deltacam.model import Drawing, Process, Report
from deltacam.program.formats import read_program
from deltacam.program.program import Program
from deltacam.robot.reader import load_robot
from deltacam.robot.robot import Robot
from deltacam.verification import verify as verification


@dataclass(frozen=True, slots=True, eq=False)
class Verified:
    """A program that was checked.

    Attributes:
        program: as it was read.
        report: what was found.
        drawing: that it was compared with, if any.
        robot: that it was checked against.
        process: likewise.
    """

    program: Program
    report: Report
    drawing: Drawing | None
    robot: Robot
    process: Process


def verify(
    program: Program | str | Path,
    *,
    drawing: str | Path | None = None,
    robot: Robot | str | Path | None = None,
    process: Process | str | Path | None = None,
) -> Report:
    """Check a program against the robot it was made for, and against a drawing where one is given.

    Args:
        program: a program, or the path of a program file.
        drawing: path of the DXF file that it should cut, or of a folder that holds a file of the name in the program.
        robot: the robot that it must be for, where that is not simply what the program says.
        process: likewise how the material must be cut.

    Raises:
        DeltacamError: a file cannot be read at all; what is wrong with a readable program is in the report.
    """
    return examine(program, drawing=drawing, robot=robot, process=process).report


def examine(
    program: Program | str | Path,
    *,
    drawing: str | Path | None = None,
    robot: Robot | str | Path | None = None,
    process: Process | str | Path | None = None,
) -> Verified:
    """As `verify`, with what was read on the way.

    Raises:
        DeltacamError: as `verify`.
    """
    program = program if isinstance(program, Program) else read_program(program)
    if robot is not None and not isinstance(robot, Robot):
        robot = load_robot(robot)
    if process is not None and not isinstance(process, Process):
        process = load_process(process)
    part = None
    if drawing is not None:
        path = Path(drawing) / Path(program.drawing.file).name if Path(drawing).is_dir() else drawing
        scale = program.drawing.metres_per_unit
        part = read_drawing(path, metres_per_unit=scale, selection=program.selection)
    report = verification.verify(program, drawing=part, robot=robot, process=process)
    return Verified(program, report, part, robot or program.robot, process or program.process)
