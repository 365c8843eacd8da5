from hypothesis import given
from hypothesis import strategies as st

from deltacam.inspection.table import aligned, width


def test_columns_are_as_wide_as_their_widest_cell() -> None:
    rows = [("layer", "n"), ("a", "10"), ("漢字 long", "2")]
    assert aligned(rows, right=(1,)) == ["  layer       n", "  a          10", "  漢字 long   2"]


def test_wide_letters_take_two_columns_and_accents_none() -> None:
    assert [width(text) for text in ("abc", "漢字", "e\u0301", "é")] == [3, 4, 1, 1]


@given(st.lists(st.tuples(st.text("abc", max_size=5), st.text("abc", max_size=5), st.just("x")), min_size=1))
def test_the_last_column_starts_in_the_same_place_in_all_lines(rows: list[tuple[str, str, str]]) -> None:
    lines = aligned(rows)
    assert len({len(line) for line in lines}) == 1
