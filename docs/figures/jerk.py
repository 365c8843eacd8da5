"""Speed, acceleration and jerk of a joint along a rounded rectangle, without a limit of jerk and with one."""

from __future__ import annotations

from typing import Final

import numpy as np
from figures.chart import Axes, legend, picture
from figures.example import ACROSS, DEVIATION, JERK, LEFT, robot, rounded_rectangle

from deltacam.model import Array
from deltacam.motion.along import Along
from deltacam.motion.corners import pieces
from deltacam.motion.jerk import limited
from deltacam.motion.parametrize import solve
from deltacam.motion.route import Grid, Limits, Route
from deltacam.motion.rows import Rows, limits_at
from deltacam.motion.sample import sample

SIZE: Final = (0.06, 0.04, 0.008)
FEED: Final = 0.5
JOINT: Final = 1

_SHARES: Final = np.linspace(0.0, 1.0, 601)


_NAMES: Final = ("speed of joint 2, deg/s", "acceleration, 1000 deg/s²", "jerk, 1000 deg/s³")
_RANGES: Final = ((-110.0, 110.0), (-4.5, 4.5), (-1200.0, 1200.0))
_TICKS: Final = ([-100, -50, 0, 50, 100], [-4, -2, 0, 2, 4], [-1000, -500, 0, 500, 1000])


def draw() -> str:
    """The picture as SVG."""
    rough, smooth = _without(), _with()
    end = 0.05 * float(np.ceil(20.0 * max(rough[0][-1], smooth[0][-1])))
    ends, ticks = np.array([0.0, end]), [round(0.05 * number, 2) for number in range(round(20.0 * end) + 1)]
    limits = (None, float(np.degrees(robot().joints.max_acceleration[JOINT])), float(np.degrees(JERK)))
    parts = []
    for row, (name, scale, limit) in enumerate(zip(_NAMES, (1.0, 1e3, 1e3), limits, strict=True)):
        axes = Axes(LEFT, 40 + 190 * row, ACROSS, 140, (0, end), _RANGES[row])
        parts.append(axes.frame(ticks, _TICKS[row], y_name=name, x_name="time, s" if row == 2 else ""))
        sides = () if limit is None else (-limit / scale, limit / scale)
        parts += [axes.line(ends, np.full(2, side), "line", width=1.0, dashed=True) for side in sides]
        parts.append(axes.line(rough[0] if row < 2 else rough[4], rough[row + 1] / scale, "red", width=1.1))
        parts.append(axes.line(smooth[0], smooth[row + 1] / scale, "blue", width=1.5))
    parts.append(legend(LEFT, 612, [(f"no limit of jerk, {rough[0][-1]:.4f} s", "red", "line")]))
    parts.append(legend(LEFT + 215, 612, [(f"with the limit of delta-300, {smooth[0][-1]:.4f} s", "blue", "line")]))
    parts.append(legend(LEFT + 500, 612, [("limits", "line", "dashed")]))
    about = "Jerk without a limit is that of the setpoints, by third differences; between them it has no bound"
    return picture("A limit of jerk", about, 632, parts)


def _route(*, ramps: bool) -> Route:
    machine = robot()
    curve = rounded_rectangle(*SIZE)
    (path,) = pieces(curve, corner="round", deviation=DEVIATION, ramps=ramps, z=machine.workspace.sheet_z)
    return Route.of([(path, Limits(FEED, machine.tool.max_acceleration))])


def _without() -> tuple[Array, ...]:
    """Time, speed and acceleration of the joint, degrees; its jerk by differences of setpoints, and their times."""
    machine, route = robot(), _route(ramps=False)
    grid = Grid.over(route, machine)
    law = solve(grid, Rows.over(route, grid, machine))
    time = law.durations[0] * _SHARES
    interval = np.clip(np.searchsorted(law.time, time, side="right") - 1, 0, len(grid.segment) - 1)
    place = law.at(np.zeros_like(interval), time) - grid.distance[interval] + grid.start[interval]
    first, second, _, _ = limits_at(route, machine, grid.segment[interval], place)
    u = law.acceleration[interval]
    x = np.maximum(law.squared[interval] + 2.0 * u * (place - grid.start[interval]), 0.0)
    speed, change = first[:, JOINT] * np.sqrt(x), first[:, JOINT] * u + second[:, JOINT] * x
    (q,) = sample(route.path, law, machine)
    rate = machine.controller.rate_hz
    held = np.concatenate([q[:1], q[:1], q[:1], q, q[:1], q[:1], q[:1]])[:, JOINT]
    jerk = np.diff(held, n=3) * rate**3
    ticks = (np.arange(len(jerk)) - 1.5) / rate
    inside = (ticks >= 0.0) & (ticks <= law.durations[0])
    return time, np.degrees(speed), np.degrees(change), np.degrees(jerk[inside]), ticks[inside]


def _with() -> tuple[Array, ...]:
    """Time, speed, acceleration and jerk of the joint, degrees."""
    machine, route = robot(jerk=JERK), _route(ramps=True)
    grid = Grid.over(route, machine)
    tempo = limited(route, grid, Rows.over(route, grid, machine), machine, np.ones(len(grid.segment)))
    time, move = tempo.durations[0] * _SHARES, np.zeros(len(_SHARES), dtype=np.int64)
    along = Along.of(route, machine, tempo.motion(*tempo.locate(move, time)), move)
    return time, *(np.degrees(one[:, JOINT]) for one in along.joints)
