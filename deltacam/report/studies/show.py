"""What ``deltacam robot show`` shows."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, Final

import numpy as np

from deltacam.model import Array
from deltacam.report.charts import heat_map
from deltacam.report.study import Chart, Study, Table
from deltacam.report.view import sheet_edge
from deltacam.robot.dimensions import HANGING
from deltacam.robot.rating import (
    Extreme,
    Rating,
    acceleration_allowed,
    acceleration_needed,
    speed_allowed,
    speed_needed,
)
from deltacam.robot.robot import Robot
from deltacam.units import to_mm

GRID: Final = 61  # places per side of a map
_DEGREES: Final = 180.0 / math.pi


def study(robot: Robot, rating: Rating) -> Study:
    """The study of a robot's rating over its sheet."""
    return Study(
        title=f"robot {robot.name}" + (f": {robot.description}" if robot.description else ""),
        facts=(*_geometry(robot), *_machine(robot), *_poses(rating)),
        tables=(_joints(robot, rating), _tool(robot, rating)),
        charts=_charts(robot, rating),
        notes=_notes(robot, rating),
        data=_data(robot, rating),
    )


def _geometry(robot: Robot) -> list[tuple[str, str]]:
    geometry, mount = robot.geometry, robot.geometry.mount
    facts = [
        ("base radius", _lengths(geometry.base_radius)),
        ("effector radius", _lengths(geometry.effector_radius)),
        ("upper arm", _lengths(geometry.upper_arm)),
        ("forearm", _lengths(geometry.forearm)),
        ("azimuths", ", ".join(f"{angle * _DEGREES:g}" for angle in geometry.azimuths) + " deg"),
    ]
    if mount != HANGING:
        place = ", ".join(f"{to_mm(value):g}" for value in (mount.x, mount.y, mount.z))
        turned = f", turned {mount.rotation * _DEGREES:g} deg" if mount.rotation else ""
        facts.append(("mount", f"base at ({place}) mm{turned}{', upside down' if mount.upside_down else ''}"))
    return facts


def _machine(robot: Robot) -> list[tuple[str, str]]:
    sheet, controller = robot.workspace, robot.controller
    if sheet.radius is not None:
        size = f"disc of {to_mm(2.0 * sheet.radius):g} mm"
    else:
        size = f"{to_mm(sheet.width or 0.0):g} x {to_mm(sheet.depth or 0.0):g} mm"
    tool = robot.tool
    return [
        ("sheet", f"{size} at z = {to_mm(sheet.sheet_z):g} mm"),
        ("tool rating", f"{tool.max_speed * 60.0:g} m/min, {tool.max_acceleration:g} m/s2"),
        ("controller", f"{controller.rate_hz:g} Hz, {controller.interpolation}"),
        ("source", robot.source or "not stated"),
    ]


def _poses(rating: Rating) -> list[tuple[str, str]]:
    (mu1, at1), (mu2, at2) = rating.pressure_angles
    value, where = rating.inverse_condition
    return [
        ("pressure angles", f"mu1 {mu1 * _DEGREES:.2f} deg {_at(at1)}, mu2 {mu2 * _DEGREES:.2f} deg {_at(at2)}"),
        ("condition", f"{1.0 / value:.3f} at worst (1/cond {value:.3f}) {_at(where)}"),
    ]


def _joints(robot: Robot, rating: Rating) -> Table:
    """One row per limit: its values, where they come from, what the rated tool needs."""
    joints = robot.joints
    low, high = rating.angles * _DEGREES
    jerk = "none" if joints.max_jerk is None else _angles(joints.max_jerk)

    def origin(name: str) -> str:
        return "derived from the tool" if name in joints.derived else "robot file"

    rows = (
        ("smallest angle, deg", _angles(joints.min), "robot file", f"{low.min():.2f}", "", ""),
        ("largest angle, deg", _angles(joints.max), "robot file", f"{high.max():.2f}", "", ""),
        ("speed, deg/s", _angles(joints.max_speed), origin("max_speed"), *_needed(rating.speed_needed)),
        (
            "acceleration, deg/s2",
            _angles(joints.max_acceleration),
            origin("max_acceleration"),
            *_needed(rating.acceleration_needed),
        ),
        ("jerk, deg/s3", jerk, "robot file", "", "", ""),
    )
    heads = ("joints", "limit", "from", "needed by the rated tool", "joint", "with the tool at, mm")
    return Table("limits of the joints, and what the rated tool needs over the sheet", heads, rows)


def _tool(robot: Robot, rating: Rating) -> Table:
    tool = robot.tool
    rows = (
        ("speed, m/min", f"{tool.max_speed * 60.0:g}", *_allowed(rating.speed_allowed, 60.0)),
        ("acceleration from rest, m/s2", f"{tool.max_acceleration:g}", *_allowed(rating.acceleration_from_rest)),
        ("acceleration at rated speed, m/s2", f"{tool.max_acceleration:g}", *_allowed(rating.acceleration_at_speed)),
    )
    heads = ("tool", "rating", "allowed everywhere", "joint that binds", "with the tool at, mm")
    return Table("what the joints allow the tool in any direction, everywhere on the sheet", heads, rows)


def _needed(extreme: Extreme) -> tuple[str, str, str]:
    return f"{extreme.value * _DEGREES:.5g}", str(extreme.joint + 1), _place(extreme.point)


def _allowed(extreme: Extreme, factor: float = 1.0) -> tuple[str, str, str]:
    return f"{extreme.value * factor:.4g}", str(extreme.joint + 1), _place(extreme.point)


def _notes(robot: Robot, rating: Rating) -> tuple[str, ...]:
    notes = []
    if rating.acceleration_at_speed.value < robot.tool.max_acceleration * (1.0 - 1e-9):
        notes.append("the joints do not allow the rated acceleration at the rated speed everywhere; the planner slows")
    if rating.speed_allowed.value < robot.tool.max_speed * (1.0 - 1e-9):
        notes.append("the joints do not allow the rated speed everywhere; the planner slows down there")
    return tuple(notes)


def _charts(robot: Robot, rating: Rating) -> tuple[Chart, ...]:
    def chart(heading: str, caption: str, unit: str, values: Callable[[Array], Array], worst: Extreme) -> Chart:
        x, y, field = _field(robot, values)
        x_mm, y_mm, _ = to_mm(1.0) * worst.point
        edge = sheet_edge(robot.workspace)
        outline = to_mm(1.0) * np.vstack([edge, edge[:1]])
        mark = (float(x_mm), float(y_mm), f"joint {worst.joint + 1}")
        return heat_map(heading, caption, x_mm=x, y_mm=y, values=field, unit=unit, marks=[mark], outlines=[outline])

    speed = robot.tool.max_speed
    return (
        chart(
            "joint speed that the rated tool needs",
            "The largest of the three joints, in the tool direction that needs most. The mark is the worst place.",
            "deg/s",
            lambda points: speed_needed(robot, points).max(axis=1) * _DEGREES,
            rating.speed_needed,
        ),
        chart(
            "joint acceleration that the rated tool needs",
            "At the rated acceleration and the rated speed at once, in the two directions that need most.",
            "deg/s2",
            lambda points: acceleration_needed(robot, points).max(axis=1) * _DEGREES,
            rating.acceleration_needed,
        ),
        chart(
            "tool speed that the joints allow",
            "In any direction of the sheet's plane. The mark is where it is least.",
            "m/min",
            lambda points: speed_allowed(robot, points).min(axis=1) * 60.0,
            rating.speed_allowed,
        ),
        chart(
            "tool acceleration that the joints allow at the rated speed",
            "In any two directions of speed and acceleration. The mark is where it is least.",
            "m/s2",
            lambda points: acceleration_allowed(robot, points, speed=speed).min(axis=1),
            rating.acceleration_at_speed,
        ),
    )


def _field(robot: Robot, values: Callable[[Array], Array]) -> tuple[Array, Array, Array]:
    """A field over the sheet: x (K,) mm, y (L,) mm, values (L, K), nan beside the sheet."""
    edge = sheet_edge(robot.workspace)
    x, y = (np.linspace(low, high, GRID) for low, high in zip(edge.min(axis=0), edge.max(axis=0), strict=True))
    places = np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2)
    on = robot.workspace.excess(places) <= 1e-12
    field = np.full(len(places), np.nan)
    field[on] = values(np.column_stack([places[on], np.full(on.sum(), robot.workspace.sheet_z)]))
    return to_mm(1.0) * x, to_mm(1.0) * y, field.reshape(GRID, GRID)


def _data(robot: Robot, rating: Rating) -> dict[str, Any]:
    (mu1, at1), (mu2, at2) = rating.pressure_angles
    value, where = rating.inverse_condition
    return {
        "name": robot.name,
        "description": robot.description,
        "source": robot.source,
        "fingerprint": robot.fingerprint,
        "robot": robot.motion_values(),
        "derived_joint_limits": list(robot.joints.derived),
        "joint_angles_deg": {
            "min": (rating.angles[0] * _DEGREES).tolist(),
            "max": (rating.angles[1] * _DEGREES).tolist(),
        },
        "joint_speed_needed": _extreme(rating.speed_needed, "deg_s", _DEGREES),
        "joint_acceleration_needed": _extreme(rating.acceleration_needed, "deg_s2", _DEGREES),
        "tool_speed_allowed": _extreme(rating.speed_allowed, "m_s"),
        "tool_acceleration_allowed_from_rest": _extreme(rating.acceleration_from_rest, "m_s2"),
        "tool_acceleration_allowed_at_rated_speed": _extreme(rating.acceleration_at_speed, "m_s2"),
        "mu1": {"worst_deg": mu1 * _DEGREES, "at_mm": _listed(at1)},
        "mu2": {"worst_deg": mu2 * _DEGREES, "at_mm": _listed(at2)},
        "inverse_condition": {"worst": value, "at_mm": _listed(where)},
    }


def _extreme(extreme: Extreme, unit: str, factor: float = 1.0) -> dict[str, Any]:
    return {
        f"worst_{unit}": extreme.value * factor,
        "joint": extreme.joint + 1,
        "at_mm": _listed(extreme.point),
    }


def _listed(point: Array) -> list[float]:
    return [float(value) for value in to_mm(1.0) * point]


def _place(point: Array) -> str:
    return "({:.1f}, {:.1f})".format(*(to_mm(1.0) * point[:2] + 0.0))


def _at(point: Array) -> str:
    return f"at {_place(point)} mm"


def _lengths(value: float | tuple[float, ...]) -> str:
    values = value if isinstance(value, tuple) else (value,)
    return ", ".join(f"{to_mm(one):.6g}" for one in values) + " mm"


def _angles(values: tuple[float, ...]) -> str:
    """One number where the joints are alike, else three."""
    shown = values[:1] if values.count(values[0]) == len(values) else values
    return ", ".join(f"{value * _DEGREES:.5g}" for value in shown)
