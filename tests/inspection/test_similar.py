import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.inspection.similar import pattern, summary


def test_numbers_become_their_range() -> None:
    assert summary(["gap of 0.3 mm", "gap of 0.02 mm", "gap of 10 mm"]) == "gap of 0.02 to 10 mm"
    assert summary(["9 lines", "10 lines"]) == "9 to 10 lines"


def test_of_places_and_handles_the_first_is_named() -> None:
    sentences = ["#2F from (1.000, 2.000) to (3.000, -4.500) mm", "#30 from (1.000, 2.000) to (9.000, 9.000) mm"]
    assert summary(sentences) == "#2F ... from (1.000, 2.000) to (3.000, -4.500) ... mm"


def test_what_is_the_same_in_all_sentences_stays() -> None:
    assert summary(["2 TEXT in R12", "2 TEXT in R12"]) == "2 TEXT in R12"


@pytest.mark.parametrize(
    ("one", "other", "alike"),
    [
        ("gap of 0.3 mm", "gap of -2e-3 mm", True),
        ("gap of 0.3 mm", "hole of 0.3 mm", False),
        ("duplicate of #2F", "duplicate of #ABC", True),
        ("layer A1", "layer A2", False),
        ("open from (1, 2)", "open from (3, 4.5)", True),
        ("layer 5", "layer #A", False),
        ("layer 5", "layer \0", False),
        ("layer 5", "layer \x000", False),
        ("layer #5", "layer (1, 2)", False),
    ],
)
def test_sentences_are_alike_when_only_numbers_places_and_handles_differ(one: str, other: str, alike: bool) -> None:
    assert (pattern(one) == pattern(other)) == alike


@given(st.lists(st.text(), min_size=1, max_size=6))
def test_any_sentences_of_one_pattern_have_a_summary(sentences: list[str]) -> None:
    alike = [sentence for sentence in sentences if pattern(sentence) == pattern(sentences[0])]
    assert summary(alike[:1]) == alike[0]
    assert pattern(summary(alike)).split("\0")[0] == pattern(alike[0]).split("\0")[0]
