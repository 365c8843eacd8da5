"""The feed by the gas."""

from dataclasses import replace

import pytest

from deltacam.cutting.gas import at_feed_of_its_gas, stated_feed, with_gas
from deltacam.cutting.process import load_process
from deltacam.errors import ProcessError
from deltacam.model import Gas

STEEL = load_process("steel-1mm-fibre")


def test_another_gas_changes_the_feed_by_its_factor_and_back() -> None:
    nitrogen = with_gas(STEEL, "nitrogen")
    assert nitrogen.gas == "nitrogen"
    assert nitrogen.feed == pytest.approx(0.65 * STEEL.feed)
    assert nitrogen.feeds == pytest.approx(tuple(0.65 * feed for feed in STEEL.feeds or ()))
    again = with_gas(nitrogen, "oxygen")
    assert (again.feed, again.gas) == (pytest.approx(STEEL.feed), "oxygen")


def test_the_gas_in_use_changes_nothing() -> None:
    assert with_gas(STEEL, "oxygen") is STEEL
    assert at_feed_of_its_gas(STEEL) is STEEL


def test_factors_of_both_gases_count() -> None:
    process = replace(STEEL, gas="a", gases=(Gas("a", None, 2.0), Gas("b", None, 3.0)))
    assert with_gas(process, "b").feed == pytest.approx(1.5 * process.feed)
    assert stated_feed(process) == pytest.approx(process.feed / 2.0)


def test_a_gas_that_nothing_is_known_about_is_refused() -> None:
    with pytest.raises(ProcessError, match="argon") as caught:
        with_gas(STEEL, "argon")
    assert "oxygen, nitrogen" in caught.value.hint
    with pytest.raises(ProcessError) as caught:
        with_gas(replace(STEEL, gases=()), "argon")
    assert "one feed only" in caught.value.hint
