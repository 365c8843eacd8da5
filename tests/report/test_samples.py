"""A thinned series keeps its extremes."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

from deltacam.report.samples import EVERY_TICK, MOST_SAMPLES, Sampling

VALUES = arrays.arrays(
    np.float64, st.integers(1, 200), elements=st.floats(-1e6, 1e6, allow_nan=False) | st.just(float("nan"))
)


@given(VALUES, st.integers(1, 30))
def test_every_value_lies_within_its_sample_and_both_ends_of_a_sample_are_values(values: np.ndarray, step: int) -> None:
    sampling = Sampling(len(values), step)
    extremes = sampling.extremes(values)
    low, high = extremes[0], extremes[-1]
    assert len(low) == len(high) == len(sampling.first) == -(-len(values) // step)
    for sample, first in enumerate(sampling.first):
        part = values[first : first + step]
        known = part[~np.isnan(part)]
        if len(known):
            assert (low[sample], high[sample]) == (known.min(), known.max())
        else:
            assert np.isnan([low[sample], high[sample]]).all()


@given(st.integers(1, 3_000_000))
def test_short_programs_are_not_thinned_and_long_ones_come_to_a_bounded_number_of_samples(ticks: int) -> None:
    sampling = Sampling.of(ticks)
    if ticks <= EVERY_TICK:
        assert sampling.step == 1
    else:
        assert MOST_SAMPLES / 2 < len(sampling.first) <= MOST_SAMPLES


def test_a_sample_is_at_its_first_tick_and_has_the_largest_of_whole_numbers() -> None:
    sampling = Sampling(7, 3)
    assert sampling.at_first(np.arange(7) * 10).tolist() == [0, 30, 60]
    assert sampling.largest(np.array([1, 5, 2, 0, 0, 1, 9])).tolist() == [5, 1, 9]
