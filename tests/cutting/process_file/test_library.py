"""The built-in processes."""

from collections import Counter

import pytest

from deltacam.cutting.gas import stated_feeds
from deltacam.cutting.process import DEFAULT_PROCESS, check_process, load_process, process_names
from deltacam.cutting.process_file.values import NOT_SAID, provenance_of, sections, worst_grade
from deltacam.model import Lead, Process

FIRST = ("steel-1mm-fibre", "acrylic-3mm-co2")
PEOPLE_ONLY = ("name", "source", "material", "thickness_mm", "laser", "laser_power_w", "gas")
OURS = ("tolerance_um", "chord_tolerance_um")
LIBRARY = [load_process(name) for name in process_names()]


def test_there_are_processes_for_what_people_cut() -> None:
    materials = Counter((process.laser, process.material) for process in LIBRARY)
    assert len(LIBRARY) >= 25
    assert {("fibre", name) for name in ("mild steel", "stainless steel", "aluminium")} <= set(materials)
    assert {("co2", name) for name in ("cast acrylic", "birch plywood", "MDF", "card")} <= set(materials)
    gases = {(process.material, gas.name) for process in LIBRARY for gas in process.gases}
    assert {("mild steel", gas) for gas in ("oxygen", "nitrogen", "air")} <= gases


@pytest.mark.parametrize("process", LIBRARY, ids=lambda process: process.name)
def test_every_value_of_a_built_in_process_says_where_it_is_from(process: Process) -> None:
    unsaid = [
        (section.name, value.key)
        for section in sections(process)
        for value in section.values
        if provenance_of(process, section.name, value.key) is None and value.key not in (*PEOPLE_ONLY, *OURS)
    ]
    assert unsaid in ([], [("", "feed_range_m_min")])
    assert worst_grade(process) != NOT_SAID
    assert all(one.source or one.grade == "estimate" for one in process.provenance)
    assert all(one.grade != "measured" for one in process.provenance)  # nobody has cut it on your machine
    assert "Make a test cut." in process.source


@pytest.mark.parametrize("process", LIBRARY, ids=lambda process: process.name)
def test_the_name_of_a_built_in_process_says_what_it_is(process: Process) -> None:
    words = process.name.split("-")
    assert process.laser in words
    if process.name not in FIRST:
        power = f"{process.laser_power / 1e3:g}kw" if process.laser_power % 1e3 == 0 else f"{process.laser_power:g}w"
        assert power in words
    size = next(word for word in words if word.endswith("mm"))
    assert float(size.removesuffix("mm")) == pytest.approx(process.thickness * 1e3, abs=0.31)


@pytest.mark.parametrize("process", LIBRARY, ids=lambda process: process.name)
def test_the_feed_of_a_built_in_process_is_in_its_range(process: Process) -> None:
    low, high = stated_feeds(process)
    assert low <= process.feed <= high
    assert check_process(process) == process


@pytest.mark.parametrize("process", LIBRARY, ids=lambda process: process.name)
def test_a_built_in_process_begins_and_ends_cuts_in_the_waste_and_leaves_no_tabs(process: Process) -> None:
    assert Lead() not in (process.lead_in, process.lead_out)
    assert process.overcut > 0.0
    assert (process.power_law is None) == (process.name in FIRST)
    assert process.tabs is None


def test_the_first_two_have_the_values_that_programs_were_made_with() -> None:
    steel, acrylic = (load_process(name) for name in FIRST)
    assert (steel.kerf, steel.feed, steel.power, steel.pierce_time) == pytest.approx((0.15e-3, 0.15, 1.0, 0.1))
    assert (acrylic.kerf, acrylic.feed, acrylic.power, acrylic.pierce_time) == pytest.approx((0.2e-3, 0.012, 0.7, 0.2))
    assert steel.name == DEFAULT_PROCESS


def test_thicker_material_of_the_same_kind_is_not_cut_faster() -> None:
    kinds: dict[tuple[str, float, str], list[Process]] = {}
    for process in LIBRARY:
        kinds.setdefault((process.material, process.laser_power, process.gas), []).append(process)
    for alike in kinds.values():
        feeds = [process.feed for process in sorted(alike, key=lambda one: one.thickness)]
        assert feeds == sorted(feeds, reverse=True)
