"""Bases and tempos against differences in time, quadrature, and their own other side at every knot."""

import numpy as np
import pytest
from scipy.integrate import quad

from deltacam.model import Array, IntArray
from deltacam.motion.tempo import Base, Motion, Tempo, shares, spline_parts, squared_rate, windows

FIRST = np.array([0, 20, 31, 60])
START = np.array([0.0, 0.05, 0.06])
LENGTH = np.array([0.05, 0.01, 0.2])
DURATIONS = np.array([0.1, 0.04, 0.3])


def hump(move: IntArray, at: Array) -> Array:
    """A speed that rises and falls with continuous acceleration, of the right length of way."""
    share = np.clip(at / DURATIONS[move], 0.0, 1.0)
    return np.asarray(2.0 * LENGTH[move] / DURATIONS[move] * np.sin(np.pi * share) ** 2)


def base() -> Base:
    """Three moves on uneven knots."""
    rng = np.random.default_rng(5)
    widths = [rng.uniform(0.7, 1.3, count) for count in np.diff(FIRST)]
    widths = [taken * width / width.sum() for taken, width in zip(DURATIONS, widths, strict=True)]
    return Base.through(FIRST, np.concatenate(widths), hump, START, LENGTH)


def tempo(seed: int = 1) -> Tempo:
    """The moves at rates that vary by about a third from knot to knot."""
    own = base()
    count = len(own.width) + 2 * len(LENGTH)
    return Tempo.of(own, np.exp(np.random.default_rng(seed).normal(0.0, 0.3, count)))


def everywhere(own: Base, parts: Array) -> tuple[IntArray, Array]:
    interval = np.arange(len(own.width))
    return np.repeat(interval, len(parts)), np.tile(parts, len(interval))


def ends_of(own: Base) -> tuple[IntArray, IntArray]:
    """The intervals before and behind every knot within a move."""
    behind = np.setdiff1d(np.arange(1, len(own.width)), own.first)
    return behind - 1, behind


def close(found: Array, wanted: Array, rel: float) -> bool:
    return bool(np.abs(found - wanted).max() <= rel * np.abs(wanted).max())


def test_a_base_begins_and_ends_at_rest_without_acceleration_after_its_length() -> None:
    own = base()
    first, last = FIRST[:-1], FIRST[1:] - 1
    begin, end = own.at(first, np.zeros(3)), own.at(last, np.ones(3))
    assert begin.distance == pytest.approx(START, abs=1e-15)
    assert end.distance == pytest.approx(START + LENGTH, abs=1e-15)
    for motion in (begin, end):
        assert motion.speed == pytest.approx(0.0, abs=1e-12)
        assert motion.acceleration == pytest.approx(0.0, abs=1e-9)


def test_the_derivatives_of_a_base_are_its_differences() -> None:
    own, step = base(), 1e-4
    interval, u = everywhere(own, np.array([0.2, 0.5, 0.8]))
    before, here, after = (own.at(interval, u + side * step) for side in (-1.0, 0.0, 1.0))
    run = 2.0 * step * own.width[interval]
    for order in range(3):
        assert close((after[order] - before[order]) / run, here[order + 1], 1e-6)


def test_a_base_is_smooth_up_to_its_jerk() -> None:
    own = base()
    before, behind = ends_of(own)
    one, other = own.at(before, np.ones(len(before))), own.at(behind, np.zeros(len(behind)))
    for left, right, scale in zip(one, other, own.at(*everywhere(own, np.linspace(0, 1, 5))), strict=True):
        assert np.abs(left - right).max() <= 1e-9 * np.abs(scale).max()


def test_a_base_is_near_the_given_speed() -> None:
    own = base()
    interval, u = everywhere(own, np.linspace(0.0, 1.0, 7))
    begins = np.concatenate([[0.0], np.cumsum(own.width)])
    at = begins[interval] - begins[FIRST[own.move[interval]]] + u * own.width[interval]
    speed = hump(own.move[interval], at)
    assert np.abs(own.at(interval, u).speed - speed).max() <= 0.02 * speed.max()


def test_the_motion_is_the_derivative_in_time_of_the_place() -> None:
    own, step = tempo(), 1e-6
    interval, u = everywhere(own.base, np.array([0.1, 0.4, 0.7, 0.9]))
    move = own.base.move[interval]
    here = own.motion(interval, u)
    since = time_of(own, interval, u)
    places = [own.at(move, since + side * step) for side in (-1.0, 0.0, 1.0)]
    assert close(places[1], here.distance, 1e-7)
    assert close((places[2] - places[0]) / (2.0 * step), here.speed, 1e-6)
    # The next derivatives by differences of the one before, at the places where the clock finds them.
    before, after = (own.motion(*own.locate(move, since + side * step)) for side in (-1.0, 1.0))
    for order in (1, 2):
        assert close((after[order] - before[order]) / (2.0 * step), here[order + 1], 1e-5)


def time_of(own: Tempo, interval: IntArray, u: Array) -> Array:
    """When places of intervals are passed, s after the start of their move, by adaptive quadrature."""
    part = spline_parts(own.base, own.weights)
    found = []
    for one, share in zip(interval.tolist(), u.tolist(), strict=True):
        inside, _ = quad(lambda x, k=one: squared_rate(part[:, k], np.array(x))[0] ** -0.5, 0.0, share, epsabs=1e-13)
        found.append(own.time[one] + own.base.width[one] * inside)
    return np.array(found) - own.time[own.base.first[own.base.move[interval]]]


def test_the_clock_agrees_with_quadrature_and_finds_every_place_again() -> None:
    own = tempo(2)
    interval, u = everywhere(own.base, np.array([0.3, 0.999]))
    since = time_of(own, interval, u)
    found = own.locate(own.base.move[interval], since)
    assert np.array_equal(found[0], interval)
    assert found[1] == pytest.approx(u, abs=1e-6)
    whole = time_of(own, FIRST[1:] - 1, np.ones(3))
    assert own.durations == pytest.approx(whole, rel=1e-7)


def test_a_tempo_is_smooth_up_to_its_acceleration() -> None:
    own = tempo(3)
    before, behind = ends_of(own.base)
    one: Motion = own.motion(before, np.ones(len(before)))
    other: Motion = own.motion(behind, np.zeros(len(behind)))
    for left, right in zip(one[:3], other[:3], strict=True):
        assert np.abs(left - right).max() <= 1e-9 * np.abs(left).max()
    assert np.abs(one.jerk - other.jerk).max() > 0.01 * np.abs(one.jerk).max()


def test_the_square_of_the_rate_lies_between_the_weights_of_its_interval() -> None:
    own = tempo(4)
    low, high = (bound(windows(own.base, own.weights), axis=0) for bound in (np.min, np.max))
    for u in np.linspace(0.0, 1.0, 9):
        X, _, _ = squared_rate(spline_parts(own.base, own.weights), np.full(len(low), u))
        assert (low * (1.0 - 1e-12) <= X).all()
        assert (high * (1.0 + 1e-12) >= X).all()


def test_the_shares_are_those_of_neighbours_in_the_same_move() -> None:
    own = base()
    before, behind = shares(own)
    inner, outer = ends_of(own)
    assert before[outer] == pytest.approx(own.width[outer] / (own.width[inner] + own.width[outer]))
    assert behind[inner] == pytest.approx(1.0 - before[outer])
    assert before[FIRST[:-1]] == pytest.approx(0.5)
    assert behind[FIRST[1:] - 1] == pytest.approx(0.5)


def test_a_steady_rate_runs_the_base_faster_by_its_root() -> None:
    own = base()
    quick = Tempo.of(own, np.full(len(own.width) + 6, 4.0))
    assert quick.durations == pytest.approx(np.add.reduceat(own.width, FIRST[:-1]) / 2.0, rel=1e-12)
    interval, u = everywhere(own, np.array([0.25, 0.75]))
    slow, fast = own.at(interval, u), quick.motion(interval, u)
    for order, factor in enumerate((1.0, 2.0, 4.0, 8.0)):
        assert close(fast[order], factor * slow[order], 1e-12)


def test_a_stretched_tempo_is_the_same_motion_in_more_time() -> None:
    own, factor = tempo(), np.array([1.0, 1.5, 2.0])
    longer = own.stretched(factor)
    assert longer.durations == pytest.approx(own.durations * factor, rel=1e-12)
    interval, u = everywhere(own.base, np.array([0.1, 0.6]))
    by = factor[own.base.move[interval]]
    for order, (one, other) in enumerate(zip(own.motion(interval, u), longer.motion(interval, u), strict=True)):
        assert close(other, one / by**order, 1e-12)
