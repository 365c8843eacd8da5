"""Naive use of toppra beside deltacam: the speed along a contour, and the shares of the limit of acceleration."""

from __future__ import annotations

from typing import Final

import numpy as np
from figures.chart import Axes, label, legend, picture
from figures.example import ACROSS, LEFT, outline

from benchmarks.naive import cases, shares
from benchmarks.ways import Case, Plan, deltacam, joints_on_grid, uniform
from deltacam.geometry import curve as curves
from deltacam.model import Array
from deltacam.robot.robot import Robot

NUMBER: Final = 3
"""Of the contour among those of the benchmark."""

_STRETCHES: Final = 450
_WIDTH: Final = 560.0


def draw() -> str:
    """The picture as SVG."""
    case = list(cases(NUMBER + 1, 0))[NUMBER]
    found = {"orange": uniform(case), "red": joints_on_grid(case), "blue": deltacam(case)}
    plans = {colour: plan for colour, plan in found.items() if plan is not None}
    length = plans["blue"].distance[-1] * 1e3
    speed = Axes(LEFT, 40, _WIDTH, 180, (0, length), (0, 0.25))
    share = Axes(LEFT, 286, ACROSS, 210, (0, length), (0, 2.25))
    ticks = list(range(0, int(length) + 1, 5))
    parts = [
        speed.marks(plans["blue"].breaks * 1e3),
        share.marks(plans["blue"].breaks * 1e3),
        speed.frame(ticks, [0, 0.05, 0.1, 0.15, 0.2, 0.25], y_name="speed of the tool, m/s", x_name="length, mm"),
        share.frame(
            ticks, [0, 0.5, 1, 1.5, 2], y_name="largest acceleration of a joint, over its limit", x_name="length, mm"
        ),
    ]
    for colour, plan in plans.items():
        at, value = _largest(plan, case.robot)
        if colour != "blue":
            parts.append(share.area(at, np.maximum(value, 1.0), 1.0, colour))
        parts += [_speed(plan, speed, colour), share.line(at, value, colour, width=1.3)]
    names = {"orange": "toppra, uniform grid", "red": "toppra, joints of the path on the grid", "blue": "deltacam"}
    for number, (colour, plan) in enumerate(plans.items()):
        name = f"{names[colour]}: {plan.duration:.3f} s"
        parts.append(legend(LEFT + (0, 235, 585)[number], 552, [(name, colour, "line")]))
    parts.append(_contour(case))
    about = f"Contour {NUMBER} of benchmarks/naive.py, weak joints; dotted where the curvature jumps"
    return picture("Naive use of toppra, and deltacam", about, 574, parts)


def _largest(plan: Plan, machine: Robot) -> tuple[Array, Array]:
    """The largest share in each of some stretches of the contour, with where they are, mm."""
    place, value = shares(plan, machine)
    edges = np.linspace(0.0, plan.distance[-1], _STRETCHES + 1)
    into = np.clip(np.searchsorted(edges, place, side="right") - 1, 0, _STRETCHES - 1)
    most = np.zeros(_STRETCHES)
    np.maximum.at(most, into, value)
    middle = 0.5 * (edges[:-1] + edges[1:])
    seen = most > 0.0
    return middle * 1e3, np.interp(middle, middle[seen], most[seen])


def _speed(plan: Plan, axes: Axes, colour: str) -> str:
    at = np.linspace(0.0, plan.distance[-1], 301)
    return axes.line(at * 1e3, np.sqrt(np.interp(at, plan.distance, plan.speed**2)), colour)


def _contour(case: Case) -> str:
    """The contour beside the speed, with a dot at every joint."""
    points = outline(case.smooth) * 1e3
    middle, size = 0.5 * (points.min(axis=0) + points.max(axis=0)), float(np.ptp(points, axis=0).max())
    half = 0.55 * size
    axes = Axes(
        LEFT + _WIDTH + 45, 25, 200, 200, (middle[0] - half, middle[0] + half), (middle[1] - half, middle[1] + half)
    )
    dots = "".join(
        f'<circle cx="{x:.1f}" cy="{y:.1f}" r="2.2" fill="var(--line)"/>'
        for x, y in axes.pixels(*(case.smooth.points * 1e3).T)
    )
    caption = f"the contour, {curves.length(case.smooth) * 1e3:.1f} mm around"
    return axes.line(*points.T, "ink", width=1.4) + dots + label(axes.left + 100, 240, caption, anchor="middle")
