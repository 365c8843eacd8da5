"""Robots side by side as a study."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, Final

from deltacam.report.charts import scatter_chart
from deltacam.report.study import Study, Table
from deltacam.robot.comparison import Outcome, Profile
from deltacam.robot.producers import UNITS, Produced

_MISSING: Final = "-"
_ERROR: Final = "tool error per arcmin, um"

_PUBLISHED: Final = {
    "workspace diameter, mm": ("workspace_diameter", 1e3),
    "payload, kg": ("payload", 1.0),
    "repeatability, mm": ("repeatability", 1e3),
    "speed, m/s": ("speed", 1.0),
    "acceleration, m/s2": ("acceleration", 1.0),
    "cycle, s": ("cycle", 1.0),
}
"""The columns of the table of producers: the quantity, and the factor from SI."""


def study_of_outcomes(drawing: str, outcomes: Sequence[Outcome]) -> Study:
    """What every robot makes of a drawing.

    Args:
        drawing: its name.
        outcomes: one per robot.
    """
    heads = ("robot", "fits", "passed", "centre at, mm", "turned, deg", "time, s", "laser on, s", "binds most", _ERROR)
    planned = [one for one in outcomes if one.duration is not None and one.error is not None]
    chart = scatter_chart(
        "Time and accuracy",
        "Towards the lower left corner is faster and more exact.",
        x_title="time, s",
        y_title=_ERROR,
        points=[(one.name, [one.duration or 0.0], [1e6 * (one.error or 0.0)], [one.name]) for one in planned],
    )
    return Study(
        title=f"{drawing} on {len(outcomes)} robots",
        facts=(("planned and verified", f"{sum(one.passed for one in outcomes)} of {len(outcomes)} robots"),),
        tables=(Table("Robots", heads, tuple(_row(one) for one in outcomes)),),
        charts=(chart,) if planned else (),
        notes=tuple(f"{one.name}: {one.reason}" for one in outcomes if one.reason),
        data={"drawing": drawing, "robots": [_data(one) for one in outcomes]},
    )


def study_of_robots(profiles: Sequence[Profile], producers: Sequence[Produced]) -> Study:
    """The robots with their geometry, and what producers publish.

    Args:
        profiles: robots that can be planned for.
        producers: the table of producers.
    """
    sizes = ("robot", "R - r, mm", "upper arm, mm", "forearm, mm", "sheet, mm", "joint speed, deg/s", "limits")
    heads = (*sizes, "condition", "pressure, deg", _ERROR)
    return Study(
        title="Delta robots side by side",
        facts=(("built-in or given", f"{len(profiles)} robots"), ("published", f"{len(producers)} robots")),
        tables=(
            Table("Robots that can be planned for", heads, tuple(_figures(one) for one in profiles)),
            Table("Robots as published", ("maker", "model", *_PUBLISHED, "grade"), tuple(map(_published, producers))),
        ),
        notes=tuple(f"{one.name}: {one.robot.source}" for one in profiles if one.robot.source),
        data={"robots": [_profile_data(one) for one in profiles], "producers": [_produced(one) for one in producers]},
    )


def _row(one: Outcome) -> tuple[str, ...]:
    limit = f"{one.binds[0][0]} {100.0 * one.binds[0][1]:.0f} %" if one.binds else _MISSING
    place = _MISSING if one.at is None else ", ".join(f"{1e3 * value:g}" for value in one.at)
    turned = None if one.rotation is None else math.degrees(one.rotation)
    numbers = (place, _number(turned, "g"), _number(one.duration, ".3f"), _number(one.laser, ".3f"))
    error = _number(None if one.error is None else 1e6 * one.error, ".1f")
    return (one.name, _yes(one.fits), _yes(one.passed), *numbers, limit, error)


def _figures(one: Profile) -> tuple[str, ...]:
    robot = one.robot
    geometry = robot.geometry
    lengths = (geometry.offsets, geometry.upper_arms, geometry.forearms)
    sheet = robot.workspace
    size = (
        f"diameter {2e3 * sheet.radius:g}"
        if sheet.radius is not None
        else f"{1e3 * (sheet.width or 0.0):g} x {1e3 * (sheet.depth or 0.0):g}"
    )
    return (
        one.name,
        *("/".join(dict.fromkeys(f"{1e3 * float(value):.1f}" for value in values)) for values in lengths),
        size,
        f"{math.degrees(min(robot.joints.max_speed)):.0f}",
        "derived" if robot.joints.derived else "given",
        f"{one.condition:.2f}",
        f"{math.degrees(one.pressure):.1f}",
        f"{1e6 * one.error:.1f}",
    )


def _published(one: Produced) -> tuple[str, ...]:
    values = ((getattr(one, quantity), factor) for quantity, factor in _PUBLISHED.values())
    shown = (_MISSING if value is None else f"{value * factor:g}" for value, factor in values)
    return (one.maker, one.model, *shown, one.grade)


def _data(one: Outcome) -> dict[str, Any]:
    return {
        "robot": one.name,
        "fits": one.fits,
        "passed": one.passed,
        "reason": one.reason,
        "at_mm": None if one.at is None else [1e3 * value for value in one.at],
        "rotation_deg": None if one.rotation is None else math.degrees(one.rotation),
        "duration_s": one.duration,
        "laser_on_s": one.laser,
        "binds_share": dict(one.binds),
        "tool_error_per_arcmin_um": None if one.error is None else 1e6 * one.error,
    }


def _profile_data(one: Profile) -> dict[str, Any]:
    return {
        "robot": one.name,
        "source": one.robot.source,
        "sheet_inscribed_diameter_mm": 1e3 * one.reach,
        "worst_condition": one.condition,
        "worst_pressure_angle_deg": math.degrees(one.pressure),
        "tool_error_per_arcmin_um": 1e6 * one.error,
        "derived_joint_limits": list(one.robot.joints.derived),
    }


def _produced(one: Produced) -> dict[str, Any]:
    found: dict[str, Any] = {quantity: getattr(one, quantity) for quantity in UNITS}
    return {"maker": one.maker, "model": one.model, "grade": one.grade, "source": one.source, "si": found}


def _number(value: float | None, form: str) -> str:
    return _MISSING if value is None else format(value, form)


def _yes(value: bool) -> str:
    return "yes" if value else "no"
