"""Where the drawing lies on the sheet, and whether it fits there."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from deltacam.cutting.fitting import FLATTENING, OUTSIDE, Footprint
from deltacam.errors import InfeasibleError
from deltacam.geometry import curve as curves
from deltacam.geometry import rings
from deltacam.geometry.pack import Pack
from deltacam.model import Array, Contour, Cut, IntArray, Operation, Placement, Stretch
from deltacam.units import METRES_PER, likely_units, to_mm

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot


def bounding_box(contours: Sequence[Contour | Cut | Stretch]) -> Array:
    """The smallest x and y, and the largest, of all the curves, (2, 2) m."""
    boxes = Pack.of(contour.curve for contour in contours).bounds()
    return np.array([boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)])


def place(contours: Sequence[Contour], *, robot: Robot, at: tuple[float, float], rotation: float) -> Placement:
    """Put the centre of the drawing's bounding box at ``at`` and turn the drawing about it.

    Args:
        contours: what is cut or engraved, sheet frame, m.
        robot: gives the height of the sheet.
        at: machine frame, m.
        rotation: rad, counter-clockwise.
    """
    centre = bounding_box(contours).mean(axis=0)
    cos, sin = np.cos(rotation), np.sin(rotation)
    turned = np.array([cos * centre[0] - sin * centre[1], sin * centre[0] + cos * centre[1]])
    x, y = np.asarray(at) - turned
    return Placement(x=float(x), y=float(y), rotation=rotation, z=robot.workspace.sheet_z)


def footprint(cuts: Sequence[Cut], contours: Sequence[Contour]) -> Footprint:
    """What the cuts of these contours need of the sheet, about the place that `place` puts where it is asked to."""
    return Footprint.of(cuts, centre=bounding_box(contours).mean(axis=0))


def refuse_outside(
    cuts: Sequence[Cut],
    *,
    contours: Sequence[Contour],
    robot: Robot,
    placement: Placement,
    unit: str,
    metres_per_unit: float,
) -> None:
    """Refuse cuts that leave the sheet.

    Args:
        cuts: in the sheet frame, m.
        contours: what they cut.
        robot: gives the sheet.
        placement: of the drawing.
        unit: what the drawing's numbers were taken as, for the message.
        metres_per_unit: of that unit.

    Raises:
        InfeasibleError: the worst contour is outside; says by how much, and where, how turned, or in which unit it
            would fit.
    """
    points, owner = _placed(cuts, placement)
    excess = np.maximum.reduceat(robot.workspace.excess(points), np.searchsorted(owner, np.arange(len(cuts))))
    worst = int(np.argmax(excess))
    if excess[worst] <= OUTSIDE:
        return
    cut = cuts[worst]
    count = int((excess > OUTSIDE).sum())
    low, high = bounding_box(cuts)
    width, depth = to_mm(high[0] - low[0]), to_mm(high[1] - low[1])
    subject = "the cut" if cut.operation is Operation.CUT else "what is engraved"
    raise InfeasibleError(
        f"{subject} leaves the sheet of robot {robot.name} ({_sheet(robot)}) by {to_mm(excess[worst]):.3f} mm"
        + (f"; so do {count - 1} other contours" if count > 1 else ""),
        where=cut.where,
        hint=f"with its kerf the part is {width:.1f} x {depth:.1f} mm, one unit of the drawing taken as {unit}: "
        + (
            _fitting_place(footprint(cuts, contours), robot, placement, bounding_box(contours).mean(axis=0))
            or _fitting_unit(points, robot, (high - low) / metres_per_unit, metres_per_unit)
            or _too_large(footprint(cuts, contours), robot)
        ),
    )


def _placed(cuts: Sequence[Cut], placement: Placement) -> tuple[Array, IntArray]:
    """Points (N, 2) m along the cuts, machine frame, and the index of the cut that each is on, (N,)."""
    points, owner = rings.flatten(Pack.of(cut.curve for cut in cuts), FLATTENING)
    return points @ _turn(placement.rotation).T + (placement.x, placement.y), owner


def _fitting_place(part: Footprint, robot: Robot, placement: Placement, centre: Array) -> str:
    """Where, or how turned, a part that leaves the sheet would lie on it; empty where nothing helps.

    Args:
        part: of the drawing.
        robot: gives the sheet.
        placement: with which it leaves the sheet.
        centre: of the drawing's box, (2,) m in the sheet frame.
    """
    sheet, rotation = robot.workspace, placement.rotation
    at = (_turn(rotation) @ centre) + (placement.x, placement.y)
    moved = part.spot(sheet, part.places(sheet, rotation).centre, rotation)
    if moved is not None:
        return f"move it: --at {moved.x_mm},{moved.y_mm}, or --place auto"
    turned = part.turned_spot(sheet, (float(at[0]), float(at[1])))
    if turned is not None:
        return f"turn it: --rotate {turned.turn_deg}, or --place auto"
    both = part.turned_spot(sheet)
    return "" if both is None else f"move and turn it: {both.options}, or --place auto"


def _too_large(part: Footprint, robot: Robot) -> str:
    """What to do about a part that fits nowhere."""
    turn, excess = part.best_turn(robot.workspace)
    how = "however it is turned" if robot.workspace.radius else f"best turned by {np.degrees(turn):.2f} deg"
    least = f"at the best place it leaves the sheet by {to_mm(excess):.3f} mm, {how}"
    return f"{least}: take a larger robot (--robot), or check the unit (--units)"


def refuse_everywhere(part: Footprint, *, robot: Robot) -> None:
    """Refuse a part that fits nowhere on the sheet, however it is turned.

    Raises:
        InfeasibleError: says by how much, and how it would have to be turned for that.
    """
    turn, excess = part.best_turn(robot.workspace)
    if excess <= OUTSIDE:
        return
    how = "" if robot.workspace.radius else f", and that turned by {np.degrees(turn):.2f} deg"
    least = f"at the best place it leaves the sheet by {to_mm(excess):.3f} mm{how}"
    raise InfeasibleError(
        f"the part fits nowhere on the sheet of robot {robot.name} ({_sheet(robot)}), however it is turned: {least}",
        hint="take a larger robot (--robot), or check the unit of the drawing (--units)",
    )


def _turn(rotation: float) -> Array:
    cos, sin = np.cos(rotation), np.sin(rotation)
    return np.array([[cos, -sin], [sin, cos]])


def _fitting_unit(points: Array, robot: Robot, drawn: Array, metres_per_unit: float) -> str:
    """What to do about a part that is too large for the sheet and would not be in another unit; else empty.

    Args:
        points: of all cuts, (N, 2) m, machine frame.
        robot: gives the sheet.
        drawn: the part's width and height in the drawing's own numbers.
        metres_per_unit: that were used.
    """
    centre = (points.min(axis=0) + points.max(axis=0)) / 2.0
    for name in likely_units(*drawn):
        factor = METRES_PER[name] / metres_per_unit
        fits = robot.workspace.excess(centre + factor * (points - centre)).max() <= OUTSIDE
        if fits:
            width, depth = to_mm(METRES_PER[name]) * drawn
            size = f"in {name} it would be {width:.1f} x {depth:.1f} mm and fit"
            return f"{size}: --units {name}, or take a larger robot (--robot) if the unit is right"
    return ""


def refuse_frame_outside(corners: Array, *, robot: Robot, placement: Placement) -> None:
    """Refuse a bounding box, corners (4, 2) m in the sheet frame, that leaves the sheet.

    Raises:
        InfeasibleError: a corner is outside; says by how much.
    """
    box = curves.transform(curves.polygon(corners), rotation=placement.rotation, shift=(placement.x, placement.y))
    excess = float(robot.workspace.excess(box.points).max())
    if excess > OUTSIDE:
        raise InfeasibleError(
            f"a corner of the frame leaves the sheet of robot {robot.name} ({_sheet(robot)}) by {to_mm(excess):.3f} mm",
            hint="the part itself fits: use --dry-run, or move or turn it (--at, --rotate)",
        )


def _sheet(robot: Robot) -> str:
    area = robot.workspace
    if area.radius is not None:
        return f"a disc of {to_mm(2.0 * area.radius):.0f} mm"
    return f"{to_mm(area.width or 0.0):.0f} x {to_mm(area.depth or 0.0):.0f} mm"
