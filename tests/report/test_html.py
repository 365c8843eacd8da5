"""The page shows every part of the report, and nothing in a file can change what the page does."""

import json
import re
from dataclasses import replace

import numpy as np
import pytest

from deltacam.model import Block, BlockKind, Check, Drawing, Finding, LedgerEntry, Mode, Operation, Outcome, Report
from deltacam.program.program import Program
from deltacam.report.html import to_html
from deltacam.report.page import plotly_js
from deltacam.verification.evidence import gather
from deltacam.verification.verify import verify
from tests.bench import Bench
from tests.report.parsed import Page, page

HOSTILE = "</style></title><script>alert(1)</script>\"' onload=x ]]>&lt;\u202e\u2066\x00\x1b[31m\ud800\ufffe\n"
SPELLED = "</style></title><script>alert(1)</script>\"' onload=x ]]>&lt;\\u202e\\u2066\\x00"

CHECKS = (
    Check("joint range", True, worst=-3.25, limit=0.0, unit="deg", tick=800, where="joint 2"),
    Check(
        "feed while cutting", False, worst=104.2, limit=100.0, unit="mm/s", tick=123, where="contour 1 (layer CUT, #1A)"
    ),
    Check("drawing", True),
    Check("rows", False, worst=123456.7, limit=0.0, unit="rows"),
)
LEDGER = tuple(
    LedgerEntry(
        f"{number:X}", "LINE", f"layer {number}", "", Outcome.CUT if number % 3 else Outcome.IGNORED, "", number
    )
    for number in range(1, 61)
)
FINDINGS = (Finding("an open chain is not cut", "layer 0, #2F", "close it"), Finding("no hint"))
REPORT = Report(CHECKS, {"contours_cut": 4, "time_s": {"cut": 1.5}, "nothing": None}, LEDGER, FINDINGS)


def test_the_verdict_comes_first_and_names_what_failed(program: Program) -> None:
    failed = page(REPORT, program)
    passed = page(replace(REPORT, checks=CHECKS[::2]), program)
    assert [text for tag, text in failed.texts if tag in ("h1", "p")] == [
        "plate",
        "Failed",
        "2 of 4 checks failed: feed while cutting, rows.",
    ]
    assert "Passed" in passed.text_in("p")
    assert passed.text_in("title")[0] == "plate: passed"


def test_a_warning_is_told_and_does_not_fail_the_program(program: Program) -> None:
    found = page(replace(REPORT, checks=(CHECKS[0], replace(CHECKS[1], warns=True), CHECKS[2])), program)
    assert "Passed" in found.text_in("p")
    assert "3 checks, 1 with a warning: feed while cutting." in found.text_in("p")
    assert [row["verdict"] for row in found.rows("Checks")] == ["! warning", "\u2713 passed", "\u2713 passed"]
    both = page(replace(REPORT, checks=(replace(CHECKS[1], warns=True), CHECKS[3])), program)
    assert [row["check"] for row in both.rows("Checks")] == ["rows", "feed while cutting"]


def test_the_bar_of_a_limit_that_is_exceeded_is_marked(program: Program) -> None:
    shares = {"joint speed": 0.5, "tool speed": 1.001, "feed while cutting": 1.9}
    bars = page(replace(REPORT, summary={"share_of_limit": shares}), program).all_of("b")
    assert [(bar["style"], bar.get("class")) for bar in bars] == [
        ("width:50%", None),
        ("width:100%", None),
        ("width:100%", "over"),
    ]


def test_a_report_without_checks_has_not_passed(program: Program) -> None:
    assert "Not checked" in page(Report((), {}), program).text_in("p")


def test_every_check_is_in_its_table_with_the_failed_ones_first(program: Program) -> None:
    rows = page(REPORT, program).rows("Checks")
    assert [row["check"] for row in rows] == ["feed while cutting", "rows", "joint range", "drawing"]
    assert list(rows[0].values())[1:] == ["\u2717 failed", "104.2", "100", "mm/s", "0.3075", CHECKS[1].where]
    assert list(rows[1].values())[1:] == ["\u2717 failed", "123457", "0", "rows", "", ""]
    assert list(rows[2].values())[1:] == ["\u2713 passed", "-3.25", "0", "deg", "2.0000", "joint 2"]
    assert list(rows[3].values())[1:] == ["\u2713 passed", "", "", "", "", ""]


def test_every_entity_of_the_drawing_and_every_finding_is_listed(program: Program) -> None:
    found = page(replace(REPORT, checks=CHECKS * 9), program)
    entries = [(f"#{entry.handle}", entry.layer, entry.outcome, str(entry.contour)) for entry in LEDGER]
    rows = found.rows("Entities of the drawing")
    assert [(row["handle"], row["layer"], row["outcome"], row["contour"]) for row in rows] == entries
    assert "Entities of the drawing" in found.folded
    assert "Checks" not in found.folded
    assert [tuple(row.values()) for row in found.rows("Findings")] == [
        (finding.what, finding.where, finding.hint) for finding in FINDINGS
    ]


def test_every_figure_of_the_summary_is_listed_and_none_says_none(program: Program) -> None:
    found = page(REPORT, program)
    figures = {row["figure"]: row["value"] for row in found.rows("All figures")}
    assert figures == {"contours_cut": "4", "time_s: cut": "1.5", "nothing": ""}
    assert not re.search(r"\b(None|nan|inf)\b", " ".join(text for tag, text in found.texts if tag != "script"))


def test_every_contour_has_its_length_time_and_speeds(bench: Bench) -> None:
    program = bench.program()
    rows = page(verify(program, drawing=bench.drawing), program, bench.drawing).rows("Contours")
    assert [row["contour"] for row in rows] == ["1", "2", "3", "4"]
    assert [row["handles"] for row in rows] == [f"#{number}A, #{number}B" for number in range(1, 5)]
    circle = rows[1]
    block = next(block for block in program.blocks if block.kind is BlockKind.CUT and block.contour == 2)
    time = (block.last - block.first + 1) / 400.0
    assert float(circle["length, mm"]) == pytest.approx(2e3 * np.pi * (6e-3 - 0.1e-3), abs=0.05)
    assert float(circle["time, s"]) == pytest.approx(time, abs=1e-3)
    assert float(circle["mean, mm/s"]) == pytest.approx(float(circle["length, mm"]) / time, abs=0.1)
    # The law of the bench has its peak at 1.875 of its mean.
    assert float(circle["largest, mm/s"]) == pytest.approx(1.875 * float(circle["mean, mm/s"]), rel=0.01)


def test_a_contour_that_is_not_cut_and_a_cut_that_is_not_drawn_are_in_the_table(bench: Bench) -> None:
    program = bench.but(order=(4, 2)).program()
    drawing = replace(bench.drawing, contours=bench.drawing.contours[:3])
    rows = page(REPORT, program, drawing).rows("Contours")
    assert {row["contour"]: row["done"] == "not done" for row in rows} == {
        "1": True,
        "2": False,
        "3": True,
        "4": False,
    }


def test_the_size_of_every_contour_is_shown(bench: Bench, program: Program) -> None:
    report = verify(program, drawing=bench.drawing)
    rows = page(report, program, bench.drawing).rows("Sizes")
    assert [row["contour"] for row in rows] == ["1", "2", "3", "4"]
    circle = rows[1]
    assert float(circle["drawn, mm\u00b2"]) == pytest.approx(36.0 * np.pi, rel=1e-4)
    assert float(circle["left, mm\u00b2"]) == pytest.approx(36.0 * np.pi, rel=2e-3)
    assert float(circle["edge off, \u00b5m"]) == pytest.approx(1e6 * report.sizes[1].edge, abs=0.005)


def test_many_handles_are_shortened(bench: Bench) -> None:
    contours = tuple(replace(contour, handles=tuple("ABCDE")) for contour in bench.drawing.contours)
    rows = page(REPORT, bench.program(), replace(bench.drawing, contours=contours)).rows("Contours")
    assert {row["handles"] for row in rows} == {"#A, #B, #C and 2 more"}


def hostile(bench: Bench) -> tuple[Report, Program, Drawing]:
    contours = tuple(replace(c, layer=HOSTILE, handles=(HOSTILE,)) for c in bench.drawing.contours)
    program = bench.program()
    program = replace(
        program,
        blocks=tuple(replace(block, layer=HOSTILE, handles=(HOSTILE,)) for block in program.blocks),
        drawing=replace(program.drawing, file=HOSTILE),
        process=replace(program.process, name=HOSTILE),
    )
    report = Report(
        (Check(HOSTILE, False, 1.0, 0.0, HOSTILE, 3, HOSTILE),),
        {HOSTILE: {HOSTILE: HOSTILE}, "share_of_limit": {HOSTILE: 0.5}, "contours_cut": HOSTILE},
        (LedgerEntry(HOSTILE, HOSTILE, HOSTILE, HOSTILE, Outcome.IGNORED, HOSTILE),),
        (Finding(HOSTILE, HOSTILE, HOSTILE),),
    )
    return report, program, replace(bench.drawing, file=HOSTILE, contours=contours)


def test_names_from_files_are_shown_and_do_nothing(bench: Bench) -> None:
    report, program, drawing = hostile(bench)
    content = to_html(report, program, drawing=drawing, title=HOSTILE)
    found = Page(content)
    assert len(found.all_of("script")) == content.count("<script") == 3
    data, *scripts = found.text_in("script")
    for bad in ("]]>", "\u202e", "\u2066", "\x00", "\x1b", "\ud800", "\ufffe", "\"' onload"):
        assert bad not in content.replace(plotly_js(), "").replace(data, ""), bad
    assert not set("<>&\u2028\u2029") & set(data)
    assert data.isascii()
    assert json.loads(data)["blocks"]["layers"] == [SPELLED[:57] + "..."]
    harmless = page(REPORT, bench.program(), bench.drawing)
    assert found.text_in("style") == harmless.text_in("style")
    names = {name for _, attributes in harmless.tags for name in attributes}
    assert {name for _, attributes in found.tags for name in attributes} <= names
    assert scripts == harmless.text_in("script")[1:]
    assert not any(name.startswith("on") or name in ("href", "src") for name in names)
    styles = {attributes["style"] for _, attributes in found.tags if "style" in attributes}
    assert all(re.fullmatch(r"width:\d+%|background-color: rgb\(\d+, \d+, \d+\)", style) for style in styles)
    for heading in ("Checks", "Findings", "Contours", "Entities of the drawing", "All figures"):
        assert any(SPELLED[:30] in cell for row in found.tables[heading][1:] for cell in row), heading
    assert found.text_in("h1")[0].startswith(SPELLED)


def test_tables_have_headings_and_pictures_have_titles(program: Program) -> None:
    found = page(REPORT, program)
    assert {cell.get("scope") for cell in found.all_of("th")} == {"col", "row"}
    assert all(svg["role"] == "img" for svg in found.all_of("svg"))
    assert [tag for tag, _ in found.tags].count("desc") == len(found.all_of("svg")) == 1
    plots = [plot for plot in found.all_of("div") if "plot" in (plot.get("class") or "")]
    assert all(plot["role"] == "img" and plot["aria-label"] for plot in plots)
    assert found.all_of("html") == [{"lang": "en"}]


def test_a_long_program_is_thinned_and_the_page_says_so(bench: Bench) -> None:
    program = bench.program()
    q = np.tile(program.q, (1 + 200_000 // len(program.q), 1))
    row = np.zeros(len(q), dtype=np.int64)
    blocks = (Block(BlockKind.CUT, 0, len(q) - 1, 1, "CUT", ("1A",)),)
    program = replace(program, q=q, power=row + 0.85, block=row, blocks=blocks)
    content = to_html(REPORT, program, drawing=None, title="plate").replace(plotly_js(), "")
    assert len(content) < 4_000_000
    assert "Each point pair is the smallest and the largest of 17 setpoints." in content
    assert "Zoomed out, every column" in to_html(REPORT, bench.program(), drawing=None, title="plate")


def test_a_check_with_a_place_has_a_button_that_goes_there(program: Program) -> None:
    found = page(REPORT, program)
    buttons = [button for button in found.all_of("button") if button.get("class") == "go"]
    assert [button["data-tick"] for button in buttons] == ["123", "800"]
    x, y = 1e3 * gather(program, program.robot).sheet[123]
    assert [float(buttons[0][name]) for name in ("data-x", "data-y")] == pytest.approx([x, y], abs=1e-4)
    placed = replace(REPORT, checks=(replace(CHECKS[3], place=(0.012, -0.003)),))
    (button,) = [button for button in page(placed, program).all_of("button") if button.get("class") == "go"]
    assert (button["data-x"], button["data-y"], button.get("data-tick")) == ("12.0000", "-3.0000", None)


@pytest.mark.parametrize("rows", [1, 2, 3, 5])
def test_programs_of_a_few_rows_have_a_page(program: Program, rows: int) -> None:
    few = replace(program, q=program.q[:rows], power=program.power[:rows], block=program.block[:rows])
    assert page(verify(few, drawing=None), few).all_of("svg")


def test_what_is_engraved_is_told_from_what_is_cut(bench: Bench) -> None:
    contours = [replace(c, operation=Operation.ENGRAVE) if c.number == 2 else c for c in bench.drawing.contours]
    drawing = replace(bench.drawing, contours=tuple(contours))
    paths = bench.paths
    marked = bench.but(drawing=drawing, order=(2, 4, 3, 1), paths=lambda half: paths(half) | {2: paths(0.0)[2]})
    program = marked.program()
    found = page(verify(program, drawing=drawing), program, drawing)
    assert {row["contour"]: row["done"] for row in found.rows("Contours")} == dict.fromkeys("134", "cut") | {
        "2": "engraved"
    }
    assert f"{2e3 * np.pi * 6e-3:.1f} mm" in found.text_in("dd")
    assert "contours engraved" in found.text_in("dt")
    assert "mm (header)" in found.text_in("dd")


def test_a_frame_and_a_program_out_of_reach_have_a_page(program: Program) -> None:
    frame = replace(
        program, mode=Mode.FRAME, blocks=(Block(BlockKind.RAPID, 0, len(program.q) - 1),), block=0 * program.block
    )
    assert "frame" in page(verify(frame, drawing=None), frame).text_in("dd")
    q = program.q.copy()
    q[3] = 3.0
    lost = replace(program, q=q)
    found = page(verify(lost, drawing=None), lost)
    assert "Failed" in found.text_in("p")
    assert {row["length, mm"] for row in found.rows("Contours")} == {"unknown"}
    assert not [button for button in found.all_of("button") if button.get("class") == "go"]


def test_the_page_is_of_the_robot_that_the_program_was_checked_against(program: Program) -> None:
    slow = replace(program.robot, tool=replace(program.robot.tool, max_speed=0.75))
    assert "606.7 of 1000" in to_html(REPORT, program, drawing=None, title="plate")
    assert "606.7 of 750" in to_html(REPORT, program, drawing=None, title="plate", robot=slow)


def test_the_same_report_gives_the_same_page(bench: Bench) -> None:
    program = bench.program()
    report = verify(program, drawing=bench.drawing)
    assert to_html(report, program, drawing=bench.drawing, title="plate") == to_html(
        report, program, drawing=bench.drawing, title="plate"
    )
