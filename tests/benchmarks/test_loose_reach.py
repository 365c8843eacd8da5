"""The page about published designs says what the benchmark finds."""

import re
from pathlib import Path

import numpy as np

from benchmarks.loose_reach import TOLERANCES, loose, table

PAGE = Path(__file__).parents[2] / "docs" / "explanation" / "published-designs.md"


def test_the_table_of_the_page_is_what_the_benchmark_prints() -> None:
    printed, page = ([row for row in text.splitlines() if row.startswith("|")] for text in (table(), PAGE.read_text()))
    assert len(printed) == len(TOLERANCES) + 2
    for row, written in zip(printed[2:], page[2:], strict=True):
        numbers, own = (np.array(re.findall(r"\d+(?:\.\d+)?", text), dtype=float) for text in (row, written))
        np.testing.assert_allclose(numbers, own, rtol=0.02)
        assert row.split("|")[5] == written.split("|")[5]


def test_a_loose_test_of_reach_is_refuted() -> None:
    found = loose(0.1)
    assert found.reached < 0.6
    assert found.verdict == "refuted"
