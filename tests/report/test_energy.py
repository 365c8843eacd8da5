"""The energy of a millimetre in the report: the line of the text, the colours, the charts."""

from dataclasses import replace

import numpy as np
import pytest

from deltacam.model import Mode, PowerLaw
from deltacam.program.program import Program
from deltacam.report.colouring import by_energy
from deltacam.report.motion import motion_of
from deltacam.report.motion_figure import motion_figure
from deltacam.report.payload import payload
from deltacam.report.text import to_text
from deltacam.report.view import View
from deltacam.verification.energy import line_energy
from deltacam.verification.evidence import gather
from deltacam.verification.verify import verify
from tests.bench import Bench


def line(program: Program) -> str:
    text = to_text(verify(program, drawing=None))
    return next((one for one in text.splitlines() if one.startswith("  energy")), "")


def test_the_text_names_the_worst_place_and_how_much_it_gets(bench: Bench, program: Program) -> None:
    found = bench.check(verify(program, drawing=None), "energy per mm")
    assert f"to {found.worst:.2f} times that at the feed; most at {found.where}" in line(program)
    assert f"contour {found.contour} (layer CUT" in line(program)


def test_joules_are_there_where_the_power_of_the_laser_is_known(program: Program) -> None:
    strong = replace(program, process=replace(program.process, laser_power=500.0))
    assert "J/mm" not in line(program)
    assert "at the feed, 4.25 J/mm; most" in line(strong)  # 0.85 of 500 W at 100 mm/s
    assert verify(strong, drawing=None).summary["line_energy"]["at_feed_j_mm"] == pytest.approx(4.25)


@pytest.mark.parametrize("mode", [Mode.DRY_RUN, Mode.FRAME])
def test_a_program_that_cuts_nothing_has_no_energy(bench: Bench, mode: Mode) -> None:
    program = bench.but(mode=mode).program()
    assert line(program) == ""
    assert "line_energy" not in verify(program, drawing=None).summary
    evidence = gather(program, program.robot)
    data, _ = payload(evidence, None, View.around(evidence, None))
    assert "energy" not in data["series"]
    assert [colouring["name"] for colouring in data["colourings"]] == ["Speed", "Limit"]


def test_the_level_of_a_colour_holds_the_energy() -> None:
    energy = np.array([np.nan, 0.3, 0.9, 1.0, 1.04, 1.3, 4.9, 99.0])
    colouring = by_energy(energy, 0.0)
    levels = [colouring.labels[colour] for colour in colouring.choice(np.arange(len(energy))).tolist()]
    assert levels == ["", "0.5", "0.95", "1.05", "1.05", "1.6", "5", "more"]
    assert len(colouring.inks) == len(colouring.labels)
    assert colouring.title == "energy per mm up to, 1 is that at the feed"
    assert "1 is 4.25 J/mm" in by_energy(energy, 4.25).title


def test_the_most_unusual_energy_of_a_cell_counts_and_a_cell_without_any_is_grey() -> None:
    energy = np.array([1.0, np.nan, 3.9, np.nan, np.nan, 1.0, 0.3, 1.2])
    colouring = by_energy(energy, 0.0)
    levels = [colouring.labels[colour] for colour in colouring.choice(np.array([0, 3, 5])).tolist()]
    assert levels == ["5", "", "0.5"]


def test_the_power_is_charted_where_it_follows_the_speed(program: Program) -> None:
    for law, titles in ((None, 1), (PowerLaw(0.2), 2)):
        evidence = gather(replace(program, process=replace(program.process, power_law=law)), program.robot)
        figure = motion_figure(evidence, motion_of(evidence), line_energy(evidence))
        words = [word["text"] for word in figure["layout"]["annotations"]]
        assert sum(word.startswith(("Energy per mm", "Laser power")) for word in words) == titles
        assert {"energy", *(["power"] if law else [])} <= {one["series"] for one in figure["lines"]}


def test_the_chart_of_energy_shows_its_largest_value(program: Program) -> None:
    evidence = gather(program, program.robot)
    energy = line_energy(evidence)
    figure = motion_figure(evidence, motion_of(evidence), energy)
    assert figure["layout"]["yaxis3"]["range"][1] >= np.nanmax(energy) > 2.0
