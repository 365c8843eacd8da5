"""Reading a process."""

from dataclasses import replace
from pathlib import Path

import pytest

from deltacam.cutting.process import check_process, load_process, process_names
from deltacam.errors import ProcessError
from deltacam.model import DEFAULT_RULES, Lead, Operation, Rule, Tabs

GOOD = 'name = "card"\nkerf_mm = 0.2\nfeed_m_min = 6\n'


def write(folder: Path, text: str) -> Path:
    path = folder / "card.toml"
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", process_names())
def test_a_built_in_process_is_whole_and_names_its_source(name: str) -> None:
    process = check_process(load_process(name))
    assert process.name == name
    assert process.source
    assert process.material
    assert 0.0 < process.kerf < 1e-3


def test_values_become_si(tmp_path: Path) -> None:
    process = load_process(write(tmp_path, GOOD + "tolerance_um = 15\nthickness_mm = 2\ncorner = 'stop'\n"))
    assert (process.kerf, process.feed) == pytest.approx((2e-4, 0.1))
    assert (process.tolerance, process.thickness) == pytest.approx((15e-6, 2e-3))
    assert process.corner == "stop"
    assert (process.power, process.pierce_time) == (1.0, 0.0)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        (GOOD + "pierce_times = 1\n", "pierce_time_s"),
        (GOOD.replace("0.2", "-0.2"), "kerf_mm"),
        (GOOD.replace("0.2", '"wide"'), "kerf_mm"),
        (GOOD.replace("0.2", "nan"), "kerf_mm"),
        (GOOD + "power = 1.5\n", "power"),
        (GOOD + "corner = 'sharp'\n", "round"),
        ('name = "card"\nkerf_mm = 0.2\n', "feed_m_min"),
        ("name = ", "card.toml"),
    ],
)
def test_what_is_wrong_in_a_file_is_named(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(ProcessError) as caught:
        load_process(write(tmp_path, text))
    assert says in f"{caught.value.what} {caught.value.where} {caught.value.hint}"


RULES = (
    GOOD
    + """
open = "cut"

[engrave]
feed_m_min = 12
power = 0.2

[[operations]]
layer = "ENGRAVE*"
color = "red"
linetype = "DASHED*"
do = "engrave"

[[operations]]
color = 30
do = "ignore"

[[operations]]
layer = "SLITS"
do = "cut"

[[operations]]
do = "cut"
open = "engrave"
"""
)


def test_rules_are_read_in_order(tmp_path: Path) -> None:
    process = load_process(write(tmp_path, RULES))
    cut, engrave, ignore = Operation.CUT, Operation.ENGRAVE, Operation.IGNORE
    assert process.rules == (
        Rule(engrave, layer="ENGRAVE*", color=1, linetype="DASHED*", open=engrave),
        Rule(ignore, color=30, open=ignore),
        Rule(cut, layer="SLITS", open=cut),
        Rule(cut, open=engrave),
    )
    assert process.open is cut
    assert (process.engrave_feed, process.engrave_power) == pytest.approx((0.2, 0.2))


def test_without_rules_there_are_the_default_ones_and_none_can_be_asked_for(tmp_path: Path) -> None:
    process = load_process(write(tmp_path, GOOD))
    assert process.rules == DEFAULT_RULES
    assert process.open is Operation.IGNORE
    assert (process.engrave_feed, process.engrave_power) == (None, None)
    assert load_process(write(tmp_path, GOOD + "operations = []\n")).rules == ()


@pytest.mark.parametrize("name", process_names())
def test_a_built_in_process_can_engrave_faster_and_not_more_strongly_than_it_cuts(name: str) -> None:
    process = load_process(name)
    assert (process.engrave_feed or 0.0) > process.feed or process.feed > 0.2
    assert 0.0 < (process.engrave_power or 0.0) <= process.power


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("open = 'burn'", 'open = \'burn\' is not "cut" or "engrave" or "ignore"'),
        ("engrave = 1", "engrave = 1 must be a section"),
        ("[engrave]\npower = 0.2", "feed_m_min is missing"),
        ("[engrave]\nfeed_m_min = 1", "power is missing"),
        ("[engrave]\nfeed_m_min = 1\npower = 2", "power = 2 is outside"),
        ("[engrave]\nfeed_m_min = 1\npower = 1\npierce_time_s = 1", "unknown key 'pierce_time_s'"),
        ("[operations]\ndo = 'cut'", "write [[operations]] above each"),
        ("[[operations]]\nlayer = 'A'", "do is missing"),
        ("[[operations]]\ndo = 'etch'", "do = 'etch' is not"),
        ("[[operations]]\ndo = 'cut'\nlayer = ' '", "layer is empty"),
        ("[[operations]]\ndo = 'cut'\ncolor = 0", "color = 0 is outside 1 to 255"),
        ("[[operations]]\ndo = 'cut'\ncolor = 'purple'", "color = 'purple' is not \"red\""),
        ("[[operations]]\ndo = 'cut'\ncolor = 1.5", "not a whole number"),
        ("[[operations]]\ndo = 'cut'\nlayers = 'A'", "did you mean 'layer'"),
        ("[[operations]]\ndo = 'ignore'\nopen = 'cut'", "open says nothing"),
        ("[[operations]]\ndo = 'cut'\n[[operations]]\ndo = 'cut'\ncolor = 1", "never used"),
    ],
)
def test_what_is_wrong_with_a_rule_is_named(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(ProcessError) as caught:
        load_process(write(tmp_path, f"{GOOD}{text}\n"))
    assert says in f"{caught.value.what} {caught.value.hint}"
    assert caught.value.where.startswith("card.toml")


def test_the_wrong_rule_is_counted(tmp_path: Path) -> None:
    with pytest.raises(ProcessError) as caught:
        load_process(write(tmp_path, GOOD + "[[operations]]\ndo='cut'\ncolor=1\n[[operations]]\ndo='weld'\n"))
    assert caught.value.where == "card.toml [operations 2]"


def test_an_unknown_name_is_answered_with_the_nearest() -> None:
    with pytest.raises(ProcessError, match="acrylic-3mm-co2"):
        load_process("acrylic-3mm")


def test_the_hint_for_an_unknown_name_is_short() -> None:
    with pytest.raises(ProcessError) as caught:
        load_process("wood")
    assert "deltacam process list" in caught.value.hint
    assert len(caught.value.hint) < 250


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        ("kerf", -1e-4, "kerf"),
        ("kerf", 1.0, "kerf"),
        ("kerf", float("nan"), "kerf"),
        ("feed", 0.0, "feed"),
        ("power", 0.0, "power"),
        ("power", 1.5, "power"),
        ("tolerance", 1e-7, "tolerance"),
        ("engrave_feed", 0.0, "feed for engraving"),
        ("overcut", -1e-3, "overcut"),
        ("passes", 0, "passes"),
        ("lead_in", Lead("line", 1.0), "length of the lead-in"),
        ("lead_out", Lead("arc", None, 1e-6), "radius of the lead-out"),
        ("tabs", Tabs(0.0, count=2), "width of tabs"),
        ("tabs", Tabs(1e-3, count=5000), "number of tabs"),
        ("tabs", Tabs(1e-3), "neither of count and spacing"),
        ("lead_in", Lead("line", None, 1e-3), "no radius"),
    ],
)
def test_a_single_value_out_of_range_is_refused(key: str, value: object, says: str) -> None:
    with pytest.raises(ProcessError, match=says) as caught:
        check_process(replace(load_process("steel-1mm-fibre"), **{key: value}))
    assert caught.value.where.startswith("process steel-1mm-fibre")
    assert caught.value.hint
