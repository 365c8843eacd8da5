"""The charts: the nearest limit, the tool and the joints over time, the deviation over the length that is worked."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, NamedTuple

import numpy as np

from deltacam.model import Array
from deltacam.report import palette
from deltacam.report.figures import Json, axis, layout
from deltacam.report.motion import Motion
from deltacam.robot.robot import Robot
from deltacam.units import to_mm, to_um
from deltacam.verification.evidence import Evidence

_GAP: Final = 30.0  # pixels between two rows, for their headings
_TOP, _BOTTOM = 46.0, 40.0
_CUT_OFF: Final = 2.0  # times the limit: what is beyond is not in the picture until it is zoomed
_MARGIN: Final = {"l": 52, "r": 14, "t": _TOP, "b": _BOTTOM}


class Line(NamedTuple):
    """One line of a row: the series, of which joint if any, its colour and its largest value."""

    series: str
    ink: palette.Ink
    worst: float


class Row(NamedTuple):
    """One row of the charts.

    Attributes:
        title: with the unit.
        note: to the right of it.
        height: pixels.
        lines: what is drawn in it.
        limits: each with its colour.
        low: the lower end of the range where it is not that of the limits.
        high: the upper end, likewise.
        ticks: how numbers beside it are written, as d3 formats them.
    """

    title: str
    note: str
    height: float
    lines: Sequence[Line]
    limits: Sequence[tuple[float, palette.Ink]]
    low: float | None = None
    high: float | None = None
    ticks: str = "~s"


def motion_figure(evidence: Evidence, motion: Motion, energy: Array | None = None) -> Json:
    """The rows of the charts over time, the nearest limit first.

    Args:
        evidence: of the program.
        motion: of the same.
        energy: the energy of the millimetre about every tick, (N,) times that at the feed; None where nothing is cut.

    Returns:
        ``layout``; ``height`` in pixels; ``lines``: which series is drawn against which axis, and how; ``strip``: the
        axis of the nearest limit.
    """
    rows = [Row("Nearest limit, % used", "", 58.0, [], [(100.0, palette.LIMIT)], 0.0)]
    if len(motion.speed):
        rows.append(_tool(evidence, motion))
    if energy is not None:
        rows += _laser(evidence, energy)
    rows += _joints(evidence.robot, motion)
    end = max(evidence.program.duration, 1.0 / evidence.rate)
    return _stacked(rows, "time, s", end)


def deviation_figure(deviation: Array, limit: float, length: float) -> Json:
    """The deviation (N,) m with its ``limit`` m over the ``length`` m that is worked."""
    worst = to_um(float(np.fmax.reduce(deviation, initial=0.0)))
    line = Line("deviation", palette.TOOL, worst)
    note = f"{worst:.3g} of {to_um(limit):.3g}"
    row = Row("Deviation, µm", note, 170.0, [line], [(to_um(limit), palette.LIMIT)], 0.0)
    return _stacked([row], "length cut and engraved, mm", max(to_mm(length), 1e-3))


def _tool(evidence: Evidence, motion: Motion) -> Row:
    limit, feed = to_mm(evidence.robot.tool.max_speed), to_mm(evidence.program.process.feed)
    worst = to_mm(float(motion.speed.max()))
    limits = [(limit, palette.LIMIT), (feed, palette.BINDING[0])]
    note = f"{worst:.4g} of {limit:.4g}"
    return Row("Tool speed, mm/s", note, 110.0, [Line("speed", palette.TOOL, worst)], limits, 0.0)


def _laser(evidence: Evidence, energy: Array) -> list[Row]:
    power, most = 100.0 * float(evidence.program.power.max()), float(np.nanmax(energy))
    usual = [(1.0, palette.ZERO)]
    note = f"{float(np.nanmin(energy)):.3g} to {most:.3g}"
    title = "Energy per mm, times that at the feed"
    rows = [Row(title, note, 80.0, [Line("energy", palette.TOOL, most)], usual, 0.0, high=most, ticks="~g")]
    if evidence.program.process.power_law is not None:
        rows.append(Row("Laser power, %", "", 60.0, [Line("power", palette.TOOL, power)], [], 0.0))
    return rows


def _joints(robot: Robot, motion: Motion) -> list[Row]:
    joints = robot.joints
    quantities = (
        ("Joint angle, °", "angle", joints.min, joints.max),
        ("Joint speed, °/s", "joint speed", None, joints.max_speed),
        ("Joint acceleration, °/s²", "joint acceleration", None, joints.max_acceleration),
        ("Joint jerk, °/s³", "joint jerk", None, joints.max_jerk),
    )
    rows = []
    for (title, series, low, high), values in zip(quantities, motion.joints, strict=True):
        worst = np.abs(values).max(axis=1)
        lines = [Line(f"{series} {i + 1}", palette.JOINTS[i], float(np.degrees(worst[i]))) for i in range(3)]
        lows = low or (None if high is None else tuple(-value for value in high))
        limits = [*_limits(lows), *_limits(high)]
        note = "no limit" if high is None else "" if low else _shares(worst / np.array(high))
        rows.append(Row(title, note, 110.0, lines, limits))
    return rows


def _limits(values: Sequence[float] | None) -> list[tuple[float, palette.Ink]]:
    """One line where the joints agree, else one in the colour of each joint."""
    if values is None:
        return []
    if len(set(values)) == 1:
        return [(float(np.degrees(values[0])), palette.LIMIT)]
    return [(float(np.degrees(value)), ink) for value, ink in zip(values, palette.JOINTS, strict=True)]


def _shares(shares: Array) -> str:
    """How much each joint uses of its limit, in its colour."""
    words = (
        f'<span style="color:{ink.light}">{100 * share:.0f}</span>'
        for ink, share in zip(palette.JOINTS, shares.tolist(), strict=True)
    )
    return f"{' · '.join(words)} %"


def _stacked(rows: Sequence[Row], title: str, end: float) -> Json:
    """Rows above each other with one axis of ``title`` from 0 to ``end``."""
    inner = sum(row.height for row in rows) + _GAP * (len(rows) - 1)
    figure = layout(
        margin=_MARGIN,
        dragmode="zoom",
        xaxis=axis(range=[0.0, end], title={"text": title, "standoff": 6}, anchor=_name(len(rows) - 1, "y"), nticks=10),
        annotations=[],
        shapes=[],
    )
    top, drawn = inner, []
    for index, row in enumerate(rows):
        domain = [(top - row.height) / inner, top / inner]
        figure[_name(index, "yaxis")] = axis(
            range=_range(row), domain=domain, nticks=5, tickformat=row.ticks, anchor="x"
        )
        figure["shapes"] += [_level(index, value, ink) for value, ink in row.limits]
        figure["annotations"] += [_word(row.title, 0, domain[1], strong=True), _word(row.note, 1, domain[1])]
        drawn += [{"series": one.series, "axis": _name(index, "y"), "color": one.ink.light} for one in row.lines]
        top -= row.height + _GAP
    return {"layout": figure, "height": inner + _TOP + _BOTTOM, "lines": drawn}


def _name(index: int, of: str) -> str:
    """How plotly.js numbers axes: y, y2, y3."""
    return of if index == 0 else f"{of}{index + 1}"


def _range(row: Row) -> list[float]:
    """From the lowest limit or value to the highest, with some room; what is far beyond the limits is left out."""
    bounds = [value for value, _ in row.limits]
    worst = max((line.worst for line in row.lines), default=0.0)
    far = max(map(abs, bounds), default=worst)
    reach = min(worst, _CUT_OFF * far)
    high = max([reach, *bounds]) if row.high is None else max(row.high, *bounds)
    low = row.low if row.low is not None else min([-reach, *bounds])
    room = 0.08 * max(high - low, 1e-9)
    return [low if row.low is not None else low - room, high + room]


def _level(index: int, value: float, ink: palette.Ink) -> Json:
    return {
        "type": "line",
        "xref": "paper",
        "x0": 0,
        "x1": 1,
        "yref": _name(index, "y"),
        "y0": value,
        "y1": value,
        "line": {"color": ink.light, "width": 1, "dash": "5px,4px"},
    }


def _word(text: str, side: int, height: float, *, strong: bool = False) -> Json:
    """Words above the left (0) or the right (1) end of a row."""
    ink, weight = (palette.STRONG, 600) if strong else (palette.TEXT, 400)
    return {
        "text": text,
        "xref": "paper",
        "yref": "paper",
        "x": side,
        "y": height,
        "xanchor": ("left", "right")[side],
        "yanchor": "bottom",
        "yshift": 1,
        "showarrow": False,
        "font": {"size": 12, "color": ink.light, "weight": weight},
    }
