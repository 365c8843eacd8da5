"""The picture shows what the setpoints do: decoded from its own paths it is the program again."""

import re
from collections.abc import Callable
from dataclasses import replace
from itertools import combinations
from typing import Protocol
from xml.etree import ElementTree

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from shapely import LineString, MultiLineString, Point, Polygon, box, distance, points

from deltacam.geometry import curve as curves
from deltacam.model import Block, BlockKind, Contour, Curve, Drawing, Mode, Operation
from deltacam.program.program import Program
from deltacam.report.picture import speed_colours, to_svg

SVG = "{http://www.w3.org/2000/svg}"
HOSTILE = "</style><script>alert(1)</script>\"'&]]>\u202e\u2066\x00\x1b[31m\ud800\ufffe\n"


class Bench(Protocol):
    """The planner of the tests, see conftest."""

    drawing: Drawing
    paths: Callable[[float], dict[int, Curve]]

    def but(self, **changes: object) -> "Bench": ...

    def program(self) -> Program: ...


def tree(content: str) -> ElementTree.Element:
    return ElementTree.fromstring(content)  # noqa: S314 - our own text


def parsed(program: Program, drawing: Drawing | None = None) -> ElementTree.Element:
    return tree(to_svg(program, drawing=drawing))


def to_base(program: Program, sheet: np.ndarray) -> np.ndarray:
    """Places of the sheet in the base frame, (N, 3) m; complex numbers, where the picture turns by matrices."""
    place = program.placement
    turned = sheet @ (1.0, 1j) * np.exp(1j * place.rotation) + complex(place.x, place.y)
    return np.column_stack((turned.real, turned.imag, np.full(len(sheet), place.z)))


def to_sheet(program: Program, ticks: slice | np.ndarray = np.s_[:]) -> np.ndarray:
    """Where the tool is at ``ticks``, (N, 2) m in the sheet frame."""
    place = program.placement
    turned = program.robot.forward(program.q[ticks])[:, :2] @ (1.0, 1j) - complex(place.x, place.y)
    turned *= np.exp(-1j * place.rotation)
    return np.column_stack((turned.real, turned.imag))


def of_class(picture: ElementTree.Element, name: str) -> list[ElementTree.Element]:
    return [element for element in picture.iter() if element.get("class") == name]


def polylines(path: ElementTree.Element) -> list[np.ndarray]:
    """What a path of relative moves draws, m in the sheet frame."""
    lines, pen = [], np.zeros(2, dtype=np.int64)
    for move in path.get("d", "").split("m")[1:]:
        way = np.array(re.findall(r"-?\d+", move), dtype=np.int64).reshape(-1, 2)
        lines.append((pen + np.cumsum(way, axis=0)) * 1e-6)
        pen = pen + way.sum(axis=0)
    return lines


def colour(path: ElementTree.Element) -> int:
    return int(re.fullmatch(r"var\(--c(\d+)\)", path.get("stroke", ""))[1])


def legend(picture: ElementTree.Element) -> dict[int, float]:
    """The speed under each labelled colour of the legend, mm/s."""
    keys = {float(key.get("x")) + 15.0: re.search(r"\d+", key.get("fill"))[0] for key in of_class(picture, "key")}
    texts = {float(text.get("x")): text.text for text in picture.iter(f"{SVG}text")}
    return {int(index): float(texts[x]) for x, index in keys.items() if x in texts}


def tolerance(picture: ElementTree.Element) -> float:
    return float(re.search(r"within (\d+) µm", picture.find(f"{SVG}desc").text)[1]) * 1e-6


def one_cut(bench: Bench, sheet: np.ndarray) -> Program:
    """A program of one cut through the given places, (N, 2) m."""
    program = bench.program()
    block = Block(BlockKind.CUT, 0, len(sheet) - 1, 1, "CUT", ("1A",))
    zeros = np.zeros(len(sheet), dtype=np.int64)
    q = program.robot.inverse(to_base(program, sheet))
    return replace(program, q=q, power=zeros + 0.85, block=zeros, blocks=(block,))


def straight(bench: Bench, x: np.ndarray) -> Program:
    return one_cut(bench, np.column_stack((x, np.zeros_like(x))))


def test_every_cut_has_one_dot_where_it_begins_numbered_in_its_order(bench: Bench) -> None:
    picture = parsed(bench.program(), bench.drawing)
    assert [text.text for text in of_class(picture, "number")] == ["1", "2", "3", "4"]
    names = [dot.find(f"{SVG}title").text for dot in of_class(picture, "start")]
    assert [re.search(r"contour (\d)", name)[1] for name in names] == ["4", "3", "2", "1"]
    at = np.array([[float(dot.get("cx")), float(dot.get("cy"))] for dot in of_class(picture, "start")])
    x, y, right, up = map(float, re.findall(r"-?[\d.]+(?:e-?\d+)?", of_class(picture, "speed")[0].get("transform")))
    drawn = (at - (x, y)) / (right, up) * 1e-6
    program = bench.program()
    assert right == -up > 0.0
    starts = [block.first for block in program.blocks if block.kind is BlockKind.CUT]
    assert drawn == pytest.approx(to_sheet(program, np.array(starts)), abs=2e-6)


def test_the_coloured_lines_are_the_cuts_and_the_dashed_ones_the_rapids(bench: Bench) -> None:
    program = bench.program()
    picture = parsed(program, bench.drawing)
    sheet = to_sheet(program)
    rapid = np.array([block.kind is BlockKind.RAPID for block in program.blocks])[program.block]
    for name, rows in (("rapid", rapid), ("speed", ~rapid)):
        lines = [line for path in of_class(picture, name) for line in polylines(path)]
        way = MultiLineString(
            [LineString(pair) for pair in zip(sheet[:-1][rows[:-1]], sheet[1:][rows[:-1]], strict=True)]
        )
        drawn = MultiLineString(lines)
        assert distance(points(sheet[rows]), drawn).max() <= tolerance(picture)
        assert distance(points(np.vstack(lines)), way).max() <= 1e-6
        assert drawn.length == pytest.approx(way.length, rel=2e-3)


def test_what_is_engraved_has_a_colour_of_its_own_and_a_place_in_the_legend(bench: Bench) -> None:
    ring = Contour(5, curves.circle(np.zeros(2), 4e-3), "MARK", ("5A",), operation=Operation.ENGRAVE)
    line = Curve(points=np.array([(-0.01, 0.012), (0.01, 0.012)]), bulges=np.zeros(1), closed=False)
    tick = Contour(6, line, "MARK", ("6A",), operation=Operation.ENGRAVE)
    drawing = replace(bench.drawing, contours=(*bench.drawing.contours, ring, tick))
    paths = bench.paths
    marked = bench.but(
        drawing=drawing, order=(5, 6, 4, 3, 2, 1), paths=lambda half: paths(half) | {5: ring.curve, 6: line}
    )
    program = marked.program()
    picture = parsed(program, drawing)
    (path,) = of_class(picture, "engraved")
    found = polylines(path)
    assert len(found) == 2
    assert np.hypot(*found[0].T) == pytest.approx(np.full(len(found[0]), 4e-3), abs=tolerance(picture) + 1e-6)
    assert found[1] == pytest.approx(line.points, abs=2e-6)
    assert "--mark:#" in picture.find(f"{SVG}style").text
    assert "engraved" in [text.text for text in picture.iter(f"{SVG}text")]
    assert [text.text for text in of_class(picture, "number")] == ["1", "2", "3", "4"]
    (lines,) = of_class(picture, "lines")
    assert lines.get("fill") == "none"
    assert len(polylines(lines)) == 2
    assert len(polylines(of_class(picture, "contours")[0])) == 4
    only = marked.but(order=(5, 6))
    assert not of_class(parsed(only.program(), drawing), "speed")
    plain = parsed(bench.program(), bench.drawing)
    assert not of_class(plain, "engraved")
    assert "engraved" not in [text.text for text in plain.iter(f"{SVG}text")]


def test_the_material_is_filled_between_the_drawn_contours(bench: Bench) -> None:
    picture = parsed(bench.program(), bench.drawing)
    (path,) = of_class(picture, "contours")
    assert path.get("fill-rule") == "evenodd"
    lines = polylines(path)
    assert len(lines) == len(bench.drawing.contours)
    assert all((line[0] == line[-1]).all() for line in lines)
    hole = lines[1]  # a circle of 6 mm about (-15, 0)
    middle = (hole[:-1] + hole[1:]) / 2.0 - (-0.015, 0.0)
    assert np.hypot(*middle.T) == pytest.approx(np.full(len(middle), 6e-3), abs=tolerance(picture))


@given(st.floats(1.0, 1e6))
def test_the_colours_of_speed_are_few_in_round_steps_and_reach_the_largest_speed(top: float) -> None:
    step, count = speed_colours(np.array([0.0, top]))
    assert f"{step:e}".split("e")[0].rstrip("0") in {"1.", "2.", "2.5", "5."}
    assert count <= 15
    assert abs((count - 1) * step - top) <= 0.53 * step
    assert count >= 7


@pytest.mark.parametrize("speed", [0.4, 7.3, 60.0, 125.0, 150.0, 999.0])
def test_a_constant_speed_has_the_one_colour_that_the_legend_gives_it(bench: Bench, speed: float) -> None:
    x = np.arange(40) * speed * 1e-3 / 400.0 - 0.04
    picture = parsed(straight(bench, x))
    (path,) = of_class(picture, "speed")
    speeds = legend(picture)
    assert speeds[0] == 0.0
    step = speeds[2] / 2.0
    assert abs(colour(path) * step - speed) <= 0.53 * step
    assert f"--c{colour(path)}:#" in picture.find(f"{SVG}style").text


def round_and_round(bench: Bench, step: np.ndarray) -> Program:
    """A wavy circle of 100 mm, run again and again by the given steps, m."""
    turns = np.cumsum(step) / 0.05
    radius = 0.05 + 1e-3 * np.sin(9.0 * turns)
    return one_cut(bench, radius[:, np.newaxis] * np.column_stack((np.cos(turns), np.sin(turns))))


@pytest.mark.parametrize("feed", [0.004, 0.1])
def test_a_large_program_is_small_and_keeps_its_slowest_and_fastest_tick(bench: Bench, feed: float) -> None:
    step = np.full(200_000, feed / 400.0)
    step[60_000], step[140_000] = 0.0, 2.4 * feed / 400.0
    program = round_and_round(bench, step)
    content = to_svg(program, drawing=None)
    assert len(content) < 400_000
    picture = tree(content)
    sheet = to_sheet(program)
    speed = 400e3 * np.hypot(*np.diff(sheet, axis=0).T)
    step_mm_s = speed_colours(speed)[0]
    for tick in (int(speed.argmin()), int(speed.argmax())):
        wanted = int(speed[tick] / step_mm_s + 0.53)
        (path,) = [path for path in of_class(picture, "speed") if colour(path) == wanted]
        assert MultiLineString(polylines(path)).distance(Point(sheet[tick])) <= tolerance(picture)


def test_colours_that_alternate_at_every_tick_do_not_make_a_large_picture(bench: Bench) -> None:
    program = round_and_round(bench, np.tile([8e-5, 24e-5], 50_000))
    assert len(to_svg(program, drawing=None)) < 400_000


def test_a_frame_is_coloured_as_a_whole_and_has_no_cuts(bench: Bench) -> None:
    program = bench.program()
    blocks = (Block(BlockKind.RAPID, 0, len(program.q) - 1),)
    zeros = np.zeros(len(program.q), dtype=np.int64)
    picture = parsed(replace(program, mode=Mode.FRAME, blocks=blocks, block=zeros, power=zeros), bench.drawing)
    assert of_class(picture, "speed")
    assert not of_class(picture, "rapid")
    assert not of_class(picture, "start")


@pytest.mark.parametrize("rows", [1, 2, 3, 5])
def test_programs_of_a_few_rows_at_one_place_have_a_picture(bench: Bench, rows: int) -> None:
    picture = parsed(straight(bench, np.full(rows, 0.01)))
    assert "0.00 \u00d7 0.00 mm" in picture.find(f"{SVG}desc").text
    assert not of_class(picture, "contours")


def test_a_program_out_of_reach_shows_the_drawing_and_says_why(bench: Bench) -> None:
    program = bench.program()
    q = program.q.copy()
    q[3] = 3.0
    picture = parsed(replace(program, q=q), bench.drawing)
    assert of_class(picture, "contours")
    assert not of_class(picture, "speed")
    assert "within" not in picture.find(f"{SVG}desc").text


def test_rows_of_blocks_that_do_not_exist_are_drawn_as_rapids(bench: Bench) -> None:
    program = replace(bench.program(), power=np.zeros(len(bench.program().q)))
    picture = parsed(replace(program, block=np.where(program.block == 1, 99, program.block)), bench.drawing)
    assert len(of_class(picture, "rapid")) == 1


def test_numbers_are_left_out_where_they_would_lie_on_others(bench: Bench) -> None:
    program = straight(bench, np.linspace(-0.04, 0.04, 280))
    blocks = tuple(Block(BlockKind.CUT, 2 * i, 2 * i + 1, i + 1, "CUT", ("1",)) for i in range(140))
    picture = parsed(replace(program, blocks=blocks, block=np.repeat(np.arange(140), 2)))
    assert len(of_class(picture, "start")) == 140
    numbers = of_class(picture, "number")
    assert [text.text for text in numbers[:2]] == ["1", "2"]
    assert 40 < len(numbers) < 140
    boxes = [_box(text) for text in numbers]
    assert not any(one.intersects(other) for one, other in combinations(boxes, 2))


def _box(text: ElementTree.Element) -> Polygon:
    """About where a number is, in pixels: digits are 12 high and at least 6.5 wide."""
    x, y, width = float(text.get("x")), float(text.get("y")), 6.5 * len(text.text)
    left = x - width if text.get("text-anchor") == "end" else x
    return box(left, y - 9.0, left + width, y)


def test_names_from_files_cannot_leave_their_place(bench: Bench) -> None:
    def renamed(contour: Contour) -> Contour:
        return replace(contour, layer=HOSTILE, handles=(HOSTILE,))

    drawing = replace(bench.drawing, file=HOSTILE, contours=tuple(map(renamed, bench.drawing.contours)))
    program = bench.program()
    blocks = tuple(replace(block, layer=HOSTILE, handles=(HOSTILE,)) for block in program.blocks)
    program = replace(program, blocks=blocks, drawing=replace(program.drawing, file=HOSTILE))
    content = to_svg(program, drawing=drawing)
    picture = tree(content)
    assert not list(picture.iter(f"{SVG}script"))
    assert all(
        bad not in content for bad in ("<script", "]]>", "\u202e", "\u2066", "\x00", "\x1b", "\ud800", "\ufffe", "\"'")
    )
    assert "<script>alert(1)</script>\"'&]]>\\u202e" in picture.find(f"{SVG}title").text
    assert [style.text for style in picture.iter(f"{SVG}style")] == [
        style.text for style in parsed(bench.program(), bench.drawing).iter(f"{SVG}style")
    ]


def test_nothing_is_fetched_and_nothing_runs(bench: Bench) -> None:
    content = to_svg(bench.program(), drawing=bench.drawing)
    assert not re.search(r"href|url\(|@import|<script|<image|<use|\son\w+=", content)
    assert content.count("http") == 1  # the name of the SVG vocabulary


def test_the_same_program_gives_the_same_picture(bench: Bench) -> None:
    assert to_svg(bench.program(), drawing=bench.drawing) == to_svg(bench.program(), drawing=bench.drawing)
