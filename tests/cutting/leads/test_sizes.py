"""How long leads must be: closed forms of motion under a limit of acceleration and of jerk."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.cutting.leads.sizes import Ability, Size, arrival, run_up, wanted
from deltacam.model import Lead

NOTHING = np.zeros(1)
FAR = np.ones(1)


def able(acceleration: float, jerk: float = np.inf) -> Ability:
    return Ability(np.array([acceleration]), np.array([jerk]))


def integrated(speed: float, acceleration: float, jerk: float) -> float:
    """The way from rest to a speed, by small steps: the acceleration rises, holds, and falls to 0 at the speed."""
    top = min(acceleration, np.sqrt(speed * jerk))
    rise = top / jerk
    times = np.linspace(0.0, speed / top + rise, 200_001)
    push = np.minimum(np.minimum(jerk * times, top), jerk * (times[-1] - times))
    velocity = np.concatenate([[0.0], np.cumsum(0.5 * (push[1:] + push[:-1]) * np.diff(times))])
    return float(np.sum(0.5 * (velocity[1:] + velocity[:-1]) * np.diff(times)))


@given(st.floats(0.02, 0.5), st.floats(2.0, 40.0), st.floats(100.0, 5000.0))
def test_the_run_up_is_the_way_of_a_motion_that_is_integrated(feed: float, acceleration: float, jerk: float) -> None:
    found = run_up(np.array([feed]), able(acceleration, jerk))
    assert found[0] == pytest.approx(integrated(feed, acceleration, jerk), rel=1e-3)


def test_without_a_limit_of_jerk_it_is_half_the_square_of_the_speed_over_the_acceleration() -> None:
    assert run_up(np.array([0.2]), able(20.0))[0] == pytest.approx(0.2**2 / 40.0)


@given(st.floats(0.02, 0.4), st.sampled_from(["arc", "line+arc"]), st.floats(5.0, 30.0))
def test_the_wanted_lead_reaches_the_feed(feed: float, shape: str, acceleration: float) -> None:
    can, speed = able(acceleration), np.array([feed])
    size = wanted(Lead(shape), speed, can, 10e-6, NOTHING)
    assert arrival(size, can, 10e-6, NOTHING, FAR)[0] >= 0.99 * feed
    assert size.length[0] >= run_up(speed, can)[0]


@given(st.floats(0.5e-3, 20e-3), st.floats(0.2, np.pi))
def test_on_an_arc_the_tool_arrives_as_fast_as_a_friction_circle_allows(radius: float, turn: float) -> None:
    size = Size(NOTHING, np.array([radius]), np.array([turn]), NOTHING)
    squared, most, steps = 0.0, 0.95 * 20.0, 20_000
    for _ in range(steps):  # d(v^2) = 2 a ds, where a and v^2 / r together are no more than what there is
        left = max(most**2 - (squared / radius) ** 2, 0.0)
        squared = min(squared + 2.0 * np.sqrt(left) * radius * turn / steps, most * radius)
    assert arrival(size, able(20.0), 10e-6, NOTHING, FAR)[0] == pytest.approx(np.sqrt(squared), rel=0.01)


def test_a_contour_that_bends_with_the_lead_needs_a_smaller_radius() -> None:
    can, feed = able(20.0, 200.0), np.array([0.3])
    radii = [wanted(Lead("arc"), feed, can, 10e-6, np.array([bend])).radius[0] for bend in (-50.0, 0.0, 50.0)]
    assert radii[0] > radii[1] > radii[2]


@pytest.mark.parametrize("shape", ["line", "arc", "line+arc"])
def test_a_length_that_is_given_is_kept(shape: str) -> None:
    size = wanted(Lead(shape, length=3e-3), np.array([0.3]), able(20.0), 10e-6, NOTHING)
    assert size.length[0] == pytest.approx(3e-3)


def test_a_radius_that_is_given_is_kept() -> None:
    assert wanted(Lead("arc", radius=2e-3), np.array([0.3]), able(20.0), 10e-6, NOTHING).radius[0] == 2e-3
