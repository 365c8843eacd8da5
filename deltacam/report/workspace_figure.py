"""The machine from above: the sheet, the part on it, the base with its three joints, and how steep the arms stand."""

from __future__ import annotations

from typing import Final

import numpy as np

from deltacam.errors import RobotError
from deltacam.geometry import curve as curves
from deltacam.model import Array, Drawing
from deltacam.report import palette
from deltacam.report.figures import Json, dots, lines, map_layout
from deltacam.report.thin import thin_lines
from deltacam.report.view import View, sheet_edge
from deltacam.robot.robot import Robot
from deltacam.units import to_mm
from deltacam.verification.evidence import Evidence

_GRID: Final = 41  # places per side at which the pressure angle is known
_LEVELS: Final = 9  # of pressure angle, about
_FLAT: Final = 1e-3  # of a triangle: with arms so close to one line the joints themselves stand for it
_COARSE: Final = 4.0  # times coarser than the picture of the part


def workspace_figure(evidence: Evidence, drawing: Drawing | None, view: View) -> Json:
    """What is around the part, in mm in the machine frame.

    Returns:
        ``traces`` and ``layout``; ``arms``: what the script needs to draw the arms; ``placement`` of the sheet frame.
    """
    robot, placement = evidence.robot, evidence.program.placement
    part = [_to_base(evidence, line) for line in _outlines(drawing, view)]
    sheet = sheet_edge(robot.workspace)
    geometry = robot.geometry
    middle, outwards = geometry.centre[:2], geometry.outwards
    joints, elbows = (
        middle + reach[:, np.newaxis] * outwards
        for reach in (geometry.base_radii, geometry.base_radii + geometry.upper_arms)
    )
    corners = _corners(joints - middle) + middle
    traces = [
        lines([_mm(_closed(corners))], palette.SHEET, width=1.0, fill=palette.PART, opacity=0.55),
        *_pressure(robot, sheet),
        lines([_mm(_closed(sheet))], palette.LINE, width=1.6),
        lines([_mm(line) for line in part], palette.JOINTS[0], width=1.1),
    ]
    subject = np.concatenate(part) if part else evidence.tool[:, :2]
    if len(subject):
        traces.append(lines([_mm(_box(subject))], palette.JOINTS[0], width=1.0, dash="3px,3px"))
    traces += [
        dots(_mm(joints), palette.STRONG, size=9, symbol="square"),
        dots(_mm(np.array([robot.workspace.park])), palette.LIMIT, size=9, symbol="cross-thin-open"),
    ]
    seen = np.concatenate([sheet, corners, subject, elbows])
    return {
        "traces": traces,
        "layout": map_layout(_mm(np.stack([seen.min(axis=0), seen.max(axis=0)]))),
        "arms": {
            "centre": _mm(middle).tolist(),
            "azimuths": np.arctan2(outwards[:, 1], outwards[:, 0]).tolist(),
            "base": _mm(geometry.base_radii).tolist(),
            "upper": _mm(geometry.upper_arms).tolist(),
            "effector": _mm(geometry.effector_radii).tolist(),
        },
        "placement": {"x": to_mm(placement.x), "y": to_mm(placement.y), "rotation": placement.rotation},
    }


def _corners(joints: Array) -> Array:
    """The triangle whose sides touch the joints' axes, (3, 2) m; the joints lie about the origin."""
    sides, far = np.roll(joints, 1, axis=0), np.sum(joints**2, axis=1)
    if not np.all(np.abs(np.linalg.det(np.stack([joints, sides], axis=1))) > _FLAT * far.max()):
        return joints
    return np.linalg.solve(
        np.stack([joints, sides], axis=1), np.stack([far, np.roll(far, 1)], axis=1)[:, :, np.newaxis]
    )[:, :, 0]


def _pressure(robot: Robot, sheet: Array) -> list[Json]:
    """Lines of equal pressure angle over the sheet; none where the arms do not reach all of it."""
    (left, bottom), (right, top) = sheet.min(axis=0), sheet.max(axis=0)
    x, y = np.linspace(left, right, _GRID), np.linspace(bottom, top, _GRID)
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    on = robot.workspace.excess(places) == 0.0
    points = np.column_stack([places[on], np.full(on.sum(), robot.workspace.sheet_z)])
    try:
        angle = np.degrees(np.maximum(*robot.pressure_angles(points)).max(axis=1))
    except RobotError:
        return []
    step = next((size for size in (1.0, 2.0, 5.0) if np.ptp(angle) < _LEVELS * size), 10.0)
    field = np.full(len(places), np.nan)
    field[on] = angle
    rows = field.round(2).astype(object)
    rows[~on] = None
    return [
        {
            "type": "contour",
            "x": _mm(x).round(3).tolist(),
            "y": _mm(y).round(3).tolist(),
            "z": rows.reshape(-1, _GRID).tolist(),
            "autocontour": False,
            "showscale": False,
            "line": {"color": palette.ZERO.light, "width": 1},
            "contours": {
                "start": float(np.ceil(angle.min() / step) * step),
                "end": float(angle.max()),
                "size": step,
                "coloring": "none",
                "showlabels": True,
                "labelfont": {"size": 10, "color": palette.TEXT.light},
                "labelformat": ".0f",
            },
        }
    ]


def _outlines(drawing: Drawing | None, view: View) -> list[Array]:
    """The contours as lines in the sheet frame, (K, 2) m each."""
    found = []
    for contour in drawing.contours if drawing else ():
        points = curves.flatten(contour.curve, view.error)[0]
        found.append(_closed(points) if contour.curve.closed else points)
    return thin_lines(found, _COARSE * view.error) if found else []


def _to_base(evidence: Evidence, points: Array) -> Array:
    placement = evidence.program.placement
    cos, sin = np.cos(placement.rotation), np.sin(placement.rotation)
    return np.asarray(points @ np.array([[cos, sin], [-sin, cos]]) + (placement.x, placement.y))


def _box(points: Array) -> Array:
    (left, bottom), (right, top) = points.min(axis=0), points.max(axis=0)
    return np.array([[left, bottom], [right, bottom], [right, top], [left, top], [left, bottom]])


def _closed(points: Array) -> Array:
    return np.concatenate([points, points[:1]])


def _mm(metres: Array) -> Array:
    return np.asarray(to_mm(1.0) * metres)
