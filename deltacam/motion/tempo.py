"""Motions along a route whose acceleration changes evenly: a smooth base, run faster or slower from place to place.

The base is a speed over a time tau of its own: a cubic spline, zero with its first derivative at both ends. The *rate*
at which tau passes may vary: its square X is a quadratic spline on the same knots. With s0(tau) the way of the base and
' the derivative by tau, speed, acceleration and jerk along the path are

    v = s0' sqrt(X)    a = s0'' X + s0' X' / 2    j = sqrt(X) (s0''' X + 3/2 s0'' X' + 1/2 s0' X'')

so that every motion that starts and ends at rest with zero acceleration stays such a motion under any rate, and the
limits of speed and acceleration are linear in X.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Final, NamedTuple

import numpy as np
from scipy.interpolate import BSpline, PPoly

from deltacam.model import Array, IntArray

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)
_AT: Final = 0.5 * (_NODES + 1.0)
_NEWTON_STEPS: Final = 5
_PADDING: Final = 3


class Motion(NamedTuple):
    """Where the tool is along a route and how it moves there: distance m, speed, acceleration, jerk; (N,) each."""

    distance: Array
    speed: Array
    acceleration: Array
    jerk: Array


@dataclass(frozen=True, slots=True, eq=False)
class Base:
    """The smooth speed of several moves over tau.

    Attributes:
        first: (K + 1,) the first interval of every move, and the number of intervals.
        width: (I,) s, of the intervals.
        speed: (4, I) m/s, the powers of the speed in the place u = 0..1 in each interval.
        distance: (I,) m from the start of the route, at the start of each interval.
    """

    first: IntArray
    width: Array
    speed: Array
    distance: Array

    @classmethod
    def through(
        cls, first: IntArray, width: Array, speed: Callable[[IntArray, Array], Array], start: Array, length: Array
    ) -> Base:
        """The base that is near a given speed.

        Args:
            first: (K + 1,) the first interval of every move, and the number of intervals; at least 7 for each move.
            width: (I,) s, of the intervals.
            speed: of moves (N,) at tau (N,) s after they began, (N,) m/s.
            start: (K,) m, where each move starts.
            length: (K,) m, how far it goes: the speed is scaled to that.
        """
        counts = np.diff(first)
        move = np.repeat(np.arange(len(counts)), counts)
        begins, ends = first[:-1], first[1:] - 1
        for inner in (1, 2):  # equal widths at the ends, where the weights below are those of even knots
            width[begins + inner], width[ends - inner] = width[begins], width[ends]
        # Three intervals beside every end of a move keep its spline apart from those of the others.
        where = np.repeat(np.concatenate([ends + 1, begins]), _PADDING)
        padded = np.insert(width, where, np.repeat(width[np.concatenate([ends, begins])], _PADDING))
        knots = np.concatenate([[0.0], np.cumsum(padded)])
        own = np.arange(len(width)) + _PADDING * (1 + 2 * move)  # the intervals of the moves among the padded ones
        begins, ends = own[begins], own[ends] + 1
        # Weight j belongs to the basis function over the intervals j - 3 to j.
        inside = np.concatenate([np.arange(begin + 2, end + 1) for begin, end in zip(begins, ends, strict=True)])
        holder = np.repeat(np.arange(len(counts)), counts - 1)
        place = (knots[inside - 2] + knots[inside - 1] + knots[inside]) / 3.0 - knots[begins[holder]]
        weights = np.zeros(len(padded) + 3)
        weights[inside] = speed(holder, place)
        # No speed and no acceleration at the ends, but jerk.
        for end, away in ((begins, 1), (ends + 2, -1)):
            weights[end], weights[end + away] = weights[end + 2 * away], -0.5 * weights[end + 2 * away]
        ghosts = knots[0] - padded[0] * np.arange(3.0, 0.0, -1.0), knots[-1] + padded[-1] * np.arange(1.0, 4.0)
        spline = BSpline(np.concatenate([ghosts[0], knots, ghosts[1]]), weights, 3)
        powers = PPoly.from_spline(spline).c[::-1, 3:-3][:, own] * width ** np.arange(4)[:, None]
        step = width * (1.0 / np.arange(1.0, 5.0) @ powers)
        scale = (length / np.add.reduceat(step, first[:-1]))[move]
        passed = np.cumsum(step * scale) - step * scale
        return cls(first, width, powers * scale, passed - (passed[first[:-1]] - start)[move])

    @property
    def move(self) -> IntArray:
        """The move of every interval, (I,)."""
        return np.repeat(np.arange(len(self.first) - 1), np.diff(self.first))

    def at(self, interval: IntArray, u: Array) -> Motion:
        """The motion of the base by tau, at places ``u`` (N,) in 0 to 1 of the given intervals (N,)."""
        a, b, c, d = self.speed[:, interval]
        h = self.width[interval]
        way = u * (a + u * (b / 2.0 + u * (c / 3.0 + u * d / 4.0)))
        return Motion(
            self.distance[interval] + h * way,
            np.maximum(a + u * (b + u * (c + u * d)), 0.0),
            (b + u * (2.0 * c + u * 3.0 * d)) / h,
            (2.0 * c + 6.0 * u * d) / h**2,
        )


@dataclass(frozen=True, slots=True, eq=False)
class Tempo:
    """A base, and the rate at which it is run.

    Attributes:
        base: of all moves.
        weights: (I + 2K,) of the spline X; each move has two more than intervals.
        time: (I + 1,) s, the time at the start of each interval and at the end.
    """

    base: Base
    weights: Array
    time: Array

    @classmethod
    def of(cls, base: Base, weights: Array) -> Tempo:
        """The base at the rate whose square has these weights, > 0."""
        taken = base.width * _slowness(spline_parts(base, weights), np.ones(len(base.width)))
        return cls(base, weights, np.concatenate([[0.0], np.cumsum(taken)]))

    def stretched(self, factor: Array) -> Tempo:
        """The same motion, every move in ``factor`` (K,) times its time."""
        counts = np.diff(self.base.first) + 2
        return Tempo.of(self.base, self.weights / np.repeat(factor, counts) ** 2)

    @property
    def durations(self) -> Array:
        """How long every move takes from rest to rest, (K,) s."""
        return np.diff(self.time[self.base.first])

    def at(self, move: IntArray, since: Array) -> Array:
        """The distance from the start of the route, (N,) m, at ``since`` (N,) s after moves (N,) began."""
        return self.base.at(*self.locate(move, since)).distance

    def locate(self, move: IntArray, since: Array) -> tuple[IntArray, Array]:
        """The intervals in which moves (N,) are ``since`` (N,) s after they began, and the places u there."""
        first = self.base.first
        time = self.time[first[move]] + since
        interval = np.clip(np.searchsorted(self.time, time, side="right") - 1, first[move], first[move + 1] - 1)
        part = spline_parts(self.base, self.weights)[:, interval]
        width = self.base.width[interval]
        passed, whole = (time - self.time[interval]) / width, (self.time[interval + 1] - self.time[interval]) / width
        u = np.clip(passed / whole, 0.0, 1.0)
        for _ in range(_NEWTON_STEPS):
            late = u * _slowness(part, u) - passed
            u = np.clip(u - late * np.sqrt(squared_rate(part, u)[0]), 0.0, 1.0)
        return interval, u

    def time_at(self, interval: IntArray, u: Array) -> Array:
        """The time at places ``u`` (N,) of the given intervals (N,), (N,) s; see ``time``."""
        part = spline_parts(self.base, self.weights)[:, interval]
        return np.asarray(self.time[interval] + self.base.width[interval] * u * _slowness(part, u))

    def motion(self, interval: IntArray, u: Array) -> Motion:
        """The motion in time at places ``u`` (N,) of the given intervals (N,)."""
        distance, speed, acceleration, jerk = self.base.at(interval, u)
        X, slope, bend = squared_rate(spline_parts(self.base, self.weights)[:, interval], u)
        h = self.base.width[interval]
        slope, bend, rate = slope / h, bend / h**2, np.sqrt(X)
        return Motion(
            distance,
            speed * rate,
            acceleration * X + 0.5 * speed * slope,
            rate * (jerk * X + 1.5 * acceleration * slope + 0.5 * speed * bend),
        )


def windows(base: Base, weights: Array) -> Array:
    """The three weights of the spline X in every interval, (3, I)."""
    start = np.arange(len(base.width)) + 2 * base.move
    return np.stack([weights[start + place] for place in range(3)])


def shares(base: Base) -> Array:
    """How much of the first and of the third weight of X counts at the start and at the end of every interval, (2, I).

    With h the widths of an interval and its neighbours: h_i / (h_i-1 + h_i) and h_i / (h_i + h_i+1).
    """
    width, count = base.width, len(base.width)
    before, behind = np.arange(count) - 1, np.arange(count) + 1
    before[base.first[:-1]] += 1
    behind[base.first[1:] - 1] -= 1
    return np.stack([width / (width[before] + width), width / (width + width[behind])])


def spline_parts(base: Base, weights: Array) -> Array:
    """What `squared_rate` takes, for every interval, (3, I)."""
    (a, b, c), (before, behind) = windows(base, weights), shares(base)
    return np.stack([before * (a - b), b, behind * (c - b)])


def squared_rate(part: Array, u: Array) -> tuple[Array, Array, Array]:
    """X and its first two derivatives by u, (..., N) each, at places ``u`` (..., N), for ``part`` (3, N)."""
    start, middle, end = part
    X = middle + start * (1.0 - u) ** 2 + end * u**2
    return X, 2.0 * (end * u - start * (1.0 - u)), np.broadcast_to(2.0 * (start + end), X.shape)


def _slowness(part: Array, u: Array) -> Array:
    """The mean of 1 / sqrt(X) from 0 to ``u`` (N,) for ``part`` (3, N), (N,)."""
    X, _, _ = squared_rate(part, u * _AT[:, None])
    return np.asarray((0.5 * _WEIGHTS) @ (1.0 / np.sqrt(X)))
