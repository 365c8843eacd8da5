"""Where a part is best placed, as a study."""

from __future__ import annotations

from typing import Any, Final

import numpy as np

from deltacam.model import Array
from deltacam.placing.find import Candidate, Found
from deltacam.report.charts import heat_map, line_chart
from deltacam.report.study import Chart, Study, Table
from deltacam.robot.robot import Robot
from deltacam.units import to_mm

_WISHES: Final = {
    "both": "time and accuracy, each as a share of that at the centre",
    "time": "time",
    "accuracy": "accuracy",
}
_SMALL: Final = 5e-3
_UM_PER_MRAD: Final = 1e3  # by one metre per radian


def study(found: Found, *, robot: Robot, drawing: str) -> Study:
    """The study of what was found for a drawing, the name of a file, on a robot."""
    return Study(
        title=f"Where to place {drawing} on {robot.name}",
        facts=_facts(found, drawing),
        tables=(_table(found),),
        charts=_charts(found, robot),
        notes=_notes(found),
        data=_data(found, robot, drawing),
    )


def _facts(found: Found, drawing: str) -> tuple[tuple[str, str], ...]:
    best = found.best[0]
    facts = [
        ("best by", _WISHES[found.by]),
        ("best place", f"x {best.spot.x_mm} y {best.spot.y_mm} mm, turned by {best.spot.turn_deg} deg"),
        ("time", f"{best.time:.3f} s{_instead(found, 'time')}"),
        ("tool error", f"up to {_error(best.worst)} um per mrad of the joints{_instead(found, 'worst')}"),
        ("to plan there", f"deltacam plan {drawing} {best.spot.options}, with all other options as here"),
        ("looked at", f"{found.maps.estimated} places and turns estimated, {len(found.best)} planned"),
    ]
    return tuple(facts)


def _instead(found: Found, name: str) -> str:
    """What it is at the centre, and what is gained."""
    gain = found.gain(found.best[0])
    if found.centre is None or gain is None:
        return ""
    value = f"{found.centre.time:.3f} s" if name == "time" else f"{_error(found.centre.worst)} um"
    return f", {value} at the centre: {_percent(gain[0 if name == 'time' else 1])}"


def _percent(gain: float) -> str:
    return f"{100.0 * gain:.2f} % less" if gain > 0.0 else f"{-100.0 * gain:.2f} % more" if gain < 0.0 else "the same"


def _error(value: float) -> str:
    return f"{value * _UM_PER_MRAD:.1f}"


def _table(found: Found) -> Table:
    heads = (
        "--at, mm",
        "--rotate, deg",
        "time, s",
        "worst error, um/mrad",
        "rms error, um/mrad",
        "time",
        "worst error",
    )
    return Table("Planned places, the best first", heads, tuple(_row(found, one) for one in found.best))


def _row(found: Found, one: Candidate) -> tuple[str, ...]:
    gain = found.gain(one)
    gains = ("", "") if gain is None else ("the centre", "") if one == found.centre else tuple(map(_percent, gain))
    place = f"{one.spot.x_mm},{one.spot.y_mm}"
    return (place, one.spot.turn_deg, f"{one.time:.3f}", _error(one.worst), _error(one.rms), *gains)


def _notes(found: Found) -> tuple[str, ...]:
    notes = []
    if found.excess > 0.0:
        least = f"at the centre, unturned, the part leaves the sheet by {to_mm(found.excess):.3f} mm"
        if found.centre is None:
            notes.append(f"{least}, and it does not fit there however it is turned: there is no gain to compare with")
        else:
            notes.append(
                f"{least}; what is said of the centre is with the part turned by {found.centre.spot.turn_deg} deg"
            )
    gain = found.gain(found.best[0])
    if gain is not None and max(map(abs, gain)) < _SMALL:
        notes.append("the best place is less than 0.5 % better than the centre: this part may as well lie there")
    narrow = found.maps.excess_by_turn > 0.0
    if narrow.any():
        shares = f"{100.0 * float(np.mean(narrow)):.0f} % of all turns"
        notes.append(
            f"with {shares} the part fits nowhere, at worst by {to_mm(found.maps.excess_by_turn.max()):.3f} mm"
        )
    notes.append("the times of the places are planned; those in the maps are estimates, to compare places by")
    return tuple(notes)


def _charts(found: Found, robot: Robot) -> tuple[Chart, ...]:
    maps = found.maps
    marks = [(to_mm(one.spot.at[0]), to_mm(one.spot.at[1]), str(k)) for k, one in enumerate(found.best[:3], start=1)]
    common: dict[str, Any] = {"x_mm": to_mm(1.0) * maps.x, "y_mm": to_mm(1.0) * maps.y, "marks": tuple(marks)}
    common["outlines"] = (_outline(robot),)
    degrees = np.degrees(maps.turn)
    return (
        heat_map(
            "Time over the sheet",
            "Estimated, with the best turn at each place of the part's centre; 1 is the best place.",
            values=maps.time,
            unit="s",
            **common,
        ),
        heat_map(
            "Tool error over the sheet",
            "The worst along the cuts, by the error of the joints, with the best turn at each place.",
            values=maps.worst * _UM_PER_MRAD,
            unit="um/mrad",
            **common,
        ),
        line_chart(
            "Time by turn",
            "Estimated, at the best place.",
            x_title="turn, deg",
            y_title="time, s",
            lines=(("time", degrees, maps.time_by_turn),),
        ),
        line_chart(
            "Tool error by turn",
            "At the best place.",
            x_title="turn, deg",
            y_title="worst error, um/mrad",
            lines=(("worst error", degrees, maps.worst_by_turn * _UM_PER_MRAD),),
        ),
    )


def _outline(robot: Robot) -> Array:
    """The edge of the sheet, closed, (K, 2) mm."""
    sheet = robot.workspace
    if sheet.radius is not None:
        turn = np.linspace(0.0, 2.0 * np.pi, 91)
        return to_mm(sheet.radius) * np.column_stack([np.cos(turn), np.sin(turn)])
    corners = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0]])
    return np.asarray(0.5 * corners * [to_mm(sheet.width or 0.0), to_mm(sheet.depth or 0.0)])


def _data(found: Found, robot: Robot, drawing: str) -> dict[str, Any]:
    return {
        "drawing": drawing,
        "robot": robot.name,
        "by": found.by,
        "best": _candidate(found, found.best[0]),
        "centre": None if found.centre is None else _candidate(found, found.centre),
        "centre_excess_mm": to_mm(found.excess),
        "planned": [_candidate(found, one) for one in found.best],
        "estimated": found.maps.estimated,
        "plan": f"deltacam plan {drawing} {found.best[0].spot.options}",
    }


def _candidate(found: Found, one: Candidate) -> dict[str, Any]:
    gain = found.gain(one)
    return {
        "at_mm": [to_mm(value) for value in one.spot.at],
        "rotate_deg": float(one.spot.turn_deg),
        "time_s": one.time,
        "worst_error_um_per_mrad": one.worst * _UM_PER_MRAD,
        "rms_error_um_per_mrad": one.rms * _UM_PER_MRAD,
        "time_gain_percent": None if gain is None else 100.0 * gain[0],
        "error_gain_percent": None if gain is None else 100.0 * gain[1],
    }
