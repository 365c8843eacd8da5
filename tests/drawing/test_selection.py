"""Which lines are machined, what blocks a plan, and what else a person is told about a drawing."""

from collections import Counter
from pathlib import Path
from typing import Any

import pytest

from deltacam.drawing.reader import read_drawing
from deltacam.errors import DrawingError
from deltacam.model import Drawing, Operation, Outcome, Rule, Selection

FILES = Path(__file__).parents[1] / "data" / "dxf"
SQUARE = [(0, 0), (1000, 0), (1000, 1000), (0, 1000)]


def square(msp: Any) -> None:
    msp.add_lwpolyline(SQUARE, close=True)


def a_plate(msp: Any) -> None:
    """An outline of lines with a bend line between two of its corners, a mark inside, and a tick."""
    for start, end in zip(SQUARE, (*SQUARE[1:], SQUARE[0]), strict=True):
        msp.add_line(start, end, dxfattribs={"layer": "CUT"})
    msp.add_line(SQUARE[0], SQUARE[2], dxfattribs={"layer": "BEND", "color": 1})
    msp.add_circle((300, 600), 50, dxfattribs={"layer": "Engrave"})
    msp.add_line((600, 100), (900, 100), dxfattribs={"layer": "Engrave"})


def outcomes(drawing: Drawing) -> Counter[tuple[str, Outcome]]:
    return Counter((entry.layer, entry.outcome) for entry in drawing.ledger)


def test_lines_of_one_operation_are_joined_among_themselves(reread: Any) -> None:
    rules = (Rule(Operation.IGNORE, layer="bend"), Rule(Operation.ENGRAVE, layer="ENG*", open=Operation.ENGRAVE))
    drawing = reread(a_plate, selection=Selection(rules=rules))
    assert [(one.number, one.operation, one.curve.closed, one.depth) for one in drawing.contours] == [
        (1, Operation.CUT, True, 0),
        (2, Operation.ENGRAVE, True, 1),
        (4, Operation.ENGRAVE, False, 0),
    ]
    assert [(one.number, one.layer, one.operation) for one in drawing.ignored] == [(3, "BEND", Operation.IGNORE)]
    assert outcomes(drawing) == {
        ("CUT", Outcome.CUT): 4,
        ("BEND", Outcome.IGNORED): 1,
        ("Engrave", Outcome.ENGRAVED): 2,
    }
    (entry,) = [entry for entry in drawing.ledger if entry.layer == "BEND"]
    assert (entry.reason, entry.contour) == ("the process ignores layer BEND", 3)


def test_lines_that_meet_in_more_than_one_way_block_a_plan(reread: Any) -> None:
    with pytest.raises(DrawingError, match="2 outlines share lines"):
        reread(a_plate)
    drawing = reread(a_plate, strict=False)
    assert {finding.kind for finding in drawing.findings if finding.blocks} == {"common_edge"}


@pytest.mark.parametrize(
    ("selection", "machined"),
    [
        (Selection(layers=("CUT",)), {"CUT"}),
        (Selection(ignored_layers=("b*",)), {"CUT", "Engrave"}),
        (Selection(layers=("cut", "Eng*"), ignored_layers=("engrave",)), {"CUT"}),
        (Selection(rules=(Rule(Operation.IGNORE, color=1),), open=Operation.CUT), {"CUT", "Engrave"}),
    ],
)
def test_layers_can_be_chosen(reread: Any, selection: Selection, machined: set[str]) -> None:
    drawing = reread(a_plate, selection=selection)
    assert {contour.layer for contour in drawing.contours} == machined
    assert len(drawing.ledger) == 7
    assert drawing.selection == selection


def test_what_a_layer_leaves_out_is_not_called_open(reread: Any) -> None:
    drawing = reread(a_plate, selection=Selection(layers=("CUT",)))
    assert {contour.layer for contour in drawing.ignored} == {"BEND", "Engrave"}
    (finding,) = drawing.findings
    assert (finding.kind, finding.where) == ("layer", "layer BEND, Engrave")
    assert finding.what == "3 entities are left out as --layer and --ignore-layer say"


def test_an_outline_that_is_left_out_makes_no_holes(reread: Any) -> None:
    def draw(msp: Any) -> None:
        msp.add_lwpolyline([(0, 0), (100, 0), (100, 100), (0, 100), (0, 0.5)], dxfattribs={"layer": "TABBED"})
        msp.add_circle((50, 50), 20)

    (hole,) = reread(draw).contours
    (outline,) = reread(draw, selection=Selection(ignored_layers=("TABBED",))).contours
    assert (hole.depth, outline.depth) == (1, 0)


def test_a_layer_that_is_not_there_is_refused(reread: Any) -> None:
    with pytest.raises(DrawingError, match="no layer of the drawing is called 'CTU'") as caught:
        reread(a_plate, selection=Selection(layers=("CTU",)))
    assert "'CUT'" in caught.value.hint


@pytest.mark.parametrize(("joining", "closed"), [(1e-5, 0), (2e-4, 1)])
def test_gaps_are_closed_only_where_the_user_allows_it(reread: Any, joining: float, closed: int) -> None:
    def draw(msp: Any) -> None:
        for start, end in zip(SQUARE, (*SQUARE[1:], SQUARE[0]), strict=True):
            msp.add_line(start, (end[0], end[1] + 0.1))

    drawing = reread(draw, selection=Selection(joining=joining), strict=False)
    assert len(drawing.contours) == closed
    kinds = [finding.kind for finding in drawing.findings]
    assert ("gap" in kinds, kinds.count("joined")) == ((False, 4) if closed else (True, 0))


def an_insert_of_nothing(msp: Any) -> None:
    msp.add_circle((0, 0), 30)
    msp.add_blockref("MISSING", (5, 5))


def test_lost_geometry_blocks_until_the_loss_is_accepted(reread: Any) -> None:
    with pytest.raises(DrawingError, match="MISSING"):
        reread(an_insert_of_nothing)
    for options in ({"strict": False}, {"selection": Selection(accept_loss=True)}):
        drawing = reread(an_insert_of_nothing, **options)
        assert len(drawing.contours) == 1
        (entry,) = [entry for entry in drawing.ledger if entry.outcome is Outcome.LOST]
        assert (entry.kind, entry.contour) == ("INSERT", None)
        assert "MISSING" in entry.reason


def test_damage_on_a_layer_that_is_left_out_does_not_matter(reread: Any) -> None:
    def draw(msp: Any) -> None:
        square(msp)
        msp.add_line((0, 0, 0), (1, 1, 5), dxfattribs={"layer": "NOTES"})
        msp.add_circle((5, 5), -1, dxfattribs={"layer": "NOTES"})

    with pytest.raises(DrawingError):
        reread(draw)
    drawing = reread(draw, selection=Selection(ignored_layers=("NOTES",)))
    assert len(drawing.contours) == 1
    assert Outcome.LOST in {entry.outcome for entry in drawing.ledger}

    def insert(msp: Any) -> None:
        square(msp)
        msp.add_blockref("MISSING", (5, 5), dxfattribs={"layer": "NOTES"})

    with pytest.raises(DrawingError, match="MISSING"):
        reread(insert, selection=Selection(ignored_layers=("NOTES",)))


def test_an_object_of_an_unknown_kind_blocks_until_the_loss_is_accepted(tmp_path: Path) -> None:
    path = tmp_path / "part.dxf"
    data = (FILES / "wrench-inch.dxf").read_bytes()
    first = data.index(b"\r\nLINE\r\n", data.index(b"ENTITIES"))
    path.write_bytes(data[:first] + b"\r\nBEAM" + data[first + 6 :])
    with pytest.raises(DrawingError, match="BEAM is lost: an object that only the program that made it can draw"):
        read_drawing(path)
    drawing = read_drawing(path, selection=Selection(accept_loss=True), strict=False)
    assert [entry.kind for entry in drawing.ledger if entry.outcome is Outcome.LOST] == ["BEAM"]


def test_a_drawing_without_a_unit_can_be_looked_at(reread: Any) -> None:
    drawing = reread(square, insunits=0, strict=False)
    assert (drawing.unit, drawing.unit_source, drawing.metres_per_unit) == ("", "missing", 1e-3)
    assert [(finding.kind, finding.blocks) for finding in drawing.findings] == [("units", True)]
    assert drawing.extents == pytest.approx((0.0, 0.0, 1.0, 1.0))


def test_a_page_and_many_words_look_like_a_drawing(reread: Any) -> None:
    def draw(msp: Any) -> None:
        msp.add_lwpolyline([(0, 0), (297, 0), (297, 210), (0, 210)], close=True)
        msp.add_circle((100, 100), 30)
        for i in range(10):
            msp.add_text("note", dxfattribs={"insert": (i, 0)})

    found = [finding.what for finding in reread(draw).findings if finding.kind == "drawing_sheet"]
    assert len(found) == 2
    assert "it holds 10 TEXT" in found[0]
    assert "page (A4)" in found[1]


def test_an_open_chain_that_the_process_wants_two_things_of_is_refused(reread: Any) -> None:
    def draw(msp: Any) -> None:
        square(msp)
        msp.add_line((0, 5), (10, 5), dxfattribs={"layer": "A"})
        msp.add_line((10, 5), (20, 9), dxfattribs={"layer": "B"})

    rules = (Rule(Operation.CUT, layer="A", open=Operation.CUT), Rule(Operation.CUT, layer="B"))
    with pytest.raises(DrawingError, match="different things: cut and ignore"):
        reread(draw, selection=Selection(rules=rules))


def test_the_two_edges_of_a_thick_line_are_noted(reread: Any) -> None:
    def draw(msp: Any) -> None:
        msp.add_circle((0, 0), 5)
        msp.add_circle((0, 0), 4.85)
        msp.add_circle((20, 0), 5)
        msp.add_circle((20, 0), 4.5)
        msp.add_circle((40, 0), 5)
        msp.add_circle((40.1, 0), 4.85)

    found = [finding for finding in reread(draw).findings if finding.kind == "double"]
    assert [finding.what.split(",")[0] for finding in found] == ["it runs 0.15 mm inside contour 1 all around"]
    assert found[0].place == pytest.approx((4.85e-3, 0.0))


def test_engraved_lines_may_meet_in_any_way(reread: Any) -> None:
    def draw(msp: Any) -> None:
        square(msp)
        for start, end in [((10, 10), (50, 10)), ((50, 10), (30, 40)), ((30, 40), (10, 10)), ((30, 40), (90, 90))]:
            msp.add_line(start, end, dxfattribs={"layer": "ENGRAVE"})
        msp.add_line((10, 10), (30, 20), dxfattribs={"layer": "ENGRAVE"})
        msp.add_line((30, 20), (50, 10), dxfattribs={"layer": "ENGRAVE"})

    drawing = reread(draw)
    assert {entry.outcome for entry in drawing.ledger[1:]} == {Outcome.ENGRAVED}
    assert any(finding.kind in ("branch", "common_edge") for finding in drawing.findings)
