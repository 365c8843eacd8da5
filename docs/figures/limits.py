"""The squared speed along a contour, what bounds it, and which limit binds where."""

from __future__ import annotations

from typing import Final

import numpy as np
from figures.chart import Axes, legend, picture
from figures.example import ACROSS, LEFT, robot

from benchmarks.ways import round_corners
from deltacam.geometry import curve as curves
from deltacam.model import Array, IntArray
from deltacam.motion.corners import pieces
from deltacam.motion.law import TimeLaw
from deltacam.motion.parametrize import solve
from deltacam.motion.route import Grid, Limits, Route
from deltacam.motion.rows import STATIONS, Rows

CORNERS: Final = ((-30, -15), (24, -20), (30, 8), (6, 2), (-8, 20), (-26, 14))
"""Of the contour, mm."""

ROOM: Final = (6, 4, 8, 11.3, 11.3, 5)
"""How far from them arcs begin, mm."""

PLACE: Final = (0.09, 0.05)
FEED: Final = 0.6
CHORD: Final = 16e-6

_COLOURS: Final = ("", "teal", "pink", "blue", "orange", "purple")
_NAMES: Final = ("feed", "chord tolerance", "acceleration of the tool", "of a joint", "of both")
_BINDS: Final = 0.99
_HIGHEST: Final = 0.5


def draw() -> str:
    """The picture as SVG."""
    machine = robot(acceleration=0.7)
    contour = round_corners(np.array(CORNERS) * 1e-3, np.array(ROOM) * 1e-3)
    curve = curves.transform(contour, shift=PLACE)
    (path,) = pieces(curve, corner="round", deviation=0.0, ramps=False, z=machine.workspace.sheet_z)
    route = Route.of([(path, Limits(FEED, machine.tool.max_acceleration, CHORD))])
    grid = Grid.over(route, machine)
    rows = Rows.over(route, grid, machine)
    law = solve(grid, rows)
    length = path.total * 1e3
    axes = Axes(LEFT, 40, ACROSS, 320, (0, length), (0, _HIGHEST))
    parts = _bands(axes, grid, _binding(rows, law))
    parts.append(axes.frame(list(range(0, int(length) + 1, 20)), [0, 0.1, 0.2, 0.3, 0.4, 0.5], x_name="length, mm"))
    parts.append(axes.frame([], [], y_name="squared speed x, m²/s²"))
    steady = (rows.bound[1], "pink"), (1.0 / np.maximum(rows.across[1], 1e-9), "blue")
    joints = 1.0 / np.maximum(np.abs(rows.joint_b[1]).max(axis=1), 1e-9)
    at = 0.5e3 * (grid.distance[:-1] + grid.distance[1:])
    shown = _spread(at)
    for bound, colour in (*steady, (joints, "orange")):
        parts.append(axes.line(at[shown], np.minimum(bound[shown], 1.0), colour, dashed=True))
    knots = np.append(shown, len(grid.distance) - 1)
    parts.append(axes.line(grid.distance[knots] * 1e3, law.squared[knots], "ink", width=2.2))
    left = LEFT
    for name, colour in zip(_NAMES, _COLOURS[1:], strict=True):
        parts.append(legend(left, 420, [(name, colour, "band")]))
        left += 50 + 7.4 * len(name)
    parts.append(legend(LEFT, 446, [("x", "ink", "line")]))
    parts.append(
        legend(LEFT + 70, 446, [("the largest x that each limit allows when the speed is steady", "line", "dashed")])
    )
    return picture("What limits the speed", "Bands: the limit that binds", 466, parts)


def _bands(axes: Axes, grid: Grid, binding: IntArray) -> list[str]:
    edges = np.flatnonzero(np.diff(binding, prepend=-1, append=-1))
    stretches = zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True)
    ends = grid.distance * 1e3
    return [axes.band(ends[a], ends[b], _COLOURS[binding[a]]) for a, b in stretches if binding[a]]


def _spread(at: Array) -> IntArray:
    """The intervals to draw: the first in every quarter of a millimetre, and those beside jumps."""
    return np.flatnonzero(np.diff(np.floor(at * 4.0), prepend=-1.0) > 0)


def _binding(rows: Rows, law: TimeLaw) -> IntArray:
    """The number of what binds in every interval, in the order of `_COLOURS`; 0 where nothing does."""
    before, after, u = law.squared[:-1], law.squared[1:], law.acceleration
    joints, tool, top = np.zeros((3, len(u)))
    for station, share in enumerate(STATIONS):
        x = before + share * (after - before)
        joint = np.abs(rows.joint_a[station] * u[:, None] + rows.joint_b[station] * x[:, None]).max(axis=1)
        joints = np.maximum(joints, joint)
        tool = np.maximum(tool, np.hypot(rows.along * u, rows.across[station] * x))
        top = np.maximum(top, x / rows.bound[station])
    feed = (top > _BINDS) & (rows.bound.min(axis=0) > _BINDS * FEED**2)
    by_tool, by_joints = tool > _BINDS, joints > _BINDS
    return np.select([feed, top > _BINDS, by_tool & by_joints, by_tool, by_joints], [1, 2, 5, 3, 4], 0)
