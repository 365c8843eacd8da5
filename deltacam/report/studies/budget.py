"""What ``deltacam robot budget`` shows."""

from __future__ import annotations

import math
from typing import Any, Final

from deltacam.model import Array
from deltacam.report.charts import heat_map
from deltacam.report.study import Chart, Study, Table
from deltacam.report.view import sheet_edge
from deltacam.robot.accuracy.budget import Budget, Contribution, Total, error_map
from deltacam.robot.accuracy.sources import ANGLES, WIDTHS, Source
from deltacam.robot.accuracy.wanted import Need, Needs
from deltacam.robot.robot import Robot
from deltacam.units import to_mm, to_um

GRID: Final = 61  # places per side of a map
_ARCMIN: Final = 60.0 * 180.0 / math.pi
_NAMES: Final = {
    Source.ENCODER: "encoder",
    Source.BACKLASH: "backlash",
    Source.UPPER_ARM: "upper arm",
    Source.FOREARM: "forearm",
    Source.BASE_RADIUS: "base radius",
    Source.EFFECTOR_RADIUS: "effector radius",
    Source.AZIMUTH: "azimuth of an arm",
    Source.SHEET: "height of the sheet",
}
_VIEWS: Final = {"in_plane": "x and y", "focus": "height above the sheet", "in_space": "both"}
_NOTES: Final = (
    "every error is uniform within its limits, and each arm has its own; what no option gave is assumed, not measured",
    "rms is the root mean square of the distance; 95 %: of the machines that were drawn, at each place",
    "at the bound every error is at the worse of its limits",
    "joints alone: encoder and backlash, which is what remains when a calibration has found all lengths",
    "x and y are of the place in the machine: a part keeps its size where all of it is shifted alike",
    "the head of a delta does not tilt: an error of the height of the sheet changes the focus, and x and y by nothing",
)


def study(robot: Robot, found: Budget, asked: Needs, *, process: str, kerf: float, tolerance: float) -> Study:
    """The study of an accuracy budget.

    Args:
        robot: whose it is.
        found: the budget.
        asked: what the errors must be for a wanted accuracy.
        process: its name.
        kerf: of the process, m.
        tolerance: of the process, m.
    """
    return Study(
        title=f"accuracy of {robot.name}",
        facts=_facts(found, asked, process=process, kerf=kerf, tolerance=tolerance),
        tables=(_sources(found), _totals(found), _needs(found, asked)),
        charts=_charts(robot, found),
        notes=_NOTES,
        data=_data(robot, found, asked, process=process, kerf=kerf, tolerance=tolerance),
    )


def _facts(found: Budget, asked: Needs, *, process: str, kerf: float, tolerance: float) -> tuple[tuple[str, str], ...]:
    total, largest = found.total("in_plane"), _largest(found)
    usual, part = total.usual[1], f"{100.0 * total.usual[1] / kerf:.0f} % of" if kerf > 0.0 else "no part of"
    within = "within" if usual <= tolerance else "NOT within"
    facts = [
        ("x and y", f"at each place of the sheet 95 % of such machines are within {_um(usual)} um"),
        ("tolerance", f"{within} the {_um(tolerance)} um of {process}"),
        ("kerf", f"that is {part} the {_um(kerf)} um of {process}"),
        ("height above the sheet", f"95 % within {_um(found.total('focus').usual[1])} um: an error of the focus"),
    ]
    if largest is not None:
        text = f"{_NAMES[largest.source]}: {100.0 * largest.share[0]:.0f} % of the mean square in x and y"
        facts.append(("largest source", f"{text} {_at(total.at)}"))
    if asked.factor is not None:
        facts.append((f"for {to_mm(asked.wanted):g} mm", f"all errors {asked.factor:.3g} times as large as assumed"))
    text = f"{found.draws} machines at {len(found.places)} places, seed {found.seed}"
    facts.append(("drawn", f"{text}; the closed form is within {100.0 * found.curvature:.2g} % of them"))
    return tuple(facts)


def _sources(found: Budget) -> Table:
    heads = ("source", "assumed", "x and y in the middle", "worst", "at, mm", "share", "height, worst", "share")
    rows = []
    for one in found.contributions:
        moves = one.worst[0] > 0.0
        middle, worst = (_um(one.centre[0]), _um(one.worst[0])) if moves else ("0", "0")
        where = _place(one.at[0]) if moves else ""
        share = (f"{100.0 * part:.1f} %" for part in one.share)
        given = _given(one.source, found.errors.given(one.source))
        rows.append((_NAMES[one.source], given, middle, worst, where, next(share), _um(one.worst[1]), next(share)))
    return Table("what each source does at the tool, um rms", heads, tuple(rows))


def _totals(found: Budget) -> Table:
    heads = ("error", "rms in the middle", "worst", "95 % in the middle", "worst", "joints alone", "bound")
    rows = tuple(
        (_VIEWS[total.view], *map(_um, (*total.rms, *total.usual, total.joints, total.bound[1])))
        for total in found.totals
    )
    return Table("what all sources do together, um", heads, rows)


def _needs(found: Budget, asked: Needs) -> Table:
    heads = ("source", "assumed", "if it were alone", "beside the others", "all by one factor", "equal parts")
    rows = tuple(
        (
            _NAMES[need.source],
            _given(need.source, found.errors.given(need.source)),
            _given(need.source, need.alone),
            "others too large" if need.beside_others is None else _given(need.source, need.beside_others),
            _given(need.source, need.scaled),
            _given(need.source, need.equal),
        )
        for need in asked.needs
    )
    return Table(f"what they must be for 95 % within {to_mm(asked.wanted):g} mm in x and y", heads, rows)


def _charts(robot: Robot, found: Budget) -> tuple[Chart, ...]:
    x, y, fields = error_map(robot, found.errors, GRID)
    edge = sheet_edge(robot.workspace) * 1e3
    return tuple(
        heat_map(
            heading,
            "Root mean square of all sources together, from the closed form. The cross is where it is largest.",
            x_mm=x * 1e3,
            y_mm=y * 1e3,
            values=fields[view] * 1e6,
            unit="um",
            marks=((*(found.total(view).at[:2] * 1e3).tolist(), f"{_um(found.total(view).rms[1])} um"),),
            outlines=(edge,),
        )
        for view, heading in (
            ("in_plane", "error in x and y over the sheet"),
            ("focus", "error of the height above the sheet"),
        )
    )


def _data(robot: Robot, found: Budget, asked: Needs, *, process: str, kerf: float, tolerance: float) -> dict[str, Any]:
    total = found.total("in_plane")
    return {
        "robot": robot.name,
        "process": {"name": process, "kerf_um": to_um(kerf), "tolerance_um": to_um(tolerance)},
        "within_tolerance": total.usual[1] <= tolerance,
        "bound_within_tolerance": total.bound[1] <= tolerance,
        "sources": [_source_data(found, one) for one in found.contributions],
        "totals": {one.view: _total_data(one) for one in found.totals},
        "draws": found.draws,
        "seed": found.seed,
        "closed_form_within_percent": 100.0 * found.curvature,
        "wanted": {
            "wanted_um": to_um(asked.wanted),
            "factor": asked.factor,
            "sources": [_need_data(need) for need in asked.needs],
        },
    }


def _source_data(found: Budget, one: Contribution) -> dict[str, Any]:
    key, value = _value(one.source, found.errors.given(one.source))
    return {
        "source": one.source.value,
        "given_as": "width" if one.source in WIDTHS else "limit",
        f"given_{key}": value,
        "rms_in_plane_middle_um": to_um(one.centre[0]),
        "rms_in_plane_worst_um": to_um(one.worst[0]),
        "in_plane_worst_at_mm": _listed(one.at[0]),
        "share_in_plane": one.share[0],
        "rms_focus_middle_um": to_um(one.centre[1]),
        "rms_focus_worst_um": to_um(one.worst[1]),
        "focus_worst_at_mm": _listed(one.at[1]),
        "share_focus": one.share[1],
    }


def _total_data(one: Total) -> dict[str, Any]:
    return {
        "rms_middle_um": to_um(one.rms[0]),
        "rms_worst_um": to_um(one.rms[1]),
        "rms_worst_at_mm": _listed(one.at),
        "within_95_percent_middle_um": to_um(one.usual[0]),
        "within_95_percent_worst_um": to_um(one.usual[1]),
        "joints_alone_within_95_percent_um": to_um(one.joints),
        "bound_middle_um": to_um(one.bound[0]),
        "bound_worst_um": to_um(one.bound[1]),
    }


def _need_data(need: Need) -> dict[str, Any]:
    found: dict[str, Any] = {"source": need.source.value}
    for name in ("alone", "beside_others", "scaled", "equal"):
        value = getattr(need, name)
        key, number = _value(need.source, value or 0.0)
        found[f"{name}_{key}"] = None if value is None else number
    return found


def _largest(found: Budget) -> Contribution | None:
    """The source with the largest share in x and y, if there is any error there."""
    top = max(found.contributions, key=lambda one: one.share[0])
    return top if top.share[0] > 0.0 else None


def _value(source: Source, value: float) -> tuple[str, float]:
    """The unit and the number in it."""
    return ("arcmin", value * _ARCMIN) if source in ANGLES else ("mm", to_mm(value))


def _given(source: Source, value: float) -> str:
    unit, number = _value(source, value)
    return f"{'' if source in WIDTHS else '+-'}{number:.3g} {unit}"


def _um(value: float) -> str:
    return f"{to_um(value):.1f}"


def _place(point: Array) -> str:
    x, y = (to_mm(value) + 0.0 for value in point[:2].round(6).tolist())
    return f"({x:g}, {y:g})"


def _at(point: Array) -> str:
    return f"at {_place(point)} mm"


def _listed(point: Array) -> list[float]:
    return [to_mm(value) + 0.0 for value in point.round(9).tolist()]
