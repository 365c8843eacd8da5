"""Patterns of names."""

import unicodedata

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.batch.choosing.patterns import SHOWN, check_pattern, matches, suggestion, written
from deltacam.errors import DeltacamError

LETTERS = st.text(st.sampled_from("abA[]!.-/ \n"), max_size=12)


def fits(name: str, pattern: str) -> bool:
    """By the definition, letter by letter, for letters of ASCII."""
    if not pattern:
        return not name
    if pattern[0] == "*":
        return fits(name, pattern[1:]) or bool(name and fits(name[1:], pattern))
    return bool(name) and pattern[0] in ("?", name[0].lower(), name[0].upper()) and fits(name[1:], pattern[1:])


@given(LETTERS, st.text(st.sampled_from("abA[]!.-/*?"), max_size=8))
def test_a_pattern_fits_as_defined_letter_by_letter(name: str, pattern: str) -> None:
    assert matches(name, pattern) == fits(name if "/" in pattern else name.split("/")[-1], pattern)


@given(LETTERS, LETTERS, LETTERS, LETTERS)
def test_what_stars_stand_for_may_be_anything(one: str, two: str, three: str, four: str) -> None:
    assert matches(f"folder/{one}{two}{three}{four}", f"folder/{one}*{three}*")


@given(st.text(min_size=1, max_size=20))
def test_a_name_is_like_itself_whatever_is_in_it(name: str) -> None:
    assert matches(name, name)
    for form in ("NFC", "NFD"):
        assert matches(unicodedata.normalize(form, name), name)  # type: ignore[arg-type]


@pytest.mark.parametrize(
    ("name", "pattern"),
    [
        ("brackets/left.dxf", "left.dxf"),
        ("brackets/left.dxf", "*.DXF"),
        ("brackets/left.dxf", "brackets/*.dxf"),
        ("brackets/old/left.dxf", "brackets/*.dxf"),
        ("brackets/old/left.dxf", "*/old/*"),
        ("Stra\N{LATIN SMALL LETTER SHARP S}e.dxf", "stra?e.dxf"),
        ("a[1].dxf", "a[1].dxf"),
        ("bytes\udcff.dxf", "bytes?.dxf"),
        ("two\nlines.dxf", "two*"),
    ],
)
def test_a_name_is_like_a_pattern(name: str, pattern: str) -> None:
    assert matches(name, pattern)


@pytest.mark.parametrize(
    ("name", "pattern"),
    [
        ("brackets/left.dxf", "brackets"),
        ("brackets/left.dxf", "brackets*.dxf"),
        ("more/brackets/left.dxf", "brackets/*"),
        ("a1.dxf", "a[1].dxf"),
        ("left.dxf", "eft.dxf"),
        ("left.dxf\n", "left.dxf"),
        ("brackets/left.dxf", "brackets\\*"),
    ],
)
def test_a_name_is_not_like_a_pattern(name: str, pattern: str) -> None:
    assert not matches(name, pattern)


def test_many_stars_take_no_time_to_speak_of() -> None:
    assert not matches("a" * 200, "*a" * 40 + "b")


@pytest.mark.parametrize(
    ("pattern", "hint"),
    [
        ("", "'*'"),
        (" ", "'*'"),
        ("**/left.dxf", "'left.dxf'"),
        ("brackets/**/left.dxf", "'brackets/*left.dxf'"),
        ("brackets/**", "'brackets/*'"),
        ("./left.dxf", "'left.dxf'"),
        ("../parts/left.dxf", "'parts/left.dxf'"),
        ("/", "'*'"),
    ],
)
def test_a_pattern_that_cannot_be_meant_is_refused_with_another_one(pattern: str, hint: str) -> None:
    with pytest.raises(DeltacamError) as refused:
        check_pattern(pattern)
    assert hint in refused.value.hint


@pytest.mark.parametrize("pattern", ["*", "left.dxf", "brackets/*.dxf", ".left.dxf", "..left.dxf", "a/./b", "[1]"])
def test_other_patterns_are_not_refused(pattern: str) -> None:
    check_pattern(pattern)


NAMES = ["brackets/left.dxf", "brackets/right.dxf", "gear.dxf"]


@pytest.mark.parametrize(
    ("pattern", "near"),
    [
        ("brackets", "brackets/*"),
        ("brackets/", "brackets/*"),
        ("bracket", "brackets/*"),
        ("brackets\\*.dxf", "brackets/*.dxf"),
        ("bracket/*.dxf", "brackets/*.dxf"),
        ("parts/brackets/*.dxf", "brackets/*.dxf"),
        ("parts/gear.dxf", "gear.dxf"),
        ("parts/*.dxf", "*.dxf"),
        ("gaer.dxf", "gear.dxf"),
        ("rihgt.dxf", "right.dxf"),
        ("brackets/rihgt.dxf", "brackets/right.dxf"),
    ],
)
def test_for_a_pattern_that_fits_nothing_one_that_does_is_suggested(pattern: str, near: str) -> None:
    assert not any(matches(name, pattern) for name in NAMES)
    assert suggestion(pattern, NAMES).startswith(f"did you mean {near!r}? there is brackets/left.dxf, ")
    assert any(matches(name, near) for name in NAMES)


def test_nothing_is_suggested_for_what_is_like_nothing() -> None:
    assert suggestion("zz*", NAMES) == "there is brackets/left.dxf, brackets/right.dxf, gear.dxf"
    assert suggestion("zz*", []) == "there is no drawing"


def test_names_are_written_safely_and_only_the_first_ones() -> None:
    assert written(["a\n\x1b[31m.dxf", "\udcff.dxf"]) == "a\\n\\x1b[31m.dxf, \\udcff.dxf"
    assert written([f"{n}.dxf" for n in range(SHOWN + 2)]) == "0.dxf, 1.dxf, 2.dxf and 2 more"
    assert len(written(["x" * 5000])) == 200
