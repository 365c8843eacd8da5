"""About how long straight rapids take, for many at once and for one.

A rapid is run from rest to rest within the limits of the tool and of the joints. Along a straight line in direction u
the joints turn by q' = dq/ds, so that a joint bounds the tool's speed by V / |q'|, its acceleration by A / |q'| and its
jerk by J / |q'|; steady speed is bounded by (A / |q''|)^(1/2) and (J / |q'''|)^(1/3) as well. These bounds are tabled
over the sheet and over directions. With bounds v, a and j that do not change along the way L, the fastest motion has a
jerk of j, 0 or -j at any time, and one of these durations (Biagiotti and Melchiorri, Trajectory Planning, 2008, 3.4):

    4 (L / 2j)^(1/3)                          where a is not reached, L <= 2 a^3 / j^2
    a / j + ((a / j)^2 + 4 L / a)^(1/2)       where a is reached and v is not
    L / v + v / a + a / j                     where both are
    L / v + 2 (v / j)^(1/2)                   where v is reached and a is not, v <= a^2 / j

What is put in for 1/v, 1/a and 1/j are means over three places of the way. `benchmarks/rapids.py` compares with plans.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from math import atan2, cos, hypot, pi, sin, sqrt
from typing import TYPE_CHECKING, Final

import numpy as np

from deltacam.model import Array, IntArray, Placement

if TYPE_CHECKING:
    from deltacam.robot.robot import Robot

_SIDE: Final = 24  # cells along a side of the sheet
_TURNS: Final = 36  # directions in half a turn
_TINY: Final = 1e-12
_NEAR_END: Final = 0.15  # of the way, where the limits at its ends are taken
_JERK_USED: Final = 0.96  # of the limit, by the motion that is planned

_Slowness = tuple[float, float, float]
"""1/v s/m, 1/a s2/m and 1/j s3/m."""


class Rapids:
    """Estimates the time of rapids of one robot on its sheet."""

    def __init__(self, robot: Robot, placement: Placement | None = None) -> None:
        """Tabulate what bounds the tool.

        Args:
            robot: whose sheet is covered; beyond its edge the limits are those at the edge.
            placement: of the frame that places are given in; None is that of the machine.
        """
        rotation = 0.0 if placement is None else placement.rotation
        sheet = robot.workspace
        half = (sheet.radius, sheet.radius) if sheet.radius else (0.5 * (sheet.width or 0), 0.5 * (sheet.depth or 0))
        self._half = np.array(half, dtype=np.float64)
        self._table = _slowness(robot, self._half)
        # Places are turned and shifted into the machine frame and scaled to cells at once.
        across, up = cos(rotation), sin(rotation)
        self._to_cells = np.array([[across, up], [-up, across]]) * (0.5 * _SIDE / self._half)
        shift = (0.0, 0.0) if placement is None else (placement.x, placement.y)
        self._first_cell = (shift + self._half) * (0.5 * _SIDE / self._half)
        self._turn = rotation * _TURNS / pi % _TURNS + _TURNS + 0.5

    def __call__(self, begin: Array, end: Array) -> Array:
        """About how long the straight ways from ``begin`` to ``end``, (N, 2) m, take: (N,) s."""
        step = end - begin
        length = np.hypot(step[:, 0], step[:, 1])
        turn = (np.arctan2(step[:, 1], step[:, 0]) * (_TURNS / pi) + self._turn).astype(np.int64) % _TURNS
        first, middle, last = (
            self._table[self._cells(begin + share * step) * _TURNS + turn]
            for share in (_NEAR_END, 0.5, 1.0 - _NEAR_END)
        )
        mean = 0.5 * (first + last)
        return _times(length, 0.5 * (mean[:, 0] + middle[:, 0]), mean[:, 1], mean[:, 2])

    @cached_property
    def one(self) -> Callable[[float, float, float, float], float]:
        """What tells the same for one way: takes x and y where it begins and where it ends, m; returns s."""
        table: list[_Slowness] = [(v, a, j) for v, a, j in self._table.tolist()]
        (xx, xy), (yx, yy) = self._to_cells.tolist()
        first_x, first_y = self._first_cell.tolist()
        per_turn, first_turn, most, near = _TURNS / pi, self._turn, _SIDE - 1, _NEAR_END

        def time(x: float, y: float, to_x: float, to_y: float) -> float:
            dx, dy = to_x - x, to_y - y
            turn = int(atan2(dy, dx) * per_turn + first_turn) % _TURNS
            # Where in the table the way begins, and which part of the table it crosses.
            column, row = x * xx + y * yx + first_x, x * xy + y * yy + first_y
            columns, rows = dx * xx + dy * yx, dx * xy + dy * yy
            at = []
            for share in (near, 0.5, 1.0 - near):
                one, other = int(column + share * columns), int(row + share * rows)
                one = 0 if one < 0 else most if one > most else one
                other = 0 if other < 0 else most if other > most else other
                at.append(table[(one * _SIDE + other) * _TURNS + turn])
            (v, a, j), (middle, _, _), (v_last, a_last, j_last) = at
            return _time(hypot(dx, dy), 0.25 * (v + v_last) + 0.5 * middle, 0.5 * (a + a_last), 0.5 * (j + j_last))

        return time

    def _cells(self, places: Array) -> IntArray:
        """The cells that hold the places, (N, 2) m; (N,)."""
        cell = np.clip((places @ self._to_cells + self._first_cell).astype(np.int64), 0, _SIDE - 1)
        return np.asarray(cell[:, 0] * _SIDE + cell[:, 1])


def _slowness(robot: Robot, half: Array) -> Array:
    """1/v, 1/a and 1/j in the middle of every cell in every direction, (_SIDE * _SIDE * _TURNS, 3)."""
    sheet, joints = robot.workspace, robot.joints
    middle = (2.0 * np.arange(_SIDE) + 1.0) / _SIDE - 1.0
    places = np.stack(np.meshgrid(middle, middle, indexing="ij"), axis=-1).reshape(-1, 2) * half
    if sheet.radius is not None:
        away = np.hypot(places[:, 0], places[:, 1])
        places *= np.minimum(1.0, sheet.radius / np.maximum(away, _TINY))[:, None]
    turn = np.arange(_TURNS) * pi / _TURNS
    along = np.tile(np.column_stack([np.cos(turn), np.sin(turn), np.zeros(_TURNS)]), (len(places), 1))
    points = np.repeat(np.column_stack([places, np.full(len(places), sheet.sheet_z)]), _TURNS, axis=0)
    none = np.zeros_like(points)
    _, first, second = (np.abs(one) for one in robot.path_derivatives(points, along, none))
    speed, acceleration = np.asarray(joints.max_speed), np.asarray(joints.max_acceleration)
    v = np.maximum((first / speed).max(axis=1), np.sqrt((second / acceleration).max(axis=1)))
    a = np.maximum((first / acceleration).max(axis=1), 1.0 / robot.tool.max_acceleration)
    j = np.zeros_like(a)
    if joints.max_jerk is not None:
        jerk = np.asarray(joints.max_jerk)
        third = np.abs(robot.third_derivative(points, along, none, none))
        v = np.maximum(v, np.cbrt((third / jerk).max(axis=1)))
        j = (first / jerk).max(axis=1) / _JERK_USED
    return np.column_stack([np.maximum(v, 1.0 / robot.tool.max_speed), a, j])


def _times(length: Array, v: Array, a: Array, j: Array) -> Array:
    """How long ways of ``length`` m take with bounds of 1/v, 1/a and 1/j, (N,) each; (N,) s."""
    ramp = np.where(a * a >= j * v, a / v + j / a, 2.0 * np.sqrt(j / v))
    rise = j / a
    no_speed = rise + np.sqrt(rise * rise + 4.0 * a * length)
    slow = np.where(length >= 2.0 * rise * rise / a, no_speed, 4.0 * np.cbrt(0.5 * length * j))
    return np.asarray(np.where(length * v >= ramp, length * v + ramp, slow))


def _time(length: float, v: float, a: float, j: float) -> float:
    """The same as `_times` for one way."""
    rise = j / a
    ramp = a / v + rise if a * a >= j * v else 2.0 * sqrt(j / v)
    if length * v >= ramp:
        return length * v + ramp
    if length * a >= 2.0 * rise * rise:
        return rise + sqrt(rise * rise + 4.0 * a * length)
    return float(4.0 * (0.5 * length * j) ** (1.0 / 3.0))
