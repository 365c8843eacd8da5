"""Reading what a process file says of leads, power, tabs and all else of cutting technology."""

import math
from pathlib import Path

import pytest

from deltacam.cutting.process import check_process, load_process
from deltacam.cutting.process_file.sections import SECTIONS
from deltacam.errors import ProcessError
from deltacam.model import Gas, Heat, Lead, Loops, PowerLaw, Process, Provenance, Slower, Tabs

GOOD = 'name = "card"\nkerf_mm = 0.2\nfeed_m_min = 6\n'
ALL = (
    GOOD
    + """
laser = "fibre"
laser_power_w = 1500
gas = "nitrogen"
feed_range_m_min = [4, 8]
overcut_mm = 0.5
start = "edge"
passes = 2
corner = "loop"

[lead_in]
shape = "line+arc"
radius_mm = 1.5
angle_deg = 60

[lead_out]
shape = "line"
length_mm = 2

[pierce]
power = 0.4
first = true

[power_law]
at_rest = 0.3
exponent = 1.5
lowest = 0.1

[[slower]]
factor = 0.5
hole_diameter_mm = 4

[[slower]]
factor = 0.7
radius_mm = 1

[loops]
angle_deg = 45
radius_mm = 2

[tabs]
width_mm = 0.4
spacing_mm = 50
corner_mm = 3
holes = true

[heat]
distance_mm = 20
time_s = 1.5

[gases.oxygen]
pressure_bar = 0.7

[gases.nitrogen]
pressure_bar = 12
feed_factor = 0.6

[provenance]
kerf_mm = { grade = "measured", source = "comb" }
engrave.power = { grade = "estimate" }
gases.nitrogen = { grade = "community" }
lead_in = { grade = "vendor" }
"""
)


def read(folder: Path, text: str) -> Process:
    path = folder / "card.toml"
    path.write_text(text, encoding="utf-8")
    return check_process(load_process(path))


def refused(folder: Path, text: str) -> ProcessError:
    with pytest.raises(ProcessError) as caught:
        read(folder, text)
    return caught.value


def test_everything_is_read_in_si(tmp_path: Path) -> None:
    process = read(tmp_path, ALL)
    assert (process.laser, process.laser_power, process.gas) == ("fibre", 1500.0, "nitrogen")
    assert (process.start, process.passes, process.corner) == ("edge", 2, "loop")
    assert process.overcut == pytest.approx(0.5e-3)
    assert process.lead_in == Lead("line+arc", None, 1.5e-3, math.radians(60.0))
    assert process.lead_out == Lead("line", 2e-3)
    assert (process.pierce_power, process.pre_pierce) == (0.4, True)
    assert process.power_law == PowerLaw(0.3, 1.5, 0.1)
    assert process.slower == (Slower(0.5, diameter=4e-3), Slower(0.7, radius=1e-3))
    assert process.loops == Loops(math.radians(45.0), 2e-3)
    assert process.tabs == Tabs(0.4e-3, spacing=50e-3, corner=3e-3, holes=True)
    assert process.heat == Heat(20e-3, 1.5)
    assert process.gases == (Gas("oxygen", 0.7e5), Gas("nitrogen", 12e5, 0.6))
    assert process.provenance == (
        Provenance("kerf_mm", "measured", "comb"),
        Provenance("engrave.power", "estimate"),
        Provenance("gases.nitrogen", "community"),
        Provenance("lead_in", "vendor"),
    )


def test_the_feed_and_its_range_are_those_of_the_gas_in_use(tmp_path: Path) -> None:
    process = read(tmp_path, ALL)
    assert process.feed == pytest.approx(6.0 / 60.0 * 0.6)
    assert process.feeds == pytest.approx((4.0 / 60.0 * 0.6, 8.0 / 60.0 * 0.6))


def test_a_file_that_says_nothing_of_it_has_the_defaults_of_the_model(tmp_path: Path) -> None:
    process = read(tmp_path, GOOD)
    default = Process(
        name="card", source="", material="", thickness=0.0, kerf=2e-4, feed=0.1, power=1.0, pierce_time=0.0
    )
    assert process == default


@pytest.mark.parametrize("text", ["[tabs]\nwidth_mm = 1\ncount = 0", "[heat]\ndistance_mm = 0\ntime_s = 1"])
def test_a_section_can_be_switched_off(tmp_path: Path, text: str) -> None:
    process = read(tmp_path, f"{GOOD}{text}\n")
    assert (process.tabs, process.heat) == (None, None)


@pytest.mark.parametrize("section", ["lead_in", "lead_out"])
def test_a_lead_is_automatic_where_its_length_is_not_given(tmp_path: Path, section: str) -> None:
    for length in ("", 'length_mm = "auto"\n'):
        process = read(tmp_path, f'{GOOD}[{section}]\nshape = "arc"\n{length}')
        assert getattr(process, section) == Lead("arc")


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("laser = 'yag'", "laser = 'yag' is not"),
        ("passes = 0", "passes = 0 is outside 1 to 100"),
        ("passes = 1.5", "not a whole number"),
        ("start = 'middle'", "start = 'middle' is not"),
        ("overcut_mm = -1", "overcut_mm = -1 is outside"),
        ("feed_range_m_min = [6]", "a list of 2 numbers"),
        ("feed_range_m_min = [8, 6]", "feed_range_m_min = [6, 8]"),
        ("overcuts_mm = 1", "did you mean 'overcut_mm'"),
        ("[lead_in]\nlength_mm = 2", "shape is missing"),
        ("[lead_in]\nshape = 'line'\nlength_mm = 'long'", "length_mm = 'long' is not \"auto\""),
        ("[lead_in]\nshape = 'line'\nlength_mm = 0", "length_mm = 0 is outside"),
        ("[lead_in]\nshape = 'line'\nlength = 2", "did you mean 'length_mm'"),
        ("[lead_in]\nshape = 'line'\nradius_mm = 2", "a line has no radius"),
        ("[lead_in]\nshape = 'none'\nlength_mm = 2", "neither length nor radius"),
        ("[lead_in]\nshape = 'arc'\nangle_deg = 0", "an arc that turns by 0 degrees"),
        ("[lead_in]\nshape = 'arc'\nlength_mm = 2\nradius_mm = 2", "follows from its radius"),
        ("[lead_in]\nshape = 'line+arc'\nlength_mm = 3\nradius_mm = 2", "leaves nothing for the line"),
        ("[pierce]\npower = 2", "power = 2 is outside"),
        ("[pierce]\nfirst = 1", "not true or false"),
        ("[power_law]\nexponent = 1", "at_rest is missing"),
        ("power = 0.3\n[power_law]\nat_rest = 0.5\nlowest = 0.4", "more than the power of the cut"),
        ("[[slower]]\nfactor = 0.5", "neither for which holes nor for which bends"),
        ("[slower]\nfactor = 0.5", "write [[slower]] above each"),
        ("[tabs]\nwidth_mm = 1", "neither of count and spacing_mm"),
        ("[tabs]\nwidth_mm = 1\ncount = 2\nspacing_mm = 9", "both of count and spacing_mm"),
        ("[tabs]\nwidth_mm = 9\nspacing_mm = 9", "leave nothing to cut"),
        ("[heat]\ndistance_mm = 9", "time_s is missing"),
        ("gas = 'argon'\n[gases.oxygen]\npressure_bar = 1", 'gas = "oxygen"'),
        ("[gases.oxygen]\npressure_bar = 1", "none of those under [gases]"),
        ("[gases]\noxygen = 1", "oxygen = 1 must be a section"),
        ("gas = 'oxygen'\n[gases.oxygen]\nfactor = 1", "did you mean 'feed_factor'"),
        ("[provenance]\nkerf_mm = 'me'", "must be a section"),
        ("[provenance]\nkerf_mm = { source = 'me' }", "grade is missing"),
        ("[provenance]\nkerf_mm = { grade = 'sure' }", "grade = 'sure' is not"),
        ("[provenance]\nkerf = { grade = 'vendor' }", "did you mean 'kerf_mm'"),
        ("[provenance]\nengrave.powers = { grade = 'vendor' }", "did you mean 'power'"),
        ("[provenance]\nkerf_mm.wide = { grade = 'vendor' }", "grade is missing"),
    ],
)
def test_what_is_wrong_is_named(tmp_path: Path, text: str, says: str) -> None:
    problem = refused(tmp_path, f"{GOOD}{text}\n")
    assert says in f"{problem.what} {problem.hint}"
    assert problem.where.startswith("card.toml")


def test_what_is_impossible_is_located_in_its_section(tmp_path: Path) -> None:
    problem = refused(tmp_path, GOOD + "[[slower]]\nfactor = 1\nradius_mm = 1\n[[slower]]\nfactor = 1\n")
    assert problem.where == "card.toml [slower 2]"


@pytest.mark.parametrize("section", sorted(set(SECTIONS) - {"gases"}))
def test_the_values_that_provenance_may_name_are_those_that_a_section_has(tmp_path: Path, section: str) -> None:
    opening = f"[[{section}]]" if section == "slower" else f"[{section}]"
    needed = {"engrave": "feed_m_min = 1\npower = 1\n", "power_law": "at_rest = 1\n", "slower": "factor = 1\n"}
    needed |= {"tabs": "width_mm = 1\ncount = 1\n", "heat": "distance_mm = 1\ntime_s = 1\n"}
    needed |= dict.fromkeys(("lead_in", "lead_out"), "shape = 'line'\n")
    problem = refused(tmp_path, f"{GOOD}{opening}\n{needed.get(section, '')}zz = 1\n")
    assert sorted(problem.hint.removeprefix("known: ").split(", ")) == sorted(SECTIONS[section])
