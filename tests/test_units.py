"""Units that people write, and the units that a drawing may be in."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.errors import DeltacamError
from deltacam.units import (
    METRES_PER,
    likely_units,
    metres_per,
    parse_duration,
    parse_fine_angle,
    parse_jerk,
    parse_length,
    parse_memory,
    parse_speed,
)


@pytest.mark.parametrize(
    ("text", "metres"),
    [
        ("0.2", 2e-4),
        (" 0.2 mm ", 2e-4),
        ("0.008in", 0.008 * 25.4e-3),
        ('2"', 50.8e-3),
        ("2'", 0.6096),
        ("1e1um", 1e-5),
        ("3\N{MICRO SIGN}m", 3e-6),
        ("3\N{GREEK SMALL LETTER MU}m", 3e-6),
        ("7 thou", 7 * 25.4e-6),
        ("72pt", 25.4e-3),
        ("2 Inches", 50.8e-3),
        ("1 millimeter", 1e-3),
    ],
)
def test_a_length_is_read_in_the_unit_that_it_states(text: str, metres: float) -> None:
    assert parse_length(text) == pytest.approx(metres, rel=1e-15)


@pytest.mark.parametrize("text", ["", "mm", "1 2", "nan", "inf", "1e999", "2 furlongs", "1,5", "0x10"])
def test_what_is_no_length_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(DeltacamError) as caught:
        parse_length(text)
    assert caught.value.hint


def test_every_unit_has_a_speed() -> None:
    for unit, metres in METRES_PER.items():
        assert parse_speed(f"3{unit}/min") == pytest.approx(3 * metres / 60)


@pytest.mark.parametrize(
    ("text", "jerk"),
    [
        ("180000", math.pi * 1e3),
        (" 1.8e5 deg/s3 ", math.pi * 1e3),
        ("3500rad/s3", 3500.0),
        ("none", None),
        (" None ", None),
    ],
)
def test_a_jerk_is_in_degrees_unless_it_states_another_unit(text: str, jerk: float | None) -> None:
    assert parse_jerk(text) == (None if jerk is None else pytest.approx(jerk, rel=1e-15))


@pytest.mark.parametrize("text", ["", "no", "nan", "inf", "deg/s3", "1e999", "5 deg/s2", "5 mm/s3", "5 rad", "1,5"])
def test_what_is_no_jerk_is_refused_with_an_example_or_the_units(text: str) -> None:
    with pytest.raises(DeltacamError, match="jerk") as caught:
        parse_jerk(text)
    assert "rad/s3" in caught.value.hint


@pytest.mark.parametrize(
    ("text", "seconds"),
    [("90", 90.0), (" 1.5 s", 1.5), ("10min", 600.0), ("2h", 7200.0), ("none", None), ("NONE", None)],
)
def test_a_duration_is_in_seconds_unless_it_states_another_unit(text: str, seconds: float | None) -> None:
    assert parse_duration(text) == seconds


@pytest.mark.parametrize(
    ("text", "size"),
    [("2", 2_000_000_000), ("1.5 GB", 1_500_000_000), ("800mb", 800_000_000), ("1GiB", 2**30), ("none", None)],
)
def test_a_size_of_memory_is_in_gigabytes_unless_it_states_another_unit(text: str, size: int | None) -> None:
    assert parse_memory(text) == size


@pytest.mark.parametrize("text", ["", "no", "nan", "1e999", "s", "GB", "5 days", "5 kg", "1,5"])
def test_what_is_no_duration_and_no_size_of_memory_is_refused_with_an_example_or_the_units(text: str) -> None:
    for parse, known in ((parse_duration, "min"), (parse_memory, "MB")):
        with pytest.raises(DeltacamError) as caught:
            parse(text)
        assert known in caught.value.hint


def test_a_unit_is_known_in_any_case_and_an_unknown_one_lists_them_all() -> None:
    assert metres_per(" MM ") == 1e-3
    with pytest.raises(DeltacamError, match="ell") as caught:
        metres_per("ell")
    assert all(unit in caught.value.hint for unit in METRES_PER)


@pytest.mark.parametrize(
    ("width", "height", "first"),
    [
        (206.0, 381.5, "mm"),
        (6.38, 4.98, "in"),
        (843.17, 841.89, "pt"),  # a page of an Illustrator drawing
        (595.276, 841.89, "pt"),
        (792.0, 612.0, "pt"),
        (840.5, 300.0, "mm"),
        (612.0, 300.0, "mm"),  # one side alone is a length like any other
        (0.3, 0.2, "m"),
        (2500.0, 1250.0, "mm"),  # a whole sheet
        (9000.0, 20000.0, "mil"),
        (50000.0, 80000.0, "um"),
    ],
)
def test_the_likeliest_unit_makes_the_part_a_usual_size(width: float, height: float, first: str) -> None:
    assert likely_units(width, height)[0] == first


def test_a_rare_unit_is_proposed_only_where_no_other_one_would_do() -> None:
    assert likely_units(1200.0, 500.0) == ("mm",)
    assert likely_units(20000.0, 500.0) == ("mil", "um")


@given(st.floats(0.0, 1e12), st.floats(0.0, 1e12))
def test_no_unit_is_proposed_that_makes_the_part_absurd(width: float, height: float) -> None:
    found = likely_units(width, height)
    assert len(set(found)) == len(found)
    for unit in found:
        assert 1e-3 <= max(width, height) * METRES_PER[unit] <= 10.0


@pytest.mark.parametrize(
    ("text", "turns"),
    [("0.36", 1e-3), ("21.6 arcmin", 1e-3), ("1296arcsec", 1e-3), ("0.36deg", 1e-3), ("16bit", 2.0**-16)],
)
def test_a_small_angle_is_read_in_the_unit_that_it_states(text: str, turns: float) -> None:
    assert parse_fine_angle(text) == pytest.approx(math.tau * turns, rel=1e-12)


@pytest.mark.parametrize("text", ["", "arcmin", "nan", "1 mm", "16.5bit", "0bit", "1000bit", "-3bit"])
def test_what_is_no_small_angle_is_refused_with_an_example(text: str) -> None:
    with pytest.raises(DeltacamError) as caught:
        parse_fine_angle(text)
    assert caught.value.hint
