"""The small picture of a drawing: near to it everywhere, small whatever it holds."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from shapely import LineString, MultiLineString, Point

from deltacam.batch.results.thumbnail import MOST_NUMBERS, SPAN, Lines, thumbnail, to_svg
from deltacam.drawing.reader import read_drawing
from deltacam.geometry import curve as curves
from deltacam.model import Curve, Drawing
from tests.batch.rows import DIAGONAL, TRIANGLE

ROOT = Path(__file__).parents[2]
DRAWINGS = [*sorted((ROOT / "tests" / "data" / "dxf").glob("*.dxf"))[1::3], ROOT / "samples" / "sheet.dxf"]


def dxf(*entities: str) -> bytes:
    """A drawing in mm."""
    head = "0\nSECTION\n2\nHEADER\n9\n$INSUNITS\n70\n4\n0\nENDSEC\n"
    return f"{head}0\nSECTION\n2\nENTITIES\n{''.join(entities)}0\nENDSEC\n0\nEOF\n".encode()


def circle(x: float, y: float, radius: float) -> str:
    return f"0\nCIRCLE\n8\n0\n10\n{x}\n20\n{y}\n40\n{radius}\n"


def read(*entities: str) -> Drawing:
    return read_drawing("a.dxf", data=dxf(*entities))


def places(line: tuple[int, ...]) -> list[tuple[int, int]]:
    return list(zip(line[::2], line[1::2], strict=True))


def drawn(drawing: Drawing) -> tuple[MultiLineString, float]:
    """The contours in the steps of the picture, drawn finely, and how many metres a step is; else what is ignored."""
    shown = drawing.contours or drawing.ignored
    boxes = np.array([curves.bounds(contour.curve) for contour in shown])
    origin, end = boxes[:, :2].min(axis=0), boxes[:, 2:].max(axis=0)
    step = float((end - origin).max()) / SPAN
    flat = [curves.flatten(contour.curve, step / 50)[0] for contour in shown]
    closed = [np.vstack([points, points[:1]]) for points in flat]
    lines = [p if contour.curve.closed else f for p, f, contour in zip(closed, flat, shown, strict=True)]
    return MultiLineString([(points - origin) / step for points in lines]), step


@pytest.mark.parametrize("path", DRAWINGS, ids=lambda path: path.stem)
def test_a_picture_is_near_its_drawing_and_the_other_way_round(path: Path) -> None:
    try:
        drawing = read_drawing(path, default_unit="mm", strict=False)
    except Exception:  # noqa: BLE001 - not every one of them can be read
        pytest.skip("cannot be read")
    lines = thumbnail(drawing)
    assert sum(map(len, lines)) <= MOST_NUMBERS
    if not (drawing.contours or drawing.ignored):
        assert lines == ()
        return
    assert all(isinstance(number, int) and 0 <= number <= SPAN for line in lines for number in line)
    true, _ = drawn(drawing)
    picture = MultiLineString([places(line) for line in lines])
    assert picture.hausdorff_distance(true) < 3.0  # steps of 160, which are half a pixel each
    assert max(max(line) for line in lines) == SPAN


def test_the_picture_is_the_same_for_the_same_drawing_at_any_size_and_place() -> None:
    small = read(circle(0, 0, 10), circle(3, 2, 4))
    large = read(circle(500, 700, 1000), circle(800, 900, 400))
    assert thumbnail(small) == thumbnail(large) != ()


def test_a_drawing_of_very_many_lines_keeps_its_longest_ones() -> None:
    holes = [circle(10 * column, 10 * row, 1 + (row + column) % 3) for row in range(40) for column in range(40)]
    lines = thumbnail(read(*holes, circle(200, 200, 400)))
    assert sum(map(len, lines)) <= MOST_NUMBERS
    assert any(max(line) - min(line) == SPAN for line in lines)


def test_one_line_of_very_many_corners_is_drawn_coarsely_and_not_left_out() -> None:
    # A comb of 1,300 teeth: each is narrower than a step.
    teeth = [(x, 0 if (x // 2) % 2 else 5000) for x in range(5200)]
    points = "".join(f"10\n{x}\n20\n{y}\n" for x, y in teeth)
    comb = f"0\nLWPOLYLINE\n100\nAcDbEntity\n8\n0\n100\nAcDbPolyline\n90\n{len(teeth)}\n70\n0\n{points}"
    lines = thumbnail(read(comb, circle(100, 100, 10)))
    assert 0 < sum(map(len, lines)) <= MOST_NUMBERS
    assert max(max(line) for line in lines) == SPAN


def test_a_straight_line_has_a_picture_too() -> None:
    drawing = read(circle(0, 0, 10))
    straight = Curve(np.array([[-0.5, 0.0], [0.5, 0.0]]), np.zeros(1), closed=False)
    flat = replace(drawing, contours=(replace(drawing.contours[0], curve=straight),))
    assert thumbnail(flat) == ((0, 0, SPAN, 0),)
    assert 'viewBox="-2 -2 164 4"' in to_svg(thumbnail(flat))


def test_a_hole_that_is_too_small_to_be_seen_is_a_dot() -> None:
    lines = thumbnail(read(circle(0, 0, 80), circle(30, 0, 0.2)))
    assert (110, 80, 110, 80) in lines
    assert '<path d="M110 80l0 0"/>' in to_svg(lines)


def inked(svg: str) -> tuple[list[list[tuple[int, int]]], list[list[tuple[int, int]]]]:
    """The places of the closed and of the open lines, y down, as a browser reads the paths."""
    found: tuple[list[list[tuple[int, int]]], list[list[tuple[int, int]]]] = ([], [])
    for kind, path in re.findall(r'<path( class="area")? d="([^"]*)"/>', svg):
        for x, y, steps, close in re.findall(r"M(\d+) (\d+)l([- \d]+)(z?)", path):
            numbers = np.array([int(number) for number in re.findall(r"-?\d+", steps)]).reshape(-1, 2)
            at = np.vstack([[int(x), int(y)], numbers]).cumsum(axis=0)
            assert bool(close) == bool(kind)
            found[0 if kind else 1].append([*map(tuple, at.tolist())])
    return found


def test_the_svg_shows_the_lines_with_y_down_and_closed_ones_as_areas() -> None:
    closed, others = inked(to_svg((TRIANGLE, DIAGONAL)))
    assert closed == [[(0, 90), (160, 90), (80, 0)]]
    assert others == [[(0, 0), (160, 90)]]
    assert to_svg(()) == '<svg viewBox="-2 -2 164 164" aria-hidden="true"></svg>'


@pytest.mark.parametrize("name", ["snowflake", "nameplate", "sheet"])
def test_the_svg_of_a_drawing_holds_every_point_of_its_picture(name: str) -> None:
    lines: Lines = thumbnail(read_drawing(ROOT / "samples" / f"{name}.dxf"))
    svg = to_svg(lines)
    closed, others = inked(svg)
    height = max(max(line[1::2]) for line in lines)
    shown = {tuple((x, height - y) for x, y in each) for each in (*others, *([*one, one[0]] for one in closed))}
    assert shown == {tuple(places(line)) for line in lines}
    assert len(svg) < 3 * MOST_NUMBERS


def test_places_of_a_circle_are_on_it() -> None:
    (ring,) = thumbnail(read(circle(7, 7, 3)))
    true = Point(SPAN / 2, SPAN / 2).buffer(SPAN / 2, quad_segs=200).exterior
    assert LineString(places(ring)).hausdorff_distance(true) < 1.5
    assert ring[:2] == ring[-2:]
