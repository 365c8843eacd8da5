"""The fastest rate at which a smooth base may be run within every limit, that of jerk among them.

The time of a move is the integral of 1 / sqrt(X), which is convex in the weights of the spline X. The limits of speed
and acceleration are linear in X, that of the tool's acceleration is a circle, and that of jerk reads

    |q''' X + 3/2 q'' X' + 1/2 q' X''| <= J / sqrt(X)

with ' the derivative by tau. Its right side is convex: in every step it is replaced by its tangent, which lies below. A
primal-dual interior-point method (Boyd and Vandenberghe 2004, "Convex Optimization", section 11.7) keeps every iterate
strictly within all limits. Each weight has to do with two neighbours on either side, so that a step is one banded solve
for all moves at once; every move has its own length of step and its own gap.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from scipy.linalg import solveh_banded

from deltacam.model import Array, IntArray
from deltacam.motion.tempo import Base, shares, windows

STATIONS: Final = 4
"""Places in every interval at which the limits are held."""

GAP: Final = 1e-3
"""About the part of its time by which a motion may be longer than the best one."""

_QUADRATURE: Final = ((0.0, 1.0 / 6.0), (0.5, 4.0 / 6.0), (1.0, 1.0 / 6.0))  # place and weight (Simpson)
_MOST_STEPS: Final = 60
_TO_BOUNDARY: Final = 0.99
_LEFT: Final = 0.005
_LOWEST: Final = 1e-3  # of X at the ends of an interval
_BELOW: Final = 0.3
_HALVINGS: Final = 30


class Stations(NamedTuple):
    """The base at the stations of every interval, derivatives by tau, and the limits there.

    Joints are (3, S, I), all else is (S, I).

    Attributes:
        first: rad/s, of the joint angles.
        second: rad/s2, likewise.
        third: rad/s3, likewise.
        speed: m/s, of the tool along the path.
        along: m/s2, its derivative.
        across: m/s2, the acceleration of the tool across the path.
        highest: the largest X that the limits of speed allow.
        accelerations: (3, 1, I) rad/s2, of the joints.
        acceleration: m/s2, of the tool.
        jerks: (3, 1, I) rad/s3, of the joints.
    """

    first: Array
    second: Array
    third: Array
    speed: Array
    along: Array
    across: Array
    highest: Array
    accelerations: Array
    acceleration: Array
    jerks: Array

    def steady(self) -> Array:
        """The largest X, held all along, that is within the limits of every station, (S, I)."""
        joints = np.abs(self.second / self.accelerations).max(axis=0)
        tool = np.hypot(self.along, self.across) / self.acceleration
        jerk = np.abs(self.third / self.jerks).max(axis=0)
        within = np.minimum(1.0 / np.maximum(np.maximum(joints, tool), 1e-12), np.maximum(jerk, 1e-12) ** (-2.0 / 3.0))
        return np.asarray(np.minimum(within, self.highest))


class Rows(NamedTuple):
    """The limits at the stations of every interval, by the three weights there: shares, 1 is the limit.

    Attributes:
        value: (3, S, I) X.
        highest: (S, I) largest X.
        joints: (3, 3 S, I) acceleration of the joints.
        along: (3, S, I) acceleration of the tool along the path.
        across: (3, S, I) across it.
        jerk: (3, 3 S, I) jerk of the joints over sqrt(X).
    """

    value: Array
    highest: Array
    joints: Array
    along: Array
    across: Array
    jerk: Array

    @classmethod
    def at(cls, base: Base, u: Array, at: Stations) -> Rows:
        """The rows for a base at stations ``u`` (S, I) of its intervals."""
        splines = _splines(base, u)

        def rows(*terms: Array) -> Array:
            """Of a X + b X' + c X'', with a, b and c (..., S, I)."""
            found = np.zeros((3, *terms[0].shape))
            for power, (term, factors) in enumerate(zip(terms, splines, strict=False)):
                found += factors.reshape(3, *[1] * (term.ndim - 2), *term.shape[-2:]) * (term / base.width**power)
            return found.reshape(3, -1, len(base.width))

        limit, jerks = at.accelerations, at.jerks
        return cls(
            splines[0],
            at.highest,
            rows(at.second / limit, 0.5 * at.first / limit),
            rows(at.along / at.acceleration, 0.5 * at.speed / at.acceleration),
            rows(at.across / at.acceleration),
            rows(at.third / jerks, 1.5 * at.second / jerks, 0.5 * at.first / jerks),
        )


def _splines(base: Base, u: Array) -> tuple[Array, Array, Array]:
    """X and its first two derivatives by u at ``u`` (S, I), by weight: (3, S, I) each."""
    before, behind = shares(base)[:, None]
    flat = np.zeros_like(u)
    first = before * (1.0 - u) ** 2, -2.0 * before * (1.0 - u), 2.0 * before + flat
    third = behind * u**2, 2.0 * behind * u, 2.0 * behind + flat
    value, slope, bend = (
        np.stack([one, total - one - other, other])
        for one, other, total in zip(first, third, (1.0, 0.0, 0.0), strict=True)
    )
    return value, slope, bend


class _State(NamedTuple):
    """What the limits and the time are for some weights.

    Attributes:
        X: (S, I) at the stations.
        shares: (2, S, I), those of the tool along and across the path.
        slack: (C, I), what is left of every limit; `_factors` has their order.
        time: (I,) s, of every interval; nan where X is not positive.
    """

    X: Array
    shares: Array
    slack: Array
    time: Array


def fastest(base: Base, rows: Rows, start: Array, *, gap: float = GAP, first_gap: float = 1.0) -> Array:
    """The weights of the fastest rate within the rows.

    Args:
        base: what is run.
        rows: its limits.
        start: (I + 2 K,) weights strictly within all limits.
        gap: about the part of the time by which the motion may be longer than the best one.
        first_gap: the same for the start.

    Returns:
        (I + 2 K,) the weights of X.
    """
    simpson = _simpson(base)
    weights, state = start, _state(base, rows, simpson, start)
    ends = base.first[:-1]
    limits = len(state.slack) * np.diff(base.first)
    mean = first_gap * np.add.reduceat(state.time, ends) / limits
    price = mean[base.move] / state.slack
    centring = np.full(len(ends), 0.2)
    for _ in range(_MOST_STEPS):
        gaps, wanted = np.add.reduceat((price * state.slack).sum(axis=0), ends), gap * np.add.reduceat(state.time, ends)
        if (gaps <= wanted).all():
            break
        target = (np.maximum(centring * gaps, _BELOW * wanted) / limits)[base.move]
        factors = _factors(rows, state)
        gradient, band = _system(base, simpson, weights, state, factors, price, target)
        change = -solveh_banded(band, gradient, lower=True, check_finite=False)
        part = windows(base, change)
        lost = np.einsum("kmi,ki->mi", factors, part)
        by_price = target / state.slack - price + price / state.slack * lost
        length = np.minimum(_reach(state.slack, -lost, ends), _reach(price, by_price, ends))
        length[gaps <= wanted] = 0.0
        weights, state, length = _advance(base, rows, simpson, weights, change, length, state.slack)
        price = price + length[base.move] * by_price
        centring = np.clip((1.0 - length) ** 2, 0.1, 0.6)  # the shorter the step, the nearer to the middle
    return weights


def scaled(base: Base, rows: Rows, weights: Array, share: float) -> Array:
    """Positive weights (I + 2 K,), those of every move scaled so that they use at most a share of every limit."""
    part = windows(base, weights)
    X, *others = (np.einsum("kmi,ki->mi", one, part) for one in (rows.value, rows.joints, rows.along, rows.across))
    joints, along, across = others
    jerk = np.einsum("kmi,ki->mi", rows.jerk, part) * np.tile(np.sqrt(X), (3, 1))
    used = np.maximum((X / rows.highest).max(axis=0), np.abs(joints).max(axis=0))
    used = np.maximum(used, np.hypot(along, across).max(axis=0))
    used = np.maximum(used, np.abs(jerk).max(axis=0) ** (2.0 / 3.0))
    factor = share / np.maximum.reduceat(used, base.first[:-1])
    return weights * np.repeat(factor, np.diff(base.first) + 2)


def _simpson(base: Base) -> Array:
    """X at the places of the quadrature, by weight: (3, Q, I)."""
    places = np.array([place for place, _ in _QUADRATURE])[:, None]
    return _splines(base, np.broadcast_to(places, (len(places), len(base.width))))[0]


def _state(base: Base, rows: Rows, simpson: Array, weights: Array) -> _State:
    part = windows(base, weights)
    X, joints, along, across, jerk, at_quadrature = (
        np.einsum("kmi,ki->mi", one, part)
        for one in (rows.value, rows.joints, rows.along, rows.across, rows.jerk, simpson)
    )
    with np.errstate(invalid="ignore", divide="ignore"):
        room = np.tile(1.0 / np.sqrt(X), (3, 1))
        time = base.width * (np.array([weight for _, weight in _QUADRATURE]) @ at_quadrature**-0.5)
    slack = (1.0 - X / rows.highest, 1.0 - joints, 1.0 + joints, 1.0 - along**2 - across**2, room - jerk, room + jerk)
    # X must not come near 0 anywhere, at its turning point neither: the time is not known well there.
    start, middle, end = at_quadrature
    bend, slope = 2.0 * (start - 2.0 * middle + end), 4.0 * middle - 3.0 * start - end
    turn = np.clip(np.divide(-0.5 * slope, bend, out=np.zeros_like(bend), where=bend > 0.0), 0.0, 1.0)
    positive = start + turn * (slope + turn * bend) > _LOWEST * np.maximum(start, end)
    return _State(X, np.stack([along, across]), np.concatenate(slack), np.where(positive, time, np.nan))


def _factors(rows: Rows, state: _State) -> Array:
    """The derivatives of the limits' shares, which the slack lacks, by weight: (3, C, I)."""
    tool = 2.0 * (state.shares[0] * rows.along + state.shares[1] * rows.across)
    room = np.tile(0.5 * state.X**-1.5 * rows.value, (1, 3, 1))
    parts = (rows.value / rows.highest, rows.joints, -rows.joints, tool, room + rows.jerk, room - rows.jerk)
    return np.concatenate(parts, axis=1)


def _system(
    base: Base, simpson: Array, weights: Array, state: _State, factors: Array, price: Array, target: Array
) -> tuple[Array, Array]:
    """The gradient by all weights, and the lower bands of the Hessian as `solveh_banded` takes them."""
    X = np.einsum("kmi,ki->mi", simpson, windows(base, weights))
    time = base.width * np.array([weight for _, weight in _QUADRATURE])[:, None]
    gradient = np.einsum("mi,kmi->ki", -0.5 * time * X**-1.5, simpson)
    gradient += np.einsum("mi,kmi->ki", target / state.slack, factors)
    at = np.arange(len(base.width)) + 2 * base.move
    whole, band = np.zeros(len(weights)), np.zeros((3, len(weights)))
    by_time, by_limits = 0.75 * time * X**-2.5 * simpson, price / state.slack * factors
    for row in range(3):
        whole[at + row] += gradient[row]
        for column in range(row + 1):
            both = np.einsum("mi,mi->i", by_time[row], simpson[column])
            both += np.einsum("mi,mi->i", by_limits[row], factors[column])
            band[row - column, at + column] += both
    return whole, band


def _reach(values: Array, changes: Array, ends: IntArray) -> Array:
    """How much of the changes (C, I) every move may make, (K,), so that no value comes near 0."""
    with np.errstate(divide="ignore"):
        share = np.where(changes < 0.0, -_TO_BOUNDARY * values / changes, 1.0).min(axis=0)
    return np.asarray(np.minimum(1.0, np.minimum.reduceat(share, ends)))


def _advance(
    base: Base, rows: Rows, simpson: Array, weights: Array, change: Array, length: Array, slack: Array
) -> tuple[Array, _State, Array]:
    """The weights after as much of the change as leaves a part of all slack (C, I), their state, and how much it is."""
    sizes = np.diff(base.first) + 2
    for _ in range(_HALVINGS):
        trial = weights + np.repeat(length, sizes) * change
        state = _state(base, rows, simpson, trial)
        inside = (state.slack > _LEFT * slack).all(axis=0) & np.isfinite(state.time)
        inside = np.logical_and.reduceat(inside, base.first[:-1])
        if inside.all():
            break
        length = np.where(inside, length, 0.5 * length)
    else:
        length = np.where(inside, length, 0.0)
        trial = weights + np.repeat(length, sizes) * change
        state = _state(base, rows, simpson, trial)
    return trial, state, length
