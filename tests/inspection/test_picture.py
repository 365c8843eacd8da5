"""The picture of what was read: decoded from its own elements it is the drawing again."""

import re
from collections import Counter
from dataclasses import replace
from xml.etree import ElementTree

import numpy as np
import pytest

from deltacam.geometry import curve as curves
from deltacam.inspection import picture, style
from deltacam.inspection.picture import to_svg
from deltacam.model import Contour, Drawing, Finding, Operation

HOSTILE = "</style><script>alert(1)</script>\"'&]]>\u202e\u2066\x00\x1b[31m\ud800\ufffe\n"
SVG = "{http://www.w3.org/2000/svg}"
NUMBER = r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?"


def tree(content: str) -> ElementTree.Element:
    return ElementTree.fromstring(content)  # noqa: S314 - our own text


def group(content: str, name: str) -> ElementTree.Element:
    return next(element for element in tree(content).iter(f"{SVG}g") if element.get("class") == name)


def paths(content: str, name: str) -> list[ElementTree.Element]:
    return group(content, name).findall(f"{SVG}path")


def numbers(text: str | None) -> list[float]:
    return [float(number) for number in re.findall(NUMBER, text or "")]


def pixels(content: str, place: tuple[float, float], drawing: Drawing) -> np.ndarray:
    """Where the picture's own transformation puts a place of the drawing, m."""
    x, y, sx, sy = numbers(group(content, "curves").get("transform"))
    left, lower = (drawing.extents or (0.0, 0.0))[:2]
    return np.array([x + sx * 1e6 * (place[0] - left), y + sy * 1e6 * (place[1] - lower)])


def legend(content: str) -> dict[str, int]:
    """What the legend says of each kind of line and mark."""
    texts = [text.text or "" for text in group(content, "legend").iter(f"{SVG}text")]
    return {match[1]: int(match[2]) for text in texts if (match := re.fullmatch(r"(.*) (\d+)", text))}


def many(count: int) -> Drawing:
    """A row of small circles."""
    contours = tuple(
        Contour(i + 1, curves.circle(np.array([0.01 * i, 0.0]), 0.004), "0", (f"{i:X}",)) for i in range(count)
    )
    return Drawing("many.dxf", "", 1e-3, "mm", "header", contours, (), extents=(-0.004, -0.004, 0.01 * count, 0.004))


def test_every_contour_is_drawn_by_what_becomes_of_it(drawing: Drawing) -> None:
    drawn = Counter(path.get("class") for path in paths(to_svg(drawing), "curves"))
    kinds = {"outer": 2, "hole": 2, "engraved": 2, "line": 1, "open": 1, "ignored": 1, "repeated": 1}
    assert drawn == kinds


def test_the_legend_counts_what_is_drawn(drawing: Drawing) -> None:
    assert legend(to_svg(drawing)) == {
        "outer": 2,
        "hole": 2,
        "open, cut on the line": 1,
        "engraved": 2,
        "open, not cut": 1,
        "ignored": 1,
        "some of it drawn twice": 1,
        "gap": 1,
        "branch": 1,
        "crossing": 1,
        "other warning": 1,
    }


def test_a_band_marks_the_contour_that_something_was_merged_into(drawing: Drawing) -> None:
    content = to_svg(drawing)
    band = next(path for path in paths(content, "curves") if path.get("class") == "repeated")
    slot = next(path for path in paths(content, "curves") if "contour 4:" in path.findtext(f"{SVG}title", ""))
    assert band.get("d") == slot.get("d")


def test_every_finding_with_a_place_has_its_mark_there(drawing: Drawing) -> None:
    content = to_svg(drawing)
    placed = [finding for finding in drawing.findings if finding.place]
    marks = paths(content, "marks")
    assert [mark.get("class") for mark in marks] == ["gap", "crossing", "branch", "note"]
    for mark, finding in zip(marks, placed, strict=True):
        assert finding.place is not None
        np.testing.assert_allclose(numbers(mark.get("transform")), pixels(content, finding.place, drawing), atol=0.02)
        assert mark.findtext(f"{SVG}title") == finding.what


def test_the_drawing_lies_inside_the_picture_with_y_up(drawing: Drawing) -> None:
    content = to_svg(drawing)
    assert drawing.extents is not None
    left, lower, right, upper = drawing.extents
    low, high = pixels(content, (left, upper), drawing), pixels(content, (right, lower), drawing)
    _, _, width, height = numbers(tree(content).get("viewBox"))
    assert np.all(low >= (30.0, 60.0))
    assert np.all(high <= (width - 30.0, height - 60.0))
    assert min(high - low) > 100.0


def test_the_scale_bar_is_as_long_as_it_says(drawing: Drawing) -> None:
    content = to_svg(drawing)
    bar = next(path for path in paths(content, "legend") if "h" in path.get("d", ""))
    length = float(re.search(rf"h({NUMBER})", bar.get("d", ""))[1])  # type: ignore[index]
    stated = next(text.text for text in group(content, "legend").findall(f"{SVG}text"))
    scale = numbers(group(content, "curves").get("transform"))[2] * 1e6
    assert length / scale == pytest.approx(numbers(stated)[0] * 1e-3, rel=1e-4)
    assert 50.0 < length <= 150.0


def test_numbers_are_those_of_the_contours(drawing: Drawing) -> None:
    texts = group(to_svg(drawing), "numbers").findall(f"{SVG}text")
    assert sorted(int(text.text or 0) for text in texts) == list(range(1, 10))


def test_a_number_stands_in_its_contour_unless_others_are_in_there(drawing: Drawing) -> None:
    content = to_svg(drawing)
    boxes = {2: ((0.016, 0.024), (0.024, 0.016)), 4: ((0.06, 0.035), (0.1, 0.025))}
    texts = {int(text.text or 0): text for text in group(content, "numbers").findall(f"{SVG}text")}
    for number, inside in ((2, False), (4, True)):
        low, high = (pixels(content, corner, drawing) for corner in boxes[number])
        place = np.array([float(texts[number].get(axis, "nan")) for axis in "xy"])
        assert bool(np.all((low < place) & (place < high))) == inside


def test_holes_are_drawn_on_their_material_whatever_the_numbers() -> None:
    hole = Contour(1, curves.circle(np.zeros(2), 0.01), "0", ("1",), depth=1, parent=2)
    outline = Contour(2, curves.circle(np.zeros(2), 0.02), "0", ("2",))
    frame = Contour(3, curves.circle(np.zeros(2), 0.03), "0", ("3",), operation=Operation.IGNORE)
    sheet = Drawing(
        "a.dxf", "", 1.0, "m", "header", (hole, outline), (), ignored=(frame,), extents=(-0.03, -0.03, 0.03, 0.03)
    )
    assert [path.get("class") for path in paths(to_svg(sheet), "curves")] == ["outer", "hole", "ignored"]


def test_titles_name_number_kind_layer_operation_and_size(drawing: Drawing) -> None:
    titles = {path.findtext(f"{SVG}title") for path in paths(to_svg(drawing), "curves")}
    assert "contour 2: hole in 1, layer CUT, cut, 20.00 x 20.00 mm" in titles
    assert "contour 9: open, layer CUT, ignore, 15.00 x 30.00 mm" in titles


def test_the_heading_names_file_unit_and_size(drawing: Drawing) -> None:
    assert "part.dxf</text>" in to_svg(drawing)
    assert ">unit mm (header), 145.00 \u00d7 90.00 mm<" in to_svg(drawing)
    assert "no unit stated: sizes as if it were mm" in to_svg(replace(drawing, unit="", unit_source="missing"))


def test_kinds_differ_in_colour_and_without_colour() -> None:
    dashes = [each.dash for each in style.LINES]
    shapes = [mark.shape for mark in style.MARKS]
    assert len(set(dashes)) == len(dashes)
    assert len(set(shapes)) == len(shapes)
    for theme in ("light", "dark"):
        assert len({getattr(each, theme) for each in style.LINES}) >= 5
    sheet = style.sheet()
    assert "prefers-color-scheme:dark" in sheet
    assert "vector-effect:non-scaling-stroke" in sheet
    defined = set(re.findall(r"--(\w+):", sheet.partition("@media")[0]))
    assert set(re.findall(r"var\(--(\w+)\)", sheet)) <= defined


def test_nothing_in_a_name_becomes_markup(drawing: Drawing) -> None:
    contours = tuple(replace(contour, layer=HOSTILE) for contour in drawing.contours)
    findings = tuple(replace(finding, what=HOSTILE) for finding in drawing.findings)
    content = to_svg(replace(drawing, file=HOSTILE, unit=HOSTILE, contours=contours, findings=findings))
    assert {element.tag.removeprefix(SVG) for element in tree(content).iter()} == {
        "svg",
        "title",
        "desc",
        "style",
        "rect",
        "g",
        "path",
        "text",
    }
    assert not set("\u202e\u2066\x00\x1b\ud800\ufffe") & set(content)


def test_the_same_drawing_gives_the_same_picture(drawing: Drawing) -> None:
    assert to_svg(drawing) == to_svg(drawing)


def test_a_drawing_of_nothing_has_a_picture(empty: Drawing) -> None:
    content = to_svg(empty)
    assert paths(content, "curves") == []
    assert "nothing is drawn" in content


@pytest.mark.parametrize("points", [[(0, 0), (5, 0)], [(0, 0), (0, 1e-6)]])
def test_a_single_line_has_a_picture(points: list[tuple[float, float]]) -> None:
    line = curves.Curve(points=np.array(points), bulges=np.zeros(1), closed=False)
    contour = Contour(1, line, "0", ("1",), operation=Operation.IGNORE)
    (x, y), (u, v) = points
    one = Drawing("a.dxf", "", 1.0, "m", "header", (), (), ignored=(contour,), extents=(x, y, u, v))
    assert np.isfinite(numbers(group(to_svg(one), "curves").get("transform"))).all()
    assert legend(to_svg(one)) == {"open, not cut": 1}


def test_many_contours_are_one_path_without_titles_and_numbers() -> None:
    few, more = to_svg(many(picture.MOST_TITLES)), to_svg(many(picture.MOST_TITLES + 1))
    assert len(paths(few, "curves")) == picture.MOST_TITLES
    assert [path.get("d", "").count("M") for path in paths(more, "curves")] == [picture.MOST_TITLES + 1]
    assert 'class="numbers"' not in more
    assert ("no numbers" in more, "no numbers" in few) == (True, False)


def test_the_picture_of_very_many_segments_stays_small(monkeypatch: pytest.MonkeyPatch) -> None:
    crowd = many(2000)
    whole = to_svg(crowd)
    monkeypatch.setattr(picture, "MOST_SEGMENTS", 1000)
    coarse = to_svg(crowd)
    assert "is left out</desc>" in coarse
    assert "is left out;" in coarse  # and where people see it
    assert len(coarse) < 0.7 * len(whole)
    assert legend(coarse) == legend(whole) == {"outer": 2000}


def test_of_very_many_marks_some_are_drawn_and_all_are_counted(drawing: Drawing) -> None:
    gaps = tuple(Finding("gap", kind="gap", place=(i * 1e-5, 0.0)) for i in range(picture.MOST_MARKS + 7))
    content = to_svg(replace(drawing, findings=gaps))
    assert len(paths(content, "marks")) == picture.MOST_MARKS
    assert f"gap {picture.MOST_MARKS + 7} ({picture.MOST_MARKS} shown)" in content
