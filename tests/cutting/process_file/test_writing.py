"""A process as its file."""

import re
from dataclasses import replace
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from deltacam.cutting.process import load_process, process_names
from deltacam.cutting.process_file.bounds import BOUNDS
from deltacam.cutting.process_file.measured import with_measured
from deltacam.cutting.process_file.reading import KEYS, read_process
from deltacam.cutting.process_file.values import GRADES, NOT_SAID, provenance_of, sections, worst_grade
from deltacam.cutting.process_file.writing import MEANINGS, to_toml
from deltacam.errors import ProcessError
from deltacam.model import Gas, Lead, Process, Provenance, Rule
from deltacam.settings import read_table

ROOT = Path(__file__).parents[3]
DEFAULT = load_process("steel-1mm-fibre")


def read(folder: Path, text: str) -> Process:
    path = folder / "own.toml"
    path.write_text(text, encoding="utf-8")
    return read_process(read_table(path, error=ProcessError))


@pytest.mark.parametrize("name", [*process_names(), ROOT / "samples" / "process.toml"])
@pytest.mark.parametrize("examples", [False, True])
def test_a_process_that_is_written_is_read_back_as_it_was(name: str | Path, examples: bool, tmp_path: Path) -> None:
    process = load_process(name)
    assert read(tmp_path, to_toml(process, heading="two\nlines", examples=examples)) == process


@given(
    kerf=st.integers(0, 200_000),
    feed=st.integers(6, 9_999_999),
    power=st.integers(1, 1000),
    name=st.text(min_size=1).filter(lambda text: text.strip() and text.isprintable()),
)
def test_a_number_that_a_file_can_state_comes_back_to_the_last_bit(
    tmp_path_factory: pytest.TempPathFactory, kerf: int, feed: int, power: int, name: str
) -> None:
    stated = {"kerf": kerf / 1e4 / 1e3, "feed": feed / 1e4 / 60.0, "power": power / 1e3}
    process = replace(DEFAULT, **stated, feeds=None, name=name)
    assert read(tmp_path_factory.mktemp("written"), to_toml(process)) == process


def test_a_number_of_many_digits_is_not_shortened(tmp_path: Path) -> None:
    process = replace(DEFAULT, kerf=0.17272727272727276 / 1e3, feed=8.123456789012345 / 60.0)
    assert read(tmp_path, to_toml(process)) == process


@given(feed=st.floats(1e-5, 16.0), tolerance=st.floats(2e-6, 1e-3))
def test_any_number_comes_back_nearly(tmp_path_factory: pytest.TempPathFactory, feed: float, tolerance: float) -> None:
    process = replace(DEFAULT, feed=feed, feeds=None, tolerance=tolerance)
    found = read(tmp_path_factory.mktemp("written"), to_toml(process))
    assert (found.feed, found.tolerance) == pytest.approx((feed, tolerance), rel=1e-12)


def test_names_that_need_quotes_come_back(tmp_path: Path) -> None:
    process = replace(DEFAULT, gas='a "b"\\', gases=(Gas('a "b"\\'),), source="line\nfeed\x7f", rules=(Rule("cut"),))
    assert read(tmp_path, to_toml(process)) == process


def test_the_feed_of_a_gas_is_written_as_the_file_states_it(tmp_path: Path) -> None:
    nitrogen = replace(DEFAULT, gas="nitrogen", feed=DEFAULT.feed * 0.65, feeds=None)
    text = to_toml(nitrogen)
    assert "feed_m_min = 9.0 " in text
    assert read(tmp_path, text) == nitrogen


def test_every_example_can_be_used_as_it_is(tmp_path: Path) -> None:
    nothing = Lead()
    bare = replace(DEFAULT, engrave_feed=None, engrave_power=None, provenance=(), lead_in=nothing, lead_out=nothing)
    text = to_toml(bare, examples=True)
    used = re.sub(r"^# (?=\[|\w+ =)", "", text, flags=re.MULTILINE)
    found = read(tmp_path, used)
    assert found.tabs is not None
    assert found.power_law is not None
    assert found.lead_in.shape == "line+arc"
    assert (found.pre_pierce, len(found.slower), len(found.provenance)) == (True, 1, 1)
    assert found.heat is not None


def test_a_process_that_has_a_section_gets_no_example_of_it() -> None:
    full = to_toml(load_process(ROOT / "samples" / "process.toml"), examples=True)
    assert "# [power_law]" not in full
    assert "# [tabs]" in full


def test_every_value_has_a_meaning_and_every_bound_a_value() -> None:
    assert {key for key in MEANINGS if "." not in key} >= set(KEYS) - {
        *("engrave", "lead_in", "lead_out", "pierce", "power_law", "slower"),
        *("loops", "tabs", "heat", "gases", "provenance"),
    }
    named = {name.removeprefix("lead.") for name in BOUNDS}
    assert named <= set(MEANINGS)


def test_a_value_is_from_where_its_section_is() -> None:
    said = (Provenance("engrave", "vendor"), Provenance("engrave.power", "measured"), Provenance("gases", "community"))
    process = replace(DEFAULT, provenance=said)
    assert provenance_of(process, "engrave", "power") == said[1]
    assert provenance_of(process, "engrave", "feed_m_min") == said[0]
    assert provenance_of(process, "gases.oxygen", "pressure_bar") == said[2]
    assert provenance_of(process, "", "kerf_mm") is None


def test_the_worst_grade_is_that_of_the_values_that_matter() -> None:
    keys = ("kerf_mm", "feed_m_min", "power", "pierce_time_s")
    for worst in GRADES:
        said = [Provenance(key, "measured") for key in keys[1:]]
        process = replace(DEFAULT, provenance=(Provenance("kerf_mm", worst), *said, Provenance("tabs", "estimate")))
        assert worst_grade(process) == worst
    assert worst_grade(replace(DEFAULT, provenance=(Provenance("kerf_mm", "measured"),))) == NOT_SAID


def test_what_was_measured_replaces_what_was_said() -> None:
    found = with_measured(DEFAULT, source="bench", kerf=0.2e-3, feed=8.5 / 60.0)
    assert (found.kerf, found.feed, found.feeds) == (0.2e-3, 8.5 / 60.0, DEFAULT.feeds)
    assert provenance_of(found, "", "kerf_mm") == Provenance("kerf_mm", "measured", "bench")
    assert [one.key for one in found.provenance].count("feed_m_min") == 1
    assert provenance_of(found, "", "power") == provenance_of(DEFAULT, "", "power")


def test_a_measured_feed_outside_of_the_range_takes_the_range_away() -> None:
    assert with_measured(DEFAULT, feed=12.0 / 60.0).feeds is None


def test_sections_leave_out_what_is_as_it_is_by_default() -> None:
    names = [section.name for section in sections(DEFAULT)]
    assert names == ["", "engrave", "lead_in", "lead_out", "gases.oxygen", "gases.nitrogen"]
