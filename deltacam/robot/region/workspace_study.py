"""Everything that is found out about where a robot can work."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.robot.region.certify import Certificate, certify
from deltacam.robot.region.largest import Fitted, largest_region
from deltacam.robot.region.requirements import Requirements
from deltacam.robot.region.shapes import Box, Cylinder, Region
from deltacam.robot.region.survey import Poses, Slice, cut, poses_at, survey
from deltacam.robot.region.usable import Usable, requirements_of, usable_region, whole_reach
from deltacam.robot.robot import Robot
from deltacam.robot.workspace import Workspace

_CELLS: Final = 60_000
_SLICES: Final = 7
_MOST_SLICES: Final = 200
_PICTURE: Final = 160  # points per side of a section


@dataclass(frozen=True, slots=True, eq=False)
class WorkspaceStudy:
    """Where a robot can work.

    Attributes:
        robot: the robot.
        requirements: what a usable pose keeps.
        usable: the usable region, between proved bounds.
        volume: of the usable region, as the points of ``region`` have it, m^3.
        region: poses at a grid of points about the usable region.
        within_joints: a grid of points about all that the arms reach, with the joint range as the only requirement.
        sheet: poses on the sheet.
        sheet_certificate: of the sheet.
        cylinder: the largest that is certified.
        box: the largest that is certified.
        slices: level ones, from the lowest to the highest.
        sections: upright ones through the base's axis: along x, along y.
        level: the slice at the sheet's height.
    """

    robot: Robot
    requirements: Requirements
    usable: Usable
    volume: float
    region: Poses
    within_joints: Poses
    sheet: Poses
    sheet_certificate: Certificate
    cylinder: Fitted
    box: Fitted
    slices: tuple[Slice, ...]
    sections: tuple[Slice, Slice]
    level: Slice


def study_workspace(
    robot: Robot,
    *,
    slices: int = _SLICES,
    height: float | None = None,
    min_inverse_condition: float | None = None,
) -> WorkspaceStudy:
    """Find out where a robot can work.

    Args:
        robot: the robot.
        slices: how many level slices, 1 to 200.
        height: of the largest cylinder and box, m; None for the one that gives the largest volume.
        min_inverse_condition: smallest inverse condition number that is required, 0 to 1.

    Returns:
        What was found.

    Raises:
        RobotError: an option is out of its bounds, or no pose keeps the requirements.
    """
    _check(slices, height, min_inverse_condition)
    geometry = robot.geometry
    wanted = requirements_of(robot, min_inverse_condition=min_inverse_condition)
    usable = usable_region(geometry, wanted, max_cells=_CELLS)
    bounds = usable.bounds
    region, each = survey(geometry, wanted, bounds)
    if not region.kept.any():
        what = "no pose of the robot keeps all requirements"
        raise RobotError(what, where="workspace", hint="allow more in the robot file, or a smaller 1/cond")
    joints_only = Requirements(robot.joints.min, robot.joints.max, max_mu2=np.pi)
    levels = np.linspace(*_heights(region), slices) if slices > 1 else [robot.workspace.sheet_z]
    x, y = float(geometry.mount.x), float(geometry.mount.y)
    picture = {"per_side": _PICTURE}
    return WorkspaceStudy(
        robot=robot,
        requirements=wanted,
        usable=usable,
        volume=each * int(region.kept.sum()),
        region=region,
        within_joints=survey(geometry, joints_only, np.stack(whole_reach(geometry).bounds))[0],
        sheet=poses_at(geometry, wanted, robot.workspace.grid()),
        sheet_certificate=certify(geometry, _sheet(robot.workspace), wanted),
        cylinder=largest_region(geometry, wanted, bounds, height=height),
        box=largest_region(geometry, wanted, bounds, ratio=1.0, height=height),
        slices=tuple(cut(geometry, wanted, bounds, axes=(0, 1), at=float(z)) for z in levels),
        sections=(
            cut(geometry, wanted, bounds, axes=(0, 2), at=y, **picture),
            cut(geometry, wanted, bounds, axes=(1, 2), at=x, **picture),
        ),
        level=cut(geometry, wanted, bounds, axes=(0, 1), at=robot.workspace.sheet_z, **picture),
    )


def _check(slices: int, height: float | None, least: float | None) -> None:
    if not 1 <= slices <= _MOST_SLICES:
        raise RobotError(f"{slices} slices are not 1 to {_MOST_SLICES}", hint="use --slices 7")
    if height is not None and not 0.0 < height < 100.0:
        raise RobotError(f"a height of {height * 1e3:g} mm is not above 0", hint="use --height 20")
    if least is not None and not 0.0 <= least < 1.0:
        raise RobotError(f"1/cond of {least:g} is not in 0 to 1", hint="use --min-inverse-condition 0.3")


def _heights(region: Poses) -> tuple[float, float]:
    z = region.points[region.kept, 2]
    return float(z.min()), float(z.max())


def _sheet(sheet: Workspace) -> Region:
    z = sheet.sheet_z
    if sheet.radius is not None:
        return Cylinder((0.0, 0.0), sheet.radius, z, z)
    x, y = (sheet.width or 0.0) / 2.0, (sheet.depth or 0.0) / 2.0
    return Box((-x, -y, z), (x, y, z))
