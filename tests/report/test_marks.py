"""Leads, loops, overcuts, tabs, order and direction are in the pictures where they are in the program."""

from __future__ import annotations

import json
import re
from dataclasses import replace

import ezdxf
import numpy as np
import pytest

from deltacam.cutting.process import load_process
from deltacam.model import BlockKind, Lead, Loops, Tabs
from deltacam.pipeline import Planned, plan
from deltacam.report.annotations import Looks
from deltacam.report.bands import BESIDE, DARK, NAMES, RAPID, SUBJECT, TWICE, bands
from deltacam.report.html import to_html
from deltacam.report.marks import headings, marks_of
from deltacam.report.payload import payload, to_script
from deltacam.report.picture import to_svg
from deltacam.report.view import View
from deltacam.verification.evidence import KINDS, Evidence, gather
from deltacam.verification.verify import verify
from tests.bench import Bench
from tests.report.parsed import Page
from tests.report.test_figures import unpacked
from tests.report.test_picture import of_class, polylines, to_sheet, tree


@pytest.fixture(scope="module")
def planned(tmp_path_factory: pytest.TempPathFactory) -> Planned:
    """A square with a hole, and a triangle beside it, cut with all that a cut can have."""
    drawing = ezdxf.new(units=ezdxf.units.MM)
    model = drawing.modelspace()
    model.add_lwpolyline([(0, 0), (40, 0), (40, 40), (0, 40)], close=True)
    model.add_lwpolyline([(60, 0), (100, 0), (80, 36)], close=True)
    model.add_circle((20, 20), 8.0)
    path = tmp_path_factory.mktemp("marks") / "two.dxf"
    drawing.saveas(path)
    process = replace(
        load_process("steel-1mm-fibre"),
        lead_in=Lead("arc", angle=np.pi / 2),
        lead_out=Lead("arc", angle=np.pi / 2),
        overcut=0.5e-3,
        corner="loop",
        loops=Loops(angle=np.radians(60.0)),
        tabs=Tabs(width=0.5e-3, count=2),
    )
    found = plan(path, process=process, what_if=False)
    assert found.report.passed
    return found


@pytest.fixture(scope="module")
def evidence(planned: Planned) -> Evidence:
    return gather(planned.program, planned.program.robot)


def blocks(planned: Planned, kind: BlockKind) -> list[tuple[int, int]]:
    return [(block.first, block.last) for block in planned.program.blocks if block.kind is kind]


def test_every_kind_of_block_is_in_its_band(planned: Planned, evidence: Evidence) -> None:
    band = bands(evidence)
    wanted = {
        BlockKind.RAPID: RAPID,
        BlockKind.PIERCE: SUBJECT,
        BlockKind.CUT: SUBJECT,
        BlockKind.LEAD_IN: BESIDE,
        BlockKind.LOOP: BESIDE,
        BlockKind.OVERCUT: TWICE,
        BlockKind.TAB: DARK,
        BlockKind.LEAD_OUT: DARK,
    }
    kinds = [KINDS[kind] for kind in evidence.kind[:-1]]
    assert set(kinds) == set(wanted)
    assert band.tolist() == [wanted[kind] for kind in kinds]


def test_a_lead_out_with_the_laser_on_is_not_drawn_as_dark(planned: Planned) -> None:
    first, last = blocks(planned, BlockKind.LEAD_OUT)[0]
    power = planned.program.power.copy()
    power[first : last + 1] = 0.5
    burning = replace(planned.program, power=power)
    assert (bands(gather(burning, burning.robot))[first : last + 1] == SUBJECT).all()


def test_the_dots_are_where_the_laser_pierces(planned: Planned, evidence: Evidence) -> None:
    marks = marks_of(evidence, View.around(evidence, planned.drawing).box)
    pierced = evidence.sheet[[first for first, _ in blocks(planned, BlockKind.PIERCE)]]
    drawn = evidence.sheet[np.concatenate([marks.starts, marks.pierces])]
    assert len(pierced) == len(drawn) == 3 + 4
    gaps = np.hypot(*(pierced[:, None] - drawn[None]).transpose(2, 0, 1))
    assert gaps.min(axis=1).max() < 1e-9
    assert [evidence.block_of(tick + 1).kind for tick in marks.starts.tolist()] == [BlockKind.LEAD_IN] * 3
    assert list(marks.numbers.text) == ["1", "2", "3"]


def test_the_bars_are_across_the_path_at_both_ends_of_every_tab(planned: Planned, evidence: Evidence) -> None:
    marks = marks_of(evidence, View.around(evidence, planned.drawing).box)
    tabs = blocks(planned, BlockKind.TAB)
    assert marks.tabs.tolist() == [tick for first, last in tabs for tick in (first, last + 1)]
    ends = evidence.sheet[marks.tabs].reshape(-1, 2, 2)
    along = np.repeat(np.arctan2(*(ends[:, 1] - ends[:, 0]).T[::-1]), 2)
    assert np.abs(np.angle(np.exp(1j * (headings(evidence.sheet, marks.tabs) - along)))).max() < 0.02
    kerf = planned.program.process.kerf
    assert np.hypot(*(ends[:, 1] - ends[:, 0]).T) == pytest.approx(np.full(4, 0.5e-3 + kerf), abs=5e-6)


def test_every_cut_has_an_arrow_that_points_the_way_it_runs(planned: Planned, evidence: Evidence) -> None:
    arrows = marks_of(evidence, View.around(evidence, planned.drawing).box).arrows
    cut = np.flatnonzero(bands(evidence) == SUBJECT)
    steps = evidence.sheet[cut + 1] - evidence.sheet[cut]
    cut, steps = cut[np.hypot(*steps.T) > 5e-5], steps[np.hypot(*steps.T) > 5e-5]
    contours = set()
    for point, heading in zip(arrows.points, arrows.heading, strict=True):
        middle = (evidence.sheet[cut] + evidence.sheet[cut + 1]) / 2.0 - point
        at = int(np.argmin(np.hypot(*middle.T)))
        assert np.hypot(*middle[at]) < 1e-9
        assert (np.cos(heading), np.sin(heading)) == pytest.approx(steps[at] / np.hypot(*steps[at]))
        contours.add(evidence.block_of(int(cut[at])).contour)
    assert contours == {1, 2, 3}
    assert len(arrows.points) > 12


def test_arrows_are_where_the_cut_is_straight(planned: Planned, evidence: Evidence) -> None:
    arrows = marks_of(evidence, View.around(evidence, planned.drawing).box).arrows
    corners = np.array([(0, 0), (40, 0), (40, 40), (0, 40), (60, 0), (100, 0), (80, 36)]) * 1e-3
    gaps = np.hypot(*(arrows.points[:, None] - corners[None]).transpose(2, 0, 1))
    assert gaps.min() > 1.5e-3


def test_a_closer_look_shows_more_arrows_and_never_fewer(planned: Planned, evidence: Evidence) -> None:
    scale = marks_of(evidence, View.around(evidence, planned.drawing).box).arrows.scale
    shown = [int((scale >= pixel).sum()) for pixel in (1e-3, 2.5e-4, 1.5e-4, 5e-5, 1e-5)]
    assert shown == sorted(shown)
    assert 3 <= shown[1] < shown[-1] == len(scale)


def test_the_page_draws_what_is_beside_a_cut_in_lines_of_its_own(planned: Planned, evidence: Evidence) -> None:
    data, _ = payload(evidence, planned.drawing, View.around(evidence, planned.drawing))
    part = json.loads(to_script(data))["part"]
    strokes = part["strokes"]
    assert strokes[BESIDE]["width"] < strokes[SUBJECT]["width"] < strokes[TWICE]["width"]
    assert strokes[DARK]["dash"] != strokes[RAPID]["dash"] != strokes[SUBJECT]["dash"] == "solid"
    names = [name for _, name in part["legend"]]
    assert names == [
        "cut",
        "lead-in, loop",
        "overcut",
        "lead-out, laser off",
        "rapid",
        "tab",
        "pierce, in order",
        "direction",
    ]
    bars = next(trace for trace in part["above"] if trace["marker"]["symbol"] == "line-ns")
    assert len(unpacked(bars["x"])) == len(bars["marker"]["angle"]) == 8
    kinds = next(colouring for colouring in data["colourings"] if colouring["name"] == "Kind")
    assert [label for label in kinds["labels"] if label] == ["cut", "lead-in", "loop", "overcut"]


def test_the_still_picture_has_them_as_well(planned: Planned) -> None:
    picture = tree(to_svg(planned.program, drawing=planned.drawing))
    sheet = to_sheet(planned.program)
    for name, kinds in (("beside", {"lead_in", "loop"}), ("twice", {"overcut"}), ("dark", {"lead_out", "tab"})):
        lines = [line for path in of_class(picture, name) for line in polylines(path)]
        ends = [(b.first, b.last + 1) for b in planned.program.blocks if b.kind.value in kinds]
        drawn = sum(float(np.hypot(*np.diff(line, axis=0).T).sum()) for line in lines)
        way = sum(float(np.hypot(*np.diff(sheet[first : last + 1], axis=0).T).sum()) for first, last in ends)
        assert drawn == pytest.approx(way, rel=0.02), name
    assert len(of_class(picture, "tab")) == 8
    assert len(of_class(picture, "arrow")) >= 3
    texts = [text.text for text in picture.iter() if text.get("class") == "look"]
    assert texts == ["cut", "lead-in, loop", "overcut", "lead-out, laser off", "rapid", "tab", "direction"]
    height = float(picture.get("viewBox", "").split()[3])
    for row in of_class(picture, "looks"):
        x, y = map(float, re.findall(r"[\d.]+", row.get("transform", "")))
        assert x + 36.0 + 8.0 * len("".join(row.itertext())) < 900.0
        assert y < height - 8.0


def test_a_long_legend_goes_on_in_a_second_row() -> None:
    words = {band: ", ".join(word for _, word in pairs) for band, pairs in NAMES.items()}
    looks = Looks(words, tabs=True, arrows=True)
    places = re.findall(r"translate\(([\d.]+) ([\d.]+)\).*?4.5\">(.*?)</text>", looks.drawn(0.0))
    assert [name for *_, name in places] == [*words.values(), "tab", "direction"]
    assert {float(y) for _, y, _ in places} == {0.0, 24.0}
    assert max(float(x) + 36.0 + 8.0 * len(name) for x, _, name in places) < 900.0
    assert looks.height == Looks({}).height + 48.0


def test_the_table_of_contours_says_what_they_have_beside_their_cut(planned: Planned) -> None:
    page = Page(to_html(planned.report, planned.program, drawing=planned.drawing, title="two"))
    rows = {row["contour"]: row for row in page.rows("Contours")}
    counts = {number: (row["loops"], row["tabs"]) for number, row in rows.items()}
    depth = {str(contour.number): contour.depth for contour in planned.drawing.contours}
    assert sorted(value for number, value in counts.items() if depth[number] == 0) == [("3", "2"), ("4", "2")]
    assert [value for number, value in counts.items() if depth[number] == 1] == [("", "")]
    for number, row in rows.items():
        assert float(row["overcut, mm"]) == pytest.approx(0.5, abs=0.45), number
        assert float(row["lead-in, mm"]) > 0.5


def test_a_program_of_cuts_alone_says_nothing_of_other_things(bench: Bench) -> None:
    program = bench.program()
    found = gather(program, program.robot)
    data, _ = payload(found, bench.drawing, View.around(found, bench.drawing))
    assert [name for _, name in data["part"]["legend"]] == ["cut", "rapid", "pierce, in order", "direction"]
    assert "Kind" not in [colouring["name"] for colouring in data["colourings"]]
    heads = Page(to_html(verify(program, drawing=bench.drawing), program, drawing=bench.drawing, title="plate")).rows(
        "Contours"
    )[0]
    assert not {"tabs", "loops", "overcut, mm", "lead-in, mm"} & set(heads)
